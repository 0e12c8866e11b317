//! Reduced equations derived from texts.

use expression::formulas::{Formulas, Parameters, ReducedFormulas, Unit, Words};
use expression::{Names, Tape};

/// A system by its coordinates (angles with a star), parameters, Lagrangian and constraints.
fn formulas(coordinates: &str, parameters: &str, lagrangian: &str, constraints: &[&str]) -> (Formulas, Names) {
    let mut words = Words::default();
    let mut names = Names::of(["t"]).unwrap();
    for name in coordinates.split(' ') {
        let unit = if name.ends_with('*') { Unit::Angle } else { Unit::other("m") };
        words.coordinates.push((name.trim_end_matches('*').to_owned(), unit));
    }
    for suffix in ["", "'"] {
        for (name, _) in &words.coordinates {
            names.add(&format!("{name}{suffix}")).unwrap();
        }
    }
    for name in parameters.split(' ').filter(|name| !name.is_empty()) {
        words.parameters.push((name.to_owned(), 1.0));
        names.add(name).unwrap();
    }
    words.lagrangian = lagrangian.to_owned();
    words.constraints = constraints.iter().map(|&text| text.to_owned()).collect();
    (Formulas::of(&words, Parameters::Variables).unwrap(), names)
}

/// The vectors of the basis, the accelerations, and how many operations these take.
fn told(formulas: &Formulas, names: &Names, reduced: &ReducedFormulas) -> (Vec<String>, Vec<String>, usize) {
    let text = |e| formulas.graph.text(e, names).unwrap();
    let tape = Tape::new(&formulas.graph, &reduced.acceleration).unwrap();
    let vectors = reduced.basis.iter().map(|w| w.iter().map(|&e| text(e)).collect::<Vec<_>>().join(", ")).collect();
    (vectors, reduced.acceleration.iter().map(|&e| text(e)).collect(), tape.cost().total())
}

#[test]
fn a_blade() {
    let lagrangian = "m/2*(x'^2 + y'^2) + m*a*th'*(y'*cos(th) - x'*sin(th)) + J/2*th'^2";
    let (mut formulas, names) = formulas("x y th*", "m J a", lagrangian, &["y'*cos(th) - x'*sin(th)"]);
    let reduced = formulas.reduced().unwrap();
    let (basis, acceleration, _) = told(&formulas, &names, &reduced);
    assert_eq!(basis, ["cos(th), sin(th), 0", "0, 0, 1"]);
    // `u' = a omega^2`, `omega' = -(m a / J) u omega`; the quasi-velocities have the names of the first rates.
    assert_eq!(acceleration, ["y'^2*a", "-x'*y'*m*a/J"]);
    assert_eq!((reduced.reconstruction, reduced.stands_alone), (Some(1), true));
}

#[test]
fn a_rolling_disk() {
    let lagrangian = "m/2*(x'^2 + y'^2) + I/2*phi'^2 + J/2*th'^2";
    let rows = ["x' - R*phi'*cos(th)", "y' - R*phi'*sin(th)"];
    let (mut formulas, names) = formulas("x y phi* th*", "m R I J", lagrangian, &rows);
    let reduced = formulas.reduced().unwrap();
    let (basis, acceleration, _) = told(&formulas, &names, &reduced);
    assert_eq!(basis, ["R*cos(th), R*sin(th), 1, 0", "0, 0, 0, 1"]);
    assert_eq!(acceleration, ["0", "0"]);
}

/// The angle of the whole racer cancels, and not more operations are left than by computer algebra (59).
#[test]
fn a_roller_racer() {
    let lagrangian = "m/2*(x'^2 + y'^2) + I1/2*theta'^2 + I2/2*(theta' + phi')^2";
    let rows = [
        "y'*cos(theta) - x'*sin(theta)",
        "y'*cos(theta + phi) - x'*sin(theta + phi) + (d1*cos(phi) + d2)*theta' + d2*phi'",
    ];
    let (mut formulas, names) = formulas("x y theta* phi*", "m I1 I2 d1 d2", lagrangian, &rows);
    let reduced = formulas.reduced().unwrap();
    let (basis, acceleration, operations) = told(&formulas, &names, &reduced);
    assert_eq!(basis, ["cos(theta), sin(theta), 0, sin(phi)/d2", "0, 0, 1, -d1*cos(phi)/d2 - 1"]);
    assert!(acceleration.iter().all(|text| !text.contains("theta")) && operations <= 50, "{operations}");
    // The hinge turns by an angle that depends on itself.
    assert_eq!(reduced.reconstruction, None);
}

/// A coin that rolls and tilts, the upright one being `al = 0`.
#[test]
fn a_coin() {
    let lagrangian = "m/2*((x' - R*sin(psi)*cos(al)*al' - R*cos(psi)*sin(al)*psi')^2 \
        + (y' + R*cos(psi)*cos(al)*al' - R*sin(psi)*sin(al)*psi')^2 + R^2*sin(al)^2*al'^2) \
        + m*R^2/8*(al'^2 + psi'^2*cos(al)^2) + m*R^2/4*(ph' + psi'*sin(al))^2 - m*g*R*cos(al)";
    let rows = ["x' + R*ph'*cos(psi)", "y' + R*ph'*sin(psi)"];
    let (mut formulas, names) = formulas("x y psi* al* ph*", "m R g", lagrangian, &rows);
    let reduced = formulas.reduced().unwrap();
    let (_, acceleration, operations) = told(&formulas, &names, &reduced);
    assert!(acceleration.iter().all(|text| !text.contains("cos(psi)")) && operations <= 60, "{operations}");
}

/// `b` moves a velocity that no quasi-velocity makes: the shortest.
#[test]
fn a_belt() {
    let (mut formulas, names) = formulas("x y", "w", "(x'^2 + y'^2)/2 - x", &["x' + y' - w*t"]);
    let reduced = formulas.reduced().unwrap();
    let (basis, acceleration, _) = told(&formulas, &names, &reduced);
    assert_eq!(basis, ["-1, 1"]);
    // `x = s - xi`, `y = s + xi` with `s' = w t / 2`: `2 xi' = 1`.
    assert_eq!(acceleration, ["0.5"]);
}
