//! The step of a sleigh that is pushed against its own equations, term by term, and where it leaves the step to others.

use approx::assert_abs_diff_eq;
use lagrangian::{Effect, EffectSlope, Scalar, With};
use proptest::prelude::*;
use sleigh::closed::{ClosedForm, ClosedStart, ClosedStep, Memory};
use sleigh::effects::{Bowl, Drag, EggCrate};
use sleigh::{Sleigh, SleighState};

/// The potential `-F x cos t`, on the blade.
#[derive(Debug, Clone, Copy)]
struct Tide(f64);

impl Effect<Sleigh, 3> for Tide {
    fn lagrangian<S: Scalar>(&self, _body: &Sleigh, t: S, q: &[S; 3], _v: &[S; 3]) -> Option<S> {
        Some(q[0] * t.cos() * self.0)
    }
    fn slope<S: Scalar>(&self, _body: &Sleigh, t: S, _q: &[S; 3]) -> EffectSlope<S, 3> {
        EffectSlope::Known([t.cos() * self.0, S::zero(), S::zero()])
    }
}

/// A potential of which no slope is given.
struct Unsaid;

impl Effect<Sleigh, 3> for Unsaid {
    fn lagrangian<S: Scalar>(&self, _body: &Sleigh, _t: S, q: &[S; 3], _v: &[S; 3]) -> Option<S> {
        Some(q[0])
    }
}

type Laden = With<Sleigh, (Bowl, EggCrate, Tide, Drag)>;

/// The time at which steps begin (s).
const TIME: f64 = 0.7;

fn laden(m: f64, i: f64, a: f64, stiffness: [f64; 2], height: f64) -> Laden {
    let bowl = Bowl::new(stiffness, [0.4, -0.3]).unwrap();
    let drag = Drag::new(height.abs(), 0.5 * height.abs()).unwrap();
    let effects = (bowl, EggCrate::new(height, [1.0, 1.3]).unwrap(), Tide(height), drag);
    With { body: Sleigh::new(m, i, a).unwrap(), effects }
}

fn step<Sys: ClosedForm<3, 1>>(system: &Sys, h: f64, (heading, u, omega): (f64, f64, f64)) -> Option<ClosedStep<3, 1>> {
    let (q, v) = SleighState { x: 0.3, y: -0.2, heading, speed: u, turn_rate: omega }.to_coordinates();
    system.closed_step(TIME, h, ClosedStart::new(&q, &v, &mut Memory::default())).map(Result::unwrap)
}

/// As many steps: where they end, the last one, and what it leaves.
fn steps<Sys: ClosedForm<3, 1>>(
    system: &Sys,
    h: f64,
    (heading, u, omega): (f64, f64, f64),
    number: u32,
) -> ([f64; 3], ClosedStep<3, 1>, Memory) {
    let (mut q, v) = SleighState { x: 0.3, y: -0.2, heading, speed: u, turn_rate: omega }.to_coordinates();
    let mut memory = Memory::EMPTY;
    let mut made = system.closed_step(TIME, h, ClosedStart::new(&q, &v, &mut memory)).unwrap().unwrap();
    for k in 1..number {
        for i in 0..3 {
            q[i] += made.increment[i];
        }
        let start = ClosedStart { xi: Some(made.xi), ..ClosedStart::new(&q, &made.velocity, &mut memory) };
        made = system.closed_step(TIME + h * f64::from(k), h, start).unwrap().unwrap();
    }
    (std::array::from_fn(|i| q[i] + made.increment[i]), made, memory)
}

