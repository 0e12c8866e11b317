//! A system of text is the system of the library: the same numbers over a run, by several methods.

use dla::{Mechanics, Schedule, State, drive};
use harness::Method;
use lagrangian::{Reduced, Scalar, System};
use std::sync::Arc;
use test_systems::{ChaplyginBall, KnifeEdge, Model, RollerRacer, RollingDisk, Snakeboard};
use text::{TextFunctions, TextSystem, Unit, Words};

/// Coordinates in metres or angles (a name that ends in `!`), parameters, Lagrangian, constraints.
fn words(coordinates: &[&str], parameters: &[(&str, f64)], lagrangian: &str, constraints: &[&str]) -> Words {
    let unit = |name: &&str| match name.strip_suffix('!') {
        Some(name) => (name.to_owned(), Unit::Angle),
        None => ((*name).to_owned(), Unit::other("m")),
    };
    Words {
        coordinates: coordinates.iter().map(unit).collect(),
        parameters: parameters.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
        lagrangian: lagrangian.to_owned(),
        constraints: constraints.iter().map(|&row| row.to_owned()).collect(),
        ..Words::default()
    }
}

fn disk() -> Words {
    words(
        &["x", "y", "phi!", "theta!"],
        &[("m", 1.3), ("R", 0.5), ("I", 0.2), ("J", 0.1)],
        "m/2*(x'^2 + y'^2) + I/2*phi'^2 + J/2*theta'^2",
        &["x' - R*phi'*cos(theta)", "y' - R*phi'*sin(theta)"],
    )
}

fn racer() -> Words {
    words(
        &["x", "y", "theta!", "phi!"],
        &[("m", 1.0), ("I1", 0.4), ("I2", 0.1), ("d1", 0.5), ("d2", 0.3)],
        "m/2*(x'^2 + y'^2) + I1/2*theta'^2 + I2/2*(theta' + phi')^2",
        &[
            "y'*cos(theta) - x'*sin(theta)",
            "y'*cos(theta + phi) - x'*sin(theta + phi) + (d1*cos(phi) + d2)*theta' + d2*phi'",
        ],
    )
}

fn edge() -> Words {
    words(
        &["x", "y", "theta!"],
        &[("m", 1.5), ("I", 0.7), ("g", 2.0)],
        "m/2*(x'^2 + y'^2) + I/2*theta'^2 + m*g*x",
        &["y'*cos(theta) - x'*sin(theta)"],
    )
}

fn board() -> Words {
    words(
        &["x", "y", "theta!", "psi!", "phi!"],
        &[("m", 6.0), ("l", 0.2), ("J", 0.016), ("Jr", 0.072), ("Jw", 0.0013)],
        "m/2*(x'^2 + y'^2) + J/2*theta'^2 + Jr/2*(theta' + psi')^2 + Jw/2*((theta' + phi')^2 + (theta' - phi')^2)",
        &["y'*cos(theta) - x'*sin(theta)", "sin(phi)*(x'*cos(theta) + y'*sin(theta)) + l*cos(phi)*theta'"],
    )
}

fn filled<const K: usize, const N: usize>(x: [f64; K]) -> [f64; N] {
    std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0))
}

fn end<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    method: &str,
    (q, v): ([f64; N], [f64; N]),
    (step, steps): (f64, u64),
) -> ([f64; N], [f64; N]) {
    let method = Method::named(method, None).unwrap();
    let mut state = State::new(q, v, system.angles());
    let schedule = Schedule { t0: 0.0, step, steps };
    drive(system, &mut *method.stepper(), &schedule, &mut state, ()).unwrap();
    (state.unwrapped(), *state.v())
}

