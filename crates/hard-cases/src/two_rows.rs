use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};
use models::CompoundPendulum;
use sleigh::Sleigh;

/// The systems of cases with two constraints, of one type, so that every method is compiled once for all of them.
#[derive(Debug, Clone, Copy)]
pub enum TwoRows {
    /// Two blades side by side, parallel: the second says what the first does.
    Parallel(Sleigh),
    /// A blade, and a guide `(x - 1) theta' = 0`, which lets go at `x = 1 m`.
    Guide(Sleigh),
    /// A pendulum whose hinge is given by its rates alone.
    Pendulum(CompoundPendulum),
}

impl System<3, 2> for TwoRows {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        match self {
            Self::Parallel(sleigh) | Self::Guide(sleigh) => sleigh.lagrangian(t, q, v),
            Self::Pendulum(pendulum) => pendulum.lagrangian(t, q, v),
        }
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 2> {
        let zero = S::zero();
        match self {
            Self::Parallel(sleigh) => {
                let ([blade], _) = sleigh.constraint(t, q);
                ([blade, blade], [zero; 2])
            }
            Self::Guide(sleigh) => {
                let ([blade], _) = sleigh.constraint(t, q);
                ([blade, [zero, zero, q[0] - 1.0]], [zero; 2])
            }
            Self::Pendulum(pendulum) => pendulum.constraint(t, q),
        }
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 2>> {
        match self {
            Self::Parallel(_) | Self::Guide(_) => None,
            Self::Pendulum(pendulum) => pendulum.admissible_basis(t, q),
        }
    }
    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }
}
