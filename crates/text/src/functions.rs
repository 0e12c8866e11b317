use crate::TextModel;
use crate::reduced::SharedEquations;
use crate::tapes::TapePoint;
use lagrangian::{AdmissibleBasis, Constraint, Pivots, Reduced, Scalar, System};
use nalgebra::DMatrix;
use std::sync::Arc;

/// The functions of a system of text, of `N` coordinates and `M` constraints, on any numbers: what [`TextSystem`](crate::TextSystem) asks
/// seldom follows from them by automatic derivatives.
///
/// A smaller text is padded to this shape: each further coordinate belongs to a unit mass that rests at zero, and each further constraint
/// holds one such coordinate. The padding is exact and does not influence the motion, since all its terms are zero.
#[derive(Debug, Clone)]
pub struct TextFunctions<const N: usize, const M: usize> {
    pub(crate) model: Arc<TextModel>,
    /// The rates that have the same kinetic energy.
    sizes: Arc<[f64]>,
    pub(crate) pivots: Pivots,
    pub(crate) equations: SharedEquations,
    /// The sides of the corners in time on this smooth piece.
    pub(crate) sides: Arc<[f64]>,
}

/// Compares all fields but the reduced equations, which follow from the others.
impl<const N: usize, const M: usize> PartialEq for TextFunctions<N, M> {
    fn eq(&self, other: &Self) -> bool {
        (&self.model, &self.sizes, self.pivots, &self.sides) == (&other.model, &other.sizes, other.pivots, &other.sides)
    }
}

impl<const N: usize, const M: usize> TextFunctions<N, M> {
    /// Whether the shape has room for this number of coordinates and constraints. Each padding constraint needs a padding coordinate.
    #[must_use]
    pub const fn has_room(coordinates: usize, constraints: usize) -> bool {
        coordinates <= N && constraints <= M && coordinates - constraints <= N - M
    }

    /// The system in this shape. If the text gives no basis, the system has one for the neighbourhood of `q` at the time `t` (s).
    /// Returns `None` if the shape has no room for the model.
    #[must_use]
    pub fn new(model: Arc<TextModel>, t: f64, q: &[f64]) -> Option<Self> {
        let (n, m) = (model.coordinates().len(), model.constraints());
        if m > n || !Self::has_room(n, m) || q.len() < n {
            return None;
        }
        let (rows, _) = model.rows_at(t, &q[..n]);
        let sizes: Arc<[f64]> = model.sizes(t, &q[..n]).into();
        let pivots = Pivots::best(&rows, &sizes);
        let equations = model.equations.of(model.basis_number(&pivots));
        Some(Self { model, sizes, pivots, equations, sides: Arc::new([]) })
    }

    fn with(&self, model: &Arc<TextModel>, pivots: Pivots) -> Self {
        let (model, equations) = (Arc::clone(model), model.equations.of(model.basis_number(&pivots)));
        let (sizes, sides) = (Arc::clone(&self.sizes), Arc::clone(&self.sides));
        Self { model, sizes, pivots, equations, sides }
    }

    /// The model that the texts describe.
    #[must_use]
    pub fn model(&self) -> &Arc<TextModel> {
        &self.model
    }

    pub(crate) fn n(&self) -> usize {
        self.model.coordinates.len()
    }

    pub(crate) fn m(&self) -> usize {
        self.model.constraints()
    }

    /// The same system with the basis of this number; zero keeps its basis.
    pub(crate) fn rebased(&self, basis: u64) -> Self {
        let pivots = if basis == 0 { self.pivots } else { Pivots::numbered(basis, self.m()) };
        self.with(&self.model, pivots)
    }

    /// The smooth piece that holds at the time `t` (s).
    pub(crate) fn piece(&self, t: f64) -> Self {
        match &self.model.pieces {
            Some(pieces) => Self { sides: pieces.corners.sides(t).into(), ..self.of_model(&pieces.model) },
            None => self.clone(),
        }
    }

    /// The same system with another model, which must have the same coordinates and constraints.
    pub(crate) fn of_model(&self, model: &Arc<TextModel>) -> Self {
        self.with(model, self.pivots)
    }

    pub(crate) fn point<'a, S>(&'a self, p: &'a [S], t: S, q: &'a [S; N], v: &'a [S]) -> TapePoint<'a, S> {
        let n = self.n();
        TapePoint { t, q: &q[..n], v: if v.is_empty() { v } else { &v[..n] }, p, sides: &self.sides }
    }
}

/// The functions of the system at the values `p` of the parameters that its model leaves free.
impl<const N: usize, const M: usize> TextFunctions<N, M> {
    pub(crate) fn lagrangian_at<S: Scalar>(&self, p: &[S], t: S, q: &[S; N], v: &[S; N]) -> S {
        let n = self.n();
        let mut lagrangian = S::zero();
        self.model.lagrangian.evaluate(n, self.point(p, t, q, v), |_, x| lagrangian = x);
        for rate in &v[n..] {
            lagrangian += rate.squared() * 0.5;
        }
        lagrangian
    }

