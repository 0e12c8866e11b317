//! A system of as many coordinates and constraints as one of fixed size may have.

use crate::HardCaseError;
use crate::lab::Lab;
use crate::systems::record_seen;
use dla::{Schedule, State};
use harness::stability::check::{constraint, energy, measured};
use harness::stability::{Case, Claim, VALUES};
use lagrangian::{Constraint, Scalar, System};

const BODIES: usize = 20;
const N: usize = 3 * BODIES;
/// As much stack as a thread has that is not the first (bytes).
const STACK: usize = 2 << 20;
/// m/s^2.
const GRAVITY: f64 = 9.81;

/// Points of unit mass on a chain of light rods of unit length, hung at the origin.
#[derive(Debug, Clone, Copy)]
struct Chain;

/// From the joint before it, or from where the chain hangs.
fn rod<S: Scalar>(q: &[S; N], i: usize) -> [S; 3] {
    [0, 1, 2].map(|k| if i == 0 { q[k] } else { q[3 * i + k] - q[3 * (i - 1) + k] })
}

impl System<N, BODIES> for Chain {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; N], v: &[S; N]) -> S {
        (0..BODIES).fold(S::zero(), |sum, i| {
            let [x, y, z] = [0, 1, 2].map(|k| v[3 * i + k]);
            sum + (x * x + y * y + z * z) * 0.5 - q[3 * i + 2] * GRAVITY
        })
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; N]) -> Constraint<S, N, BODIES> {
        let mut rows = [[S::zero(); N]; BODIES];
        for (i, row) in rows.iter_mut().enumerate() {
            let rod = rod(q, i);
            for k in 0..3 {
                row[3 * i + k] = rod[k];
                if i > 0 {
                    row[3 * (i - 1) + k] = -rod[k];
                }
            }
        }
        (rows, [S::zero(); BODIES])
    }
}

pub(crate) const MANY_BODIES: Case = Case {
    name: "many-bodies",
    hard: "A chain of 20 points on rods: 60 coordinates and 20 constraints, in a thread of 2 MB. All that a step holds \
           stands on its stack.",
    shows: "The constraint and the energy hold, or an error names the size before the first step; the program never \
            aborts.",
    bar: "Rounding of the velocities; the energy by the method's order over the run, relative to its size.",
    claim: Claim::Order,
    refusable: true,
};

pub(crate) fn many_bodies(lab: &mut Lab) -> Result<(), HardCaseError> {
    let schedule = Schedule { t0: 0.0, step: 0.01, steps: 50 };
    let look = |state: &State<N>| -> [f64; VALUES] {
        let ([q, v], end) = ([state.q(), state.v()], N - 3);
        [q[end], q[end + 1], q[end + 2], v[end], v[end + 1], v[end + 2]]
    };
    // Level at first, along the first axis.
    let mut q = [0.0; N];
    (0..BODIES).for_each(|i| q[3 * i] = (i + 1) as f64);
    let made = std::thread::scope(|scope| {
        let make = || record_seen(lab, &Chain, (q, [0.0; N]), &schedule, (&look, &|_| 1.0));
        let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, make).ok()?;
        thread.join().ok()
    });
    let fault = || HardCaseError::Impossible("the thread of the chain has ended without a result");
    let run = made.ok_or_else(fault)?;
    // The last points fall freely, and the rods turn at the rate of a free fall of their length.
    let (time, rate) = (schedule.step * schedule.steps as f64, GRAVITY.sqrt());
    let all = BODIES as f64 * GRAVITY * GRAVITY * time * time;
    let bar = lab.accuracy(schedule.step * rate, rate * time, schedule.steps) * all;
    let fallen = run.end().map_or(f64::NAN, |node| -node.values[2]);
    let still = measured("runs that do not fall", f64::from(u8::from(fallen < 0.25 * GRAVITY * time * time)), 0.0);
    lab.judge("", &run, [constraint(&run, GRAVITY * time * BODIES as f64), energy(&run, bar), still]);
    Ok(())
}
