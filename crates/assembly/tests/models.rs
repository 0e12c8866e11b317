//! Snakeboard and roller racer as assemblies, against their forms in few coordinates; a car with trailers; springs.

use approx::assert_abs_diff_eq;
use assembly::parts::{Blade, Body, Hinge, RotorElement, SteeredBlade, Trailer, Train};
use assembly::{Assembly, AssemblyMethod, AssemblyState, Joint, Solver, SparseComposition, SparseDla};
use lagrangian::{Constraint, Piecewise, Scalar, System};
use sleigh::{Sleigh, SleighState};
use test_systems::{Model, RollerRacer, Snakeboard};

const STEP: f64 = 0.05;
const STEPS: u32 = 40;

/// The end of a run of order 8.
fn end(assembly: &Assembly, mut state: AssemblyState) -> AssemblyState {
    let mut method = SparseComposition::new(assembly, Solver::Best, 8).unwrap();
    for k in 0..STEPS {
        method.step(assembly, f64::from(k) * STEP, STEP, &mut state).unwrap();
    }
    state
}

/// The same of a static system.
fn static_end<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    (q, v): ([f64; N], [f64; N]),
) -> [f64; N] {
    let mut state = dla::State::new(q, v, system.angles());
    let mut method = dla::Composition::fifteen8(dla::Dla::midpoint());
    for k in 0..STEPS {
        dla::OneStep::step(&mut method, system, f64::from(k) * STEP, STEP, &mut state).unwrap();
    }
    state.unwrapped()
}

/// Two bodies, two axles, a hinge; the front body counts by its inertia alone. The chords of the two forms are not the same, so
/// that they agree to the order of the method: to what it leaves of an error, the eighth power of the step.
#[test]
fn roller_racer() {
    let (m, i1, i2, d1, d2) = (1.0, 0.5, 0.2, 0.7, 0.4);
    let small = RollerRacer { m, I1: i1, I2: i2, d1, d2 };
    let (q, v) = small.start();
    let expected = static_end(&small, (q, v));

    let mut racer = Assembly::new();
    let rear = racer.body("rear body", Body { mass: m, inertia: i1 });
    let front = racer.body("front body", Body { mass: 0.0, inertia: i2 });
    racer.attach("rear axle", Blade { ahead: 0.0 }, rear).unwrap();
    racer.attach("front axle", Blade { ahead: 0.0 }, front).unwrap();
    let at = [rear[0], rear[1], rear[2], front[0], front[1], front[2]];
    // The front body's reference point is on its axle, ahead of the hinge.
    racer.join("hinge", Hinge::new([d1, 0.0], [-d2, 0.0]), at).unwrap();
    let (heading, turn) = (q[2] + q[3], v[2] + v[3]);
    let place = [q[0] + d1 * q[2].cos() + d2 * heading.cos(), q[1] + d1 * q[2].sin() + d2 * heading.sin()];
    let velocity = [
        v[0] - d1 * v[2] * q[2].sin() - d2 * turn * heading.sin(),
        v[1] + d1 * v[2] * q[2].cos() + d2 * turn * heading.cos(),
    ];
    let start = AssemblyState::new(
        &racer,
        &[q[0], q[1], q[2], place[0], place[1], heading],
        &[v[0], v[1], v[2], velocity[0], velocity[1], turn],
    );
    let [slip, hinge] = racer.misses(0.0, &start);
    assert!(slip.max(hinge) < 1e-14);
    let end = end(&racer, start);
    let found = [0, 1, 2].map(|i| end.unwrapped()[i]);
    println!("{found:?} {expected:?}");
    for i in 0..3 {
        assert_abs_diff_eq!(found[i], expected[i], epsilon = 1e-8);
    }
    assert_abs_diff_eq!(end.unwrapped()[5] - end.unwrapped()[2], expected[3], epsilon = 1e-8);
}

/// The two axles of a snakeboard turn by opposite angles against the board.
struct Opposite;

impl Joint<3, 1> for Opposite {
    fn position<S: Scalar>(&self, _t: S, q: &[S; 3]) -> [S; 1] {
        [q[1] + q[2] - q[0] * 2.0]
    }
}

#[test]
fn snakeboard() {
    let (m, l, j, j_r, j_w) = (1.2, 0.5, 0.1, 0.05, 0.02);
    let small = Snakeboard { m, l, J: j, Jr: j_r, Jw: j_w };
    let (q, v) = small.start();
    let expected = static_end(&small, (q, v));

    let mut board = Assembly::new();
    let body = board.body("board", Body { mass: m, inertia: j });
    let [rotor] = board.body("rotor", RotorElement { inertia: j_r });
    let [back] = board.body("back axle", RotorElement { inertia: j_w });
    let [front] = board.body("front axle", RotorElement { inertia: j_w });
    for (name, ahead, angle) in [("back wheels", -l, back), ("front wheels", l, front)] {
        board.attach(name, SteeredBlade { ahead }, [body[0], body[1], body[2], angle]).unwrap();
    }
    board.join("steering", Opposite, [body[2], back, front]).unwrap();
    let start = AssemblyState::new(
        &board,
        &[q[0], q[1], q[2], q[2] + q[3], q[2] + q[4], q[2] - q[4]],
        &[v[0], v[1], v[2], v[2] + v[3], v[2] + v[4], v[2] - v[4]],
    );
    let [slip, steering] = board.misses(0.0, &start);
    assert!(slip.max(steering) < 1e-14, "{slip} {steering}");
    let end = end(&board, start);
    let heading = end.unwrapped()[2];
    let found = [
        end.unwrapped()[0],
        end.unwrapped()[1],
        heading,
        end.unwrapped()[rotor] - heading,
        end.unwrapped()[back] - heading,
    ];
    println!("{found:?} {expected:?}");
    for i in 0..5 {
        assert_abs_diff_eq!(found[i], expected[i], epsilon = 1e-8);
    }
}