proptest! {
    #[test]
    fn the_equations_of_the_step_hold(
        (m, i, a) in (0.3..3.0, 0.3..3.0, -0.8..0.8),
        (kx, ky, height) in (-0.5..0.5, -0.5..0.5, -0.3..0.3),
        (heading, u0, omega0) in (-3.0..3.0, -2.0..2.0, -2.0..2.0),
        h in prop_oneof![-0.1..-0.01, 0.01..0.1],
    ) {
        let system = laden(m, i, a, [kx, ky], height);
        let made = step(&system, h, (heading, u0, omega0)).expect("a short step");
        let (sleigh, [dx, dy, turn]) = (system.body, made.increment);
        let (w, d, k) = (turn / h, 0.5 * turn, 0.5 * h * sleigh.spin_gain());
        let (sin, cos) = (heading + d).sin_cos();
        let chord = (dx * cos + dy * sin) / h;
        let middle = [0.3 + 0.5 * dx, -0.2 + 0.5 * dy, heading + d];
        let mean = made.increment.map(|d| d / h);
        let [fx, fy, torque] = system.effects.whole_force(&sleigh, TIME + 0.5 * h, &middle, &mean).expect("slopes by hand");
        let (along, across) = (cos * fx + sin * fy, cos * fy - sin * fx);
        let (of_mass, of_inertia) = (0.5 * h / m, 0.5 * h / sleigh.pivot_inertia());
        let [u1, omega1, _] = made.xi;
        // Terms below ten, and their rounding divided by a determinant that is near one.
        let bound = 1e-13;
        assert_abs_diff_eq!(dy * cos - dx * sin, 0.0, epsilon = 1e-15);
        let turned = a * w * d.sin();
        let pushed = |side: f64| of_mass * (along * d.cos() + side * across * d.sin());
        assert_abs_diff_eq!(chord * d.cos() - turned, u0 + pushed(-1.0), epsilon = bound);
        assert_abs_diff_eq!(chord * d.cos() + turned, u1 - pushed(1.0), epsilon = bound);
        assert_abs_diff_eq!(w * (1.0 + k * chord), omega0 + of_inertia * torque, epsilon = bound);
        assert_abs_diff_eq!(w * (1.0 - k * chord), omega1 - of_inertia * torque, epsilon = bound);
    }

    /// The memory of earlier steps changes the first guess of the search, not its result: also of another sleigh, after a jump of the
    /// velocity, or at another heading.
    #[test]
    fn the_step_is_the_same_whatever_is_remembered(
        (m, i, a) in (0.3..3.0, 0.3..3.0, -0.8..0.8),
        (kx, ky, height) in (-0.5..0.5, -0.5..0.5, -0.3..0.3),
        start in (-3.0..3.0, -1.0..1.0, -1.0..1.0),
        h in prop_oneof![-0.1..-0.01, 0.01..0.1],
        number in 1..20u32,
    ) {
        let ours = laden(m, i, a, [kx, ky], height);
        let other = laden(i, m, 0.9 * a, [ky, kx], height);
        for (system, factor, turned) in
            [(&ours, 1.0, 0.0), (&ours, 0.5, 0.0), (&ours, -1.0, 0.0), (&ours, 1.0, 1e-9), (&ours, 1.0, 2.0), (&other, 1.0, 0.0)]
        {
            let (mut q, made, memory) = steps(system, h, start, number);
            q[2] += turned;
            let (sin, cos) = q[2].sin_cos();
            let [u, omega] = [factor * made.xi[0], factor * made.xi[1]];
            let v = [u * cos, u * sin, omega];
            let [blank, known] = [Memory::EMPTY, memory].map(|mut memory| {
                let start = ClosedStart { xi: Some([u, omega, 0.0]), ..ClosedStart::new(&q, &v, &mut memory) };
                ours.closed_step(TIME, h, start).unwrap().unwrap()
            });
            // Terms below ten, and their rounding divided by a determinant that is near one.
            let bound = 1e-13;
            for i in 0..3 {
                assert_abs_diff_eq!(known.increment[i], blank.increment[i], epsilon = bound);
                assert_abs_diff_eq!(known.velocity[i], blank.velocity[i], epsilon = bound);
                assert_abs_diff_eq!(known.xi[i], blank.xi[i], epsilon = bound);
            }
            for end in 0..2 {
                assert_abs_diff_eq!(known.impulses[end][0], blank.impulses[end][0], epsilon = 10.0 * bound);
            }
        }
    }

    /// A smooth motion needs one correction a step, once the steps before tell where to begin.
    #[test]
    fn one_correction_is_enough(heading in -3.0..3.0, u0 in 0.5..1.0, omega0 in 0.5..1.0) {
        let system = laden(1.3, 0.8, 0.4, [0.2, 0.3], 0.1);
        let corrections = [1, 12, 13, 14, 15, 16].map(|number| steps(&system, 0.01, (heading, u0, omega0), number).1.iterations);
        prop_assert!(corrections[0] > 1, "the control");
        prop_assert!(corrections[1..].iter().all(|n| *n == 1), "{corrections:?}");
    }
}

