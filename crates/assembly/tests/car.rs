//! A car with one to eight trailers, against its kinematics with one equation of motion, integrated by themselves.

use approx::assert_abs_diff_eq;
use assembly::parts::{RotorElement, SteeredBlade, Trailer, Train};
use assembly::{Assembly, AssemblyMethod, AssemblyState, AssemblySubject, Joint, Solver, SparseComposition};
use dla::Mechanism;
use lagrangian::{PowerSources, Scalar};
use sleigh::{Sleigh, SleighState};

const WHEELBASE: f64 = 1.0;
const WHEELS: f64 = 0.01;
const DURATION: f64 = 6.0;
/// The driver turns the front wheels by `AMPLITUDE sin(FREQUENCY t)` against the car (rad).
const AMPLITUDE: f64 = 0.3;
const FREQUENCY: f64 = 0.5;

struct Steering;

impl Joint<2, 1> for Steering {
    fn position<S: Scalar>(&self, t: S, q: &[S; 2]) -> [S; 1] {
        [q[1] - q[0] - (t * FREQUENCY).sin() * AMPLITUDE]
    }
}

fn car() -> Sleigh {
    Sleigh::new(1.0, 0.5, 0.4).unwrap()
}

/// Unlike trailers, heavy enough to push the car.
fn trailers(count: usize) -> Vec<Trailer> {
    (0..count).map(|k| Trailer::new(0.5, 0.1, 0.1, 0.2, 0.8 + 0.05 * k as f64).unwrap()).collect()
}

/// The car and its trailers, the wheels straight and beginning to turn.
fn steered(count: usize) -> (Train, AssemblyState) {
    let mut train = Train::new(car(), trailers(count), |trailer| trailer.sleigh).unwrap();
    let [wheels] = train.assembly.body("front wheels", RotorElement { inertia: WHEELS });
    train.assembly.attach("front axle", SteeredBlade { ahead: WHEELBASE }, [0, 1, 2, wheels]).unwrap();
    train.assembly.join("steering", Steering, [2, wheels]).unwrap();
    let start = train.start(&SleighState { speed: 1.0, ..SleighState::default() }, &[0.2]);
    // The wheels begin to turn at the rate of their joint.
    let (q, mut v) = (start.q().to_vec(), start.v().to_vec());
    v[wheels] = AMPLITUDE * FREQUENCY;
    let start = AssemblyState::new(&train.assembly, &q, &v);
    (train, start)
}

/// The end of a run by the assembly, headings after the place of the car; and what its constraints miss most.
fn assembled(count: usize, steps: u32) -> (Vec<f64>, [f64; 2]) {
    let (train, mut state) = steered(count);
    let assembly: &Assembly = &train.assembly;
    let mut method = SparseComposition::new(assembly, Solver::Best, 8).unwrap();
    let (h, mut most) = (DURATION / f64::from(steps), [0.0f64; 2]);
    for k in 0..steps {
        method.step(assembly, f64::from(k) * h, h, &mut state).unwrap();
        let misses = assembly.misses(f64::from(k + 1) * h, &state);
        most = [most[0].max(misses[0]), most[1].max(misses[1])];
    }
    let headings = (0..=count).map(|k| state.unwrapped()[3 * k + 2]);
    ([state.q()[0], state.q()[1]].into_iter().chain(headings).collect(), most)
}

/// The rates of place, headings and energy.
///
/// At the speed `u` every blade has the speed `u w_k` and the turn rate `u r_k`: `r_0 = tan(phi)/L`, and behind the hinge each
/// next by its own direction. With `A = sum_k (m_k w_k^2 + J_k r_k^2) + I r_0^2` the energy of the motion at fixed steering is
/// `E = A u^2/2`, and what the driver turns does `E' = -I r_0 u phi''`.
fn rates(t: f64, y: &[f64], trailers: &[Trailer]) -> Vec<f64> {
    let phase = FREQUENCY * t;
    let (phi, twice) = (AMPLITUDE * phase.sin(), -AMPLITUDE * FREQUENCY.powi(2) * phase.sin());
    let turn = phi.tan() / WHEELBASE;
    let mut of_speed = vec![(1.0, turn)];
    for (k, Trailer { hitch, bar, .. }) in trailers.iter().enumerate() {
        let (w, r) = of_speed[k];
        // The hinge in the frame of the blade before it moves by (w, -b r).
        let (sin, cos) = (y[3 + k] - y[2 + k]).sin_cos();
        of_speed.push((w * cos - hitch * r * sin, (-w * sin - hitch * r * cos) / bar));
    }
    let sleighs = std::iter::once(car()).chain(trailers.iter().map(|trailer| trailer.sleigh));
    let inertia: f64 =
        sleighs.zip(&of_speed).map(|(s, (w, r))| s.mass() * w * w + s.pivot_inertia() * r * r).sum::<f64>()
            + WHEELS * turn * turn;
    let energy = y[y.len() - 1];
    let u = (2.0 * energy / inertia).sqrt();
    let place = [u * y[2].cos(), u * y[2].sin()];
    place.into_iter().chain(of_speed.iter().map(|(_, r)| u * r)).chain([-WHEELS * turn * u * twice]).collect()
}