/// Both run, and every coordinate and rate ends within `tolerance` of the size of the largest; what fills the shape stays zero.
fn same<Sys: System<N, M>, const N: usize, const M: usize, const P: usize, const R: usize>(
    words: &Words,
    model: &Sys,
    start: ([f64; N], [f64; N]),
    (methods, steps): (&[&str], u64),
    tolerance: f64,
) {
    let text = Arc::new(text::TextModel::new(words).unwrap());
    let system = TextSystem::<P, R>::new(text, 0.0, &start.0).unwrap();
    for method in methods {
        let steps = (0.02, steps);
        let (q, v) = end(model, method, start, steps);
        let (p, u) = end(&system, method, (filled(start.0), filled(start.1)), steps);
        for (own, there) in [(q, p), (v, u)] {
            let size = lagrangian::linear::largest(&own);
            for i in 0..P {
                let expected = own.get(i).copied().unwrap_or(0.0);
                let bound = if i < N { tolerance * size } else { 0.0 };
                assert!((there[i] - expected).abs() <= bound, "{method}, place {i}: {} {expected}", there[i]);
            }
        }
    }
}

/// In another basis they are the same maps, but for round-off.
const FAMILY: [&str; 4] = ["dla", "dla4", "lobatto3", "rk4"];
const BASED: [&str; 8] = ["dla", "dla4", "lobatto3", "rk4", "dop853", "gauss8", "energy4", "rk4-reduced"];

/// The basis of the disk is the derived one up to a factor; the racer has another.
#[test]
fn small_systems_move_as_those_of_the_library() {
    let disk_there = RollingDisk { m: 1.3, R: 0.5, I: 0.2, J: 0.1 };
    same::<_, 4, 2, 4, 2>(&disk(), &disk_there, disk_there.start(), (&FAMILY, 300), 1e-13);
    let racer_there = RollerRacer { m: 1.0, I1: 0.4, I2: 0.1, d1: 0.5, d2: 0.3 };
    same::<_, 4, 2, 4, 2>(&racer(), &racer_there, racer_there.start(), (&FAMILY, 300), 1e-12);
    let edge_there = KnifeEdge { m: 1.5, I: 0.7, g: 2.0 };
    same::<_, 3, 1, 3, 1>(&edge(), &edge_there, edge_there.start(), (&FAMILY, 300), 1e-12);
}

#[test]
fn a_basis_that_is_given_is_that_of_the_library() {
    in_the_basis_of_the_library(40);
}

#[test]
#[ignore = "slow"]
fn a_basis_that_is_given_is_that_of_the_library_in_full() {
    in_the_basis_of_the_library(300);
}

/// The same with the basis of the library given as text: then the methods that move in it agree too.
fn in_the_basis_of_the_library(steps: u64) {
    let mut words = racer();
    let vectors = [["cos(theta)", "sin(theta)", "0", "sin(phi)/d2"], ["0", "0", "1", "-d1/d2*cos(phi) - 1"]];
    words.basis = vectors.map(|vector| vector.map(str::to_owned).to_vec()).to_vec();
    let there = RollerRacer { m: 1.0, I1: 0.4, I2: 0.1, d1: 0.5, d2: 0.3 };
    same::<_, 4, 2, 4, 2>(&words, &there, there.start(), (&BASED, steps), 1e-12);
}

#[test]
fn a_shape_that_is_filled_up_shows_nothing_of_it() {
    filled_up(60);
}

#[test]
#[ignore = "slow"]
fn a_shape_that_is_filled_up_shows_nothing_of_it_in_full() {
    filled_up(300);
}

/// Five coordinates and two constraints in the shape of six and three, and of twelve and six.
fn filled_up(steps: u64) {
    let there = Snakeboard { m: 6.0, l: 0.2, J: 0.016, Jr: 0.072, Jw: 0.0013 };
    same::<_, 5, 2, 6, 3>(&board(), &there, there.start(), (&["dla", "rk4", "lobatto3"], steps), 1e-12);
    same::<_, 5, 2, 12, 6>(&board(), &there, there.start(), (&["dla"], steps), 1e-12);
}

