use super::implicit::{Elementary, Seeder};
use super::reduced::{BasisColumns, BasisFrame};
use super::{Differentiable, SensitivityError, StepDerivative, Variation};
use crate::convergence::tolerances::NEAR_ROUNDINGS;
use crate::{Mechanics, OneStep, SeededMechanics, StackUse, State, StepReport};
use lagrangian::linear::{larger, largest};
use lagrangian::{Gradients, Member, Parametrised, Scalar, Seeded, SeededMember, from_fn, mapped};
use nalgebra::DMatrix;
use std::fmt;

/// First derivatives of the steps of any [`Differentiable`] method on a system, exact but for rounding.
///
/// A step is the solution `z` of equations `R(z; x) = 0` with `x = (q0, v0, t, h, p)`; so `dz = -(R_z)^-1 R_x dx`, with `R_z` and
/// `R_x` by dual numbers. The equations are stated here a second time, on dual numbers, and solved by Newton's method; that
/// the step of the method is their solution is checked at every step.
///
/// A system that is a [`Member`] of a family is differentiated in its parameters too. A control that is constant over a step
/// is one. Across a jump in time a step has no derivative: give one smooth [piece](lagrangian::Piecewise) at a time.
///
/// ```
/// use dla::{Dla, Sensitivity, State};
/// # use lagrangian::{Constraint, Scalar, System};
/// # struct Particle;
/// # impl System<3, 1> for Particle {
/// #     fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
/// #         (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5
/// #     }
/// #     fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
/// #         ([[-q[1], S::zero(), S::constant(1.0)]], [S::zero()])
/// #     }
/// # }
/// let mut state = State::new([0.1, 0.2, 0.3], [0.9, 0.7, 0.2 * 0.9], [false; 3]);
/// let derivative = Sensitivity::of(&Particle).step(&mut Dla::midpoint(), 0.0, 0.1, &mut state)?;
/// // Nothing pushes along y: y1 = y0 + h y'0.
/// assert!((derivative.from_v[1].q[1] - 0.1).abs() < 1e-15);
/// # Ok::<(), dla::SensitivityError>(())
/// ```
pub struct Sensitivity<'a, const N: usize, const M: usize, const P: usize> {
    system: &'a dyn Mechanics<N, M>,
    parameters: [f64; P],
    seeder: Box<Seeder<'a, N, M>>,
}

impl<const N: usize, const M: usize, const P: usize> fmt::Debug for Sensitivity<'_, N, M, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Sensitivity").field("parameters", &self.parameters).finish_non_exhaustive()
    }
}

impl<'a, const N: usize, const M: usize> Sensitivity<'a, N, M, 0> {
    /// On a system without parameters.
    #[must_use]
    pub fn of(system: &'a dyn SeededMechanics<N, M>) -> Self {
        let seeder = move |_: &[Seeded]| system.gradients();
        Self { system, parameters: [], seeder: Box::new(seeder) }
    }
}

impl<'a, const N: usize, const M: usize, const P: usize> Sensitivity<'a, N, M, P> {
    /// On a member of a family, in whose parameters the steps are differentiated too.
    #[must_use]
    pub fn of_member<F: Parametrised<N, M, P>>(system: &'a Member<F, P>) -> Self {
        let seeder = move |p: &[Seeded]| -> Box<dyn Gradients<N, M> + 'a> {
            let parameters = from_fn(|k| p.get(k).copied().unwrap_or(Seeded::zero()));
            Box::new(SeededMember { family: &system.family, parameters })
        };
        Self { system, parameters: system.parameters, seeder: Box::new(seeder) }
    }

    /// On a system that `seeder` gives on numbers with derivatives, at values of its parameters; `parameters` are the values for `system`.
    ///
    /// For families that are known at run time, and for a system whose equations on such numbers are another object than itself.
    #[must_use]
    pub fn seeded(
        system: &'a dyn Mechanics<N, M>,
        parameters: [f64; P],
        seeder: impl Fn(&[Seeded]) -> Box<dyn Gradients<N, M> + 'a> + 'a,
    ) -> Self {
        Self { system, parameters, seeder: Box::new(seeder) }
    }
}

/// Numbers carry eight directions here; the numbers of a step's equations carry one or two gradients of such numbers.
const USE: StackUse = StackUse { squares: 110, rows: 60 };

impl<const N: usize, const M: usize, const P: usize> Sensitivity<'_, N, M, P> {
    /// The system.
    #[must_use]
    pub fn system(&self) -> &dyn Mechanics<N, M> {
        self.system
    }

    /// Moves `state` from time `t` to `t + h` as [`OneStep::step`] does, and gives the derivative of the step.
    ///
    /// # Errors
    /// [`SensitivityError`] if the step fails or has no derivative; `state` is then unchanged.
    pub fn step<Method>(
        &self,
        method: &mut Method,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepDerivative<N, M, P>, SensitivityError>
    where
        Method: OneStep<N, M> + Differentiable<N, M>,
    {
        if const { USE.exceeds::<N, M>() } {
            return Err(USE.refusal::<N, M>().into());
        }
        let mut end = *state;
        let report = method.step(self.system, t, h, &mut end)?;
        let derivative = self.between(method, (t, h), state, &end, report)?;
        *state = end;
        Ok(derivative)
    }

    /// The derivative of a step that has been made: from `start` to `end`; `time` is its start and its
    /// length (s).
    ///
    /// The method is an object here, so that code for many methods is compiled once.
    ///
    /// # Errors
    /// As [`Sensitivity::step`], [`SensitivityError::OtherSolution`] if the step was not made by this method.
    pub fn between(
        &self,
        method: &dyn Differentiable<N, M>,
        time: (f64, f64),
        start: &State<N>,
        end: &State<N>,
        report: StepReport<M>,
    ) -> Result<StepDerivative<N, M, P>, SensitivityError> {
        if const { USE.exceeds::<N, M>() } {
            return Err(USE.refusal::<N, M>().into());
        }
        derivative(method, &*self.seeder, &self.parameters, time, start, end, report)
    }
}

