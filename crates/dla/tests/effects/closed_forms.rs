//! Motions under an effect that are known in closed form.

use crate::effects::tools::{Laden, assert_order, laden, moving, run, sleigh, steps};
use dla::{Composition, Dla, OneStep, State, Trajectory};
use scene::AnyEffect;
use sleigh::effects::{Drag, Slope};
use sleigh::{Exact, Sleigh, SleighState};
use std::f64::consts::TAU;

fn place(state: &State<3>) -> SleighState {
    SleighState::from_coordinates(&state.unwrapped(), state.v())
}

fn distance(a: &SleighState, b: &SleighState) -> f64 {
    let d = [a.x - b.x, a.y - b.y, a.heading - b.heading, a.speed - b.speed, a.turn_rate - b.turn_rate];
    d.iter().fold(0.0, |m, d| d.abs().max(m))
}

fn errors<Method: OneStep<3, 1>>(
    system: &Laden<Sleigh>,
    mut method: Method,
    start: &SleighState,
    (end, exact): (f64, &SleighState),
    counts: [u64; 3],
) -> [f64; 3] {
    counts.map(|n| {
        let state = run(system, &mut method, &steps(end / n as f64, n), start.to_coordinates(), ());
        distance(&place(&state), exact)
    })
}

/// Drag in proportion to the mass, `F = -nu M v`, only slows the clock: the path is that of the free sleigh at the time
/// `S = (1 - e^(-nu t))/nu`, with velocities `e^(-nu t)` of it.
#[test]
fn drag_in_proportion_to_the_mass() {
    let (nu, end) = (0.3_f64, 4.0);
    let effect = Drag::new(nu * sleigh().mass(), nu * sleigh().pivot_inertia()).unwrap();
    let system = laden(sleigh(), vec![AnyEffect::Drag(effect)]);
    let slowed = (-nu * end).exp();
    let free = Exact::new(&sleigh(), &moving()).unwrap().at((1.0 - slowed) / nu);
    let exact = SleighState { speed: slowed * free.speed, turn_rate: slowed * free.turn_rate, ..free };
    let base = Dla::midpoint();
    let target = (end, &exact);
    assert_order("drag, dla", &errors(&system, base, &moving(), target, [40, 80, 160]), 2.0);
    assert_order("drag, dla4", &errors(&system, Composition::suzuki4(base), &moving(), target, [20, 40, 80]), 4.0);
    let eight = errors(&system, Composition::fifteen8(base), &moving(), target, [8, 16, 32]);
    assert_order("drag, dla8", &eight, 8.0);
    // The control: the free sleigh is elsewhere.
    assert!(distance(&exact, &Exact::new(&sleigh(), &moving()).unwrap().at(end)) > 0.1);
}

/// The skate on a slope along `x`, from `theta = 0` at the origin:
///
/// ```text
/// u = u0 + B sin(omega t),  B = g/omega,
/// x = u0/omega sin + B/(2 omega) sin^2,  y = u0/omega (1 - cos) + B/(2 omega) (omega t - sin(2 omega t)/2).
/// ```
fn skate(g: f64, u0: f64, omega: f64, t: f64) -> SleighState {
    let (theta, b) = (omega * t, g / omega);
    let (sin, cos) = theta.sin_cos();
    SleighState {
        x: u0 / omega * sin + b / (2.0 * omega) * sin * sin,
        y: u0 / omega * (1.0 - cos) + b / (2.0 * omega) * (theta - sin * cos),
        heading: theta,
        speed: u0 + b * sin,
        turn_rate: omega,
    }
}

#[test]
fn skate_on_a_slope() {
    let body = Sleigh::new(1.3, 0.8, 0.0).unwrap();
    let (g, u0, omega) = (0.7, 0.4, 0.9);
    let system = laden(body, vec![AnyEffect::Slope(Slope::new([g, 0.0]).unwrap())]);
    let start = skate(g, u0, omega, 0.0);
    let exact = skate(g, u0, omega, 4.0);
    let base = Dla::midpoint();
    assert_order("slope, dla", &errors(&system, base, &start, (4.0, &exact), [40, 80, 160]), 2.0);
    let eight = errors(&system, Composition::fifteen8(base), &start, (4.0, &exact), [4, 8, 16]);
    assert_order("slope, dla8", &eight, 8.0);

    // Hundred turns: on the mean it does not descend, but moves across the slope. Each turn is 64 steps, the same
    // up to symmetry, so the method errs by a periodic amount along the slope.
    let period = TAU / omega;
    let mut nodes = Trajectory::every(64);
    run(&system, &mut Dla::midpoint(), &steps(period / 64.0, 6400), start.to_coordinates(), &mut nodes);
    let descent = nodes.nodes().iter().fold(0.0_f64, |m, node| m.max(node.q[0].abs()));
    let across = nodes.nodes().last().unwrap().q[1];
    // Rounding of the heading, 6400 half-ulps of the angle at worst, on a circle of some metres.
    assert!(descent < 6400.0 * f64::EPSILON * 5.0, "{descent:e}");
    let whole = skate(g, u0, omega, 100.0 * period).y;
    println!("after 100 turns: down {descent:.1e} m, across {across:.3} m, exactly {whole:.3} m");
    assert!((across / whole - 1.0).abs() < 0.01 && whole > 100.0, "{across}, {whole}");
    // The control: without turning it descends.
    let straight = SleighState { turn_rate: 0.0, ..start };
    let fallen = run(&system, &mut Dla::midpoint(), &steps(0.1, 100), straight.to_coordinates(), ());
    assert!(fallen.q()[0] > 30.0);
}