/// The ball's quaternion is held by a constraint on positions.
#[test]
fn constraints_on_positions_are_kept() {
    let mut words = words(
        &["x", "y", "e0", "e1", "e2", "e3"],
        &[("m", 1.0), ("r", 0.7), ("I1", 0.4), ("I2", 0.6), ("I3", 0.9)],
        "m/2*(x'^2 + y'^2) + 2*mean*(e0'^2 + e1'^2 + e2'^2 + e3'^2) + ((I1 - mean)*b1^2 + (I2 - mean)*b2^2 + (I3 - mean)*b3^2)/2",
        &["x' - r*2*(e0*e2' - e2*e0' + e3*e1' - e1*e3')", "y' + r*2*(e0*e1' - e1*e0' + e2*e3' - e3*e2')"],
    );
    words.abbreviations = [
        ("mean", "(I1 + I2 + I3)/3"),
        ("b1", "2*(e0*e1' - e1*e0' - e2*e3' + e3*e2')"),
        ("b2", "2*(e0*e2' - e2*e0' - e3*e1' + e1*e3')"),
        ("b3", "2*(e0*e3' - e3*e0' - e1*e2' + e2*e1')"),
    ]
    .map(|(name, text)| (name.to_owned(), text.to_owned()))
    .to_vec();
    words.positions = vec!["(e0^2 + e1^2 + e2^2 + e3^2 - 1)/2".to_owned()];
    let there = ChaplyginBall::new(1.0, 0.7, [0.4, 0.6, 0.9]);
    same::<_, 6, 3, 6, 3>(&words, &there, there.start(), (&["dla", "lobatto3"], 300), 1e-11);
}

#[test]
fn a_derived_basis_changes_and_the_method_keeps_its_claims() {
    keeps_its_claims(4.0, 0.04, &[("gauss4", 4.0)]);
}

#[test]
#[ignore = "slow"]
fn a_derived_basis_changes_and_the_method_keeps_its_claims_at_length() {
    let methods = [("gauss4", 4.0), ("gauss6", 6.0), ("energy4", 4.0), ("rk4-reduced", 4.0), ("dla", 2.0)];
    keeps_its_claims(8.0, 0.02, &methods);
}

/// A method that moves in the basis keeps its order, the energy and the constraint, wherever a derived basis has to be changed: the racer turns
/// by several rounds, and each elimination is bad at two headings of every round. In steps of the length `h` and half of it.
fn keeps_its_claims(duration: f64, h: f64, methods: &[(&str, f64)]) {
    let steps = (duration / h).round() as u64;
    let there = RollerRacer { m: 1.0, I1: 0.4, I2: 0.1, d1: 0.5, d2: 0.3 };
    let (q, v) = there.admissible([0.0, 0.0, 0.0, 2.0], [0.3, 2.0, 0.0, 0.0]);
    // Of a row that is scaled by a function no basis is seen that holds everywhere.
    let mut words = racer();
    words.constraints[0] = format!("(2 + cos(phi))*({})", words.constraints[0]);
    let system = TextSystem::<4, 2>::new(Arc::new(text::TextModel::new(&words).unwrap()), 0.0, &q).unwrap();
    assert!(System::near(system.functions(), 0.0, &q, 0).is_some());
    let whole = TextSystem::<4, 2>::new(Arc::new(text::TextModel::new(&racer()).unwrap()), 0.0, &q).unwrap();
    assert!(System::near(whole.functions(), 0.0, &q, 0).is_none());
    let reference = end(&there, "gauss16", (q, v), (0.5 * h, 2 * steps)).0;
    assert!(reference[2].abs() > 6.0, "it turns: {reference:?}");
    let error = |method: &str, step: f64, steps: u64| {
        let (p, u) = end(&system, method, (q, v), (step, steps));
        let energy = |v: &[f64; 4]| lagrangian::energy(&there, 0.0, &p, v);
        let slip = lagrangian::constraint_residual(&there, 0.0, &p, &u);
        assert!(lagrangian::linear::largest(&slip) < 1e-14, "{method}: {slip:?}");
        let drift = (energy(&u) - lagrangian::energy(&there, 0.0, &q, &v)).abs();
        (lagrangian::linear::largest(&std::array::from_fn::<f64, 4, _>(|i| p[i] - reference[i])), drift)
    };
    for &(method, order) in methods {
        let ((coarse, _), (fine, drift)) = (error(method, h, steps), error(method, 0.5 * h, 2 * steps));
        let found = (coarse / fine).log2();
        assert!((found - order).abs() < 0.35, "{method}: order {found}, errors {coarse:e} {fine:e}");
        if method == "energy4" {
            assert!(drift < 1e-13, "{method}: {drift:e}");
        }
    }
    assert!(error("gauss16", h, steps).0 < 1e-11);
}

