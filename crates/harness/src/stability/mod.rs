//! Hard cases: what a case is, what a run of it shows, and which methods claim it.
//!
//! A case is run by whoever has its system; what it recorded, a [`Recorded`], is given to small functions in [`check`],
//! each of which gives a [`Finding`], a measured number and its bar. [`judge`] makes a [`Verdict`] of them. Nothing here
//! knows which method made a run, so the same checks can be shown to see a stepper that is broken.

pub mod check;
mod recorded;
mod verdict;

pub use check::Finding;
pub use recorded::{Recorded, Recorder, Seen, VALUES};
pub use verdict::{Outcome, Trial, Verdict, judge};

use crate::MethodKind;

/// A hard case, in words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Case {
    /// Its name in commands.
    pub name: &'static str,
    /// Why it is hard.
    pub hard: &'static str,
    /// The result of a correct code.
    pub shows: &'static str,
    /// The bar, and what it follows from.
    pub bar: &'static str,
    /// The claim of the methods that must meet it.
    pub claim: Claim,
    /// Whether an error value is an answer: the step or the numbers are beyond what a method can do.
    pub refusable: bool,
}

/// The property that a case asks of a method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Claim {
    /// The error is of the method's order, and nothing else goes wrong.
    Order,
    /// The velocity constraint to round-off.
    Constraint,
    /// The digits of a spin, however small beside the speed.
    SmallSpin,
    /// A motion that dies out stays dead.
    StableLine,
    /// It is its own adjoint: there and back is home.
    Symmetry,
    /// The energy to round-off, or an error.
    Energy,
    /// An accepted solution is the one that continues the motion.
    Continuation,
    /// A mass matrix that is regular on the constraint only.
    LightInertia,
    /// A step that explicit methods cannot make.
    Stiffness,
}

/// The table of claims: whether a method claims something, or why it does not.
///
/// # Errors
/// The reason why not.
pub fn claims(method: MethodKind, claim: Claim) -> Result<(), &'static str> {
    use Claim as C;
    use MethodKind as K;
    const HIDDEN_MODE: &str = "its hidden multiplier mode grows about the stable line";
    const EXPLICIT: &str = "explicit: beyond its stability bound it grows";
    match (method, claim) {
        (K::Gni, C::StableLine | C::Symmetry | C::Order) => Err(HIDDEN_MODE),
        (K::Gni, C::Continuation) => Err("takes whatever solution its search finds"),
        (K::Rk4 | K::ImplicitMidpoint, C::Constraint) => Err("the blade slips, by the error of the method"),

        // The spin is a component of a velocity in the plane, and noise below the rounding of the largest.
        (
            K::DlaTrapezoid | K::DlaAlpha | K::Lobatto(_) | K::Gni | K::Rk4 | K::Rk4Projected | K::ImplicitMidpoint,
            C::SmallSpin,
        ) => Err("works in coordinates: a spin below the rounding of the speed is noise to it"),

        (K::Lobatto(_), C::LightInertia) => Err(
            "its stages leave the constraint, where the mass matrix is singular: they cannot be shown to continue the motion",
        ),
        (K::Gni, C::LightInertia) => Err(HIDDEN_MODE),

        (K::Rk4 | K::Rk4Projected | K::Rk4Reduced, C::Symmetry) => Err("is not its own adjoint"),
        (K::GaussAdaptive | K::Taylor | K::Dop853, C::Symmetry) => Err("is not its own adjoint"),
        (K::Energy(_), C::Energy) => Ok(()),
        (_, C::Energy) => Err("keeps the energy to its order only"),
        (K::Rk4 | K::Rk4Projected | K::Rk4Reduced, C::Continuation | C::Stiffness) => Err(EXPLICIT),
        (K::DlaTrapezoid | K::Gni, C::Stiffness) => {
            Err("takes a potential at the nodes, as the leapfrog does: beyond sqrt(k/m) h = 2 it grows")
        }
        _ => Ok(()),
    }
}
