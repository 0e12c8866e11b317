use crate::convergence::tolerances::{SHRINKING, is_slight};
use crate::convergence::{parted, rounding_of_place};
use crate::increment::{Departure, Increment};
use crate::{Discretisation, Equations, Mechanics, State};
use lagrangian::linear::{Singular, largest};
use lagrangian::{FactoredSaddle, Rounded, Rows, Saddle, from_fn, mapped};

/// The corrections of the mean velocity of a step: Newton's own, by one second-order evaluation, and then simplified ones, with its
/// Jacobian and first-order evaluations, as long as they converge as well.
pub(crate) struct Corrections<'e, 'a, D, const N: usize, const M: usize> {
    of: &'e Increment<'a, D, N, M>,
    /// The independent rows in the equations, if rows are dependent and consistent.
    pub(crate) some: Option<Rows>,
    /// Their multipliers.
    lambda: [f64; M],
    /// Whether the determinant of the last correction was positive; `None` if the correction used only some of the rows.
    positive: Option<bool>,
    /// The Jacobian of the last own correction of Newton, for the simplified ones after it.
    jacobian: Option<Jacobian<N, M>>,
    /// The last correction, and the momenta from which it was made.
    last: LastCorrection<N>,
    /// The correction before the last.
    before: [f64; N],
    /// Whether the reaction, the part of the momenta that the multipliers take up, is subtracted before the linear equations are solved: if
    /// the reaction is large, its round-off in their solution exceeds the round-off of the rest.
    refined: bool,
}

/// The derivatives of the equations in the mean velocity at one point: of the momenta, `K`, and of the discrete constraint.
#[derive(Clone, Copy)]
struct Jacobian<const N: usize, const M: usize> {
    block: [[f64; N]; N],
    factors: FactoredSaddle<N, M>,
}

/// A correction `d` at a mean velocity `v`.
#[derive(Clone, Copy)]
struct LastCorrection<const N: usize> {
    correction: [f64; N],
    simplified: bool,
    /// `r + K d`: the part of the momenta at the beginning that the multipliers balance, at `v + d`.
    rest: [f64; N],
    /// `D2 L_d + f_d^+ - K d`: with `dD2/dv = -K + O(h)` the momenta at the end, for a small `d` at `v + d`.
    arriving: [f64; N],
}

impl<const N: usize> Default for LastCorrection<N> {
    fn default() -> Self {
        let zero = [0.0; N];
        Self { correction: zero, simplified: false, rest: zero, arriving: zero }
    }
}

impl<const N: usize> LastCorrection<N> {
    #[inline(always)]
    fn new(correction: [f64; N], simplified: bool, at: &Departure<N>, block: &[[f64; N]; N]) -> Self {
        let gained: [f64; N] = from_fn(|i| (0..N).map(|j| block[i][j] * correction[j]).sum());
        let rest = from_fn(|i| at.residual[i] + gained[i]);
        Self { correction, simplified, rest, arriving: from_fn(|i| at.arriving[i] - gained[i]) }
    }
}

impl<'e, 'a, D: Discretisation<N, M>, const N: usize, const M: usize> Corrections<'e, 'a, D, N, M> {
    #[inline(always)]
    pub(crate) fn new(of: &'e Increment<'a, D, N, M>) -> Self {
        Self {
            of,
            some: None,
            lambda: [0.0; M],
            positive: None,
            jacobian: None,
            last: LastCorrection::default(),
            before: [0.0; N],
            refined: false,
        }
    }

    /// The derivatives of the momenta in the last own correction of Newton, if it solved for all rows.
    #[inline(always)]
    pub(crate) fn block(&self) -> Option<[[f64; N]; N]> {
        self.jacobian.as_ref().map(|jacobian| jacobian.block)
    }

    /// The momenta at the end, and the multipliers at the beginning, of a solution `v`.
    #[inline(always)]
    pub(crate) fn ends(&mut self, v: &[f64; N]) -> Result<([f64; N], [f64; M]), Singular> {
        // The first order in the last correction `d` leaves `O(h d)`.
        const SMALL: f64 = 16.0 * f64::EPSILON;
        if largest(&self.last.correction) > SMALL * largest(v) {
            let (at, _) = self.of.departure(v);
            (self.last.rest, self.last.arriving) = (at.residual, at.arriving);
        }
        let lambda = if self.some.is_some() { self.lambda } else { self.of.multipliers(&self.last.rest)? };
        Ok((self.last.arriving, lambda))
    }

    /// Whether the determinant has the sign that it has in a step of length zero, as far as both are known.
    #[inline(always)]
    pub(crate) fn continues(&self, positive: Option<bool>) -> bool {
        self.positive.zip(positive).is_none_or(|(here, at_rest)| here == at_rest)
    }

