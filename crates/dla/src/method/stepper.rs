//! The methods by name, as objects.

use super::table::NOT_HERE;
use crate::{
    Composition, Differentiable, Dla, Energy, Gauss, GaussAdaptive, Gni, Lobatto, OwnMethods, Rebased,
    SensitivityError, Stepper, Taylor,
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
        let (method, along): (Stepper<'static, N, M>, bool) = match self.info().kind {
            MethodKind::Dla => (Box::new(Dla::midpoint()), false),
            MethodKind::DlaTrapezoid | MethodKind::DlaAlpha => (Box::new(Dla::new(self.rule(), self.rule())), false),
            MethodKind::Composed(order) => (Box::new(composed(order, Dla::midpoint())), false),
            MethodKind::Lobatto(3) => (Box::new(Lobatto::<3>::new()), false),
            MethodKind::Lobatto(4) => (Box::new(Lobatto::<4>::new()), false),
            MethodKind::Lobatto(_) => (Box::new(Lobatto::<5>::new()), false),
            MethodKind::Gauss(stages) => (Box::new(gauss(stages)), true),
            MethodKind::GaussAdaptive => (Box::new(GaussAdaptive::new::<8>(self.tolerance())), false),
            MethodKind::Energy(stages) => (Box::new(energy(stages)), true),
            MethodKind::Gni => (Box::new(Gni::<N>::default()), false),
            MethodKind::Rk4Reduced => (Box::new(Rk4Reduced), true),
            MethodKind::ImplicitMidpoint => (Box::new(ImplicitMidpoint::default()), true),
            MethodKind::Dop853 => (Box::new(Dop853::<N, M>::new(self.tolerance())), false),
            MethodKind::Taylor => (Box::new(Taylor::<N>::new(self.tolerance())), false),
            MethodKind::Rk4 => return Box::new(Rk4),
            MethodKind::Rk4Projected => return Box::new(Rk4Projected),
        };
        // One type of `Rebased` for all of them.
        let method = Rebased::new(method);
        Box::new(if along { method.along() } else { method })
    }
}

/// Whether the steps of a method have derivatives.
///
/// # Errors
/// [`SensitivityError::Unsupported`] with the reason, if they have none.
pub fn has_derivatives(method: &Method) -> Result<(), SensitivityError> {
    if method.info().kind == MethodKind::Taylor { Ok(()) } else { differentiable::<3, 1>(method).map(drop) }
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