    /// `L_v`.
    pub(crate) fn momentum_at<S: Scalar>(&self, p: &[S], t: S, q: &[S; N], v: &[S; N]) -> [S; N] {
        let n = self.n();
        let mut momentum = [S::zero(); N];
        momentum[n..].copy_from_slice(&v[n..]);
        self.model.momentum.evaluate(n, self.point(p, t, q, v), |i, x| momentum[i] = x);
        momentum
    }

    /// `L_q` and `L_v`.
    pub(crate) fn slopes_at<S: Scalar>(&self, p: &[S], t: S, q: &[S; N], v: &[S; N]) -> [[S; N]; 2] {
        let n = self.n();
        let mut slopes = [[S::zero(); N]; 2];
        slopes[1][n..].copy_from_slice(&v[n..]);
        self.model.slopes.evaluate(n, self.point(p, t, q, v), |k, x| slopes[k / n][k % n] = x);
        slopes
    }

    pub(crate) fn constraint_at<S: Scalar>(&self, p: &[S], t: S, q: &[S; N]) -> Constraint<S, N, M> {
        let (n, m) = (self.n(), self.m());
        let (mut a, mut b) = ([[S::zero(); N]; M], [S::zero(); M]);
        self.model.constraint.evaluate(n, self.point(p, t, q, &[]), |k, x| match k.checked_sub(n * m) {
            Some(row) => b[row] = x,
            None => a[k / n][k % n] = x,
        });
        for (k, row) in a.iter_mut().enumerate().skip(m) {
            row[n + k - m] = S::constant(1.0);
        }
        (a, b)
    }

    pub(crate) fn force_at<S: Scalar>(&self, p: &[S], t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        let formulas = self.model.force.as_ref()?;
        let mut force = [S::zero(); N];
        formulas.evaluate(self.n(), self.point(p, t, q, v), |i, x| force[i] = x);
        Some(force)
    }

    pub(crate) fn basis_at<S: Scalar>(&self, p: &[S], t: S, q: &[S; N]) -> AdmissibleBasis<S, N, M> {
        self.basis_of(p, t, q, || self.constraint_at(p, t, q).0)
    }

    /// The basis, if the constraint has these rows.
    pub(crate) fn basis_of<S: Scalar>(
        &self,
        p: &[S],
        t: S,
        q: &[S; N],
        rows: impl FnOnce() -> [[S; N]; M],
    ) -> AdmissibleBasis<S, N, M> {
        let (n, m) = (self.n(), self.m());
        let mut vectors = match &self.model.basis {
            Some(formulas) => {
                let mut vectors = [[S::zero(); N]; N];
                formulas.evaluate(n, self.point(p, t, q, &[]), |k, x| vectors[k / n][k % n] = x);
                vectors
            }
            None => self.pivots.basis(n, rows()),
        };
        // The coordinates that are held by no constraint rest by themselves.
        for (vector, i) in vectors[n - m..].iter_mut().zip(n + M - m..N) {
            vector[i] = S::constant(1.0);
        }
        AdmissibleBasis::from_fn(|k| vectors[k])
    }

    pub(crate) fn holonomic_at<S: Scalar>(&self, p: &[S], t: S, q: &[S; N]) -> Option<[Option<S>; M]> {
        let first = self.model.velocities;
        if self.model.positions == 0 {
            return None;
        }
        let mut functions = [None; M];
        functions[first..first + self.model.positions].fill(Some(S::zero()));
        self.model.holonomic.evaluate(self.n(), self.point(p, t, q, &[]), |k, x| functions[first + k] = Some(x));
        Some(functions)
    }
}

impl<const N: usize, const M: usize> System<N, M> for TextFunctions<N, M> {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> S {
        self.lagrangian_at(&[], t, q, v)
    }

    fn constraint<S: Scalar>(&self, t: S, q: &[S; N]) -> Constraint<S, N, M> {
        self.constraint_at(&[], t, q)
    }

    fn force<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        self.force_at(&[], t, q, v)
    }

    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<AdmissibleBasis<S, N, M>> {
        Some(self.basis_at(&[], t, q))
    }

    fn near(&self, t: f64, q: &[f64; N], basis: u64) -> Option<(Self, u64)> {
        if self.model.basis.is_some() || self.m() == 0 {
            return None;
        }
        let (n, m) = (self.n(), self.m());
        let there = (basis != 0).then(|| Pivots::numbered(basis, m));
        let there = there.filter(|pivots| pivots.are_good(n, self.constraint(t, q).0, &self.sizes));
        let pivots = there.unwrap_or_else(|| {
            let rows = self.constraint(t, q).0;
            Pivots::best(&DMatrix::from_fn(m, n, |k, i| rows[k][i]), &self.sizes)
        });
        Some((self.with(&self.model, pivots), pivots.number()))
    }

    fn holonomic<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<[Option<S>; M]> {
        self.holonomic_at(&[], t, q)
    }

    fn reduced(&self) -> impl Reduced<N, M> {
        self
    }

    fn angles(&self) -> [bool; N] {
        let coordinates = &self.model.coordinates;
        std::array::from_fn(|i| coordinates.get(i).is_some_and(|coordinate| coordinate.unit == crate::Unit::Angle))
    }
}
