//! The methods by name, as objects.

use super::table::NOT_HERE;
use crate::{
    Composition, Differentiable, Dla, Energy, Gauss, GaussAdaptive, Gni, Lobatto, Mechanics, OneStep, OwnMethods,
    Rebased, SensitivityError, State, StepError, StepReport, Stepper,
};
use crate::{Dop853, ImplicitMidpoint, Method, MethodKind, Rk4, Rk4Projected, Rk4Reduced};

impl Method {
    /// The method, to make steps with, for a system that brings integrators of its own: its closed form of `dla` takes the place of the
    /// general form, also in compositions, and its series makes the steps of `taylor`. The result holds for the smooth piece of a run at
    /// the time `t` (s).
    #[must_use]
    pub fn stepper_of<'a, const N: usize, const M: usize>(
        &self,
        own: &'a dyn OwnMethods<N, M>,
        t: f64,
    ) -> Stepper<'a, N, M> {
        let midpoint = || own.closed_map(t, self.as_dla().stepper());
        match self.info().kind {
            MethodKind::Dla => midpoint(),
            MethodKind::DlaAlpha if self.alpha().is_symmetric() => midpoint(),
            MethodKind::Composed(order) => Box::new(composed(order, midpoint())),
            MethodKind::Taylor => own.series(t, self.tolerance()).unwrap_or_else(|| self.stepper()),
            _ => self.stepper(),
        }
    }

    /// The method, to make steps with: only here a name becomes a type.
    #[must_use]
    #[inline(never)]
    pub fn stepper<const N: usize, const M: usize>(&self) -> Stepper<'static, N, M> {
        match self.info().kind {
            MethodKind::Dla => Box::new(Rebased::new(Dla::midpoint())),
            MethodKind::DlaTrapezoid | MethodKind::DlaAlpha => {
                Box::new(Rebased::new(Dla::new(self.rule(), self.rule())))
            }
            MethodKind::Composed(order) => Box::new(Rebased::new(composed(order, Dla::midpoint()))),
            MethodKind::Lobatto(3) => Box::new(Rebased::new(Lobatto::<3>::new())),
            MethodKind::Lobatto(4) => Box::new(Rebased::new(Lobatto::<4>::new())),
            MethodKind::Lobatto(_) => Box::new(Rebased::new(Lobatto::<5>::new())),
            MethodKind::Gauss(stages) => Box::new(Rebased::new(gauss(stages)).along()),
            MethodKind::GaussAdaptive => Box::new(Rebased::new(GaussAdaptive::new::<8>(self.tolerance()))),
            MethodKind::Taylor => Box::new(NoSeries),
            MethodKind::Energy(stages) => Box::new(Rebased::new(energy(stages)).along()),
            MethodKind::Gni => Box::new(Rebased::new(Gni::<N>::default())),
            MethodKind::Rk4 => Box::new(Rk4),
            MethodKind::Rk4Projected => Box::new(Rk4Projected),
            MethodKind::Rk4Reduced => Box::new(Rebased::new(Rk4Reduced).along()),
            MethodKind::ImplicitMidpoint => Box::new(Rebased::new(ImplicitMidpoint::default()).along()),
            MethodKind::Dop853 => Box::new(Rebased::new(Dop853::<N, M>::new(self.tolerance()))),
        }
    }
}

/// Whether the steps of a method have derivatives.
///
/// # Errors
/// [`SensitivityError::Unsupported`] with the reason, if they have none.
pub fn has_derivatives(method: &Method) -> Result<(), SensitivityError> {
    differentiable::<3, 1>(method).map(drop)
}

/// Whether they have derivatives on the distribution, for exponents.
///
/// # Errors
/// [`SensitivityError::Unsupported`] with the reason, if they have none.
pub fn has_tangents(method: &Method) -> Result<(), SensitivityError> {
    method.info().tangent.map_err(|reason| SensitivityError::Unsupported { reason })
}

/// A method as an object whose steps can be differentiated.
///
/// # Errors
/// [`SensitivityError::Unsupported`] with the reason, if the method is not differentiated.
#[inline(never)]
pub(crate) fn differentiable<const N: usize, const M: usize>(
    method: &Method,
) -> Result<Box<dyn Differentiable<N, M>>, SensitivityError> {
    Ok(match method.info().kind {
        MethodKind::Dla => Box::new(Dla::midpoint()),
        MethodKind::DlaTrapezoid | MethodKind::DlaAlpha => Box::new(Dla::new(method.rule(), method.rule())),
        MethodKind::Composed(order) => Box::new(composed(order, Dla::midpoint())),
        MethodKind::Gauss(stages) => Box::new(gauss(stages)),
        MethodKind::Rk4 => Box::new(Rk4),
        _ => return Err(SensitivityError::Unsupported { reason: method.info().tangent.err().unwrap_or(NOT_HERE) }),
    })
}

/// The composition of an order in the table of methods.
fn composed<Step>(order: u32, step: Step) -> Composition<Step> {
    match order {
        4 => Composition::suzuki4(step),
        6 => Composition::kahan_li6(step),
        _ => Composition::fifteen8(step),
    }
}

/// The collocation with a number of stages in the table of methods.
fn gauss(stages: usize) -> Gauss {
    match stages {
        2 => Gauss::new::<2>(),
        3 => Gauss::new::<3>(),
        4 => Gauss::new::<4>(),
        5 => Gauss::new::<5>(),
        6 => Gauss::new::<6>(),
        7 => Gauss::new::<7>(),
        _ => Gauss::new::<8>(),
    }
}

/// The energy-preserving method with a number of stages in the table of methods.
fn energy(stages: usize) -> Energy {
    match stages {
        1 => Energy::new::<1>(),
        2 => Energy::new::<2>(),
        3 => Energy::new::<3>(),
        _ => Energy::new::<4>(),
    }
}

/// The method `taylor` on a system that brings no series.
struct NoSeries;

impl<const N: usize, const M: usize> OneStep<N, M> for NoSeries {
    fn step(
        &mut self,
        _system: &dyn Mechanics<N, M>,
        _t: f64,
        _h: f64,
        _state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        Err(StepError::Unsupported {
            reason: "series need a sleigh whose equations are of second degree in axes that turn with it: free, in a round well, under a \
                     constant thrust or torque, with viscous drag or without",
        })
    }
}
