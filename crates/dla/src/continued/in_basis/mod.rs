//! The predicted step in the basis of admissible velocities, `v = W xi`: there are no multipliers to eliminate, and the Jacobian hardly
//! changes if the basis turns with a body.

mod arrival;
mod mean;

use super::{FoundMean, advanced};
use crate::branch;
use crate::convergence::tolerances::STALL;
use crate::derivatives::COORDINATES;
use crate::dla::Dla;
use crate::settle::LEAST;
use crate::{Discretisation, Mechanics, State, StepReport};
use arrival::arrival;
use lagrangian::{AdmissibleBasis, from_fn, mapped};
use mean::mean;

/// A velocity with its quasi-velocities, and the impulse of the constraints.
struct InBasis<const N: usize, const M: usize> {
    found: FoundMean<N, M>,
    xi: [f64; N],
}

/// The first `N` entries of a row.
#[inline(always)]
fn first<const N: usize>(row: [f64; COORDINATES]) -> [f64; N] {
    from_fn(|i| row[i])
}

// Compiled twice in a build for any x86-64, as the loop over steps is (`drive_part`).
#[cfg_attr(not(target_feature = "avx2"), multiversion::multiversion(targets("x86_64+avx2+bmi1+bmi2+lzcnt")))]
#[inline(never)]
pub(super) fn going_on<D: Discretisation<N, M>, const N: usize, const M: usize>(
    method: &mut Dla<D>,
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    state: &mut State<N>,
) -> Option<StepReport<M>> {
    let q0 = *state.q();
    let (InBasis { found: FoundMean { v, lambda, corrections }, xi }, p1) = mean(method, system, (t0, h), state)?;
    if branch::turn_of(system, (t0, h), &q0, &v) > branch::NEAR {
        return None;
    }

    let d = mapped(&v, |v| h * v);
    let (t1, q1) = (t0 + h, state.ahead(&d));
    let end = arrival(method, system, (t1, h, &q1), p1)?;
    let v1 = end.found.v;

    advanced(system, (t0, h), state, &d, (&v, &v1), &q1)?;
    method.kept.block.took_in_basis::<N>(corrections.max(LEAST));
    method.kept.mass.took_in_basis::<N>(end.found.corrections.max(LEAST));
    // `v1` and not the velocity of the state: that has just been stored, and the load would stall on store forwarding.
    method.kept.ended_in_basis(h, (state.q(), &v1), &v, [&xi, &end.xi]);
    Some(StepReport { impulses: [lambda, end.found.lambda], iterations: corrections, work: None })
}

/// Whether every correction `d` of the quasi-velocities is within the tolerance, or stalls at round-off.
#[inline(always)]
fn has_settled<const N: usize>(d: &[f64; N], xi: &[f64; N], last: &[f64; N], tolerance: f64) -> bool {
    (0..N).fold(true, |all, a| {
        let size = d[a].abs();
        all & ((size <= tolerance * xi[a].abs()) | (size >= STALL * last[a].abs()))
    })
}

