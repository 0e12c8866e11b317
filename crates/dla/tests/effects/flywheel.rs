//! A rotor on the sleigh.

use crate::effects::balance::sine;
use crate::effects::tools::{Laden, laden, moving, run, sleigh, steps};
use crate::support::ByHand;
use dla::{Dla, Observer, Report, View};
use lagrangian::With;
use scene::AnyEffect;
use sleigh::effects::Thrust;
use sleigh::{ClosedMap, Flywheel, Sleigh};
use std::ops::ControlFlow;

/// The largest departure of the rotor's absolute rate `omega + psi'` from its first value, relative.
#[derive(Default)]
struct Spin {
    start: f64,
    worst: f64,
}
impl Observer for Spin {
    fn start(&mut self, node: &View<'_>) {
        self.start = node.state.v()[2] + node.state.v()[3];
    }
    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        let spin = node.state.v()[2] + node.state.v()[3];
        self.worst = self.worst.max((spin / self.start - 1.0).abs());
        ControlFlow::Continue(())
    }
}

/// On a free bearing the rotor keeps its momentum and the sleigh knows nothing of it: by the closed form on the free
/// sleigh, and by the general one under a backward thrust, which keeps the sleigh turning around.
fn keeps_its_momentum(closed: u64, general: u64) {
    let rate = 3.0;
    let (q, v) = moving().to_coordinates();
    let with_rotor = ([q[0], q[1], q[2], 0.0], [v[0], v[1], v[2], rate]);
    let back = || vec![AnyEffect::Thrust(Thrust::new(-0.5).unwrap())];

    let mut spin = Spin::default();
    let body = With { body: Flywheel::new(sleigh(), 0.2, None).unwrap(), effects: () };
    let end = run(&body.body, &mut ClosedMap::of(body.clone()), &steps(0.05, closed), with_rotor, &mut spin);
    let free = With { body: sleigh(), effects: () };
    let bare = run(&ByHand::from(free.body), &mut ClosedMap::of(free), &steps(0.05, closed), (q, v), ());
    println!("free, closed form: momentum to {:.1e}", spin.worst);
    assert!(spin.worst <= 1e-14);
    for i in 0..3 {
        assert!(end.unwrapped()[i].to_bits() == bare.unwrapped()[i].to_bits());
        assert!(end.v()[i].to_bits() == bare.v()[i].to_bits());
    }

    let mut spin = Spin::default();
    let system = laden(Flywheel::new(sleigh(), 0.2, None).unwrap(), back());
    run(&system, &mut Dla::midpoint(), &steps(0.05, general), with_rotor, &mut spin);
    println!("under thrust, general form: momentum to {:.1e}", spin.worst);
    // Every step rounds the velocities anew, and the roundings walk at random.
    assert!(spin.worst <= 8.0 * f64::EPSILON * (general as f64).sqrt());

    // The motion of the sleigh in the general form, before rounding has grown.
    let system = laden(Flywheel::new(sleigh(), 0.2, None).unwrap(), back());
    let end = run(&system, &mut Dla::midpoint(), &steps(0.05, 400), with_rotor, ());
    let bare: Laden<Sleigh> = laden(sleigh(), back());
    let bare = run(&bare, &mut Dla::midpoint(), &steps(0.05, 400), (q, v), ());
    let off = (0..3).map(|i| (end.unwrapped()[i] - bare.unwrapped()[i]).abs()).fold(0.0, f64::max);
    println!("the sleigh beneath it: off by {off:.1e} after 400 steps");
    assert!(off < 400.0 * 16.0 * f64::EPSILON, "{off:e}");

    // The control: a motor changes both.
    let mut spin = Spin::default();
    let body = Flywheel::new(sleigh(), 0.2, Some(sine(0.3, 1.0, 0.0))).unwrap();
    let driven = run(&laden(body, vec![]), &mut Dla::midpoint(), &steps(0.05, 400), with_rotor, &mut spin);
    assert!(spin.worst > 0.1 && (driven.q()[0] - bare.q()[0]).abs() > 0.1);
}

#[test]
fn a_free_rotor_keeps_its_momentum() {
    keeps_its_momentum(20_000, 2000);
}

#[test]
#[ignore = "slow"]
fn a_free_rotor_keeps_its_momentum_at_length() {
    keeps_its_momentum(1_000_000, 100_000);
}

/// The frequency `w` of the drive over `c = m a/J`.
const DELAY: f64 = 0.5 / (0.5 / 1.25);

/// The speed after `count` steps from 1 m/s, and `3 <K'^2> t/(m^2 a)`, where the rotor's momentum `K` is driven to and fro.
fn driven(count: u64) -> [f64; 2] {
    let body = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let (amplitude, frequency) = (1.0, 0.5);
    let system = laden(Flywheel::new(body, 0.2, Some(sine(amplitude, frequency, 0.0))).unwrap(), vec![]);
    let start = ([0.0; 4], [1.0, 0.0, 0.0, 0.0]);
    let end = run(&system, &mut Dla::midpoint(), &steps(0.05, count), start, ());
    let (t, speed) = (0.05 * count as f64, f64::hypot(end.v()[0], end.v()[1]));
    println!("t = {t}: u = {speed:.3}");
    [speed, 3.0 * (0.5 * amplitude * amplitude) * t / 0.5]
}

/// With the delay of the spin behind the drive, `(c^2 u^2 + w^2) u' = a <K'^2>/J^2`, so that `u^3 + 3 (w/c)^2 u` grows evenly.
#[test]
fn a_driven_rotor_accelerates_without_bound() {
    let [speed, law] = driven(3000);
    let ratio = (speed.powi(3) - 1.0 + 3.0 * DELAY * DELAY * (speed - 1.0)) / law;
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
}

/// With the spin slaved to the drive, `m a u omega = -K'`; its delay takes `3 (w/(c u))^2`, here 0.3 %, from `u^3`.
#[test]
#[ignore = "slow"]
fn a_driven_rotor_accelerates_without_bound_at_length() {
    let [speed, law] = driven(400_000);
    let ratio = speed.powi(3) / law;
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
}
