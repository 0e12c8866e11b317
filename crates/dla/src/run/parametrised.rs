use super::mechanism::Mechanism;
use super::subject::{Subject, seeded_row};
use crate::method::differentiable;
use crate::taylor::tangent::{TaylorFlow, same_end};
use crate::{
    AnyState, Mechanics, Method, MethodKind, ReducedSeries, Report, Sensitivity, SensitivityError, State, Tangent,
    Variation,
};
use lagrangian::{Gradients, Scalar, Seeded, from_fn};
use nalgebra::DMatrix;
use std::fmt;

/// A system as a function of `P` parameters, on numbers with derivatives; an object, so that what uses it is compiled once for a shape.
pub trait ParametrisedMechanics<const N: usize, const M: usize, const P: usize> {
    /// The system at these parameters, with the basis of that number ([`lagrangian::System::near`]).
    fn at(&self, basis: u64, p: &[Seeded; P]) -> Box<dyn Gradients<N, M> + '_>;

    /// The reduced equations in the basis of that number, with the parameters for [constants](ReducedSeries::constants).
    ///
    /// # Errors
    /// The reason, if the family has none.
    fn series(&self, _basis: u64) -> Result<ReducedSeries, &'static str> {
        Err("the series of this system have no derivatives in its parameters: write it as text, or take gauss16")
    }
}

/// A variation of a state and of the parameters of its system, of sizes known at run time; what a list lacks is zero.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AnyTangent {
    /// The variation of the configuration.
    pub q: Vec<f64>,
    /// The variation of the velocity.
    pub v: Vec<f64>,
    /// The variation of the parameters; it is the same along a run.
    pub parameters: Vec<f64>,
}

/// A member of a family of systems, whose motions are differentiated in the parameters too; sizes are known at run time.
pub trait ParametrisedMechanism {
    /// The member.
    fn mechanism(&self) -> &dyn Mechanism;

    /// The values of its parameters.
    fn parameters(&self) -> &[f64];

    /// The energy (J) at a time and a state on numbers with derivatives.
    fn energy(&self, t: f64, q: &[Seeded], v: &[Seeded], p: &[Seeded]) -> Seeded;

    /// Tangents after a step of a method, made in the basis number `basis`.
    ///
    /// # Errors
    /// [`SensitivityError`] if the step has no derivative.
    fn carried(
        &self,
        method: &Method,
        basis: u64,
        time: (f64, f64),
        ends: [&AnyState; 2],
        report: &Report,
        tangents: &[AnyTangent],
    ) -> Result<Vec<AnyTangent>, SensitivityError>;
}

/// A system of a shape with its family.
pub struct Member<'a, const N: usize, const M: usize, const P: usize> {
    subject: Subject<'a, N, M>,
    family: &'a dyn ParametrisedMechanics<N, M, P>,
    parameters: [f64; P],
}

impl<'a, const N: usize, const M: usize, const P: usize> Member<'a, N, M, P> {
    /// The member at these parameters, which the subject is.
    pub fn new(
        subject: Subject<'a, N, M>,
        family: &'a dyn ParametrisedMechanics<N, M, P>,
        parameters: [f64; P],
    ) -> Self {
        Self { subject, family, parameters }
    }
}

impl<const N: usize, const M: usize, const P: usize> fmt::Debug for Member<'_, N, M, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Member").field("parameters", &self.parameters).finish_non_exhaustive()
    }
}

impl<const N: usize, const M: usize, const P: usize> ParametrisedMechanism for Member<'_, N, M, P> {
    fn mechanism(&self) -> &dyn Mechanism {
        &self.subject
    }

    fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// `v . L_v - L`.
    fn energy(&self, t: f64, q: &[Seeded], v: &[Seeded], p: &[Seeded]) -> Seeded {
        let (t, q, v): (_, [Seeded; N], [Seeded; N]) = (Seeded::constant(t), seeded_row(q), seeded_row(v));
        let model = self.family.at(0, &seeded_row(p));
        let momentum = model.momentum(t, &q, &v);
        let twice = v.iter().zip(momentum).fold(Seeded::zero(), |sum, (v, p)| sum + *v * p);
        twice - model.lagrangian(t, &q, &v)
    }

    fn carried(
        &self,
        method: &Method,
        basis: u64,
        time: (f64, f64),
        [start, end]: [&AnyState; 2],
        report: &Report,
        tangents: &[AnyTangent],
    ) -> Result<Vec<AnyTangent>, SensitivityError> {
        let (start, end) = start.typed().zip(end.typed()).ok_or(crate::StepError::OTHER_SHAPE)?;
        if method.info().kind == MethodKind::Taylor {
            return self.along_series(method.tolerance(), basis, time, [start, end], tangents);
        }
        let rule = differentiable::<N, M>(method)?;
        let seeder = |p: &[Seeded]| self.family.at(basis, &from_fn(|k| p.get(k).copied().unwrap_or(Seeded::zero())));
        let sensitivity = Sensitivity::seeded(self.subject.system(), self.parameters, seeder);
        let derivative = sensitivity.between(&*rule, time, start, end, report.typed())?;
        let carried = |tangent: &AnyTangent| {
            let (q, v): ([f64; N], [f64; N]) = (filled(&tangent.q), filled(&tangent.v));
            let state = Variation { q, v };
            let Tangent { state, parameters } =
                derivative.apply(&Tangent { state, parameters: filled(&tangent.parameters) });
            AnyTangent { q: state.q.to_vec(), v: state.v.to_vec(), parameters: parameters.to_vec() }
        };
        Ok(tangents.iter().map(carried).collect())
    }
}

