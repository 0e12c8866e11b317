//! Systems by `system!` move as those written by hand: the same numbers, over 10^4 steps where a run is full, by every method that applies.

use dla::{Schedule, State, drive};
use harness::{METHODS, Method};
use lagrangian::{Piecewise, Reduced, System, quasi_velocities, reduced_acceleration};
use sleigh::{Sleigh, SleighState};
use test_systems::{ChaplyginBall, Model};

noslip::system! {
    /// The Chaplygin sleigh.
    pub struct Blade;
    coordinates = { x = "m", y = "m", theta = "angle" }
    parameters = { m = 1.0, I = 1.0, a = 0.5 }
    let = { across = "y'*cos(theta) - x'*sin(theta)" }
    lagrangian = "m/2*(x'^2 + y'^2) + m*a*theta'*across + (I + m*a^2)/2*theta'^2"
    constraints = ["across"]
    outputs = { speed = "x'*cos(theta) + y'*sin(theta)" }
}

noslip::system! {
    struct Ball;
    coordinates = { x = "m", y = "m", e0 = "", e1 = "", e2 = "", e3 = "" }
    parameters = { m = 1.2, r = 0.8, I1 = 0.4, I2 = 0.6, I3 = 0.9 }
    let = {
        mean = "(I1 + I2 + I3)/3",
        // The angular velocity in the body, and in space.
        b1 = "2*(e0*e1' - e1*e0' - e2*e3' + e3*e2')",
        b2 = "2*(e0*e2' - e2*e0' - e3*e1' + e1*e3')",
        b3 = "2*(e0*e3' - e3*e0' - e1*e2' + e2*e1')",
        w1 = "2*(e0*e1' - e1*e0' + e2*e3' - e3*e2')",
        w2 = "2*(e0*e2' - e2*e0' + e3*e1' - e1*e3')",
    }
    lagrangian = "m/2*(x'^2 + y'^2) + 2*mean*(e0'^2 + e1'^2 + e2'^2 + e3'^2)
        + ((I1 - mean)*b1^2 + (I2 - mean)*b2^2 + (I3 - mean)*b3^2)/2"
    constraints = ["x' - r*w2", "y' + r*w1"]
    positions = ["(e0^2 + e1^2 + e2^2 + e3^2 - 1)/2"]
    basis = [
        ["2*r*(e1*e2 + e0*e3)", "-r*(e0^2 + e1^2 - e2^2 - e3^2)", "-e1/2", "e0/2", "e3/2", "-e2/2"],
        ["r*(e0^2 - e1^2 + e2^2 - e3^2)", "-2*r*(e1*e2 - e0*e3)", "-e2/2", "-e3/2", "e0/2", "e1/2"],
        ["2*r*(e2*e3 - e0*e1)", "-2*r*(e1*e3 + e0*e2)", "-e3/2", "e2/2", "-e1/2", "e0/2"],
    ]
}

/// A structure of one's own.
struct Point {
    mass: f64,
}

noslip::system! {
    impl Point;
    coordinates = { x = "m", y = "m" }
    parameters = { m = self.mass, k = 2.0 * self.mass }
    lagrangian = "m/2*(x'^2 + y'^2) - k*x"
    forces = { y = "min(k, 5)*t" }
}

#[test]
fn a_structure_of_ones_own() {
    let point = Point { mass: 1.5 };
    assert_eq!(point.lagrangian(0.0, &[1.0, 0.0], &[2.0, 0.0]), 0.0);
    assert_eq!(point.force(2.0, &[0.0; 2], &[0.0; 2]), Some([0.0, 6.0]));
    assert_eq!(point.reduced_motion(2.0, &[0.0; 2], &[0.0; 2]), Some([-2.0, 4.0]));
}

