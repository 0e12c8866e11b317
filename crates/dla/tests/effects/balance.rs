//! The energy and the work.

use crate::effects::tools::{Laden, assert_order, laden, moving, run, sleigh, steps};
use dla::{Composition, Dla, Energy, Observer, OneStep, Report, View, Work};
use lagrangian::{Piecewise, System};
use scene::AnyEffect;
use sleigh::effects::{Bowl, Drag, MovingMass, Slope, Thrust, Torque};
use sleigh::{Guide, Guided, Sleigh, Table, TimeFunction};
use std::ops::ControlFlow;

/// The largest error of the energy balance, and what it would be without the work.
#[derive(Debug, Default)]
pub struct Balance {
    pub work: Work,
    first: f64,
    /// The largest `|E - E0 - work|` (J).
    pub worst: f64,
    /// The largest `|E - E0|` (J).
    pub unpaid: f64,
    /// The largest `|A v + b|`.
    pub slip: f64,
}

impl Observer for Balance {
    fn start(&mut self, node: &View<'_>) {
        self.work.start(node);
        self.first = node.energy();
    }
    fn resume(&mut self, node: &View<'_>) {
        self.work.resume(node);
    }
    fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
        let flow = self.work.step(node, report);
        let change = node.energy() - self.first;
        self.unpaid = self.unpaid.max(change.abs());
        self.worst = self.worst.max((change - self.work.total()).abs());
        self.slip = self.slip.max(node.constraint());
        flow
    }
}

pub fn sine(amplitude: f64, frequency: f64, phase: f64) -> TimeFunction {
    TimeFunction::Sine { amplitude, frequency, phase }
}

fn balance<Sys, Method, const N: usize, const M: usize>(
    system: &Sys,
    mut method: Method,
    start: ([f64; N], [f64; N]),
    h: f64,
) -> Balance
where
    Sys: System<N, M> + Piecewise,
    Method: OneStep<N, M>,
{
    let mut seen = Balance::default();
    run(system, &mut method, &steps(h, (4.0 / h).round() as u64), start, &mut seen);
    seen
}

/// The balance at the order of the method, and at most 6, that of the quadrature of the power.
fn converges<Sys, const N: usize, const M: usize>(name: &str, system: &Sys, start: ([f64; N], [f64; N]))
where
    Sys: System<N, M> + Piecewise,
{
    let two = [0.1, 0.05, 0.025].map(|h| balance(system, Dla::midpoint(), start, h));
    let six = [0.2, 0.1, 0.05].map(|h| balance(system, Composition::fifteen8(Dla::midpoint()), start, h));
    assert_order(&format!("{name}, dla"), &two.each_ref().map(|seen| seen.worst), 2.0);
    assert_order(&format!("{name}, dla8"), &six.each_ref().map(|seen| seen.worst), 6.0);
    // The control: the energy itself changes by a finite amount.
    let [.., last] = &six;
    assert!(last.unpaid > 0.05 && last.worst < 1e-6 * last.unpaid, "{name}: {last:?}");
}

#[test]
fn forced() {
    let effects = vec![
        AnyEffect::Bowl(Bowl::new([0.4, 0.15], [0.2, -0.3]).unwrap()),
        AnyEffect::Drag(Drag::new(0.2, 0.1).unwrap()),
        AnyEffect::Thrust(Thrust::new(sine(0.6, 1.3, 0.4)).unwrap()),
        AnyEffect::Torque(Torque::new(0.2).unwrap()),
    ];
    converges("forced", &laden(sleigh(), effects), moving().to_coordinates());
}

#[test]
fn explicit_time() {
    let mass = MovingMass::new(0.4, sine(0.3, 2.0, 0.3), 0.2).unwrap();
    let effects = vec![AnyEffect::Slope(Slope::new([0.3, -0.2]).unwrap())];
    let carrying = Guided::from(sleigh()).carrying(vec![mass]);
    converges("explicit time", &laden(carrying, effects), moving().to_coordinates());
}