/// The accelerations that are derived as formulas are those by derivatives of the Lagrangian, with forces, in time, and with moving
/// constraints; to 1e-12 of their size.
#[test]
fn accelerations_as_formulas_are_those_by_derivatives() {
    let mut scaled = racer();
    scaled.constraints[0] = format!("(2 + cos(phi))*({})", scaled.constraints[0]);
    let mut driven = edge();
    driven.constraints[0].push_str(" - sin(t)/3");
    driven.lagrangian.push_str(" + x*sin(theta)*cos(t)");
    driven.forces = vec![("theta".to_owned(), "-theta'^3 + sin(x)".to_owned())];
    derived_alike::<4, 2>(&racer());
    derived_alike::<4, 2>(&scaled);
    derived_alike::<3, 1>(&driven);
    derived_alike::<5, 2>(&board());
    // In a shape that is filled up.
    derived_alike::<6, 3>(&board());
}

fn derived_alike<const N: usize, const M: usize>(words: &Words) {
    for k in 0..20 {
        let number = |i: usize, scale: f64| scale * (1.7 * i as f64 + 2.3 * f64::from(k) + 0.4).sin();
        let n = words.coordinates.len();
        let q: [f64; N] = std::array::from_fn(|i| if i < n { number(i, 2.0) } else { 0.0 });
        let xi: [f64; N] =
            std::array::from_fn(|i| if i < n - words.constraints.len() { number(i + 7, 1.0) } else { 0.0 });
        let system = TextFunctions::<N, M>::new(Arc::new(text::TextModel::new(words).unwrap()), 0.3, &q).unwrap();
        let formulas = system.reduced().reduced_motion(0.3, &q, &xi).unwrap();
        let derived = lagrangian::reduced_acceleration(&system, 0.3, &q, &xi).unwrap();
        let size = lagrangian::linear::largest(&derived).max(1.0);
        for i in 0..N - M {
            assert!((formulas[i] - derived[i]).abs() < 1e-12 * size, "{formulas:?} {derived:?}");
        }
    }
}

/// What methods ask is answered by formulas in the system's own size; the same answers follow from its functions by automatic derivatives in
/// the size of the shape.
#[test]
fn answers_by_formulas_are_those_by_derivatives() {
    let mut scaled = racer();
    scaled.constraints[0] = format!("(2 + cos(phi))*({})", scaled.constraints[0]);
    let mut driven = edge();
    driven.constraints[0].push_str(" - sin(t)/3");
    driven.lagrangian.push_str(" + x*sin(theta)*cos(t) + x'*cos(x)*y");
    driven.forces = vec![("theta".to_owned(), "-theta'^3 + sin(x)*y'".to_owned())];
    answered_alike::<3, 1>(&driven);
    answered_alike::<4, 2>(&driven);
    answered_alike::<4, 2>(&scaled);
    answered_alike::<8, 5>(&scaled);
    answered_alike::<18, 6>(&board());
    let mut held = racer();
    held.positions = vec!["x*cos(phi) - y^2*sin(theta)/3".to_owned()];
    answered_alike::<8, 5>(&held);
}

fn answered_alike<const N: usize, const M: usize>(words: &Words) {
    let n = words.coordinates.len();
    let number = |i: usize| (1.7 * i as f64 + 0.4).sin();
    let filled = |first: usize, count: usize| -> [f64; N] {
        std::array::from_fn(|i| if i < count { number(first + i) } else { 0.0 })
    };
    let (q, v, xi) = (filled(0, n), filled(7, n), filled(19, n - words.constraints.len() - words.positions.len()));
    let impulse: [f64; M] = std::array::from_fn(|k| number(k + 31));
    let system = TextSystem::<N, M>::new(Arc::new(text::TextModel::new(words).unwrap()), 0.3, &q).unwrap();
    let (formulas, functions): (_, &dyn Mechanics<N, M>) =
        (answers(&system, &q, &v, &xi, &impulse), system.functions());
    for ((name, found), (_, expected)) in formulas.into_iter().zip(answers(functions, &q, &v, &xi, &impulse)) {
        let size = expected.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
        assert_eq!(found.len(), expected.len(), "{name}");
        for (i, (found, expected)) in found.iter().zip(&expected).enumerate() {
            assert!((found - expected).abs() < 1e-13 * size, "{name}, place {i}: {found} {expected}");
        }
    }
}

