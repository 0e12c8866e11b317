//! The method that keeps the energy: of one sleigh the static one, of trains with joints and blades held.

use crate::tools::{bent, end, ground, hilly};
use approx::assert_abs_diff_eq;
use assembly::parts::{Blade, Body, Hinge, RotorElement, Trailer, Train};
use assembly::{
    Assembly, AssemblyError, AssemblyMethod, AssemblyState, Joint, Solver, SparseComposition, SparseDla, SparseEnergy,
    SparseLobatto,
};
use lagrangian::linear::larger;
use lagrangian::{Constraint, Piecewise, Scalar, System, With};
use sleigh::effects::Drag;
use sleigh::{Sleigh, SleighState};

#[test]
fn one_sleigh_is_the_static_sleigh() {
    is_the_static_sleigh(80);
}

#[test]
#[ignore = "slow"]
fn one_sleigh_is_the_static_sleigh_in_full() {
    is_the_static_sleigh(400);
}

/// Free and on the hills.
fn is_the_static_sleigh(steps: u32) {
    fn compare<Sys: System<3, 1> + Piecewise + Clone + Send + Sync + 'static>(system: &Sys, steps: u32) {
        let mut alone = Assembly::new();
        let _: [usize; 3] = alone.body("blade", system.clone());
        let (q, v) = SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }.to_coordinates();
        let (mut state, mut fixed) = (AssemblyState::new(&alone, &q, &v), dla::State::new(q, v, [false, false, true]));
        let (mut method, mut reference) = (SparseEnergy::new(&alone, Solver::Best).unwrap(), dla::Energy::new::<1>());
        let h = 0.05;
        for k in 0..steps {
            method.step(&alone, f64::from(k) * h, h, &mut state).unwrap();
            dla::OneStep::step(&mut reference, system, f64::from(k) * h, h, &mut fixed).unwrap();
        }
        // As with `dla`: each step rounds the velocities by some four ulps, and a heading that is off by so much in each step puts
        // the end of a way, of 24 m in 400 steps, beside its place by so much of the way.
        let (turned, way) = (f64::from(steps) * 4.0 * f64::EPSILON, 24.0 * f64::from(steps) / 400.0);
        for i in 0..3 {
            assert_abs_diff_eq!(state.unwrapped(i), fixed.unwrapped()[i], epsilon = way * turned);
            assert_abs_diff_eq!(state.v(i), fixed.v()[i], epsilon = turned);
        }
    }
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    compare(&sleigh, steps);
    compare(&With { body: sleigh, effects: ground() }, steps);
}

/// The largest relative error of the energy, and what the constraints and the joints miss most.
fn worst(train: &Train, method: &mut dyn AssemblyMethod, h: f64, steps: u32) -> [f64; 3] {
    let assembly = &train.assembly;
    let mut state = bent(train);
    let initial = assembly.energy(0.0, &state);
    let (mut most, mut far, mut turns) = ([0.0; 3], 0.0, 0.0);
    for k in 1..=steps {
        method.step(assembly, f64::from(k - 1) * h, h, &mut state).unwrap();
        let [slip, joint] = assembly.misses(f64::from(k) * h, &state);
        let error = (assembly.energy(f64::from(k) * h, &state) - initial) / initial;
        most = [larger(most[0], error), larger(most[1], slip), larger(most[2], joint)];
        far = larger(far, state.q(0));
        turns = larger(turns, state.unwrapped(2) - state.unwrapped(5));
    }
    println!("{most:?}, {far} m, {turns} rad between the first two");
    most
}

#[test]
fn a_train_on_hills_keeps_its_energy() {
    keeps_its_energy(&hilly(3), 100, 50);
}

#[test]
#[ignore = "slow"]
fn a_train_on_hills_keeps_its_energy_at_length() {
    keeps_its_energy(&hilly(6), 10_000, 1000);
}

/// The positive control is that the midpoint rule changes the energy.
fn keeps_its_energy(train: &Train, steps: u32, of_control: u32) {
    let kept = worst(train, &mut SparseEnergy::new(&train.assembly, Solver::Best).unwrap(), 0.02, steps);
    let control = worst(train, &mut SparseDla::new(&train.assembly, Solver::Best).unwrap(), 0.02, of_control);
    // Rounding that walks at random, a few ulps a step.
    assert!(kept[0] < 4.0 * f64::EPSILON * f64::from(steps).sqrt(), "{kept:?}");
    assert!(kept[1] < 1e-14 && kept[2] < 1e-14, "{kept:?}");
    assert!(control[0] > 1e4 * kept[0]);
}

/// Drag takes what it takes: the work of the step is the force in its middle along its way.
#[test]
fn drag_only_takes_energy() {
    let train = {
        let lead = With { body: Sleigh::new(1.0, 1.0, 0.5).unwrap(), effects: Drag::new(0.1, 0.1).unwrap() };
        Train::new(lead, vec![Trailer::new(0.5, 0.1, 0.1, 0.2, 0.8).unwrap(); 3], |trailer| trailer.sleigh).unwrap()
    };
    let mut state = bent(&train);
    let mut method = SparseEnergy::new(&train.assembly, Solver::Best).unwrap();
    let first = train.assembly.energy(0.0, &state);
    let mut before = first;
    for k in 0..200 {
        method.step(&train.assembly, f64::from(k) * 0.1, 0.1, &mut state).unwrap();
        let now = train.assembly.energy(0.0, &state);
        assert!(now < before);
        before = now;
    }
    assert!(before < 0.7 * first);
}