impl<const N: usize, const M: usize, const P: usize> Member<'_, N, M, P> {
    /// Tangents after a step by Taylor series: the variations of the quasi-velocities follow from those of the velocity, and give them at the
    /// end.
    fn along_series(
        &self,
        tolerance: f64,
        basis: u64,
        (t, h): (f64, f64),
        [start, end]: [&State<N>; 2],
        tangents: &[AnyTangent],
    ) -> Result<Vec<AnyTangent>, SensitivityError> {
        let mut all = Err("there is no basis of this number");
        let series = self.family.series(basis);
        let mut run = |system: &dyn Mechanics<N, M>| {
            all = Ok(self.carried_by(system, &series, tolerance, (t, h), [start, end], tangents));
        };
        if !self.subject.system().near(t, start.q(), basis, &mut |_, near| run(near)) {
            run(self.subject.system());
        }
        all.map_err(|reason| SensitivityError::Unsupported { reason })?
    }

    fn carried_by(
        &self,
        system: &dyn Mechanics<N, M>,
        series: &Result<ReducedSeries, &'static str>,
        tolerance: f64,
        (t, h): (f64, f64),
        [start, end]: [&State<N>; 2],
        tangents: &[AnyTangent],
    ) -> Result<Vec<AnyTangent>, SensitivityError> {
        let of = series.clone().map_err(|reason| SensitivityError::Unsupported { reason })?;
        let motion = system.series().map_err(|reason| SensitivityError::Unsupported { reason })?;
        let (n, unknowns) = (of.coordinates, of.recurrences.unknowns());
        let column = |part: &[f64], k: usize| part.get(k).copied().unwrap_or(0.0);
        let mut flow = TaylorFlow::new(of.with_constants(&self.parameters));
        let mut begin = DMatrix::from_fn(unknowns + P, tangents.len(), |row, j| match row {
            i if i < n => column(&tangents[j].q, i),
            k if k < unknowns => 0.0,
            p => column(&tangents[j].parameters, p - unknowns),
        });
        let at = |t: f64, state: &State<N>| -> Result<Vec<f64>, SensitivityError> {
            let xi = state.quasi_velocities(system, t).map_err(crate::StepError::from)?;
            Ok([&state.q()[..n], &xi[..unknowns - n]].concat())
        };
        let velocities = DMatrix::from_fn(n, tangents.len(), |i, j| column(&tangents[j].v, i));
        flow.solve_velocities(t, &at(t, start)?, &mut begin, &velocities);
        let (there, carried) = flow.carried((system, motion), tolerance, (t, h), start, begin)?;
        same_end(start, &there, end)?;
        let velocities = flow.velocities(t + h, &at(t + h, &there)?, &carried);
        let padded = |of: &DMatrix<f64>, j: usize| -> Vec<f64> {
            (0..N).map(|i| if i < n { of[(i, j)] } else { 0.0 }).collect()
        };
        let tangent = |(j, tangent): (usize, &AnyTangent)| AnyTangent {
            q: padded(&carried, j),
            v: padded(&velocities, j),
            parameters: (0..P).map(|k| column(&tangent.parameters, k)).collect(),
        };
        Ok(tangents.iter().enumerate().map(tangent).collect())
    }
}

/// A list as a row, with zeros in the places that it lacks.
fn filled<const K: usize>(x: &[f64]) -> [f64; K] {
    from_fn(|i| x.get(i).copied().unwrap_or(0.0))
}
