//! The length of a quaternion, over long runs of a body that tumbles.

use crate::attitudes::tools::{Place, largest};
use crate::large::with_stack;
use crate::support::{Four, Six};
use dla::{Composition, Dla, Energy, Form, Gauss, Gni, Lobatto, OneStep, State, StepError, View};
use lagrangian::{System, Trapezoid};
use test_systems::{Attitude, ChaplyginBall, Model, Suslov};

fn ball() -> ChaplyginBall {
    ChaplyginBall::new(1.2, 0.6, [0.5, 0.8, 1.1])
}

/// The largest `||e|^2 - 1|/2` over `steps` steps of 0.05 s.
fn off<Sys: System<N, M>, Method: OneStep<N, M>, const N: usize, const M: usize>(
    (system, start): &(Sys, Place<N>),
    mut method: Method,
    steps: u64,
) -> f64 {
    let ([off], end) = largest(system, &mut method, *start, (0.05, steps), |node: &View<'_>| {
        let q = node.state.q();
        [Attitude::new([q[N - 4], q[N - 3], q[N - 2], q[N - 1]]).norm_miss().abs()]
    });
    end.unwrap();
    off
}

fn held(name: &str, off: f64) {
    println!("{name}: {off:e}");
    // One rounding of each of the four squares, whatever the number of steps.
    assert!(off <= 4.0 * f64::EPSILON, "{name}: {off:e}");
}

/// As a constraint on positions, by every method that carries those.
fn on_positions(steps: u64) {
    let ball = (Six::from(ball()), ball().start());
    held("dla", off(&ball, Dla::midpoint(), steps));
    held("dla, with multipliers", off(&ball, Dla::midpoint().solved(Form::Multipliers), steps / 10));
    held("dla-trapezoid", off(&ball, Dla::new(Trapezoid, Trapezoid), steps));
    held("dla4", off(&ball, Composition::suzuki4(Dla::midpoint()), steps / 5));
    held("lobatto3", off(&ball, Lobatto::<3>::new(), steps / 10));
    held("gauss4", off(&ball, Gauss::new::<2>(), steps / 10));
    held("gauss8", off(&ball, Gauss::new::<4>(), steps / 10));
    let suslov = Suslov::new([1.0, 2.0, 1.5], 0.3, 0.5);
    let suslov = (Four::from(suslov), suslov.start());
    held("Suslov, dla", off(&suslov, Dla::midpoint(), steps));
    held("Suslov, gauss8", off(&suslov, Gauss::new::<4>(), steps / 10));
}

#[test]
fn on_positions_it_holds_for_ever() {
    with_stack(2 << 20, || on_positions(400));
}

#[test]
#[ignore = "slow"]
fn on_positions_it_holds_for_ever_at_length() {
    on_positions(100_000);
}

/// By its rate alone it is kept by what keeps functions of second degree: what adds up are the roundings of increments, which are
/// those of a twentieth, as a random walk does. Lobatto's methods keep it by their order only, and are the control.
fn by_its_rate(steps: u64, control: u64) {
    let ball = ball().norm_by_rate();
    let ball = (Six::from(ball), ball.start());
    let walk = |steps: u64| f64::EPSILON * (4.0 + 0.05 * (steps as f64).sqrt());
    for (name, off, steps) in [
        ("dla", off(&ball, Dla::midpoint(), steps), steps),
        ("dla-trapezoid", off(&ball, Dla::new(Trapezoid, Trapezoid), steps), steps),
        ("dla4", off(&ball, Composition::suzuki4(Dla::midpoint()), steps / 5), steps / 5),
        ("gauss8", off(&ball, Gauss::new::<4>(), steps / 10), steps / 10),
        ("energy2", off(&ball, Energy::new::<1>(), steps / 10), steps / 10),
        ("energy4", off(&ball, Energy::new::<2>(), steps / 10), steps / 10),
    ] {
        println!("{name}: {off:e} after {steps} steps");
        assert!(off <= walk(steps), "{name}: {off:e}");
    }
    let lost = off(&ball, Lobatto::<3>::new(), control);
    println!("lobatto3: {lost:e}");
    assert!((1e-14 * control as f64..1e-8).contains(&lost), "{lost:e}");
}

#[test]
fn by_its_rate_it_walks() {
    by_its_rate(200, 100);
}

#[test]
#[ignore = "slow"]
fn by_its_rate_it_walks_at_length() {
    by_its_rate(100_000, 1000);
}

/// What would let it drift refuses it as a constraint on positions.
#[test]
fn what_cannot_hold_it_refuses() {
    let ball = ball();
    let (q, v) = ball.start();
    for method in [&mut Energy::new::<2>() as &mut dyn OneStep<6, 3>, &mut Gni::default()] {
        let mut state = State::new(q, v, ball.angles());
        let error = method.step(&Six::from(ball), 0.0, 0.01, &mut state).unwrap_err();
        assert!(matches!(error, StepError::Unsupported { reason } if reason.contains("positions")), "{error}");
        method.step(&Six::from(ball.norm_by_rate()), 0.0, 0.01, &mut state).unwrap();
    }
}
