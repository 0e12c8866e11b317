use crate::{NotANumber, not_a_number};
use lagrangian::{AdmissibleBasis, Dependence, RowSpace, Rows, Scalar, SeldomNumber, System, lagrangian_power, mapped};

/// The questions that a system answers after a step has failed, or before the first one.
pub trait Diagnosis<const N: usize, const M: usize> {
    /// The first function that is not finite at a state, or has no finite derivative there.
    fn not_a_number(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<NotANumber>;

    /// The span of the rows of the constraint at a state.
    fn row_space(&self, t: f64, q: &[f64; N], v: &[f64; N], tolerance: f64) -> RowSpace<N, M>;

    /// Rows that imply all rows, if the remaining ones depend on them everywhere nearby and agree; `None` otherwise.
    fn redundant_rows(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<Rows>;

    /// Whether the rank of the rows is the same nearby.
    fn rank_is_constant(&self, t: f64, q: &[f64; N], v: &[f64; N], space: &RowSpace<N, M>) -> bool;

    /// Whether rows that depend on others ask for the same velocities.
    fn rows_are_consistent(&self, t: f64, q: &[f64; N], v: &[f64; N], dependence: &Dependence<M>) -> bool;

    /// Whether constraints move: `b` or one of its derivatives in the coordinates is not zero.
    fn constraints_move(&self, t: f64, q: &[f64; N]) -> bool;

    /// Whether the Lagrangian, the constraint or the basis changes with time at a state.
    fn depends_on_time(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> bool;
}

impl<Sys: System<N, M>, const N: usize, const M: usize> Diagnosis<N, M> for Sys {
    fn not_a_number(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<NotANumber> {
        not_a_number(self, t, q, v)
    }

    fn row_space(&self, t: f64, q: &[f64; N], v: &[f64; N], tolerance: f64) -> RowSpace<N, M> {
        lagrangian::row_space(self, t, q, v, tolerance)
    }

    fn redundant_rows(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<Rows> {
        lagrangian::redundant_rows(self, t, q, v)
    }

    fn rank_is_constant(&self, t: f64, q: &[f64; N], v: &[f64; N], space: &RowSpace<N, M>) -> bool {
        lagrangian::rank_is_constant(self, t, q, v, space)
    }

    fn rows_are_consistent(&self, t: f64, q: &[f64; N], v: &[f64; N], dependence: &Dependence<M>) -> bool {
        lagrangian::rows_are_consistent(self, t, q, v, dependence)
    }

    fn constraints_move(&self, t: f64, q: &[f64; N]) -> bool {
        let still = |j: usize| {
            let (_, b) = System::constraint(self, SeldomNumber::fixed(t), &SeldomNumber::along_one(q, j));
            b.iter().all(Scalar::is_zero)
        };
        !(0..N).all(still)
    }

    fn depends_on_time(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> bool {
        // Numbers that are not finite fail later, and are named there.
        let mut changes = lagrangian_power(self, t, q, v).abs() > 0.0;
        let mut see = |x: &SeldomNumber| changes |= x.rate().abs() > 0.0;
        let (t, q) = (SeldomNumber::moving(t, 1.0), mapped(q, SeldomNumber::fixed));
        let (a, b) = System::constraint(self, t, &q);
        let basis = self.admissible_basis(t, &q);
        // Loops: iterators would be a dozen functions more for each system.
        for row in a.iter().chain(basis.as_ref().map_or(&[][..], AdmissibleBasis::vectors)) {
            for x in row {
                see(x);
            }
        }
        for x in &b {
            see(x);
        }
        changes
    }
}
