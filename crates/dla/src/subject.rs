use crate::{OneStep, PiecewiseMechanics};
use std::fmt;

/// A method as an object.
pub type Stepper<'a, const N: usize, const M: usize> = Box<dyn OneStep<N, M> + 'a>;

/// The integrators that a system brings of its own, beside those that are for every system; by default none.
pub trait OwnMethods<const N: usize, const M: usize> {
    /// The midpoint discrete Lagrange-d'Alembert map in a closed form of the system's own, for the smooth piece of a run that holds at the
    /// time `t` (s). The given method is the same map in its general form: it makes the steps that have no closed form, and where the
    /// system has none at all it is what is returned.
    fn closed_map<'a>(&'a self, _t: f64, general: Stepper<'a, N, M>) -> Stepper<'a, N, M> {
        general
    }

    /// The series of the motion that holds at the time `t` (s), with steps of its own as the tolerance asks for; none where the system
    /// has none.
    fn series(&self, _t: f64, _tolerance: f64) -> Option<Stepper<'_, N, M>> {
        None
    }
}

/// None.
impl<const N: usize, const M: usize> OwnMethods<N, M> for () {}

/// A system to be integrated, with the integrators that it brings of its own.
///
/// Every system is one that brings none: `Subject::from(&system)`.
#[derive(Clone, Copy)]
pub struct Subject<'a, const N: usize, const M: usize> {
    /// The system.
    pub system: &'a dyn PiecewiseMechanics<N, M>,
    /// Its own integrators.
    pub own: &'a dyn OwnMethods<N, M>,
}

impl<const N: usize, const M: usize> fmt::Debug for Subject<'_, N, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.system.fmt(f)
    }
}

impl<'a, Sys: PiecewiseMechanics<N, M>, const N: usize, const M: usize> From<&'a Sys> for Subject<'a, N, M> {
    fn from(system: &'a Sys) -> Self {
        Self { system, own: &() }
    }
}
