use crate::{AdmissibleBasis, Constraint, Piecewise, Pivots, Scalar, System, mass_matrix};
use nalgebra::DMatrix;

/// Adds a basis of admissible velocities, found by elimination, to a system without one.
///
/// Each constraint is solved for one rate. The pivots are the best conditioned ones at a configuration, and are replaced at a node if they
/// have become bad there. The methods that move along a basis can thus take every system whose constraints are affine and independent, with
/// up to seven constraints and sixteen coordinates. A step clones the system.
///
/// A `dla::Rebased` method, as every method made by name is, replaces pivots at nodes; any other method keeps the first ones.
///
/// ```
/// use lagrangian::{Constraint, Scalar, System, WithBasis};
///
/// /// A blade, without a basis: neither `x'` nor `y'` can be solved for at every heading.
/// #[derive(Clone)]
/// struct Blade;
/// impl System<3, 1> for Blade {
///     fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
///         (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5
///     }
///     fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
///         let (sin, cos) = q[2].sin_cos();
///         ([[-sin, cos, S::zero()]], [S::zero()])
///     }
/// }
/// let blade = WithBasis::new(Blade, 0.0, &[0.0, 0.0, 0.0]);
/// let basis = blade.admissible_basis(0.0, &[0.0, 0.0, 0.1]).expect("the constraints are affine");
/// // The rate `x'` is free, and `y'` follows from it.
/// assert!((basis.vectors()[0][1] - 0.1_f64.tan()).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct WithBasis<Sys, const N: usize> {
    system: Sys,
    /// The sizes of rates with the same kinetic energy.
    sizes: [f64; N],
    pivots: Pivots,
}

impl<Sys, const N: usize> WithBasis<Sys, N> {
    /// The system, with a basis for the neighbourhood of the configuration `q` at the time `t` (s).
    #[must_use]
    pub fn new<const M: usize>(system: Sys, t: f64, q: &[f64; N]) -> Self
    where
        Sys: System<N, M>,
    {
        const {
            assert!(M <= Pivots::MOST_ROWS && N <= Pivots::MOST_COLUMNS, "at most 7 constraints and 16 coordinates");
        }
        let (_, mass) = mass_matrix(&system, t, q, &[0.0; N]);
        let mut sizes = [1.0; N];
        sizes.iter_mut().zip(Pivots::sizes((0..N).map(|i| mass[i][i]))).for_each(|(size, found)| *size = found);
        let pivots = best(&system.constraint(t, q).0, &sizes);
        Self { system, sizes, pivots }
    }

    /// The system itself.
    #[must_use]
    pub fn system(&self) -> &Sys {
        &self.system
    }
}

/// The pivots that are best conditioned for these rows.
fn best<const N: usize, const M: usize>(rows: &[[f64; N]; M], sizes: &[f64; N]) -> Pivots {
    Pivots::best(&DMatrix::from_fn(M, N, |k, i| rows[k][i]), sizes)
}

impl<Sys: System<N, M> + Clone, const N: usize, const M: usize> System<N, M> for WithBasis<Sys, N> {
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> S {
        self.system.lagrangian(t, q, v)
    }

    #[inline(always)]
    fn constraint<S: Scalar>(&self, t: S, q: &[S; N]) -> Constraint<S, N, M> {
        self.system.constraint(t, q)
    }

    #[inline(always)]
    fn force<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        self.system.force(t, q, v)
    }

    /// One vector for each rate that is free; none where a constraint is not affine.
    #[inline]
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<AdmissibleBasis<S, N, M>> {
        if self.system.nonlinear(t, q, &[S::zero(); N]).is_some() {
            return None;
        }
        let vectors = self.pivots.basis(N, self.system.constraint(t, q).0);
        Some(AdmissibleBasis::from_fn(|k| vectors[k]))
    }

    fn near(&self, t: f64, q: &[f64; N], basis: u64) -> Option<(Self, u64)> {
        if M == 0 {
            return None;
        }
        let rows = self.system.constraint(t, q).0;
        let there = (basis != 0).then(|| Pivots::numbered(basis, M));
        let there = there.filter(|pivots| pivots.are_good(N, rows, &self.sizes));
        let pivots = there.unwrap_or_else(|| best(&rows, &self.sizes));
        Some((Self { pivots, ..self.clone() }, pivots.number()))
    }

    #[inline(always)]
    fn holonomic<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<[Option<S>; M]> {
        self.system.holonomic(t, q)
    }

    #[inline(always)]
    fn nonlinear<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[Option<S>; M]> {
        self.system.nonlinear(t, q, v)
    }

    #[inline(always)]
    fn angles(&self) -> [bool; N] {
        self.system.angles()
    }
}

impl<Sys: Piecewise, const N: usize> Piecewise for WithBasis<Sys, N> {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        self.system.jumps(from, to)
    }
    fn piece(&self, t: f64) -> Self {
        Self { system: self.system.piece(t), ..*self }
    }
}
