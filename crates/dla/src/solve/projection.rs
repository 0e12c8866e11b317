use crate::convergence::{most_roundings, parted, without_reaction};
use crate::dependent::{independent_rows, rows_left_out};
use crate::{Equations, Mechanics, Newton, NewtonError, Stage, StepError};
use lagrangian::linear::{Singular, largest, normal_solve};
use lagrangian::{AdmissibleBasis, FactoredSaddle, Rounded, Rows, Saddle, from_fn, mapped};

/// The equations for the velocity at the end of a step, with the multiplier there:
/// `L_v(q1, v1) = p1 + A(q1)' mu`, `A(q1) v1 + b(q1) = 0`. Of a constraint `phi = 0` that is not affine, `A` is `phi_v(q1, v1)`.
pub(crate) struct Projection<'a, const N: usize, const M: usize> {
    system: &'a dyn Mechanics<N, M>,
    t1: f64,
    q1: [f64; N],
    p1: [f64; N],
    basis: Option<AdmissibleBasis<f64, N, M>>,
    some: Option<Rows>,
    mu: [f64; M],
    /// Whether the reaction is subtracted before the linear equations are solved, as for the increment.
    refined: bool,
}

/// The velocity at the end of a step, and the impulse of the constraints there.
pub(crate) struct Projected<const N: usize, const M: usize> {
    pub(crate) v1: [f64; N],
    pub(crate) mu: [f64; M],
    /// The mass matrix, if one correction and a simplified one were enough, as for a Lagrangian that is quadratic in the velocities with
    /// affine constraints.
    pub(crate) mass: Option<[[f64; N]; N]>,
}

impl<'a, const N: usize, const M: usize> Projection<'a, N, M> {
    pub(crate) fn new(
        system: &'a dyn Mechanics<N, M>,
        t1: f64,
        q1: [f64; N],
        p1: [f64; N],
        basis: Option<AdmissibleBasis<f64, N, M>>,
    ) -> Self {
        Self { system, t1, q1, p1, basis, some: None, mu: [0.0; M], refined: false }
    }

    /// Restricts the equations to some of the rows, if they are given.
    #[inline(always)]
    pub(crate) fn of(mut self, some: Option<Rows>) -> Self {
        self.some = some;
        self
    }

    /// `v1` and `mu`, from a first guess of `v1`.
    #[inline(always)]
    pub(crate) fn solve(self, newton: &Newton, guess: [f64; N]) -> Result<Projected<N, M>, NewtonError> {
        if self.some.is_none()
            && let Some(solution) = self.at_once(newton, &guess)
        {
            return Ok(solution);
        }
        self.searched(newton, guess)
    }

    #[cold]
    #[inline(never)]
    fn searched(mut self, newton: &Newton, guess: [f64; N]) -> Result<Projected<N, M>, NewtonError> {
        let mut v1 = guess;
        newton.solve(&mut self, &mut v1)?;
        Ok(Projected { v1, mu: self.mu, mass: None })
    }

    /// As [`Self::solve`], by one correction and a simplified one, which are enough for a Lagrangian that is quadratic in the velocities.
    /// Both are made in the same configuration, so the rows and the mass matrix are evaluated once.
    ///
    /// Not inlined, so that its matrices are not on the stack while the mean velocity is solved for.
    #[inline(never)]
    fn at_once(&self, newton: &Newton, guess: &[f64; N]) -> Option<Projected<N, M>> {
        let Self { system, t1, q1, p1, basis, .. } = self;
        if system.is_nonlinear(*t1, q1, guess) {
            return None;
        }
        let (p, mass) = system.mass_matrix(*t1, q1, guess);
        let (a1, b1) = system.constraint(*t1, q1);
        let slip = |v: &[f64; N]| -> [f64; M] { from_fn(|k| -(0..N).fold(b1[k], |sum, i| sum + a1[k][i] * v[i])) };
        let factors = FactoredSaddle::new(&mass, &a1, &a1, basis.as_ref()).ok()?;

        let missing: [f64; N] = from_fn(|i| p1[i] - p[i]);
        let first = factors.solve(&missing, &slip(guess), basis.as_ref());
        let v1: [f64; N] = from_fn(|i| guess[i] + first[i]);
        let p = system.momentum(*t1, q1, &v1);
        let missing: [f64; N] = from_fn(|i| p1[i] - p[i]);
        let second = factors.solve(&missing, &slip(&v1), basis.as_ref());
        let v1: [f64; N] = from_fn(|i| v1[i] + second[i]);

        // The convergence test of `Newton`; below the round-off of the largest component all is round-off.
        let size = newton.tolerance * largest(&v1);
        let settled = (0..N).all(|i| {
            let d = second[i].abs();
            d <= size || 2.0 * d * d <= newton.tolerance * (first[i] * v1[i]).abs()
        });
        let left = from_fn(|i| (0..N).map(|j| mass[i][j] * second[j]).sum::<f64>() - missing[i]);
        let mu = normal_solve(&a1, &left).ok()?;
        settled.then_some(Projected { v1, mu, mass: Some(mass) })
    }
}