#[test]
fn affine() {
    let table: Laden<Guided<0>> = laden(Guided::turntable(sleigh(), 0.35).unwrap(), vec![]);
    converges("turntable", &table, moving().to_coordinates());
    let servo = Guided::<1>::servo(sleigh(), Guide::Speed(sine(0.8, 1.1, 0.5))).unwrap();
    converges("servo", &laden(servo, vec![]), moving().to_coordinates());
}

/// A servo whose turn rate jumps changes the energy at once, and that counts as work.
#[test]
fn the_impulse_of_a_jump_is_work() {
    let rates = Table::new(vec![0.0, 1.0, 3.0], vec![0.5, -0.8, 0.3]).unwrap();
    let servo = Guided::<1>::servo(sleigh(), Guide::TurnRate(TimeFunction::Table(rates))).unwrap();
    let system = laden(servo, vec![]);
    let seen = balance(&system, Composition::fifteen8(Dla::midpoint()), moving().to_coordinates(), 0.05);
    println!("jumps of the servo: balance {:.1e}, energy {:.1e}", seen.worst, seen.unpaid);
    // Without a potential the sleigh's speed is continuous, so the jumps alone do J/2 (0.8^2 - 0.5^2), J/2 (0.3^2 - 0.8^2).
    let jump = 0.5 * sleigh().pivot_inertia() * (0.8 * 0.8 - 0.5 * 0.5);
    assert!(seen.worst < 1e-10 && seen.unpaid > jump, "{seen:?}");

    // The control: an observer that is not shown the jumps misses just these.
    struct Blind(Balance);
    impl Observer for Blind {
        fn start(&mut self, node: &View<'_>) {
            self.0.start(node);
        }
        fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
            self.0.step(node, report)
        }
    }
    let mut blind = Blind(Balance::default());
    let mut method = Composition::fifteen8(Dla::midpoint());
    run(&system, &mut method, &steps(0.05, 80), moving().to_coordinates(), &mut blind);
    assert!(blind.0.worst > 0.5 * jump, "{:?}", blind.0);
}

/// What the energy methods report as the work of a step balances the energy to rounding, at any step.
fn balances_to_rounding(count: u64) {
    let nu = 0.1;
    let drag = Drag::new(nu * sleigh().mass(), nu * sleigh().pivot_inertia()).unwrap();
    let thrust = Thrust::new(sine(0.6, 1.3, 0.4)).unwrap();
    let bowl = Bowl::new([0.4, 0.15], [0.2, -0.3]).unwrap();
    let effects = vec![AnyEffect::Drag(drag), AnyEffect::Thrust(thrust), AnyEffect::Bowl(bowl)];
    let system: Laden<Sleigh> = laden(sleigh(), effects);
    let mut seen = Balance::default();
    run(&system, &mut Energy::new::<2>(), &steps(0.05, count), moving().to_coordinates(), &mut seen);
    println!("energy4 over {count} steps: balance {:.1e}, energy {:.1e}", seen.worst, seen.unpaid);
    // The energies and works are below 1 J; each step rounds a few of them, and the roundings walk at random.
    assert!(seen.worst < 8.0 * f64::EPSILON * (count as f64).sqrt(), "{seen:?}");
    assert!(seen.unpaid > 0.1 && seen.slip < 1e-14, "{seen:?}");

    // The control: the midpoint rule has an error of order 2.
    let mut dla = Balance::default();
    run(&system, &mut Dla::midpoint(), &steps(0.05, 200), moving().to_coordinates(), &mut dla);
    assert!(dla.worst > 1e-6, "{dla:?}");
}

#[test]
fn the_energy_methods_balance_to_rounding() {
    balances_to_rounding(150);
}

#[test]
#[ignore = "slow"]
fn the_energy_methods_balance_to_rounding_in_full() {
    balances_to_rounding(20_000);
}

/// Nothing acts: no work, and nothing is evaluated for it.
#[test]
fn the_free_sleigh_has_no_work() {
    let seen = balance(&laden(sleigh(), vec![]), Dla::midpoint(), moving().to_coordinates(), 0.1);
    assert!(seen.work.total() == 0.0 && seen.unpaid > 0.0, "{seen:?}");
}
