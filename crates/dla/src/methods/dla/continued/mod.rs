//! The predicted step: modified Newton, started at a predictor, with a frozen Jacobian of the momenta and fresh rows of the constraint.

mod arrival;
mod mean;

use crate::branch;
use crate::derivatives::StepDerivatives;
use crate::dla::Dla;
use crate::increment::Departure;
use crate::newton::BlockEquations;
use crate::overshoot::brakes_only;
use crate::{Discretisation, Mechanics, Newton, State, StepReport};
use lagrangian::{from_fn, mapped};

/// The velocity that an iteration has found, the impulse of the constraints, and the number of corrections.
struct FoundMean<const N: usize, const M: usize> {
    v: [f64; N],
    lambda: [f64; M],
    corrections: u32,
}

/// Corrects `x` with a frozen Jacobian until it solves the equations; returns the number of evaluations, or `None` if they converge badly.
#[inline(always)]
fn searched<const N: usize>(
    tolerance: f64,
    equations: &mut impl BlockEquations<N, 1>,
    x: &mut [[f64; N]; 1],
) -> Option<u32> {
    /// After more corrections the step is made without memory.
    const CORRECTIONS: u32 = 9;
    let found = Newton { tolerance, max_iterations: CORRECTIONS }.search_blocks(equations, x).ok()?;
    Some(found.iterations + u32::from(equations.is_met()))
}

/// The size of the largest component; NaN is passed over.
#[inline(always)]
pub(crate) fn sup<const N: usize>(x: &[f64; N]) -> f64 {
    // A loop, since the compiler does not inline a fold over more than a few.
    let mut most = 0.0;
    for x in x {
        most = if x.abs() > most { x.abs() } else { most };
    }
    most
}

/// Whether a velocity meets `A v + b = 0` to the part `within` of the sizes of its terms.
#[inline(always)]
fn constraint_holds<const N: usize, const M: usize>(
    (a, b): (&[[f64; N]; M], &[f64; M]),
    v: &[f64; N],
    within: f64,
) -> bool {
    let mut all = true;
    for k in 0..M {
        let (mut slip, mut size) = (b[k], b[k].abs());
        for i in 0..N {
            let term = a[k][i] * v[i];
            slip += term;
            size += term.abs();
        }
        all &= slip.abs() <= within * size;
    }
    all
}

/// Whether `r + A' lambda = 0` to the round-off of the terms of `r`: of momenta `p`, and if they nearly cancel, of the products of the
/// Jacobian `jacobian` with the velocity `v` that they are sums of.
#[inline(always)]
fn are_met<const N: usize, const M: usize>(
    r: &[f64; N],
    (a, lambda): (&[[f64; N]; M], &[f64; M]),
    p: &[f64; N],
    (jacobian, v): (&StepDerivatives, &[f64; N]),
    tolerance: f64,
) -> bool {
    let mut all = true;
    for i in 0..N {
        let (mut rest, mut size) = (r[i], p[i].abs());
        for k in 0..M {
            let reaction = a[k][i] * lambda[k];
            rest += reaction;
            size += reaction.abs();
        }
        all &= rest.abs() <= tolerance * size || rest.abs() <= tolerance * (size + jacobian.size_of_terms(i, v));
    }
    all
}

/// The sums of the momenta of both ends.
#[inline(always)]
fn ends<const N: usize>(at: &Departure<N>) -> [f64; N] {
    from_fn(|i| at.residual[i] + at.arriving[i])
}

/// `p + A' lambda`.
#[inline(always)]
fn with_reaction<const N: usize, const M: usize>(mut p: [f64; N], a: &[[f64; N]; M], lambda: &[f64; M]) -> [f64; N] {
    for k in 0..M {
        for i in 0..N {
            p[i] += a[k][i] * lambda[k];
        }
    }
    p
}

impl<D> Dla<D> {
    /// The step in its general form, by modified Newton from the predictor; `None` if the iteration does not converge, or if no earlier
    /// step is remembered.
    ///
    /// The equations are as in [`Dla`], with multipliers. The Jacobian is from an earlier step, so that a correction takes only first-order
    /// evaluations and eliminates only the multipliers.
    #[inline(always)]
    pub(crate) fn continued_step<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t0: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Option<StepReport<M>>
    where
        D: Discretisation<N, M>,
    {
        self.kept.follows(state);
        if !self.kept.is_ready() {
            return None;
        }
        let report = going_on(self, system, (t0, h), state);
        match report {
            Some(_) => self.kept.succeeds(),
            None => self.kept.fails(),
        }
        report
    }
}

