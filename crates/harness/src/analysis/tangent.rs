use super::discrete::differentiable;
use super::flow::{Flow, ReducedFlow, admissible, divergence};
use super::stages::{DIRECTIONS, Stages, TOO_MANY};
use crate::stepper::energy;
use crate::{Kind, Method};
use dla::{Differentiable, Lobatto, SeededMechanics, Sensitivity, SensitivityError, State, StepReport};
use lagrangian::from_fn;
use nalgebra::DMatrix;

/// The derivative of single steps of a run, in the coordinates `(q, xi)` of the distribution; an object, so that what uses it
/// is compiled once.
pub(super) trait StepTangent<const N: usize, const M: usize> {
    /// `d(q1, xi1)/d(q0, xi0)` of the step that was made from `start` to `end`; `time` is its start and its length (s).
    fn matrix(
        &self,
        time: (f64, f64),
        start: &State<N>,
        end: &State<N>,
        report: StepReport<M>,
    ) -> Result<DMatrix<f64>, SensitivityError>;

    /// What the continuous equations are at a state.
    fn local(&self, t: f64, state: &State<N>) -> Result<Local<N>, SensitivityError>;

    /// The roots of twice the kinetic energies of the basis vectors at a place, by which quasi-velocities of different units are compared;
    /// one where a vector has none.
    fn weights(&self, t: f64, state: &State<N>) -> [f64; N];
}

/// The continuous equations at a state.
#[derive(Debug, Clone, Copy)]
pub(super) struct Local<const N: usize> {
    /// Their divergence (1/s).
    pub(super) divergence: f64,
    /// The quasi-velocities and their rates; zero in the places that do not count.
    pub(super) xi: [f64; N],
    pub(super) rate: [f64; N],
}

/// How the steps of a method are differentiated.
enum Rule<const N: usize, const M: usize> {
    /// A Runge-Kutta method on the reduced equations: on numbers with derivatives.
    Stages(Stages),
    /// Any other: by the implicit function theorem.
    Equations(Box<dyn Differentiable<N, M>>),
}

/// The steps of a method on a system.
pub(super) struct Steps<'a, const N: usize, const M: usize> {
    system: &'a dyn SeededMechanics<N, M>,
    rule: Rule<N, M>,
    sensitivity: Sensitivity<'a, N, M, 0>,
}

/// Whether [`lyapunov`](fn@super::lyapunov) has the derivatives of this method.
///
/// # Errors
/// [`SensitivityError::Unsupported`] with the reason, where it has not.
pub fn has_tangents(method: &Method) -> Result<(), SensitivityError> {
    rule::<3, 1>(method).map(drop)
}

fn rule<const N: usize, const M: usize>(method: &Method) -> Result<Rule<N, M>, SensitivityError> {
    let info = method.info();
    info.tangent.map_err(|reason| SensitivityError::Unsupported { reason })?;
    Ok(match info.kind {
        Kind::Gauss(stages) => Rule::Stages(Stages::gauss(stages)),
        Kind::Rk4Reduced => Rule::Stages(Stages::rk4()),
        Kind::Lobatto(3) => Rule::Equations(Box::new(Lobatto::<3>::new())),
        Kind::Lobatto(_) => Rule::Equations(Box::new(Lobatto::<4>::new())),
        Kind::Energy(stages) => Rule::Equations(Box::new(energy(stages))),
        _ => match differentiable(method) {
            Some(method) => Rule::Equations(method),
            None => return Err(SensitivityError::Unsupported { reason: "its steps are not differentiated here" }),
        },
    })
}

impl<'a, const N: usize, const M: usize> Steps<'a, N, M> {
    pub(super) fn of(system: &'a dyn SeededMechanics<N, M>, method: &Method) -> Result<Self, SensitivityError> {
        if 2 * N - M > DIRECTIONS {
            return Err(TOO_MANY);
        }
        Ok(Self { system, rule: rule(method)?, sensitivity: Sensitivity::of(system) })
    }

    fn quasi_velocities(&self, t: f64, state: &State<N>) -> Result<[f64; N], SensitivityError> {
        state.quasi_velocities(self.system, t).map_err(|error| SensitivityError::Step(error.into()))
    }
}

/// Steps that differ by more, relative, are different solutions; rounding is far below.
const AGREEMENT: f64 = 1e-9;

impl<const N: usize, const M: usize> StepTangent<N, M> for Steps<'_, N, M> {
    fn matrix(
        &self,
        time: (f64, f64),
        start: &State<N>,
        end: &State<N>,
        report: StepReport<M>,
    ) -> Result<DMatrix<f64>, SensitivityError> {
        match &self.rule {
            Rule::Stages(stages) => {
                let flow: &dyn ReducedFlow<N, M> = &Flow(self.system);
                of_stages(stages, flow, time, start, &self.quasi_velocities(time.0, start)?, end)
            }
            Rule::Equations(method) => {
                let derivative = self.sensitivity.between(&**method, time, start, end, report)?;
                let rows = derivative.reduced.ok_or(NO_BASIS)?.matrix();
                Ok(DMatrix::from_row_iterator(rows.len(), rows.len(), rows.into_iter().flatten()))
            }
        }
    }

    fn local(&self, t: f64, state: &State<N>) -> Result<Local<N>, SensitivityError> {
        let xi = admissible::<N, M>(&self.quasi_velocities(t, state)?);
        let (divergence, rate) = divergence(&Flow(self.system), t, state.q(), &xi).ok_or(NO_BASIS)?;
        Ok(Local { divergence, xi, rate })
    }

    fn weights(&self, t: f64, state: &State<N>) -> [f64; N] {
        let of = |xi: &[f64; N]| {
            let velocity = self.system.velocity_of(t, state.q(), xi).ok();
            velocity.map_or(f64::NAN, |v| self.system.energy(t, state.q(), &v))
        };
        let rest = of(&[0.0; N]);
        from_fn(|a| {
            let unit = |sign: f64| of(&from_fn(|b| if a == b && a < N - M { sign } else { 0.0 }));
            // Both signs: a constraint that moves adds what is odd.
            let twice = unit(1.0) - rest + (unit(-1.0) - rest);
            if twice > 0.0 && twice.is_finite() { twice.sqrt() } else { 1.0 }
        })
    }
}

const NO_BASIS: SensitivityError = SensitivityError::Unsupported {
    reason: "exponents need a basis of the admissible velocities, and the system gives none",
};

/// The matrix of a step by stages, after a look whether it ends where the step did.
fn of_stages<const N: usize, const M: usize>(
    stages: &Stages,
    flow: &dyn ReducedFlow<N, M>,
    (t, h): (f64, f64),
    start: &State<N>,
    xi: &[f64; N],
    end: &State<N>,
) -> Result<DMatrix<f64>, SensitivityError> {
    let [dq, dxi] = stages.increments(flow, (t, h), start.q(), xi)?;
    let moved = end.moved_since(start);
    let (mut off, mut size) = (0.0f64, 0.0f64);
    for i in 0..N {
        off = off.max((moved[i] - dq[i].re).abs());
        size = size.max(end.unwrapped()[i].abs()).max(moved[i].abs());
    }
    let defect = if off == 0.0 { 0.0 } else { off / size };
    if defect > AGREEMENT || defect.is_nan() {
        return Err(SensitivityError::OtherSolution { defect });
    }
    Ok(DMatrix::from_fn(2 * N - M, 2 * N - M, |i, j| {
        let moved = if i < N { dq[i].eps[j] } else { dxi[i - N].eps[j] };
        if i == j { 1.0 + moved } else { moved }
    }))
}
