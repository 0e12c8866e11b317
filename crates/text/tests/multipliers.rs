//! The forces of constraints, told by outputs, against closed forms, other formulations and differences.

use approx::assert_relative_eq;
use lagrangian::{Dual, Seeded};
use std::sync::Arc;
use text::{FREE, Family, TextModel, Unit, Words};

fn words(coordinates: &[&str], lagrangian: &str, constraints: &[&str], positions: &[&str]) -> Words {
    let owned = |texts: &[&str]| texts.iter().map(|&text| text.to_owned()).collect();
    Words {
        coordinates: coordinates.iter().map(|&name| (name.to_owned(), Unit::other("m"))).collect(),
        parameters: vec![("m".to_owned(), 1.7), ("g".to_owned(), 9.81)],
        lagrangian: lagrangian.to_owned(),
        constraints: owned(constraints),
        positions: owned(positions),
        outputs: vec![("force".to_owned(), "lambda1".to_owned())],
        ..Words::default()
    }
}

/// A knife edge with mass `m` above its contact point, on a slope.
fn edge() -> Words {
    let row = "y'*cos(th) - x'*sin(th)";
    words(&["x", "y", "th"], "m/2*(x'^2 + y'^2) + 0.3*th'^2 - m*g*sin(0.2)*y", &[row], &[])
}

fn told(words: &Words, q: &[f64], v: &[f64]) -> Vec<f64> {
    TextModel::new(words).unwrap().told(0.0, q, v)
}

#[test]
fn of_a_knife_edge_and_of_a_pendulum() {
    let (m, g, speed, rate, heading) = (1.7, 9.81, 1.3, 0.8, 0.6_f64);
    let (c, s) = (heading.cos(), heading.sin());
    // Across the edge the mass turns with it, and its weight pulls.
    let expected = m * speed * rate + m * g * 0.2_f64.sin() * c;
    let found = told(&edge(), &[0.4, -0.2, heading], &[speed * c, speed * s, rate]);
    assert_relative_eq!(found[0], expected, max_relative = 1e-14);

    // The tension is the centripetal force and the weight along the rod, twice its length for the slope of the square.
    let pendulum = words(&["x", "y"], "m/2*(x'^2 + y'^2) - m*g*y", &[], &["x^2 + y^2 = 4"]);
    let tension = m * speed * speed / 2.0 + m * g * c;
    let found = told(&pendulum, &[2.0 * s, -2.0 * c], &[speed * c, speed * s]);
    assert_relative_eq!(found[0], -tension / 4.0, max_relative = 1e-14);
}

/// Units of the constraint, of mass, and light coordinates beside heavy ones: the forces are those of the same system in other words.
#[test]
fn in_other_units() {
    let (q, v) = ([0.4, -0.2, 0.6], [1.3 * 0.6_f64.cos(), 1.3 * 0.6_f64.sin(), 0.8]);
    let here = told(&edge(), &q, &v)[0];
    for scale in [1e-12, 1e-6, 1e6, 1e12] {
        let mut scaled = edge();
        scaled.constraints[0] = format!("{scale:e}*({})", scaled.constraints[0]);
        assert_relative_eq!(told(&scaled, &q, &v)[0], here / scale, max_relative = 1e-13);
        let mut light = edge();
        light.coordinates.push(("caster".to_owned(), Unit::other("rad")));
        light.lagrangian += &format!(" + {scale:e}*caster'^2/2");
        light.constraints.push("caster' - th' - x'".to_owned());
        light.outputs[0].1 = "lambda1 + 0*lambda2".to_owned();
        let (q, v) = ([&q[..], &[0.1]].concat(), [&v[..], &[v[2] + v[0]]].concat());
        if scale < 1.0 {
            assert_relative_eq!(told(&light, &q, &v)[0], here, max_relative = 1e2 * scale + 1e-12);
        } else {
            assert!((told(&light, &q, &v)[0] - here).abs() > 1e-3);
        }
    }
}

#[test]
fn of_rows_that_depend_on_one_another_the_shortest() {
    let (q, v) = ([0.4, -0.2, 0.6], [1.3 * 0.6_f64.cos(), 1.3 * 0.6_f64.sin(), 0.8]);
    let here = told(&edge(), &q, &v)[0];
    let mut twice = edge();
    twice.constraints.push(twice.constraints[0].clone());
    twice.outputs.push(("other".to_owned(), "lambda2".to_owned()));
    for force in told(&twice, &q, &v) {
        assert_relative_eq!(force, here / 2.0, max_relative = 1e-12);
    }
}

