use crate::energy::systems::{Particle, Potential, at_centre, com, distance, run};
use crate::support::{ByHand, Three, Two};
use dla::{Energy, OneStep, State};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};
use sleigh::{Exact, Sleigh, SleighState};

/// Errors at the given numbers of steps, and the least order between neighbours.
fn ladder<Sys: System<N, M>, Method: OneStep<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    method: &mut Method,
    start: &([f64; N], [f64; N]),
    duration: f64,
    steps: &[u64],
    exact: &State<N>,
) -> (Vec<f64>, Vec<f64>) {
    let errors: Vec<f64> = steps.iter().map(|n| distance(&run(system, method, start, (duration, *n)), exact)).collect();
    let orders = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    (errors, orders)
}

fn check(name: &str, (errors, orders): (Vec<f64>, Vec<f64>), order: f64) {
    let shown: String = errors.iter().map(|e| format!(" {e:.1e}")).collect();
    println!("{name}: orders {orders:.3?}, errors{shown}");
    assert!(errors.iter().all(|e| *e > 1e-12), "{name}: the ladder reaches the plateau of rounding");
    let last = orders.last().unwrap();
    assert!((last - order).abs() < 0.04 * order, "{name}: order {last}, expected {order}");
}

/// The method with one node.
fn second_order<Sys: System<N, M>, const N: usize, const M: usize>(
    name: &str,
    system: &Sys,
    start: &([f64; N], [f64; N]),
    duration: f64,
    first: u64,
    exact: &State<N>,
) {
    let steps = [first, 2 * first, 4 * first];
    check(name, ladder(system, &mut Energy::new::<1>(), start, duration, &steps, exact), 2.0);
}

/// Through the reversal, against the closed form, with no parameter equal to one.
#[test]
fn free_sleigh() {
    let sleigh = Sleigh::new(1.3, 0.8, 0.4).unwrap();
    let start = SleighState { x: 0.3, y: -0.2, heading: 0.5, speed: -0.9, turn_rate: 0.8 };
    let (q, v) = Exact::new(&sleigh, &start).unwrap().at(4.0).to_coordinates();
    let exact = State::new(q, v, sleigh.angles());
    second_order("free sleigh", &ByHand::from(sleigh), &start.to_coordinates(), 4.0, 64, &exact);
}

/// The first eighth of the other.
#[test]
fn egg_crate() {
    let system = com(0.5, Potential::EggCrate);
    let start = at_centre([0.5, 1.0, 0.3, 0.4, 0.7], 0.5);
    let exact = run(&system, &mut Energy::new::<4>(), &start, (1.25, 25));
    second_order("egg-crate", &system, &start, 1.25, 16, &exact);
}

/// Against a run in 30 digits.
#[test]
#[ignore = "slow"]
fn egg_crate_in_full() {
    let end = [6.116263299104192, 12.39178403258227, 1.011883547635337, 0.4666370265451718, 0.0372610222581567];
    let system = com(0.5, Potential::EggCrate);
    let (q, v) = at_centre(end, 0.5);
    let exact = State::new(q, v, [false; 3]);
    second_order("egg-crate", &system, &at_centre([0.5, 1.0, 0.3, 0.4, 0.7], 0.5), 10.0, 128, &exact);
}

/// Masses that depend on the place, a magnetic field, an energy that is not quadratic: against itself at small steps.
fn particle_over(duration: f64, first: u64, steps: u64) {
    let system = Three::from(Particle { mass: 1.3, quartic: 0.2 });
    let start = ([0.3, 0.5, -0.2], [0.6, -0.4, 0.3]);
    let exact = run(&system, &mut Energy::new::<4>(), &start, (duration, steps));
    second_order("particle", &system, &start, duration, first, &exact);
}

#[test]
fn particle() {
    particle_over(0.75, 16, 25);
}

#[test]
#[ignore = "slow"]
fn particle_in_full() {
    particle_over(3.0, 64, 300);
}

/// A mass on a spring along a rail, pushed by `cos(2 t)`.
#[derive(Clone, Copy)]
pub(crate) struct Swung;

impl System<2, 1> for Swung {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 2], v: &[S; 2]) -> S {
        (v[0] * v[0] + v[1] * v[1] - q[0] * q[0]) * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Constraint<S, 2, 1> {
        ([[S::zero(), S::constant(1.0)]], [S::zero()])
    }
    fn force<S: Scalar>(&self, t: S, _q: &[S; 2], _v: &[S; 2]) -> Option<[S; 2]> {
        Some([(t * 2.0).cos(), S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Option<AdmissibleBasis<S, 2, 1>> {
        Some(AdmissibleBasis::new([[S::constant(1.0), S::zero()]]))
    }
}

/// Forces are taken at the times of the nodes: `x'' + x = cos(2 t)` from rest is `x = (cos t - cos 2 t)/3`.
#[test]
fn a_force_that_swings() {
    let place = |t: f64| ([(t.cos() - (2.0 * t).cos()) / 3.0, 0.0], [(2.0 * (2.0 * t).sin() - t.sin()) / 3.0, 0.0]);
    let (q, v) = place(2.0);
    let exact = State::new(q, v, [false; 2]);
    let (swung, start) = (Two::from(Swung), ([0.0; 2], [0.0; 2]));
    check("swung", ladder(&swung, &mut Energy::new::<2>(), &start, 2.0, &[10, 20, 40], &exact), 4.0);
    second_order("swung", &swung, &start, 2.0, 20, &exact);
}
