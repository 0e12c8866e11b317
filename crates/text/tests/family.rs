//! Systems as functions of their parameters: starts and steps against extrapolated differences.

use dla::{AnyTangent, Dla, Method, OneStep, ParametrisedMechanics, Sensitivity, State, Tangent, Variation};
use std::sync::Arc;
use text::{FREE, Family, TextMechanics, TextModel, TextStart, TextSystem, Unit, Varied, Words};

const PLACES: [&str; 4] = ["x", "y", "z", "th"];

/// A skate whose height follows a hill, with masses that depend on the place.
fn words(m: f64, c: f64) -> Words {
    let unit = |name: &str| if name == "th" { Unit::Angle } else { Unit::other("m") };
    Words {
        coordinates: PLACES.iter().map(|name| ((*name).to_owned(), unit(name))).collect(),
        parameters: vec![("m".to_owned(), m), ("c".to_owned(), c)],
        abbreviations: vec![("slip".to_owned(), "y'*cos(th) - x'*sin(th)".to_owned())],
        lagrangian: "m/2*(x'^2 + y'^2*(1 + x^2/4) + z'^2) + th'^2/2*(1 + c*y^2) - z".to_owned(),
        constraints: vec!["slip + c*th'".to_owned()],
        positions: vec!["z - c*sin(x)*y - m/10".to_owned()],
        ..Words::default()
    }
}

const MASS: f64 = 1.3;
const SHIFT: f64 = 0.4;

fn model(m: f64, c: f64) -> Arc<TextModel> {
    Arc::new(TextModel::new(&words(m, c)).unwrap())
}

/// Four differences with halved steps, extrapolated.
fn extrapolated(at: &dyn Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let difference = |w: f64| -> Vec<f64> { at(w).iter().zip(at(-w)).map(|(a, b)| (a - b) / (2.0 * w)).collect() };
    let mut row: Vec<Vec<f64>> = (0..4).map(|level| difference(0.02 / f64::from(1 << level))).collect();
    for order in 1..=3 {
        let factor = f64::from(1u32 << (2 * order));
        let finer =
            |pair: &[Vec<f64>]| pair[1].iter().zip(&pair[0]).map(|(f, c)| (factor * f - c) / (factor - 1.0)).collect();
        row = row.windows(2).map(finer).collect();
    }
    row.remove(0)
}

/// What is given of a start, in the order of `PLACES`.
type Given = [Option<f64>; 4];

fn started(m: f64, c: f64, [q, v]: [Given; 2]) -> TextStart {
    model(m, c).start(&q, &v).unwrap()
}

fn worst(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs() / (1.0 + b.abs())).fold(0.0, f64::max)
}

/// The largest difference between the derivatives of a start and extrapolated ones, of `wrong` times the derivative.
fn off(given: [Given; 2], wrong: f64) -> f64 {
    let names = ["m".to_owned(), "c".to_owned()];
    let family = Family::new(&words(MASS, SHIFT), &model(MASS, SHIFT), &names).unwrap();
    let start = started(MASS, SHIFT, given);
    let places = (0..4).filter(|i| given[0][*i].is_some()).map(Varied::Coordinate);
    let rates = (0..4).filter(|i| given[1][*i].is_some()).map(Varied::Rate);
    let varied = places.chain(rates).chain([Varied::Parameter(0), Varied::Parameter(1)]);
    let compared = varied.map(|varied| {
        let moved = |w: f64| {
            let (mut given, mut m, mut c) = (given, MASS, SHIFT);
            match varied {
                Varied::Coordinate(i) => given[0][i] = given[0][i].map(|x| x + w),
                Varied::Rate(i) => given[1][i] = given[1][i].map(|x| x + w),
                Varied::Parameter(0) => m += w,
                Varied::Parameter(_) => c += w,
            }
            let start = started(m, c, given);
            [start.q, start.v].concat()
        };
        let (dq, dv) = family.start_along(&start, varied);
        let made: Vec<f64> = [dq, dv].concat().iter().map(|x| x * wrong).collect();
        worst(&made, &extrapolated(&moved))
    });
    compared.fold(0.0, f64::max)
}

#[test]
fn a_start_moves_with_what_is_given_of_it() {
    let q = [Some(0.3), Some(0.5), None, Some(0.7)];
    // The rates left out are as many as the constraints, and more.
    for v in [[Some(0.8), None, None, Some(0.4)], [None, None, None, Some(0.4)], [Some(0.8), None, None, None]] {
        let off = off([q, v], 1.0);
        assert!(off < 1e-9, "{v:?}: {off:e}");
    }
    assert!(off([q, [Some(0.8), None, None, Some(0.4)]], 1.0 + 1e-7) > 1e-9);
}

