//! A homogeneous ball that rolls inside an upright cylinder: a system of one's own with the shared attitude.
//!
//! With `r` the radius of the ball, `R` that of its centre's path, `k = I/(m r^2)`, the ball runs round at a constant rate `Omega`, and
//! its height is an oscillator, `z'' = -(k Omega^2 z + g + k r Omega w)/(1 + k)` with `w` the spin across the wall at `z = 0`: it does
//! not fall out. (Neimark and Fufaev 1972, Dynamics of Nonholonomic Systems, section III.2.)

use crate::attitudes::tools::{Place, assert_halving, assert_order, largest};
use crate::support::Six;
use dla::{Composition, Dla, Lobatto, OneStep, View};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};
use test_systems::Attitude;

const PATH: f64 = 0.3;
const RADIUS: f64 = 0.05;
const RATIO: f64 = 0.4;
const GRAVITY: f64 = 9.81;

/// `q = (theta, z, e_0, e_1, e_2, e_3)`, of mass one.
#[derive(Clone, Copy)]
pub(crate) struct Ball;

fn attitude<S: Scalar>(q: &[S; 6]) -> Attitude<S> {
    Attitude::new([q[2], q[3], q[4], q[5]])
}

impl System<6, 3> for Ball {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 6], v: &[S; 6]) -> S {
        let rates = [v[2], v[3], v[4], v[5]];
        let turning =
            Attitude::turning_energy(&rates, &attitude(q).body_velocity(&rates), [RATIO * RADIUS * RADIUS; 3]);
        (v[0] * v[0] * (PATH * PATH) + v[1] * v[1]) * 0.5 + turning - q[1] * GRAVITY
    }
    /// The contact rests: `R theta' + r omega_z = 0` round the wall, `z' + r (omega x e_r) . e_z = 0` up it.
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 6]) -> Constraint<S, 6, 3> {
        let ((sin, cos), zero, one) = (q[0].sin_cos(), S::zero(), S::constant(1.0));
        let [x, y, z] = attitude(q).space_velocity_matrix();
        let e = attitude(q).norm_row();
        let round = z.map(|part| part * RADIUS);
        let up: [S; 4] = lagrangian::from_fn(|i| (x[i] * sin - y[i] * cos) * RADIUS);
        (
            [
                [S::constant(PATH), zero, round[0], round[1], round[2], round[3]],
                [zero, one, up[0], up[1], up[2], up[3]],
                [zero, zero, e[0], e[1], e[2], e[3]],
            ],
            [zero; 3],
        )
    }
    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 6]) -> Option<[Option<S>; 3]> {
        Some([None, None, Some(attitude(q).norm_miss())])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 6]) -> Option<AdmissibleBasis<S, 6, 3>> {
        let ((sin, cos), zero) = (q[0].sin_cos(), S::zero());
        let turns = attitude(q).space_turns();
        let along = [[zero, -sin * RADIUS], [zero, cos * RADIUS], [S::constant(-RADIUS / PATH), zero]];
        Some(AdmissibleBasis::new(lagrangian::from_fn::<_, 3, _>(|k| {
            let ([theta, z], [a, b, c, d]) = (along[k], turns[k]);
            [theta, z, a, b, c, d]
        })))
    }
    fn angles(&self) -> [bool; 6] {
        [true, false, false, false, false, false]
    }
}

/// Round at 6 rad/s, at `z = 0` and `z' = 0`, spinning across the wall at 10 rad/s, from an attitude.
fn start(from: &Attitude<f64>) -> Place<6> {
    let [s, x, y, z] = from.quaternion();
    let [s1, x1, y1, z1] = from.rates_of_space(&[SPIN, 0.0, -PATH * RATE / RADIUS]);
    ([0.0, 0.0, s, x, y, z], [RATE, 0.0, s1, x1, y1, z1])
}

const RATE: f64 = 6.0;
const SPIN: f64 = 10.0;

/// The largest error of the height over `steps` steps, of the length of the quaternion, and of the contact.
fn errors<Method: OneStep<6, 3>>(mut method: Method, from: &Attitude<f64>, (a_round, steps): (u64, u64)) -> [f64; 3] {
    let step = std::f64::consts::TAU / RATE / a_round as f64;
    let frequency = RATE * (RATIO / (1.0 + RATIO)).sqrt();
    let middle = -(GRAVITY + RATIO * RADIUS * RATE * SPIN) / (1.0 + RATIO) / frequency.powi(2);
    let (found, end) = largest(&Six::from(Ball), &mut method, start(from), (step, steps), |node: &View<'_>| {
        let height = middle * (1.0 - (frequency * node.t).cos());
        let (q, miss) = (node.state.q(), attitude(node.state.typed().unwrap().q()).norm_miss());
        [(q[1] - height).abs(), miss.abs(), node.constraint()]
    });
    end.unwrap();
    found
}

/// The errors of the height, with the length and the contact held.
fn heights<const K: usize>(name: &str, counts: [u64; K], run: &dyn Fn(u64) -> [f64; 3]) -> [f64; K] {
    counts.map(|a_round| {
        let [height, length, contact] = run(a_round);
        // Of the contact some tens of roundings of speeds up to 2.5 m/s.
        assert!(length <= 4.0 * f64::EPSILON && contact <= 100.0 * f64::EPSILON, "{name}: {length:e}, {contact:e}");
        height
    })
}

/// Half a round.
#[test]
fn it_does_not_fall_out() {
    let from = Attitude::nearest([0.5, 0.5, -0.5, 0.5]);
    let order = |name: &str, order: f64, run: &dyn Fn(u64) -> [f64; 3]| {
        assert_halving(name, heights(name, [100, 200], run), order);
    };
    order("lobatto3", 4.0, &|n| errors(Lobatto::<3>::new(), &from, (n, n / 2)));
    order("dla4", 4.0, &|n| errors(Composition::suzuki4(Dla::midpoint()), &from, (n, n / 2)));
}

/// Five rounds.
#[test]
#[ignore = "slow"]
fn it_does_not_fall_out_at_length() {
    for from in [Attitude::LEVEL, Attitude::nearest([0.5, 0.5, -0.5, 0.5])] {
        let order = |name: &str, order: f64, run: &dyn Fn(u64) -> [f64; 3]| {
            assert_order(name, heights(name, [100, 200, 400, 800], run), order);
        };
        order("lobatto3", 4.0, &|n| errors(Lobatto::<3>::new(), &from, (n, 5 * n)));
        order("dla4", 4.0, &|n| errors(Composition::suzuki4(Dla::midpoint()), &from, (n, 5 * n)));
    }
}