/// The derivative of the step from `start` to `end`; apart from the system, so as not to be compiled for each.
fn derivative<const N: usize, const M: usize, const P: usize>(
    method: &dyn Differentiable<N, M>,
    seeder: &Seeder<'_, N, M>,
    parameters: &[f64; P],
    (t, h): (f64, f64),
    start: &State<N>,
    end: &State<N>,
    report: StepReport<M>,
) -> Result<StepDerivative<N, M, P>, SensitivityError> {
    let (first_t, first_q, first_v) =
        (Seeded::constant(t), mapped(start.q(), Seeded::constant), mapped(start.v(), Seeded::constant));
    let model = seeder(&mapped(parameters, Seeded::constant));
    let classes =
        model.holonomic(first_t, &first_q).is_some() || model.nonlinear(first_t, &first_q, &first_v).is_some();
    if classes && !method.carries_every_class() {
        return Err(SensitivityError::Unsupported {
            reason: "constraints on positions, and constraints that are not affine in the velocities, are differentiated in the \
                     methods of the family `dla` only",
        });
    }
    let inputs = 2 * N + 2 + P;
    let (mut q, mut v) = (*start.q(), *start.v());
    let mut moved = [0.0; N];
    // d(q, v)/d(q0, v0, t, h, p) so far.
    let mut chain = DMatrix::identity(2 * N, inputs);
    let mut done = 0.0;
    for fraction in method.fractions() {
        let part = Elementary { method, seeder, parameters, t: t + done * h, h: fraction * h, q, v };
        let step = part.linearised()?;
        // The inputs of the sub-step, as functions of the inputs of the step.
        let mut begin = DMatrix::identity(inputs, inputs);
        begin.rows_mut(0, 2 * N).copy_from(&chain);
        begin[(2 * N, 2 * N + 1)] = done;
        begin[(2 * N + 1, 2 * N + 1)] = fraction;
        chain = step.derivative * begin;
        done += fraction;
        for i in 0..N {
            moved[i] += step.increment[i];
            q[i] += step.increment[i];
        }
        v = step.velocity;
    }

    let inputs = start.q().iter().chain(start.v()).chain([&t, &h]).chain(parameters);
    // A place is rounded besides, and a velocity is what places are apart over a step: at rest there is nothing else.
    let place = larger(largest(&start.unwrapped()), largest(&moved));
    let of_places = if h == 0.0 { 0.0 } else { place / h.abs() };
    let rounding =
        from_fn(|i| inputs.clone().enumerate().map(|(j, x)| (chain[(N + i, j)] * x).abs()).sum::<f64>() + of_places);
    let defect = defect(start, end, (&moved, &v), &rounding);
    if defect > AGREEMENT || defect.is_nan() {
        return Err(SensitivityError::OtherSolution { defect });
    }
    let column = |j: usize| Variation { q: from_fn(|i| chain[(i, j)]), v: from_fn(|i| chain[(N + i, j)]) };
    let (from_q, from_v) = (from_fn(column), from_fn(|j| column(N + j)));
    let (from_time, from_step) = (column(2 * N), column(2 * N + 1));
    let from_parameters = from_fn(|k| column(2 * N + 2 + k));
    let columns = BasisColumns {
        from_q: &from_q,
        from_v: &from_v,
        from_parameters: &from_parameters,
        from_time: &from_time,
        from_step: &from_step,
    };
    let frame = |t, state: &State<N>| BasisFrame::new(seeder, parameters, t, state.q(), state.v());
    let reduced = match (frame(t, start), frame(t + h, end)) {
        (Some(start), Some(end)) => Some(columns.reduced(&start, &end)),
        _ => None,
    };
    Ok(StepDerivative { from_q, from_v, from_parameters, from_time, from_step, reduced, defect, report })
}

/// Steps that differ by more, relative, are different solutions; rounding is far below.
const AGREEMENT: f64 = 1e-9;

/// The largest difference between the step made and the solution of its equations: of the increments, relative to the coordinates, in whose
/// digits they are rounded; of the velocities, relative to the largest, unless the rounding of the inputs explains it (`rounding`, in units
/// of `2^-53`).
fn defect<const N: usize>(
    start: &State<N>,
    end: &State<N>,
    (moved, velocity): (&[f64; N], &[f64; N]),
    rounding: &[f64; N],
) -> f64 {
    let (before, after) = (start.unwrapped(), end.unwrapped());
    let off: [f64; N] = from_fn(|i| after[i] - before[i] - moved[i]);
    let noise: [f64; N] = mapped(rounding, |size| NEAR_ROUNDINGS * 0.5 * f64::EPSILON * size);
    let slower: [f64; N] = from_fn(|i| {
        let off = end.v()[i] - velocity[i];
        if off.abs() <= noise[i] { 0.0 } else { off }
    });
    let relative = |off: &[f64], size: f64| if largest(off) == 0.0 { 0.0 } else { largest(off) / size };
    let place = larger(larger(largest(&before), largest(&after)), largest(moved));
    larger(relative(&off, place), relative(&slower, larger(largest(velocity), largest(start.v()))))
}