/// The front wheels of a car, turned by a driver.
struct Steering;

impl Joint<4, 1> for Steering {
    fn position<S: Scalar>(&self, t: S, q: &[S; 4]) -> [S; 1] {
        [q[3] - q[2] - t.sin()]
    }
}

/// A spring with a mass of its own.
struct HeavySpring;

impl System<6, 0> for HeavySpring {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 6], v: &[S; 6]) -> S {
        (v[0] + v[3]).squared() * 0.125
    }

    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 6]) -> Constraint<S, 6, 0> {
        ([], [])
    }
}

impl Piecewise for HeavySpring {
    fn piece(&self, _t: f64) -> Self {
        Self
    }
}

/// Constraints that move, and inertia on the coordinates of others.
#[test]
fn what_takes_the_energy_is_refused() {
    let refused = |assembly: &Assembly| {
        let mut state = AssemblyState::new(assembly, &[], &[]);
        let error =
            SparseEnergy::new(assembly, Solver::Best).unwrap().step(assembly, 0.0, 0.1, &mut state).unwrap_err();
        assert!(matches!(error, AssemblyError::Unsupported { .. }), "{error}");
        error.to_string()
    };
    let body = Body { mass: 1.0, inertia: 1.0 };
    let mut car = Assembly::new();
    let [x, y, turn] = car.body("car", body);
    let [wheels] = car.body("wheels", RotorElement { inertia: 0.1 });
    car.join("steering", Steering, [x, y, turn, wheels]).unwrap();
    assert!(refused(&car).contains("b = 0"));
    let mut pair = Assembly::new();
    let [a, b] = [0, 1].map(|_| pair.body::<_, 3, 0>("body", body));
    pair.attach("spring", HeavySpring, [a[0], a[1], a[2], b[0], b[1], b[2]]).unwrap();
    assert!(refused(&pair).contains("coordinates of their own"));
}

/// A body on two axles without mass, which has no basis of its own; and back again.
#[test]
fn a_step_is_its_own_adjoint() {
    let mut racer = Assembly::new();
    let [rear, front] = [0, 1].map(|k| racer.body::<_, 3, 0>("body", Body { mass: f64::from(2 - k), inertia: 0.4 }));
    for body in [rear, front] {
        racer.attach("axle", Blade { ahead: 0.0 }, body).unwrap();
    }
    let at = [rear[0], rear[1], rear[2], front[0], front[1], front[2]];
    racer.join("hinge", Hinge::new([0.7, 0.0], [-0.4, 0.0]), at).unwrap();
    // The rear turns at 0.3 rad/s and goes ahead at 1 m/s; the hinge moves with it, and the front axle as it can.
    let (angle, hinge): (f64, _) = (0.5, [1.0, 0.7 * 0.3]);
    let rate = (hinge[0] * angle.sin() - hinge[1] * angle.cos()) / 0.4;
    let along = hinge[0] * angle.cos() + hinge[1] * angle.sin();
    let q = [0.0, 0.0, 0.0, 0.7 + 0.4 * angle.cos(), 0.4 * angle.sin(), angle];
    let v = [1.0, 0.0, 0.3, along * angle.cos(), along * angle.sin(), rate];
    let start = AssemblyState::new(&racer, &q, &v);
    let [slip, joint] = racer.misses(0.0, &start);
    assert!(slip < 1e-15 && joint < 1e-15, "{slip} {joint}");
    let (mut state, mut method) = (start.clone(), SparseEnergy::new(&racer, Solver::Best).unwrap());
    let energy = racer.energy(0.0, &start);
    for k in 0..50 {
        method.step(&racer, 0.04 * f64::from(k), 0.04, &mut state).unwrap();
    }
    assert!(state.distance(&start) > 0.5);
    assert_abs_diff_eq!(racer.energy(2.0, &state), energy, epsilon = 1e-14);
    for k in 0..50 {
        method.step(&racer, 2.0 - 0.04 * f64::from(k), -0.04, &mut state).unwrap();
    }
    println!("{:e}", state.distance(&start));
    assert!(state.distance(&start) < 1e-12);
}

#[test]
fn order_two() {
    let train = hilly(2);
    of_order_two(&train, 1.0, [20, 40, 80], (&mut SparseLobatto::new(&train.assembly, Solver::Best, 5).unwrap(), 20));
}

#[test]
#[ignore = "slow"]
fn order_two_in_full() {
    let train = hilly(4);
    let mut exact = SparseComposition::new(&train.assembly, Solver::Best, 8).unwrap();
    of_order_two(&train, 2.0, [40, 80, 160], (&mut exact, 160));
}

/// Against the eighth order.
fn of_order_two(train: &Train, duration: f64, counts: [u32; 3], (exact, fine): (&mut dyn AssemblyMethod, u32)) {
    let assembly = &train.assembly;
    let energy = || SparseEnergy::new(assembly, Solver::Best).unwrap();
    let exact = end(train, duration, exact, fine);
    let errors = counts.map(|steps| end(train, duration, &mut energy(), steps).distance(&exact));
    let orders = [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()];
    println!("{errors:?} {orders:?}");
    assert!(orders.iter().all(|order| (order - 2.0).abs() < 0.1), "{orders:?}");
}
