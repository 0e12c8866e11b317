use super::stepper::{composed, energy, gauss};
use super::{Method, MethodKind};
use crate::{Differentiable, Dla, Lobatto, Rk4, Rk4Reduced, SensitivityError};

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
    method.info().tangent.map_err(|reason| SensitivityError::Unsupported { reason })?;
    has_derivatives(method)
}

/// A method as an object whose steps can be differentiated.
///
/// Every one is compiled for every shape of system: `lobatto` and `energy` only for small ones.
///
/// # Errors
/// [`SensitivityError::Unsupported`] with the reason, if the method is not differentiated.
#[inline(never)]
pub(crate) fn differentiable<const N: usize, const M: usize>(
    method: &Method,
) -> Result<Box<dyn Differentiable<N, M>>, SensitivityError> {
    const TOO_LARGE: SensitivityError = SensitivityError::Unsupported {
        reason: "derivatives of the steps of this method are available for systems of up to four coordinates: take gauss8",
    };
    let info = method.info();
    Ok(match info.kind {
        MethodKind::Dla => Box::new(Dla::midpoint()),
        MethodKind::DlaTrapezoid | MethodKind::DlaAlpha => Box::new(Dla::new(method.rule(), method.rule())),
        MethodKind::Composed(order) => Box::new(composed(order, Dla::midpoint())),
        MethodKind::Gauss(stages) => Box::new(gauss(stages)),
        MethodKind::Rk4 => Box::new(Rk4),
        MethodKind::Rk4Reduced => Box::new(Rk4Reduced),
        kind => match info.tangent {
            Err(reason) => return Err(SensitivityError::Unsupported { reason }),
            Ok(()) => return if const { N <= 4 } { small(kind) } else { None }.ok_or(TOO_LARGE),
        },
    })
}

fn small<const N: usize, const M: usize>(kind: MethodKind) -> Option<Box<dyn Differentiable<N, M>>> {
    Some(match kind {
        MethodKind::Lobatto(3) => Box::new(Lobatto::<3>::new()),
        MethodKind::Lobatto(4) => Box::new(Lobatto::<4>::new()),
        MethodKind::Energy(stages) => Box::new(energy(stages)),
        _ => return None,
    })
}
