use crate::gradient_in_place;
use crate::linear::Singular;
use crate::second_in_velocity;
use crate::{
    AdmissibleBasis, Dual, HyperDual, Reduced as _, Rows, Saddle, System, constraint_residual, from_fn, mapped,
    reaction_rows, redundant_rows,
};
use std::ops::Add;
use thiserror::Error;

/// The continuous equations of motion at one state.
///
/// `d/dt L_v - L_q = F + A' lambda`, `d/dt (A v + b) = 0`. Of a constraint `phi(t, q, v) = 0` that is not affine, `A` is
/// `d phi / dv`, and its rate vanishes. Rows that depend on one another and agree are met by those that are independent, and the
/// multipliers of the others are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion<const N: usize, const M: usize> {
    /// Accelerations `v'`.
    pub acceleration: [f64; N],
    /// Multipliers `lambda`: the constraint forces are `A' lambda`.
    pub multiplier: [f64; M],
}

impl<const N: usize, const M: usize> Add for Motion<N, M> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            acceleration: from_fn(|i| self.acceleration[i] + other.acceleration[i]),
            multiplier: from_fn(|k| self.multiplier[k] + other.multiplier[k]),
        }
    }
}

/// Why the equations of motion do not determine the accelerations.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("the mass matrix on the constraint is degenerate at t = {}: {source}", crate::Shown(*time))]
pub struct MotionError {
    /// The time (s).
    pub time: f64,
    /// The matrix's defect.
    #[source]
    pub source: Singular,
}

impl<const N: usize, const M: usize> Motion<N, M> {
    /// The linear equations for the accelerations, by automatic derivatives: `M v' - A' lambda = F + L_q - (d/dt L_v at v' = 0)` and
    /// `A v' = -(d/dt (A v + b) at v' = 0)`, whose multipliers are `-lambda`.
    #[must_use]
    #[inline(always)]
    pub fn equations<Sys: System<N, M>>(system: &Sys, t: f64, q: &[f64; N], v: &[f64; N]) -> Saddle<N, M> {
        let mass = second_in_velocity(system, t, q, v).e12;

        // d/dt L_v at frozen acceleration: the derivative of L_v along (t', q', v') = (1, v, 0).
        let along_t = HyperDual::linear(t, [0.0; N], [1.0]);
        let along_q: [HyperDual<f64, N, 1>; N] = from_fn(|i| HyperDual::linear(q[i], [0.0; N], [v[i]]));
        let in_v = from_fn(|i| HyperDual::linear(v[i], from_fn(|k| if k == i { 1.0 } else { 0.0 }), [0.0]));
        let transport = system.lagrangian(along_t, &along_q, &in_v).e12;

        let l_q = gradient_in_place(system, t, q, v);
        let force = system.force(t, q, v);

        // d/dt (A v + b) at frozen acceleration.
        let along_t = Dual { re: t, eps: [1.0] };
        let along_q: [Dual<f64, 1>; N] = from_fn(|i| Dual { re: q[i], eps: [v[i]] });
        let rate = constraint_residual(system, along_t, &along_q, &mapped(v, Dual::fixed));

        let a = reaction_rows(system, t, q, v);
        Saddle {
            block: mass,
            transposed: a,
            rows: a,
            right: from_fn(|i| l_q[i] + force.map_or(0.0, |f| f[i]) - transport[i][0]),
            level: mapped(&rate, |r| -r.eps[0]),
        }
    }

    /// The motion of a system, by hand where that is known, else by automatic derivatives.
    ///
    /// # Errors
    /// [`MotionError`] where the mass matrix or the constraint is degenerate.
    #[inline]
    pub fn of<Sys: System<N, M>>(system: &Sys, t: f64, q: &[f64; N], v: &[f64; N]) -> Result<Self, MotionError> {
        match system.reduced().motion(t, q, v) {
            Some(by_hand) => Ok(by_hand),
            None => Self::automatic(system, t, q, v),
        }
    }

    /// The equations of motion of any system, by automatic derivatives.
    ///
    /// # Errors
    /// [`MotionError`] where the mass matrix or the constraint is degenerate.
    pub fn automatic<Sys: System<N, M>>(system: &Sys, t: f64, q: &[f64; N], v: &[f64; N]) -> Result<Self, MotionError> {
        let saddle = Self::equations(system, t, q, v);
        let redundant = || redundant_rows(system, t, q, v);
        Self::solved(&saddle, t, system.admissible_basis(t, q).as_ref(), redundant)
    }

    /// The solution of the equations of motion at the time `t` (s), in a basis of the admissible velocities if there is one. If rows depend on
    /// one another, `redundant` gives the rows that imply the others.
    ///
    /// # Errors
    /// [`MotionError`] where the mass matrix or the constraint is degenerate.
    pub fn solved(
        saddle: &Saddle<N, M>,
        t: f64,
        basis: Option<&AdmissibleBasis<f64, N, M>>,
        redundant: impl FnOnce() -> Option<Rows>,
    ) -> Result<Self, MotionError> {
        let (acceleration, lambda) = solved(saddle, t, basis, redundant)?;
        Ok(Self { acceleration, multiplier: mapped(&lambda, |l| -l) })
    }
}

/// The solution of the equations of motion, or of equations with their matrices; of rows that depend on one another and agree the
/// independent ones alone are met.
pub(crate) fn solved<const N: usize, const M: usize>(
    saddle: &Saddle<N, M>,
    t: f64,
    basis: Option<&AdmissibleBasis<f64, N, M>>,
    redundant: impl FnOnce() -> Option<Rows>,
) -> Result<([f64; N], [f64; M]), MotionError> {
    saddle
        .solve(basis)
        .or_else(|source| redundant().map_or(Err(source), |rows| saddle.solve_some(rows)))
        .map_err(|source| MotionError { time: t, source })
}