/// All numbers of the answers of a system at a state.
fn answers<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    q: &[f64; N],
    v: &[f64; N],
    xi: &[f64; N],
    impulse: &[f64; M],
) -> Vec<(&'static str, Vec<f64>)> {
    let t = 0.3;
    let duals = |all: &[lagrangian::Dual<f64, N>]| -> Vec<f64> {
        all.iter().flat_map(|dual| [&[dual.re][..], &dual.eps].concat()).collect()
    };
    let (p, mass) = system.mass_matrix(t, q, v);
    let (both, (a, b)) = system.momentum_and_rows(t, q, v);
    let slopes = system.slopes(t, q, v);
    let second = system.second_slopes(t, q, v);
    let node = system.at_node(t, q, v, 0.03, 0.07);
    let (mut w, mut w_q) = ([0.5; N], [[0.25; N]; N]);
    let constraint = system.constraint_slopes(t, (q, v), impulse, (&mut w, &mut w_q));
    let motion = system.motion(t, q, v).unwrap();
    let basis = system.basis(t, q).unwrap();
    let lanes = |x: &[f64; N]| x.map(lagrangian::Lanes::constant);
    let flat = |x: &[lagrangian::Lanes]| -> Vec<f64> { x.iter().flat_map(|x| x.0).collect() };
    let bracket = system.bracket(lagrangian::Lanes::constant(t), &lanes(q), &lanes(xi)).unwrap();
    let energy = system.energy_slope(lagrangian::Lanes::constant(t), &lanes(q), &lanes(xi)).unwrap();
    let rates = bracket.rates(&lanes(q), &lanes(v));
    let misses = system.position_misses(t, q).map_or(Vec::new(), |misses| misses.into_iter().flatten().collect());
    let mut curvature = [[0.5; N]; N];
    system.add_position_curvature(t, q, impulse, &mut curvature);
    let force = second.force.map_or(Vec::new(), |[in_q, in_v]| [duals(&in_q), duals(&in_v)].concat());
    vec![
        ("energy", vec![system.lagrangian(t, q, v), system.energy(t, q, v)]),
        ("momentum", [system.momentum(t, q, v), p, both].concat()),
        ("mass_matrix", mass.as_flattened().to_vec()),
        ("rows", [a.as_flattened(), &b, system.reaction_rows(t, q, v).as_flattened()].concat()),
        ("slopes", [&slopes.l_q[..], &slopes.l_v, slopes.force.as_ref().map_or(&[], |force| force)].concat()),
        ("second_slopes", [&second.l_q[..], &second.l_v].concat()),
        ("second_slopes", [second.l_qq, second.l_qv, second.l_vv].concat().concat()),
        ("force", force),
        ("at_node", [&[node.re][..], &node.e1, &node.e2, node.e12.as_flattened()].concat()),
        ("residual", [&system.residual(t, q, v)[..], &duals(&system.residual_along(t, q, v, 0.4))].concat()),
        ("constraint_slopes", [constraint.a.as_flattened(), &constraint.g, constraint.g_q.as_flattened()].concat()),
        ("constraint_slopes", [&w[..], w_q.as_flattened()].concat()),
        ("positions", [&duals(&misses)[..], curvature.as_flattened()].concat()),
        ("motion", [&motion.acceleration[..], &motion.multiplier].concat()),
        ("basis", basis.vectors().concat()),
        ("inverse_reduced_mass", system.inverse_reduced_mass(t, q, v, &basis).unwrap().concat()),
        ("bracket", flat(&[&rates.0[..], &rates.1, &[bracket.energy()], &bracket.quasi_momenta()].concat())),
        ("energy_slope", flat(&[energy.h_q, energy.pi].concat())),
    ]
}