#[test]
fn names_of_rows() {
    let mut named = edge();
    named.rows = vec!["edge".to_owned()];
    named.outputs[0].1 = "abs(lambda_edge)".to_owned();
    let model = TextModel::new(&named).unwrap();
    assert_eq!(model.multiplier_names(), ["lambda_edge"]);
    // One output alone is as all of them, with a multiplier and without.
    named.outputs.push(("place".to_owned(), "x + th".to_owned()));
    let (model, both) = (TextModel::new(&named).unwrap(), [[0.4, -0.2, 0.6], [1.0, 0.0, 0.5]]);
    let all = model.told(0.0, &both[0], &both[1]);
    assert_eq!([0, 1].map(|k| model.output(k, 0.0, &both[0], &both[1])), [Some(all[0]), Some(all[1])]);
    assert!(all[0] > 0.1 && model.output(2, 0.0, &both[0], &both[1]).is_none());
    // A name that the system has keeps its meaning.
    let mut own = edge();
    own.parameters.push(("lambda1".to_owned(), 7.0));
    assert_eq!(told(&own, &[0.0; 3], &[0.0; 3]), [7.0]);
    named.parameters.push(("lambda_edge".to_owned(), 7.0));
    assert!(TextModel::new(&named).unwrap_err().to_string().contains("`lambda_edge` is defined already"));
    for (text, force) in [("lambda2", false), ("lambda1", true)] {
        let mut wrong = edge();
        if force {
            wrong.forces.push(("x".to_owned(), text.to_owned()));
        } else {
            wrong.outputs[0].1 = text.to_owned();
        }
        assert!(TextModel::new(&wrong).unwrap_err().to_string().contains(&format!("no name `{text}` is known")));
    }
}

/// The derivatives in the state and in parameters, against differences.
#[test]
fn forces_have_derivatives() {
    let mut words = words(
        &["x", "y", "z", "th"],
        "m/2*(x'^2 + y'^2 + z'^2) + (0.3 + 0.1*x^2)*th'^2 - m*g*z + x*y",
        &["y'*cos(th) - x'*sin(th) - 0.1*t*z"],
        &["z - 0.1*x^2 - 0.2*m*y^2"],
    );
    words.forces.push(("x".to_owned(), "-0.2*x'".to_owned()));
    words.outputs = vec![("one".to_owned(), "lambda1*m".to_owned()), ("two".to_owned(), "lambda2^2 + x".to_owned())];
    let free = ["m".to_owned(), "g".to_owned()];
    let at = |x: &[f64; 10]| {
        let mut words = words.clone();
        (words.parameters[0].1, words.parameters[1].1) = (x[8], x[9]);
        TextModel::new(&words).unwrap().told(0.7, &x[..4], &x[4..8])
    };
    let x = [0.4, -0.2, 0.5, 0.6, 1.0, 0.7, 0.2, 0.8, 1.7, 9.81];
    let family = Family::new(&words, &Arc::new(TextModel::new(&words).unwrap()), &free).unwrap();
    for first in [0, 2] {
        let seeded: Vec<Seeded> = (0..10)
            .map(|i| Dual { re: x[i], eps: std::array::from_fn(|k| f64::from(u8::from(first + k == i))) })
            .collect();
        let mut p = [Dual::fixed(0.0); FREE];
        p[..2].copy_from_slice(&seeded[8..]);
        let found = family.told(0.7, &seeded[..4], &seeded[4..8], &p);
        for (told, value) in found.iter().zip(at(&x)) {
            assert_relative_eq!(told.re, value, max_relative = 1e-14);
        }
        for i in first..first + 8 {
            let step = 1e-4;
            let shifted = |by: f64| at(&std::array::from_fn(|k| if k == i { x[k] + by } else { x[k] }));
            let (up, down) = (shifted(step), shifted(-step));
            for (told, (up, down)) in found.iter().zip(up.iter().zip(&down)) {
                // The third derivative times the square of the step.
                assert_relative_eq!(
                    told.eps[i - first],
                    (up - down) / (2.0 * step),
                    epsilon = 1e-5,
                    max_relative = 1e-6
                );
            }
        }
    }
}