/// The largest difference after some steps, relative to how far the coordinates and velocities have gone.
fn apart<A, B, const N: usize, const M: usize>(
    a: &A,
    b: &B,
    method: &Method,
    start: ([f64; N], [f64; N]),
    (h, steps): (f64, u64),
) -> f64
where
    A: System<N, M> + Piecewise,
    B: System<N, M>,
{
    let schedule = Schedule { t0: 0.0, step: h, steps };
    let mut states = [start; 2].map(|(q, v)| State::new(q, v, a.angles()));
    drive(a, &mut *method.stepper(), &schedule, &mut states[0], ()).unwrap();
    drive(b, &mut *method.stepper(), &schedule, &mut states[1], ()).unwrap();
    let [one, two] = states;
    let far = |x: [f64; N]| x.into_iter().fold(1.0, |far: f64, x| far.max(x.abs()));
    let (far_q, far_v) = (far(one.unwrapped()), far(*one.v()));
    let apart = |a: f64, b: f64, far: f64| (a - b).abs() / far;
    (0..N)
        .map(|i| apart(one.unwrapped()[i], two.unwrapped()[i], far_q).max(apart(one.v()[i], two.v()[i], far_v)))
        .fold(0.0, f64::max)
}

/// What is allowed: a rounding more of every step, and in one method what its multipliers make of round-off.
fn close<A, B, const N: usize, const M: usize>(
    a: &A,
    b: &B,
    methods: &[&str],
    start: ([f64; N], [f64; N]),
    run: (f64, u64),
) where
    A: System<N, M> + Piecewise,
    B: System<N, M>,
{
    for name in methods {
        let method = Method::named(name, None).unwrap();
        let apart = apart(a, b, &method, start, run);
        let allowed = if *name == "gni" { 1e-9 } else { 1e-13 + run.1 as f64 * f64::EPSILON };
        assert!(apart <= allowed, "{name}: {apart:e}");
    }
}

/// The equations by `system!` and those by derivatives of the hand-written Lagrangian, at a few states.
fn same_equations<A, B, const N: usize, const M: usize>(a: &A, b: &B, states: &[([f64; N], [f64; N])])
where
    A: System<N, M>,
    B: System<N, M>,
{
    for (q, v) in states {
        let xi = quasi_velocities(a, 0.3, q, v).unwrap();
        let derived = a.reduced().reduced_motion(0.3, q, &xi).unwrap();
        let right = reduced_acceleration(a, 0.3, q, &xi).unwrap();
        for k in 0..N - M {
            assert!((derived[k] - right[k]).abs() <= 1e-13 * (1.0 + right[k].abs()), "{k}: {derived:?} {right:?}");
        }
        let near = |one: f64, two: f64| assert!((one - two).abs() <= 1e-14 * (1.0 + two.abs()), "{one} {two}");
        near(a.lagrangian(0.3, q, v), b.lagrangian(0.3, q, v));
        let [one, two] = [a.constraint(0.3, q), b.constraint(0.3, q)];
        (0..M).for_each(|k| (0..N).for_each(|i| near(one.0[k][i], two.0[k][i])));
    }
}

fn sleigh(steps: u64) {
    let (blade, sleigh) = (Blade { m: 1.3, I: 0.7, a: 0.4 }, Sleigh::new(1.3, 0.7, 0.4).unwrap());
    let start = SleighState { speed: -1.0, turn_rate: 0.3, heading: 0.4, ..SleighState::default() }.to_coordinates();
    same_equations(&blade, &sleigh, &[start]);
    assert!((blade.speed(0.0, &start.0, &start.1) + 1.0).abs() < 1e-15);
    assert_eq!((blade.reduced().stands_alone(), blade.reduced().reconstruction()), (true, Some(1)));
    assert_eq!((Blade::COORDINATES, Blade::default().a), (["x", "y", "theta"], 0.5));
    let methods: Vec<&str> = METHODS.iter().map(|info| info.name).collect();
    close(&blade, &sleigh, &methods, start, (0.01, steps));
}

test_systems::short_and_full! {
    the_sleigh => sleigh(10);
    the_sleigh_at_length => sleigh(10_000);
}

fn ball(steps: u64) {
    let (ball, model) = (Ball::default(), ChaplyginBall::new(1.2, 0.8, [0.4, 0.6, 0.9]));
    same_equations(&ball, &model, &[model.start()]);
    close(&ball, &model, &["dla", "gauss4", "gauss16", "rk4-reduced"], model.start(), (0.002, steps));
}

test_systems::short_and_full! {
    chaplygins_ball => ball(10);
    chaplygins_ball_at_length => ball(10_000);
}