/// Moves the state by a step with the mean velocity `v`, to `q1` with the velocity `v1`; `None` if forces overshoot, or if `q1` or `v1` is
/// not finite.
#[inline(always)]
fn advanced<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    state: &mut State<N>,
    increment: &[f64; N],
    (v, v1): (&[f64; N], &[f64; N]),
    q1: &[f64; N],
) -> Option<()> {
    brakes_only(system, (t0, h), state.q(), (v, v1)).ok()?;
    // All checks in one value, without a branch between: each branch would depend on a number of its own.
    if !(0..N).fold(true, |all, i| all & q1[i].is_finite() & v1[i].is_finite()) {
        return None;
    }
    let acceleration = from_fn(|i| (v1[i] - v[i]) * (2.0 / h));
    state.advance_with_acceleration(h, increment, *v1, acceleration);
    Some(())
}

// Compiled twice in a build for any x86-64: the second has the instructions of AVX2.
#[cfg_attr(not(target_feature = "avx2"), multiversion::multiversion(targets("x86_64+avx2+bmi1+bmi2+lzcnt")))]
#[inline(never)]
fn going_on<D: Discretisation<N, M>, const N: usize, const M: usize>(
    method: &mut Dla<D>,
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    state: &mut State<N>,
) -> Option<StepReport<M>> {
    let (q0, v0) = (*state.q(), *state.v());
    let (FoundMean { v, lambda, corrections }, p1) = method.mean(system, (t0, h), state)?;
    if branch::turn_of(system, (t0, h), &q0, &v) > branch::NEAR {
        return None;
    }

    let d = mapped(&v, |v| h * v);
    let (t1, q1) = (t0 + h, state.ahead(&d));
    let guess = match method.kept.velocities.next(h) {
        Some(expected) => from_fn(|i| expected[i]),
        None => from_fn(|i| 2.0 * v[i] - v0[i]),
    };
    let end = method.arrival(system, (t1, &q1), p1, guess)?;
    let v1 = end.v;

    advanced(system, (t0, h), state, &d, (&v, &v1), &q1)?;
    method.kept.block.took::<N>(corrections);
    method.kept.mass.took::<N>(end.corrections);
    // `v1` and not the velocity of the state: that has just been stored, and the load would stall on store forwarding.
    method.kept.ended(h, state.q(), &v1);
    Some(StepReport { impulses: [lambda, end.lambda], ..StepReport::of(corrections) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OneStep;
    use lagrangian::{Constraint, Scalar, System};
    use proptest::prelude::*;

    /// A disk of unit masses that rolls upright, on a table that may tremble.
    #[derive(Clone, Copy)]
    struct Disk {
        trembling: f64,
    }

    impl System<4, 2> for Disk {
        fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 4], v: &[S; 4]) -> S {
            let square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3];
            square * 0.5 - q[0] * (t * 1e3).sin() * self.trembling
        }
        fn constraint<S: Scalar>(&self, _t: S, q: &[S; 4]) -> Constraint<S, 4, 2> {
            let ((sin, cos), zero, one) = (q[3].sin_cos(), S::zero(), S::constant(1.0));
            ([[one, zero, -cos, zero], [zero, one, -sin, zero]], [zero; 2])
        }
    }

    const SMOOTH: Disk = Disk { trembling: 0.0 };
    const STEP: f64 = 0.01;

    fn start() -> State<4> {
        State::new([0.0; 4], [1.0, 0.0, 1.0, 0.5], [false, false, true, true])
    }

    fn method() -> Dla {
        Dla::midpoint()
    }

    /// How many of a hundred steps are predicted ones.
    fn going_on(system: &Disk, method: &mut Dla, state: &mut State<4>) -> u32 {
        let mut count = 0;
        for k in 0..100 {
            let t = f64::from(k) * STEP;
            match method.continued_step::<4, 2>(system, t, STEP, state) {
                Some(_) => count += 1,
                None => {
                    method.step(system, t, STEP, state).unwrap();
                }
            }
        }
        count
    }

    #[test]
    fn smooth_motions_go_on() {
        let (mut method, mut state) = (method(), start());
        assert_eq!(going_on(&SMOOTH, &mut method, &mut state), 99);
        assert!(!method.kept.block.stale && !method.kept.mass.stale);
        // From another place, reversed, or without what the state remembers.
        let place = *state.q();
        for mut other in [start(), state.reversed(), State::new(place, [0.0; 4], [false, false, true, true])] {
            assert!(method.clone().continued_step::<4, 2>(&SMOOTH, 0.0, STEP, &mut other).is_none());
        }
    }

    /// A heavy body that moves fast, and a small part of its velocity that a constraint sets.
    #[derive(Clone, Copy)]
    struct Leaning;

    impl System<3, 1> for Leaning {
        fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
            let heavy = v[0] * v[0] * 47.0 + v[0] * v[1] * 31.0 + v[1] * v[1] * 45.0 + v[1] * v[2] * 0.3;
            heavy + v[2] * v[2] * 0.5 - q[2] * q[2] * 0.5 - q[1] * (90.0 * 9.81)
        }
        fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
            ([[S::zero(), S::constant(1.0), q[2].sin() * -1e-4]], [S::zero()])
        }
    }

    /// The rounding of the reaction to its weight is more than the rounding of the terms of its constraint.
    #[test]
    fn a_constraint_on_small_velocities_beside_large_reactions_holds() {
        let (mut method, mut count) = (method(), 0);
        let mut state = State::new([0.0, 0.0, 0.1], [5.0, 1e-4 * 0.1_f64.sin() * 0.3, 0.3], [false; 3]);
        for k in 0..200 {
            let t = f64::from(k) * STEP;
            if method.continued_step::<3, 1>(&Leaning, t, STEP, &mut state).is_none() {
                method.step(&Leaning, t, STEP, &mut state).unwrap();
                continue;
            }
            count += 1;
            let ([[_, a, b]], _) = System::constraint(&Leaning, t, state.q());
            let terms = [a * state.v()[1], b * state.v()[2]];
            assert!((terms[0] + terms[1]).abs() <= 64.0 * f64::EPSILON * (terms[0].abs() + terms[1].abs()));
        }
        assert!(count > 190, "{count} predicted steps");
    }

    /// A run is the same to the last bit, whatever its method was used for before.
    #[test]
    fn another_run_begins_anew() {
        let (mut used, mut fresh) = (method(), method());
        going_on(&Disk { trembling: 1e3 }, &mut used, &mut State::new([0.3; 4], [1.0, 0.2, 1.0, 0.7], [false; 4]));
        let [mut after, mut alone] = [start(), start()];
        for k in 0..100 {
            for (method, state) in [(&mut used, &mut after), (&mut fresh, &mut alone)] {
                method.step(&SMOOTH, f64::from(k) * STEP, STEP, state).unwrap();
            }
            assert_eq!(after, alone);
        }
    }

    /// Where predictions fail, steps are made without memory, and predictions are tried ever more rarely.
    #[test]
    fn rough_motions_are_left_alone() {
        let rough = Disk { trembling: 1e3 };
        assert!(going_on(&rough, &mut method(), &mut start()) <= 50);
        let unit = from_fn(|i| from_fn(|j| f64::from(u8::from(i == j))));
        let mut method = method();
        for pause in [1, 2, 4, 8, 16, 32, 64, 64] {
            method.kept.fails();
            let ready_again = || {
                let state = start();
                method.kept.begins::<4>(Some((unit, unit)), STEP, (state.q(), state.v()));
                method.kept.is_ready()
            };
            assert_eq!(std::iter::repeat_with(ready_again).take_while(|ready| !ready).count(), pause);
        }
    }

    proptest! {
        /// A checkpoint is a file, in which anything may stand.
        #[test]
        fn wild_memories_are_survived(
            wild in proptest::collection::vec(prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(0.0), -1e300..1e300f64, -2.0..2.0f64], 0..400),
            at in 0usize..400,
        ) {
            let (mut known, mut state) = (method(), start());
            for _ in 0..9 {
                known.step(&SMOOTH, 0.0, STEP, &mut state).unwrap();
            }
            let mut numbers = OneStep::<4, 2>::memory(&known);
            prop_assert!(numbers.len() > 100);
            let end = numbers.len().min(at + wild.len());
            let from = at.min(end);
            numbers[from..end].copy_from_slice(&wild[..end - from]);
            for numbers in [&numbers, &wild] {
                let mut method = method();
                OneStep::<4, 2>::recall(&mut method, numbers, &state);
                let (mut again, mut plain) = (state, state);
                for _ in 0..9 {
                    method.step(&SMOOTH, 0.0, STEP, &mut again).unwrap();
                    known.step(&SMOOTH, 0.0, STEP, &mut plain).unwrap();
                }
            }
        }
    }
}