    /// The right side of the equations for a correction.
    #[inline(always)]
    fn right(&self, residual: &[f64; N]) -> [f64; N] {
        let parted = if self.refined { parted(&self.of.a0, residual) } else { None };
        let left = parted.map_or(*residual, |(left, _)| left);
        mapped(&left, |r| -r)
    }

    /// The simplified correction at `v`; `None` if it is not as good as Newton's own.
    #[inline(always)]
    fn simplified(&mut self, v: &[f64; N]) -> Option<[f64; N]> {
        let Some(Jacobian { block, factors }) = &self.jacobian else { return None };
        let (at, level) = self.of.departure(v);
        let correction = factors.solve(&self.right(&at.residual), &level, self.of.basis.as_ref());
        let size = largest(&correction);
        let good = size <= SHRINKING * largest(&self.last.correction) || is_slight(size, largest(v));
        if !good {
            return None;
        }
        self.last = LastCorrection::new(correction, true, &at, block);
        Some(correction)
    }
}

impl<D: Discretisation<N, M>, const N: usize, const M: usize> Equations<N> for Corrections<'_, '_, D, N, M> {
    #[inline(always)]
    fn correction(&mut self, v: &[f64; N]) -> Result<[f64; N], Singular> {
        self.before = self.last.correction;
        match self.simplified(v) {
            Some(correction) => Ok(correction),
            None => self.own_correction(v),
        }
    }

    /// A velocity that a correction was added to has the round-off of that correction too.
    fn roundings(&self, v: &[f64; N]) -> Option<f64> {
        let velocity = from_fn(|i| Rounded { value: v[i], size: v[i].abs() + self.before[i].abs() });
        Some(self.of.roundings(&velocity, self.some))
    }

    #[inline(always)]
    fn near(&self) -> f64 {
        rounding_of_place(&self.of.q0, self.of.h)
    }

    fn refine(&mut self) -> bool {
        !std::mem::replace(&mut self.refined, true)
    }

    #[inline(always)]
    fn is_simplified(&self) -> bool {
        self.last.simplified
    }
}

impl<D: Discretisation<N, M>, const N: usize, const M: usize> Corrections<'_, '_, D, N, M> {
    /// Newton's own correction, by one second-order evaluation.
    ///
    /// Not inlined: it is long, and called from each of the iterations that a step may make.
    #[inline(never)]
    fn own_correction(&mut self, v: &[f64; N]) -> Result<[f64; N], Singular> {
        let (at, block) = self.of.linearised(v);
        let (rows, level) = self.of.rows(v);
        let right = self.right(&at.residual);
        match self.solved(&block, &rows, &right, &level) {
            Ok((factors, correction)) => {
                self.positive = Some(factors.is_positive());
                self.jacobian = Some(Jacobian { block, factors });
                self.last = LastCorrection::new(correction, false, &at, &block);
                Ok(correction)
            }
            Err(source) => {
                // The state by value: a reference that escapes would keep it in memory in steps that succeed.
                let found = independent(self.of.system, self.of.t0, *self.of.state, self.some).ok_or(source)?;
                let (correction, lambda) = of_some(&block, &self.of.a0, &rows, (right, level), found)?;
                (self.some, self.lambda, self.positive, self.jacobian) = (Some(found), lambda, None, None);
                self.last = LastCorrection::new(correction, false, &at, &block);
                Ok(correction)
            }
        }
    }

    /// The correction with these derivatives, which also determine the multipliers.
    #[inline(always)]
    fn solved(
        &self,
        block: &[[f64; N]; N],
        rows: &[[f64; N]; M],
        right: &[f64; N],
        level: &[f64; M],
    ) -> Result<(FactoredSaddle<N, M>, [f64; N]), Singular> {
        let factors = FactoredSaddle::new(block, &self.of.a0, rows, self.of.basis.as_ref())?;
        if self.of.basis.is_some() {
            self.of.multipliers(right)?;
        }
        let correction = factors.solve(right, level, self.of.basis.as_ref());
        Ok((factors, correction))
    }
}

/// The correction and the multipliers of some of the rows. Not inlined, so that its arrays are not on the stack while the independent
/// rows are determined.
#[cold]
#[inline(never)]
fn of_some<const N: usize, const M: usize>(
    block: &[[f64; N]; N],
    a0: &[[f64; N]; M],
    rows: &[[f64; N]; M],
    (right, level): ([f64; N], [f64; M]),
    some: Rows,
) -> Result<([f64; N], [f64; M]), Singular> {
    Saddle { block: *block, transposed: *a0, rows: *rows, right, level }.solve_some(some)
}

/// The rows found before, or else independent rows that imply all rows at the beginning of the step.
#[cold]
#[inline(never)]
fn independent<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t0: f64,
    start: State<N>,
    found: Option<Rows>,
) -> Option<Rows> {
    found.or_else(|| system.redundant_rows(t0, start.q(), start.v()))
}