/// The end by the classical Runge-Kutta method.
fn integrated(count: usize, steps: u32) -> Vec<f64> {
    let trailers = trailers(count);
    let mut y = vec![0.0; count + 4];
    (3..3 + count).for_each(|k| y[k] = 0.2);
    // The first trailer begins beside the car, the rest straight behind it; at phi = 0 the car goes straight at 1 m/s.
    let (sin, cos) = 0.2f64.sin_cos();
    let mut behind = (cos, -sin / trailers[0].bar);
    let mut twice = car().mass();
    for (k, Trailer { sleigh, hitch, .. }) in trailers.iter().enumerate() {
        let (w, r) = behind;
        twice += sleigh.mass() * w * w + sleigh.pivot_inertia() * r * r;
        if let Some(next) = trailers.get(k + 1) {
            behind = (w, -hitch * r / next.bar);
        }
    }
    y[count + 3] = 0.5 * twice;
    let h = DURATION / f64::from(steps);
    let moved = |y: &[f64], k: &[f64], by: f64| y.iter().zip(k).map(|(y, k)| y + by * k).collect::<Vec<_>>();
    for step in 0..steps {
        let t = f64::from(step) * h;
        let a = rates(t, &y, &trailers);
        let b = rates(t + 0.5 * h, &moved(&y, &a, 0.5 * h), &trailers);
        let c = rates(t + 0.5 * h, &moved(&y, &b, 0.5 * h), &trailers);
        let d = rates(t + h, &moved(&y, &c, h), &trailers);
        for i in 0..y.len() {
            y[i] += h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
        }
    }
    y.truncate(count + 3);
    y
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

#[test]
fn one_to_eight_trailers_follow_their_kinematics() {
    follow(2..=2, [30, 22]);
}

#[test]
#[ignore = "slow"]
fn one_to_eight_trailers_follow_their_kinematics_at_length() {
    follow(1..=8, [120, 90]);
}

fn follow(counts: std::ops::RangeInclusive<usize>, steps: [u32; 2]) {
    for count in counts {
        let [(fine, most), (coarse, _)] = steps.map(|steps| assembled(count, steps));
        let (expected, rough) = (integrated(count, 2400), integrated(count, 1200));
        // What halving the step takes off, and eight orders of a step shorter by a quarter, are more than is left.
        let allowed = apart(&expected, &rough) + apart(&fine, &coarse);
        println!("{count}: {:e} apart, {allowed:e} allowed, {most:?}", apart(&fine, &expected));
        assert!(allowed < 1e-7);
        for (found, expected) in fine.iter().zip(&expected) {
            assert_abs_diff_eq!(found, expected, epsilon = allowed);
        }
        assert!(most[0] < 1e-14 && most[1] < 1e-14, "{most:?}");
        // They have left the straight line that they began in.
        assert!((fine[2] - fine[fine.len() - 1]).abs() > 0.1);
    }
}

/// What the driver does is work of the joint: by so much the energy changes. It is integrated with the sixth order.
#[test]
fn the_driver_does_the_work() {
    let of = |steps: u32| {
        let (train, mut state) = steered(2);
        let (assembly, h) = (&train.assembly, DURATION / f64::from(steps));
        let mut method = SparseComposition::new(assembly, Solver::Best, 8).unwrap();
        let (subject, mut work) = (AssemblySubject::from(assembly), 0.0);
        let initial = assembly.energy(0.0, &state);
        let (mut error, mut most) = (0.0f64, 0.0f64);
        for k in 0..steps {
            let (t0, t1, before) = (f64::from(k) * h, f64::from(k + 1) * h, state.clone());
            method.step(assembly, t0, h, &mut state).unwrap();
            let [q0, q1] = [&before, &state].map(AssemblyState::unwrapped);
            work += subject.work_between(PowerSources::ALL, (t0, &q0, before.v()), (t1, &q1, state.v()));
            let gained = assembly.energy(t1, &state) - initial;
            (error, most) = (error.max((gained - work).abs()), most.max(gained.abs()));
        }
        println!("{steps}: {error:e} J of {most:e} J");
        (error, most)
    };
    let ((coarse, _), (fine, most)) = (of(15), of(30));
    assert!(most > 1e-4 && fine < 1e-6 * most);
    assert!((coarse / fine).log2() > 5.5, "{coarse:e} {fine:e}");
}