/// The velocity that meets the constraints, after the impulse that they give to the velocity `v`: `L_v(q, v1) = L_v(q, v) + A' mu`. Rows
/// may be dependent if they are consistent.
///
/// # Errors
/// [`StepError::Newton`] if the constraints do not determine the velocity, [`StepError::Dependent`] if rows drop or disagree.
pub(crate) fn project<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> Result<[f64; N], StepError> {
    let (p, newton) = (system.momentum(t, q, v), Newton::default());
    let fail = |source| StepError::Newton { stage: Stage::Projection, source };
    let all = Projection::new(system, t, *q, p, system.basis(t, q));
    let error = match all.solve(&newton, *v) {
        Ok(Projected { v1, .. }) => return Ok(v1),
        Err(source) => fail(source),
    };
    if !error.is_singular() {
        return Err(error);
    }
    let rows = independent_rows(system, t, q, v, error)?;
    let Projected { v1, .. } =
        Projection::new(system, t, *q, p, None).of(Some(rows)).solve(&newton, *v).map_err(fail)?;
    rows_left_out(system, t, q, &v1, rows)?;
    Ok(v1)
}

impl<const N: usize, const M: usize> Equations<N> for Projection<'_, N, M> {
    #[cold]
    #[inline(never)]
    fn roundings(&self, v1: &[f64; N]) -> Option<f64> {
        let Self { system, t1, q1, p1, some, .. } = *self;
        let (t, q, v) = (Rounded::exact(t1), mapped(&q1, Rounded::exact), mapped(v1, Rounded::once));
        let p = system.momentum_rounded(t, &q, &v);
        let left = without_reaction(&system.reaction_rows(t1, &q1, v1), from_fn(|i| p[i] + -p1[i]));
        let slip = system.residual_rounded(t, &q, &v);
        let solved = (0..M).filter(|k| some.is_none_or(|rows| rows.contains(*k)));
        Some(most_roundings(left.into_iter().chain(solved.map(|k| slip[k]))))
    }

    fn refine(&mut self) -> bool {
        !std::mem::replace(&mut self.refined, true)
    }

    #[inline]
    fn correction(&mut self, v1: &[f64; N]) -> Result<[f64; N], Singular> {
        let (p, mut mass) = self.system.mass_matrix(self.t1, &self.q1, v1);
        let a1 = self.system.reaction_rows(self.t1, &self.q1, v1);
        let slip = self.system.residual(self.t1, &self.q1, v1);
        // The reaction of a constraint that is not affine turns with the velocity.
        self.system.add_reaction_curvature(self.t1, (&self.q1, v1), &mapped(&self.mu, |mu| -mu), &mut mass);
        let missing = from_fn(|i| self.p1[i] - p[i]);
        let parted = if self.refined && self.some.is_none() { parted(&a1, &missing) } else { None };
        let (right, taken) = parted.unwrap_or((missing, [0.0; M]));
        let saddle = Saddle { block: mass, transposed: a1, rows: a1, right, level: mapped(&slip, |s| -s) };
        let (correction, minus_mu) = match self.some {
            Some(rows) => saddle.solve_some(rows)?,
            None => saddle.solve(self.basis.as_ref())?,
        };
        self.mu = from_fn(|k| -minus_mu[k] - taken[k]);
        Ok(correction)
    }
}
