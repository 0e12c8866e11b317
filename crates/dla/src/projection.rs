use crate::dependent::{independent_rows, rows_left_out};
use crate::{Equations, Newton, NewtonError, Stage, StepError};
use lagrangian::linear::Singular;
use lagrangian::{
    AdmissibleBasis, HyperDual, Rows, Saddle, System, constraint_residual, mass_matrix, momentum, reaction_rows,
};
use std::array::from_fn;

/// The equations for the velocity at the end of a step, with the multiplier there:
/// `L_v(q1, v1) = p1 + A(q1)' mu`, `A(q1) v1 + b(q1) = 0`. Of a constraint `phi = 0` that is not affine, `A` is `phi_v(q1, v1)`.
pub(crate) struct Projection<'a, Sys, const N: usize, const M: usize> {
    system: &'a Sys,
    t1: f64,
    q1: [f64; N],
    p1: [f64; N],
    basis: Option<AdmissibleBasis<f64, N, M>>,
    some: Option<Rows>,
    mu: [f64; M],
}

impl<'a, Sys: System<N, M>, const N: usize, const M: usize> Projection<'a, Sys, N, M> {
    pub(crate) fn new(
        system: &'a Sys,
        t1: f64,
        q1: [f64; N],
        p1: [f64; N],
        basis: Option<AdmissibleBasis<f64, N, M>>,
    ) -> Self {
        Self { system, t1, q1, p1, basis, some: None, mu: [0.0; M] }
    }

    /// For some of the rows alone, where they are given.
    #[inline(always)]
    pub(crate) fn of(mut self, some: Option<Rows>) -> Self {
        self.some = some;
        self
    }

    /// `v1` and `mu`, from a first guess of `v1`.
    #[inline(always)]
    pub(crate) fn solve(mut self, newton: &Newton, guess: [f64; N]) -> Result<([f64; N], [f64; M]), NewtonError> {
        let mut v1 = guess;
        newton.solve(&mut self, &mut v1)?;
        Ok((v1, self.mu))
    }
}

/// The velocity that meets the constraints, by the impulse that they give one that does not: `L_v(q, v1) = L_v(q, v) + A' mu`.
/// Rows that depend on one another and agree are no obstacle.
///
/// # Errors
/// [`StepError::Newton`] where the constraints do not determine it, [`StepError::Dependent`] where rows drop or disagree.
pub(crate) fn project<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> Result<[f64; N], StepError> {
    let (p, newton) = (momentum(system, t, q, v), Newton::default());
    let fail = |source| StepError::Newton { stage: Stage::Projection, source };
    let all = Projection::new(system, t, *q, p, system.admissible_basis(t, q));
    let error = match all.solve(&newton, *v) {
        Ok((v1, _)) => return Ok(v1),
        Err(source) => fail(source),
    };
    if !error.is_singular() {
        return Err(error);
    }
    let rows = independent_rows(system, t, q, v, error)?;
    let (v1, _) = Projection::new(system, t, *q, p, None).of(Some(rows)).solve(&newton, *v).map_err(fail)?;
    rows_left_out(system, t, q, &v1, rows)?;
    Ok(v1)
}

impl<Sys: System<N, M>, const N: usize, const M: usize> Equations<N> for Projection<'_, Sys, N, M> {
    #[inline]
    fn correction(&mut self, v1: &[f64; N]) -> Result<[f64; N], Singular> {
        let (p, mut mass) = mass_matrix(self.system, self.t1, &self.q1, v1);
        let a1 = reaction_rows(self.system, self.t1, &self.q1, v1);
        let slip = constraint_residual(self.system, self.t1, &self.q1, v1);
        // The reaction of a constraint that is not affine turns with the velocity.
        let unit = |i: usize| from_fn(|k| f64::from(u8::from(k == i)));
        let in_v = from_fn(|i| HyperDual::linear(v1[i], unit(i), unit(i)));
        let phi = self.system.nonlinear(HyperDual::fixed(self.t1), &self.q1.map(HyperDual::fixed), &in_v);
        if let Some(phi) = phi {
            for (mu, phi) in self.mu.iter().zip(phi) {
                let phi: HyperDual<f64, N, N> = phi.unwrap_or(HyperDual::fixed(0.0));
                mass = from_fn(|i| from_fn(|j| mass[i][j] - mu * phi.e12[i][j]));
            }
        }
        let saddle = Saddle {
            block: mass,
            transposed: a1,
            rows: a1,
            right: from_fn(|i| self.p1[i] - p[i]),
            level: slip.map(|s| -s),
        };
        if let Some(rows) = self.some {
            let (correction, minus_mu) = saddle.solve_some(rows)?;
            self.mu = minus_mu.map(|m| -m);
            return Ok(correction);
        }
        let (correction, minus_mu) = saddle.solve(self.basis.as_ref())?;
        self.mu = minus_mu.map(|m| -m);
        Ok(correction)
    }
}