/// What a step of one map leaves says nothing to the other, though the length of the step is the same.
#[test]
fn numbers_of_another_map_are_not_taken() {
    let (h, body) = (0.05, Sleigh::new(1.3, 0.8, 0.4).unwrap());
    let well = With { body, effects: (Bowl::new([0.1; 2], [0.4, 0.0]).unwrap(),) };
    // At rest, with the centre of mass at the lowest place: every number is zero, and would be the cosine of a half turn.
    let [mut rest, mut free] = [Memory::EMPTY; 2];
    well.closed_step(TIME, h, ClosedStart::new(&[0.0; 3], &[0.0; 3], &mut rest)).unwrap().unwrap();
    ClosedForm::<3, 1>::closed_step(&body, TIME, h, ClosedStart::new(&[0.0; 3], &[0.0; 3], &mut free))
        .unwrap()
        .unwrap();
    for (u, omega) in [(1.0, 0.0), (0.5, -0.3), (0.0, 0.0)] {
        let (q, v) = ([0.0; 3], [u, 0.0, omega]);
        let by = |system: &dyn Fn(ClosedStart<'_, 3>) -> ClosedStep<3, 1>, memory| {
            let [blank, known] = [Memory::EMPTY, memory].map(|mut memory| {
                system(ClosedStart { xi: Some([u, omega, 0.0]), ..ClosedStart::new(&q, &v, &mut memory) })
            });
            for i in 0..3 {
                assert_abs_diff_eq!(known.increment[i], blank.increment[i], epsilon = 1e-15);
                assert_abs_diff_eq!(known.velocity[i], blank.velocity[i], epsilon = 1e-15);
            }
        };
        by(&|start| ClosedForm::<3, 1>::closed_step(&body, TIME, h, start).unwrap().unwrap(), rest);
        by(&|start| well.closed_step(TIME, h, start).unwrap().unwrap(), free);
    }
}

/// Without a potential it would be the closed map's; a small one changes it little.
#[test]
fn a_vanishing_potential_leaves_the_free_step() {
    let at = (0.4, -1.0, 0.7);
    let free = step(&Sleigh::new(1.3, 0.8, 0.4).unwrap(), 0.05, at).unwrap();
    let none = step(&laden(1.3, 0.8, 0.4, [0.0; 2], 0.0), 0.05, at).unwrap();
    let some = step(&laden(1.3, 0.8, 0.4, [1e-3; 2], 0.0), 0.05, at).unwrap();
    for i in 0..3 {
        assert_abs_diff_eq!(none.increment[i], free.increment[i], epsilon = 1e-15);
        assert_abs_diff_eq!(none.velocity[i], free.velocity[i], epsilon = 1e-15);
    }
    assert!((some.velocity[0] - free.velocity[0]).abs() > 1e-6, "the control");
}

#[test]
fn what_it_does_not_know_is_left_to_the_general_step() {
    let (at, body) = ((0.4, -1.0, 0.7), Sleigh::new(1.3, 0.8, 0.4).unwrap());
    let bowl = || Bowl::new([0.1; 2], [0.0; 2]).unwrap();
    assert!(step(&With { body, effects: (bowl(),) }, 0.05, at).is_some());
    // A term of the Lagrangian whose slope is not known by hand.
    assert!(step(&With { body, effects: (bowl(), Unsaid) }, 0.05, at).is_none());
    // A blade that turns by more than a radian in the step; one that would turn by a right angle in half of it.
    for omega in [2.5, 8.0] {
        assert!(step(&With { body, effects: (bowl(),) }, 0.5, (0.4, -1.0, omega)).is_none());
    }
    // A potential whose force changes by more than itself within the step.
    let steep = Bowl::new([1e5; 2], [0.0; 2]).unwrap();
    assert!(step(&With { body, effects: (steep,) }, 0.5, at).is_none());
}
