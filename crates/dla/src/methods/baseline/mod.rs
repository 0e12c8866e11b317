//! Integrators to compare with, on the continuous equations of motion: the classical Runge-Kutta method in three forms, the
//! implicit midpoint rule, and an adaptive method of high order.

mod dop853;
mod implicit_midpoint;
mod reduced_point;
mod rk4;
mod rk4_reduced;

pub use dop853::Dop853;
pub use implicit_midpoint::ImplicitMidpoint;
pub use rk4::{Rk4, Rk4Projected};
pub use rk4_reduced::Rk4Reduced;

use crate::suspect::not_held_at_rest;
use crate::{Mechanics, StepError};
use lagrangian::from_fn;

/// `x + h k`.
#[inline(always)]
fn shifted<const N: usize>(x: &[f64; N], h: f64, k: &[f64; N]) -> [f64; N] {
    from_fn(|i| x[i] + h * k[i])
}

/// The increment `h/6 (k1 + 2 k2 + 2 k3 + k4)`. (Kutta 1901; Hairer, Norsett and Wanner 1993, section II.1.)
#[inline(always)]
fn weighted<const N: usize>(h: f64, k: &[[f64; N]; 4]) -> [f64; N] {
    from_fn(|i| h / 6.0 * (k[0][i] + 2.0 * (k[1][i] + k[2][i]) + k[3][i]))
}

/// Where the four stages are evaluated, as fractions of the step; each uses the slope of the one before it.
pub(crate) const STAGES: [f64; 4] = [0.0, 0.5, 0.5, 1.0];

/// Fails if dry friction holds the system at rest, where the velocities of the stages lie on both sides of zero.
#[inline(always)]
fn moving<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    velocities: &[[f64; N]; 4],
) -> Result<(), StepError> {
    let [first, others @ ..] = velocities;
    let turned = |v: &&[f64; N]| (0..N).any(|i| v[i] * first[i] <= 0.0 && (v[i] - first[i]).abs() > 0.0);
    others.iter().find(turned).map_or(Ok(()), |v| not_held_at_rest(system, t, q, v))
}
