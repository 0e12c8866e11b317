use crate::runs::{backward, sleigh, sleigh_state, state_of, system};
use crate::support::{OWN, run_own};
use dla::{
    AnyState, Composition, Dla, Gauss, Hermite, Observer, OneStep, Report, Samples, Schedule, State, View, drive,
};
use lagrangian::constraint_residual;
use sleigh::{Exact, SleighState};
use std::ops::ControlFlow;

/// Times of no step that is used here, in the part of the motion where it turns.
const TIMES: [f64; 5] = [1.377, 4.911, 7.139, 8.003, 9.871];
const DURATION: f64 = 10.0;

/// The largest error of position, heading and velocities.
fn error(found: &SleighState, t: f64) -> f64 {
    let exact = Exact::new(&sleigh(), &backward()).unwrap().at(t);
    let differences = [
        found.x - exact.x,
        found.y - exact.y,
        found.heading - exact.heading,
        found.speed - exact.speed,
        found.turn_rate - exact.turn_rate,
    ];
    differences.iter().fold(0.0, |largest: f64, d| largest.max(d.abs()))
}

fn schedule(steps: u64) -> Schedule {
    Schedule { t0: 0.0, step: DURATION / steps as f64, steps }
}

/// The largest error of samples, and of the constraint at them.
fn sampled<Method: OneStep<3, 1> + Copy>(method: Method, steps: u64) -> (f64, f64) {
    let (sleigh, mut state) = (system(), state_of(&backward()));
    let mut samples = Samples::new(&OWN, &TIMES);
    run_own(&sleigh, method, &schedule(steps), &mut state, &mut samples).unwrap();
    assert_eq!((samples.taken().len(), samples.failure()), (TIMES.len(), None));
    let taken = samples.taken().iter().zip(TIMES);
    taken.fold((0.0, 0.0), |(e, c): (f64, f64), (state, t)| {
        let state = state.typed().unwrap();
        let [residual] = constraint_residual(&sleigh, t, state.q(), state.v());
        (e.max(error(&sleigh_state(state), t)), c.max(residual.abs()))
    })
}

/// The orders seen over the last halving, and the one before.
fn orders(errors: [f64; 3]) -> [f64; 2] {
    [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()]
}

/// The order of the method, where at most one less is promised; the constraint to rounding.
#[test]
fn samples_have_the_order_of_the_method_and_hold_the_constraint() {
    let rows = [
        ("dla", 2.0, [100, 200, 400].map(|steps| sampled(Dla::midpoint(), steps))),
        ("dla4", 4.0, [100, 200, 400].map(|steps| sampled(Composition::suzuki4(Dla::midpoint()), steps))),
        ("gauss8", 8.0, [10, 20, 40].map(|steps| sampled(Gauss::new::<4>(), steps))),
    ];
    for (name, order, row) in rows {
        println!("{name}: {row:?}");
        let found = orders(row.map(|(error, _)| error));
        assert!(found[1] > order - 0.3, "{name}: {found:?}");
        assert!(row.iter().all(|(_, slip)| *slip <= 4.0 * f64::EPSILON), "{name}: {row:?}");
    }
    // With steps of two fifths of a second order 16 has nothing left but the rounding of some metres.
    assert!(sampled(Gauss::new::<8>(), 25).0 <= 1e-13);
}

/// Samples at nodes are the nodes, and looking changes nothing.
#[test]
fn samples_at_nodes_are_the_nodes() {
    let (sleigh, times) = (system(), [0.0, 2.5, 2.6, 5.0, 10.0, 11.0]);
    let (mut plain, mut watched) = (state_of(&backward()), state_of(&backward()));
    let mut samples = Samples::new(&OWN, &times);
    run_own(&sleigh, Dla::midpoint(), &schedule(80), &mut watched, &mut samples).unwrap();
    drive(&sleigh, &mut Dla::midpoint(), &schedule(80), &mut plain, ()).unwrap();
    assert_eq!(plain, watched);
    assert_eq!(samples.taken().len(), 5, "eleven seconds are not in the run");
    assert_eq!([&samples.taken()[0], &samples.taken()[4]], [&state_of(&backward()).into(), &plain.into()]);
    let mut half = state_of(&backward());
    drive(&sleigh, &mut Dla::midpoint(), &Schedule { steps: 40, ..schedule(80) }, &mut half, ()).unwrap();
    assert_eq!(samples.taken()[3], half.into());
    // A run without a step has its start.
    let (none, mut state) = (Schedule { steps: 0, ..schedule(80) }, state_of(&backward()));
    let mut samples = Samples::new(&OWN, &times);
    run_own(&sleigh, Dla::midpoint(), &none, &mut state, &mut samples).unwrap();
    assert_eq!(samples.taken(), [AnyState::from(state)]);

    // Backward in time, from the end.
    let times = [8.0, 3.3];
    let mut samples = Samples::new(&OWN, &times);
    let back = Schedule { t0: 10.0, step: -0.125, steps: 80 };
    run_own(&sleigh, Dla::midpoint(), &back, &mut plain, &mut samples).unwrap();
    assert_eq!(samples.taken().len(), 2);
    assert!(samples.taken().iter().zip(times).all(|(state, t)| error(&sleigh_state(state.typed().unwrap()), t) < 0.01));
}