/// Whether `W' r = 0` to the round-off of momenta `p` that are among the terms of `r`.
#[inline(always)]
fn are_met<const N: usize, const M: usize>(
    basis: &AdmissibleBasis<f64, N, M>,
    r: &[f64; N],
    p: &[f64; N],
    tolerance: f64,
) -> bool {
    let missed = basis.products(r);
    let mut all = true;
    for (missed, w) in missed.iter().zip(basis.vectors()) {
        let size = (0..N).fold(0.0, |sum, i| sum + (w[i] * p[i]).abs());
        all &= missed.abs() <= tolerance * size;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Form, OneStep};
    use approx::assert_abs_diff_eq;
    use lagrangian::With;
    use sleigh::effects::{Bowl, Drag};
    use sleigh::{Sleigh, SleighState};
    use test_systems::{Model, Particle};

    const STEP: f64 = 0.05;

    fn method() -> Dla {
        Dla::midpoint()
    }

    fn system() -> With<Sleigh, (Bowl, Drag)> {
        let effects = (Bowl::new([0.7, 0.4], [0.2, -0.1]).unwrap(), Drag::new(0.01, 0.02).unwrap());
        With { body: Sleigh::new(1.3, 0.8, 0.4).unwrap(), effects }
    }

    fn start() -> State<3> {
        let start = SleighState { x: 0.3, y: -0.2, heading: 0.4, speed: -1.0, turn_rate: 0.7 };
        let (q, v) = start.to_coordinates();
        State::new(q, v, [false, false, true])
    }

    /// Steps change to the basis if the mass matrix turns with a body, but not if it is constant or if multipliers are asked for.
    #[test]
    fn a_run_goes_on_in_the_basis_where_derivatives_last_longer_in_it() {
        let (mut turning, mut asked) = (method(), Dla::midpoint().solved(Form::Multipliers));
        for method in [&mut turning, &mut asked] {
            let mut state = start();
            for _ in 0..200 {
                method.step(&system(), 0.0, STEP, &mut state).unwrap();
            }
        }
        assert!(turning.kept.is_in_basis() && !asked.kept.is_in_basis());
        let particle = Particle { m: 1.0, k: 0.0 };
        let ((q, v), mut constant) = (particle.start(), method());
        let mut state = State::new(q, v, particle.angles());
        for _ in 0..200 {
            constant.step(&particle, 0.0, STEP, &mut state).unwrap();
        }
        assert!(!constant.kept.is_in_basis() && constant.kept.is_ready());
    }

    /// Every step is the one made without memory, to the round-off of its momenta, with its impulses.
    #[test]
    fn the_step_is_the_same() {
        let (mut used, mut state, mut count) = (method(), start(), 0);
        for _ in 0..1000 {
            let mut other = state;
            let in_basis = used.kept.is_in_basis();
            let report = used.step(&system(), 0.0, STEP, &mut state).unwrap();
            let expected = method().step(&system(), 0.0, STEP, &mut other).unwrap();
            count += u32::from(in_basis);
            // Velocities below 3 m/s, masses and inertias below 1.3: some tens of operations, each in error by half a unit.
            let bound = 3.0 * 1.3 * 16.0 * f64::EPSILON;
            for i in 0..3 {
                assert_abs_diff_eq!(state.moved_since(&other)[i], 0.0, epsilon = bound * STEP);
                assert_abs_diff_eq!(state.v()[i], other.v()[i], epsilon = bound);
            }
            for end in 0..2 {
                assert_abs_diff_eq!(report.impulses[end][0], expected.impulses[end][0], epsilon = bound);
            }
        }
        assert!(count > 900, "{count} steps in the basis");
    }

    /// By the trapezoidal rule no step is in the basis: a memory that says so is forgotten.
    #[test]
    fn a_rule_of_two_nodes_forgets_a_basis() {
        let (mut used, mut state) = (method(), start());
        for _ in 0..200 {
            used.step(&system(), 0.0, STEP, &mut state).unwrap();
        }
        assert!(used.kept.is_in_basis());
        let (mut recalled, mut fresh) = (Dla::trapezoid(), Dla::trapezoid());
        recalled.kept = used.kept;
        let mut expected = state;
        recalled.step(&system(), 0.0, STEP, &mut state).unwrap();
        fresh.step(&system(), 0.0, STEP, &mut expected).unwrap();
        assert_eq!(state, expected);
    }

    /// The memory is part of a checkpoint, to the last bit; if it is damaged, the step is made without it.
    #[test]
    fn a_run_is_resumed_in_the_basis() {
        let (mut method, mut state) = (method(), start());
        for _ in 0..200 {
            method.step(&system(), 0.0, STEP, &mut state).unwrap();
        }
        let memory = OneStep::<3, 1>::memory(&method);
        let (mut again, mut resumed) = (self::method(), state);
        OneStep::<3, 1>::recall(&mut again, &memory, &resumed);
        assert!(again.kept.is_in_basis());
        for at in 0..memory.len() {
            let (mut wild, mut other) = (memory.clone(), state);
            wild[at] = f64::NAN;
            let mut method = self::method();
            OneStep::<3, 1>::recall(&mut method, &wild, &other);
            method.step(&system(), 0.0, STEP, &mut other).unwrap();
            assert!(other.v().iter().all(|v| v.is_finite()));
        }
        for _ in 0..100 {
            method.step(&system(), 0.0, STEP, &mut state).unwrap();
            again.step(&system(), 0.0, STEP, &mut resumed).unwrap();
            assert_eq!(state, resumed);
        }
    }
}
