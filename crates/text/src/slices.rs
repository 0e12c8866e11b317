use crate::TextModel;
use crate::tapes::{TapePoint, Tapes};
use lagrangian::{Dual, Scalar};

/// The functions of a system of text on slices as long as the system has coordinates, on any numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TextSlices<'a, S> {
    pub(crate) model: &'a TextModel,
    /// The sides of the corners in time on this smooth piece.
    pub(crate) sides: &'a [f64],
    /// The free parameters; empty if the system has a value for each parameter.
    pub(crate) p: &'a [S],
}

/// The linear equations for accelerations and multipliers, matrices by rows: `block a - rows' lambda = right`, `rows a = level`.
pub(crate) struct SlicedMotion<S> {
    pub(crate) block: Vec<S>,
    pub(crate) rows: Vec<S>,
    pub(crate) right: Vec<S>,
    pub(crate) level: Vec<S>,
}

impl<'a, S: Scalar> TextSlices<'a, S> {
    pub(crate) fn of(model: &'a TextModel, sides: &'a [f64]) -> Self {
        Self { model, sides, p: &[] }
    }

    pub(crate) fn n(&self) -> usize {
        self.model.coordinates.len()
    }

    pub(crate) fn m(&self) -> usize {
        self.model.constraints()
    }

    /// The values of some formulas.
    fn all(&self, count: usize, of: &Tapes, t: S, q: &[S], v: &[S]) -> Vec<S> {
        let mut all = vec![S::zero(); count];
        of.evaluate(self.n(), TapePoint { t, q, v, p: self.p, sides: self.sides }, |k, x| all[k] = x);
        all
    }

    pub(crate) fn lagrangian(&self, t: S, q: &[S], v: &[S]) -> S {
        self.all(1, &self.model.lagrangian, t, q, v)[0]
    }

    /// `L_q`, then `L_v`.
    pub(crate) fn slopes(&self, t: S, q: &[S], v: &[S]) -> Vec<S> {
        self.all(2 * self.n(), &self.model.slopes, t, q, v)
    }

    pub(crate) fn momentum(&self, t: S, q: &[S], v: &[S]) -> Vec<S> {
        self.all(self.n(), &self.model.momentum, t, q, v)
    }

    /// The forces; zeros if there are none.
    pub(crate) fn force(&self, t: S, q: &[S], v: &[S]) -> Vec<S> {
        self.model.force.as_ref().map_or_else(|| vec![S::zero(); self.n()], |force| self.all(self.n(), force, t, q, v))
    }

    /// `A` by rows, then `b`.
    pub(crate) fn constraint(&self, t: S, q: &[S]) -> Vec<S> {
        self.all((self.n() + 1) * self.m(), &self.model.constraint, t, q, &[])
    }

    /// `A v + b`.
    pub(crate) fn residual(&self, t: S, q: &[S], v: &[S]) -> Vec<S> {
        let constraint = self.constraint(t, q);
        let (a, b) = constraint.split_at(self.n() * self.m());
        let row = |k: usize| a[k * v.len()..].iter().zip(v).fold(b[k], |sum, (a, v)| sum + *a * *v);
        (0..self.m()).map(row).collect()
    }

    /// The functions of the constraints on positions, which are the last.
    pub(crate) fn positions(&self, t: S, q: &[S]) -> Vec<S> {
        self.all(self.model.positions, &self.model.holonomic, t, q, &[])
    }

    /// The mass matrix by rows, then `L_v`.
    pub(crate) fn mass(&self, t: S, q: &[S], v: &[S]) -> Vec<S> {
        self.all(self.n() * (self.n() + 1), &self.model.mass, t, q, v)
    }

    /// The equations for accelerations and multipliers at a state.
    pub(crate) fn motion(&self, t: S, q: &[S], v: &[S]) -> SlicedMotion<S>
    where
        Dual<S, 1>: Scalar,
    {
        let n = self.n();
        // Along the motion at frozen velocity, `(t', q', v') = (1, v, 0)`.
        let fixed = |x: &S| Dual { re: *x, eps: [S::zero()] };
        let along_t = Dual { re: t, eps: [S::constant(1.0)] };
        let along_q: Vec<_> = q.iter().zip(v).map(|(q, v)| Dual { re: *q, eps: [*v] }).collect();
        let still: Vec<_> = v.iter().map(fixed).collect();
        let p: Vec<_> = self.p.iter().map(fixed).collect();
        let along = TextSlices { model: self.model, sides: self.sides, p: &p };
        let (slopes, force) = (along.slopes(along_t, &along_q, &still), self.force(t, q, v));
        let mut block = self.mass(t, q, v);
        block.truncate(n * n);
        let mut rows = self.constraint(t, q);
        rows.truncate(n * self.m());
        let right = (0..n).map(|i| slopes[i].re + force[i] - slopes[n + i].eps[0]).collect();
        let level = along.residual(along_t, &along_q, &still).iter().map(|rate| -rate.eps[0]).collect();
        SlicedMotion { block, rows, right, level }
    }
}
