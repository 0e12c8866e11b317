use super::flow::{filled, own_counts};
use super::search::Searching;
use dla::Mechanism;
use lagrangian::ReducedError;
use lagrangian::linear::Singular;
use nalgebra::DVector;
use thiserror::Error;

/// A motion that looks the same at all times except for its place: steady quasi-velocities, and no change of the coordinates that the
/// equations depend on.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// Configuration at time zero.
    pub q: Vec<f64>,
    /// Velocity.
    pub v: Vec<f64>,
    /// The system's own quasi-velocities. At rest they are all zero.
    pub xi: Vec<f64>,
    /// The coordinates that the equations depend on, the shape; all other coordinates are cyclic.
    pub shape: Vec<usize>,
    /// The shape, and the coordinates that the constraints on positions determine by it.
    pub place: Vec<usize>,
    /// The number of directions that the linear equations leave at rest: the parameters of its family; 0 if it stands alone.
    pub family: usize,
    /// The eigenvalues of the flow in shape and quasi-velocities, real and imaginary parts (1/s), the largest real part first: along the
    /// directions that the constraints on positions leave.
    pub flow: Vec<[f64; 2]>,
    /// Whether no eigenvalue of the flow has a positive real part, but for rounding.
    pub stable: bool,
}

impl Equilibrium {
    /// Whether nothing moves except by the constraints.
    pub(super) fn is_rest(&self) -> bool {
        self.xi.iter().all(|xi| *xi == 0.0)
    }

    /// The first `n` coordinates and `free` quasi-velocities.
    pub(super) fn point(&self, (n, free): (usize, usize)) -> DVector<f64> {
        [filled(n, &self.q), filled(free, &self.xi)].concat().into()
    }
}

/// The equilibria found, and the extent of the search.
#[derive(Debug, Clone, PartialEq)]
pub struct RelativeEquilibria {
    /// The fastest first, rest last.
    pub found: Vec<Equilibrium>,
    /// The number of places from which rest was searched, the start among them.
    pub places: usize,
    /// The largest distance of these places from the start in a coordinate (m or rad).
    pub reach: f64,
    /// The number of velocities from which steady motions were searched.
    pub motions: usize,
}

/// Why there are no relative equilibria.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum EquilibriumError {
    /// There are no reduced equations.
    #[error(transparent)]
    Reduced(#[from] ReducedError),
    /// They are degenerate.
    #[error("the equations of motion are degenerate: {0}")]
    Singular(#[from] Singular),
    /// They have no finite value at the start, nor near it.
    #[error("the equations of motion have no finite value at the start, nor at places near it")]
    NotFinite,
    /// The constraints leave no velocity free.
    #[error("every velocity is imposed: the scene has no free motion that could be steady")]
    NothingFree,
    /// Something acts that depends on time.
    #[error("forces or constraints depend on time: a scene that depends on time has no steady motion")]
    TimeDependent,
    /// The search found no equilibrium.
    #[error(
        "no steady motion was found: rest was looked for from {places} places up to {reach} from the start in each \
            coordinate, and steady motions from {motions} velocities; there may be none, or one far from the start: begin \
            nearer to where one may be"
    )]
    NoneFound {
        /// The number of places.
        places: usize,
        /// Their largest distance from the start (m or rad).
        reach: f64,
        /// The number of velocities.
        motions: usize,
    },
}

/// Relative equilibria of a system: rest near its start and at places around it, and steady motions near its start and near motions of its
/// energy. The first coordinates and constraints, in the numbers `own`, are its own; further ones fill up its shape, and rest.
///
/// The coordinates that the reduced equations `xi' = f(q, xi)` do not depend on are cyclic, and free to change. Searched are the roots of
/// `f`, of the rates of the other coordinates, and of the functions of the constraints on positions. Rest is searched from the start and
/// from places around it, which are always the same; steady motions from the start and from motions along each basis vector with the
/// kinetic energy of the start. Of a family of motions, and of two with as many unstable directions, one is given. Motions that are
/// steady only with respect to a symmetry that is none of the coordinates, as circles about the middle of a round bowl, are not among
/// them. (Bloch 2003, Nonholonomic Mechanics and Control, section 5.)
///
/// # Errors
/// [`EquilibriumError`].
pub fn relative_equilibria(
    system: &dyn Mechanism,
    own: (usize, usize),
    q: &[f64],
    v: &[f64],
) -> Result<RelativeEquilibria, EquilibriumError> {
    let own = own_counts(system, own);
    if own.1 == 0 {
        return Err(EquilibriumError::NothingFree);
    }
    let all = system.size().n;
    Searching::new(system, own, (filled(all, q), filled(all, v)))?.all()
}