/// The direction of a car's front wheels against the car, as the driver turns them (rad).
struct Steering;

impl Joint<2, 1> for Steering {
    fn position<S: Scalar>(&self, t: S, q: &[S; 2]) -> [S; 1] {
        [q[1] - q[0] - (t * 0.5).sin() * 0.3]
    }
}

/// A car is a body on a rear axle whose front wheels are steered; its trailers follow.
#[test]
fn car_with_trailers() {
    let trailers = vec![Trailer::new(0.5, 0.1, 0.1, 0.2, 0.8).unwrap(); 5];
    let mut train = Train::new(Sleigh::new(1.0, 0.5, 0.4).unwrap(), trailers, |trailer| trailer.sleigh).unwrap();
    let [wheels] = train.assembly.body("front wheels", RotorElement { inertia: 0.01 });
    train.assembly.attach("front axle", SteeredBlade { ahead: 1.0 }, [0, 1, 2, wheels]).unwrap();
    train.assembly.join("steering", Steering, [2, wheels]).unwrap();
    let start = train.start(&SleighState { speed: 1.0, ..SleighState::default() }, &[]);
    // The wheels begin to turn at the rate of their joint.
    let mut v = start.v().to_vec();
    v[wheels] = 0.15;
    let q = start.q().to_vec();
    let mut state = AssemblyState::new(&train.assembly, &q, &v);
    let mut method = SparseDla::new(&train.assembly, Solver::Best).unwrap();
    let (mut most, mut turned) = ([0.0f64; 2], 0.0f64);
    for k in 0..300 {
        let t = f64::from(k) * 0.02;
        method.step(&train.assembly, t, 0.02, &mut state).unwrap();
        let misses = train.assembly.misses(t + 0.02, &state);
        most = [most[0].max(misses[0]), most[1].max(misses[1])];
        turned = turned.max(
            (train.blade(&state.unwrapped(), state.v(), 0).heading
                - train.blade(&state.unwrapped(), state.v(), 5).heading)
                .abs(),
        );
    }
    println!("{most:?} {turned}");
    assert!(most[0] < 1e-13 && most[1] < 1e-14);
    assert!(turned > 0.3);
}

/// A spring between two bodies, whose system is a potential on the coordinates of both.
struct Spring {
    stiffness: f64,
    damping: f64,
}

impl System<6, 0> for Spring {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 6], _v: &[S; 6]) -> S {
        ((q[3] - q[0]).squared() + (q[4] - q[1]).squared()) * (-0.5 * self.stiffness)
    }

    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 6]) -> Constraint<S, 6, 0> {
        ([], [])
    }

    fn force<S: Scalar>(&self, _t: S, _q: &[S; 6], v: &[S; 6]) -> Option<[S; 6]> {
        let [x, y] = [v[3] - v[0], v[4] - v[1]].map(|rate| rate * self.damping);
        Some([x, y, S::zero(), -x, -y, S::zero()])
    }
}

impl Piecewise for Spring {
    fn piece(&self, _t: f64) -> Self {
        Self { ..*self }
    }
}

#[test]
fn spring_and_damper() {
    swing(20, 1.0);
}

#[test]
#[ignore = "slow"]
fn spring_and_damper_in_full() {
    swing(100, 0.1);
}

/// Two equal masses on a spring swing about their centre at `sqrt(2 k/m)`, and the damper takes what they lose.
fn swing(steps: u32, c: f64) {
    let t = 0.02 * f64::from(steps);
    let run = |damping: f64| {
        let mut pair = Assembly::new();
        let [a, b] = [0, 1].map(|_| pair.body::<_, 3, 0>("body", Body { mass: 1.0, inertia: 1.0 }));
        pair.attach("spring", Spring { stiffness: 2.0, damping }, [a[0], a[1], a[2], b[0], b[1], b[2]]).unwrap();
        let mut state = AssemblyState::new(&pair, &[-0.5, 0.0, 0.0, 0.5, 0.0, 0.0], &[0.0; 6]);
        let initial = pair.energy(0.0, &state);
        let mut method = SparseComposition::new(&pair, Solver::Best, 8).unwrap();
        for k in 0..steps {
            method.step(&pair, 0.02 * f64::from(k), 0.02, &mut state).unwrap();
        }
        (state.q()[3], pair.energy(t, &state) / initial)
    };
    // x'' = -(2k/m) x - (2c/m) x' for half the distance.
    let (free, kept) = run(0.0);
    assert_abs_diff_eq!(free, 0.5 * (2.0 * t).cos(), epsilon = 1e-12);
    assert_abs_diff_eq!(kept, 1.0, epsilon = 1e-12);
    let (damped, lost) = run(c);
    let w = (4.0 - c * c).sqrt();
    let expected = 0.5 * (-c * t).exp() * ((w * t).cos() + c / w * (w * t).sin());
    assert_abs_diff_eq!(damped, expected, epsilon = 1e-12);
    assert!(lost < 0.9);
}