/// The nodes of a run in pairs.
#[derive(Default)]
struct Quintics {
    before: Option<(f64, State<3>)>,
    found: Vec<(f64, Hermite<3>)>,
}

impl Observer for Quintics {
    fn start(&mut self, node: &View<'_>) {
        self.before = Some((node.t, *node.state.typed().unwrap()));
    }
    fn step(&mut self, node: &View<'_>, _: &Report) -> ControlFlow<()> {
        let ((t0, before), state) = (self.before.unwrap(), *node.state.typed().unwrap());
        let quintic = Hermite::between(&system(), (t0, &before), (node.t, &state)).unwrap();
        self.found.push((node.t, quintic));
        self.before = Some((node.t, state));
        ControlFlow::Continue(())
    }
}

/// The largest errors of position and velocity, and the largest slip, of the quintics of a run.
fn interpolated<Method: OneStep<3, 1>>(mut method: Method, steps: u64) -> [f64; 3] {
    let (sleigh, mut quintics) = (sleigh(), Quintics::default());
    drive(&system(), &mut method, &schedule(steps), &mut state_of(&backward()), &mut quintics).unwrap();
    let exact = Exact::new(&sleigh, &backward()).unwrap();
    let mut worst = [0.0f64; 3];
    for t in (0..997).map(|i| DURATION * (f64::from(i) + 0.5) / 997.0) {
        let (_, quintic) = quintics.found.iter().find(|(end, _)| *end >= t).unwrap();
        let ((q, v), (q_exact, v_exact)) = (quintic.at(t), exact.at(t).to_coordinates());
        for i in 0..3 {
            worst[0] = worst[0].max((q[i] - q_exact[i]).abs());
            worst[1] = worst[1].max((v[i] - v_exact[i]).abs());
        }
        let [residual] = constraint_residual(&sleigh, t, &q, &v);
        worst[2] = worst[2].max(residual.abs());
    }
    worst
}

#[test]
fn quintics_have_their_orders() {
    let rows = [25, 50, 100].map(|steps| interpolated(Gauss::new::<8>(), steps));
    let found: Vec<_> = (0..3).map(|i| orders(rows.map(|row| row[i]))).collect();
    println!("quintic: {rows:?}, orders {found:.2?}");
    // Position 6, velocity and constraint 5.
    for (order, found) in [6.0, 5.0, 5.0].iter().zip(&found) {
        assert!(found[1] > order - 0.3, "{found:?}");
    }
    assert!(rows[2][2] > 1e-14, "the control: the constraint is not at rounding");
    // With a method of order two nothing is lost.
    let rows = [100, 200, 400].map(|steps| interpolated(Dla::midpoint(), steps));
    assert!((0..2).all(|i| (orders(rows.map(|row| row[i]))[1] - 2.0).abs() < 0.1), "{rows:?}");
}

/// The velocity is the derivative of the position: Simpson's rule is exact to degree three, Boole's to five.
#[test]
fn the_velocity_of_a_quintic_is_the_derivative_of_its_position() {
    let (sleigh, mut quintics) = (system(), Quintics::default());
    drive(&sleigh, &mut Dla::midpoint(), &schedule(20), &mut state_of(&backward()), &mut quintics).unwrap();
    for (end, quintic) in &quintics.found {
        let (from, width) = (end - 0.4, 0.3);
        let v: Vec<_> = (0..5).map(|i| quintic.at(from + 0.25 * width * f64::from(i)).1).collect();
        let (q0, q1) = (quintic.at(from).0, quintic.at(from + width).0);
        for i in 0..3 {
            let boole = width / 90.0 * (7.0 * (v[0][i] + v[4][i]) + 32.0 * (v[1][i] + v[3][i]) + 12.0 * v[2][i]);
            // Rounding of positions of ten metres, and of sums of some terms.
            assert!((q1[i] - q0[i] - boole).abs() <= 1e-13, "{:e}", q1[i] - q0[i] - boole);
        }
    }
}