#[test]
fn a_step_has_derivatives_in_parameters() {
    let given = [[Some(0.3), Some(0.5), None, Some(0.7)], [Some(0.8), None, None, Some(0.4)]];
    let step = |m: f64, c: f64| {
        let start = started(MASS, SHIFT, given);
        let system = TextSystem::<4, 2>::new(model(m, c), 0.0, &start.q).unwrap();
        let [q, v] = [start.q, start.v].map(|x| std::array::from_fn(|i| x[i]));
        (system, State::new(q, v, [false, false, false, true]))
    };
    let names = ["c".to_owned(), "m".to_owned()];
    let family = Family::new(&words(MASS, SHIFT), &model(MASS, SHIFT), &names).unwrap();
    assert_eq!(family.values()[..3], [SHIFT, MASS, 0.0]);
    let (system, start) = step(MASS, SHIFT);
    let shaped = family.shaped::<4, 2>(0.0, start.q()).unwrap();
    let seeder = |p: &[lagrangian::Seeded]| shaped.at(0, &std::array::from_fn::<_, FREE, _>(|k| p[k]));
    let mut end = start;
    let derivative =
        Sensitivity::seeded(&system, *family.values(), seeder).step(&mut Dla::midpoint(), 0.0, 0.05, &mut end).unwrap();
    for (place, [dm, dc]) in [[0.0, 1.0], [1.0, 0.0]].into_iter().enumerate() {
        let state = |w: f64| started(MASS + w * dm, SHIFT + w * dc, given);
        let moved = |w: f64| {
            let system = step(MASS + w * dm, SHIFT + w * dc).0;
            let begin = state(w);
            let [q, v] = [begin.q, begin.v].map(|x| std::array::from_fn(|i| x[i]));
            let mut end = State::new(q, v, [false, false, false, true]);
            Dla::midpoint().step(&system, 0.0, 0.05, &mut end).unwrap();
            [*end.q(), *end.v()].concat()
        };
        let (dq, dv) = family.start_along(&state(0.0), Varied::Parameter(place));
        let begin = Variation { q: std::array::from_fn(|i| dq[i]), v: std::array::from_fn(|i| dv[i]) };
        let parameters = std::array::from_fn(|k| f64::from(u8::from(k == place)));
        let Variation { q, v } = derivative.apply(&Tangent { state: begin, parameters }).state;
        let off = worst(&[q, v].concat(), &extrapolated(&moved));
        assert!(off < 1e-9, "parameter {place}: {off:e}");
    }
}

/// The derivatives of one long step by series are those of many short ones by a composition; of every direction, and of the parameters.
#[test]
fn series_have_the_same_derivatives() {
    let given = [[Some(0.3), Some(0.5), None, Some(0.7)], [Some(0.8), None, None, Some(0.4)]];
    let start = started(MASS, SHIFT, given);
    let names = ["c".to_owned(), "m".to_owned()];
    let family = Family::new(&words(MASS, SHIFT), &model(MASS, SHIFT), &names).unwrap();
    let system = TextMechanics::of_family(&family, &start).unwrap();
    let member = system.member().unwrap();
    let mechanism = member.mechanism();
    let begin: Vec<AnyTangent> = [Varied::Coordinate(0), Varied::Coordinate(1), Varied::Rate(0), Varied::Rate(3)]
        .into_iter()
        .map(|varied| (varied, [0.0, 0.0]))
        .chain([(Varied::Parameter(0), [1.0, 0.0]), (Varied::Parameter(1), [0.0, 1.0])])
        .map(|(varied, parameters)| {
            let (q, v) = family.start_along(&start, varied);
            AnyTangent { q, v, parameters: parameters.to_vec() }
        })
        .collect();
    let carried = |method: &str, steps: u64| {
        let method = Method::of(method, None, Some(1e-15)).unwrap();
        let (mut integrator, mut tangents) = (mechanism.integrator(&method), begin.clone());
        let (mut state, h) = (mechanism.state(&start.q, &start.v), 2.0 / steps as f64);
        for k in 0..steps {
            let (before, t) = (state.clone(), k as f64 * h);
            let report = integrator.step(t, h, &mut state).unwrap().clone();
            tangents = member.carried(&method, 0, (t, h), [&before, &state], &report, &tangents).unwrap();
        }
        tangents
    };
    let fine = carried("dla8", 100);
    for steps in [1, 4] {
        for (found, expected) in carried("taylor", steps).iter().zip(&fine) {
            for (found, expected) in [(&found.q, &expected.q), (&found.v, &expected.v)] {
                let off = worst(&found[..4], &expected[..4]);
                assert!(off < 1e-10, "{steps} steps: {off:e}: {found:?} instead of {expected:?}");
            }
        }
    }
}
