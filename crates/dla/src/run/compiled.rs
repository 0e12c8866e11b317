use super::mechanism::Mechanism;
use super::parametrised::{Member, ParametrisedMechanics, ParametrisedMechanism};
use super::subject::{OwnMethods, Subject};
use crate::FullMechanics;

/// Maximum number of parameters of a family: a [`Seeded`](lagrangian::Seeded) number carries eight directions.
pub const PARAMETERS: usize = 8;

/// The shapes of the systems of scenes and of texts, with all methods and analyses.
///
/// Code that is generic in the shape is compiled by each crate that uses it. That of the shapes of this list is compiled here, once.
#[derive(Debug)]
pub struct Shapes;

/// What is compiled once for a shape.
pub trait CompiledShape<const N: usize, const M: usize> {
    /// The system as runs see it, with the integrators that it brings of its own.
    fn mechanism<'a>(system: &'a dyn FullMechanics<N, M>, own: &'a dyn OwnMethods<N, M>) -> Box<dyn Mechanism + 'a>;

    /// The system as a member of a family.
    fn member<'a>(
        system: &'a dyn FullMechanics<N, M>,
        own: &'a dyn OwnMethods<N, M>,
        family: &'a dyn ParametrisedMechanics<N, M, PARAMETERS>,
        parameters: [f64; PARAMETERS],
    ) -> Box<dyn ParametrisedMechanism + 'a>;
}

macro_rules! compiled {
    ($(($n:literal, $m:literal)),*) => {$(
        impl CompiledShape<$n, $m> for Shapes {
            fn mechanism<'a>(
                system: &'a dyn FullMechanics<$n, $m>,
                own: &'a dyn OwnMethods<$n, $m>,
            ) -> Box<dyn Mechanism + 'a> {
                Box::new(Subject::new(system, own))
            }

            fn member<'a>(
                system: &'a dyn FullMechanics<$n, $m>,
                own: &'a dyn OwnMethods<$n, $m>,
                family: &'a dyn ParametrisedMechanics<$n, $m, PARAMETERS>,
                parameters: [f64; PARAMETERS],
            ) -> Box<dyn ParametrisedMechanism + 'a> {
                Box::new(Member::new(Subject::new(system, own), family, parameters))
            }
        }
    )*};
}

compiled!((3, 1), (3, 2), (3, 3), (4, 1), (4, 2), (4, 3), (8, 5), (12, 6), (18, 6));
