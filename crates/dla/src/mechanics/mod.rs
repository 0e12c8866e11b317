//! The questions that a method asks of a system.

mod automatic;
pub(crate) mod dependent;
mod diagnosis;
pub(crate) mod dropping;
pub(crate) mod known_angle;
pub(crate) mod not_a_number;
pub(crate) mod power;
pub(crate) mod reduced_field;
mod rounded;
mod seeded;
mod series;
pub(crate) mod start;
pub(crate) mod suspect;

pub use diagnosis::Diagnosis;
pub use rounded::RoundedMechanics;
pub use seeded::{FullMechanics, SeededMechanics};
pub use series::ReducedSeries;

use crate::gauss::{Collocation, CollocationOutcome};
use lagrangian::{
    AdmissibleBasis, Bracket, Constraint, ConstraintSlopes, Dual, EnergySlope, HyperDual, Lanes, Motion, MotionError,
    PowerSources, ReducedError, ReducedSlope, Smoothness,
};
use std::fmt;

/// The Lagrangian's first derivatives at a state, and the generalised forces there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slopes<const N: usize> {
    /// `L_q`.
    pub l_q: [f64; N],
    /// `L_v`, the momenta.
    pub l_v: [f64; N],
    /// `F`; `None` if there are no forces.
    pub force: Option<[f64; N]>,
}

/// The Lagrangian's first and second derivatives at a state, and the forces with their first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecondSlopes<const N: usize> {
    /// `L_q`.
    pub l_q: [f64; N],
    /// `L_qq`.
    pub l_qq: [[f64; N]; N],
    /// `L_qv`, row `i` and column `j` the derivative in `q_i` and `v_j`.
    pub l_qv: [[f64; N]; N],
    /// `L_v`.
    pub l_v: [f64; N],
    /// `L_vv`, the mass matrix.
    pub l_vv: [[f64; N]; N],
    /// The forces with their derivatives in the coordinates, and with their derivatives in the velocities.
    pub force: Option<[[Dual<f64, N>; N]; 2]>,
}

/// What a method asks of a system: values and derivatives as numbers, never a scalar that carries derivatives.
///
/// Every [`System`](lagrangian::System) is one, by automatic derivatives. The trait stands between methods and systems, and can be
/// an object, so that a method is compiled once for all systems of a shape `(N, M)`, and a system without any method. Entries
/// are whole questions: values that are asked for together share sines and other functions of the configuration; and no array of dual
/// numbers, mostly zeros, goes through memory at the call.
pub trait Mechanics<const N: usize, const M: usize>: RoundedMechanics<N, M> + Diagnosis<N, M> {
    /// Which coordinates are angles.
    fn angles(&self) -> [bool; N];

    /// The Lagrangian (J).
    fn lagrangian(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> f64;

    /// The energy `v . L_v - L` (J).
    fn energy(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> f64;

    /// The momenta `L_v`.
    fn momentum(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> [f64; N];

    /// The momenta, with `A` and `b` of the constraint at the same place.
    fn momentum_and_rows(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> ([f64; N], Constraint<f64, N, M>);

    /// The momenta and the mass matrix `L_vv`.
    fn mass_matrix(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> ([f64; N], [[f64; N]; N]);

    /// All first derivatives of the Lagrangian, and the forces.
    fn slopes(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Slopes<N>;

    /// All first and second derivatives of the Lagrangian.
    fn second_slopes(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> SecondSlopes<N>;

    /// The Lagrangian, with its gradients along two groups of directions, `(dq, dv) = (back, -1) e_i` and `(ahead, 1) e_j`, and the
    /// mixed second derivatives: what a node of a quadrature rule adds to `D1 L_d`, `D2 L_d` and `D1 D2 L_d`.
    fn at_node(&self, t: f64, q: &[f64; N], v: &[f64; N], back: f64, ahead: f64) -> HyperDual<f64, N, N>;

    /// The generalised forces; `None` if there are none.
    fn force(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<[f64; N]>;

    /// How smooth the functions of the system are.
    fn smoothness(&self) -> Smoothness;

    /// The reduced equations as recurrences of Taylor coefficients.
    ///
    /// # Errors
    /// The reason, if the system has none.
    fn series(&self) -> Result<ReducedSeries, &'static str>;

    /// The sources that may do work on the system.
    fn power_sources(&self) -> PowerSources;

    /// The power of the forces (W); `None` if there are no forces.
    fn force_power(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<f64>;

    /// The power `-dL/dt` at which explicit time feeds the energy (W).
    fn lagrangian_power(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> f64;

    /// The forces with their derivatives along `(dq, dv) = (in_q, in_v) e_j`.
    fn force_along(&self, t: f64, q: &[f64; N], v: &[f64; N], in_q: f64, in_v: f64) -> Option<[Dual<f64, N>; N]>;

    /// `A` and `b` of the constraint.
    fn constraint(&self, t: f64, q: &[f64; N]) -> Constraint<f64, N, M>;

    /// The rows of `A` with their rates along `(t', q') = (in_t, in_q)`.
    fn rows_along(&self, t: f64, q: &[f64; N], in_t: f64, in_q: &[f64; N]) -> [[Dual<f64, 1>; N]; M];

    /// The residual of every constraint, `A v + b`, or `phi` of one that is not affine.
    fn residual(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> [f64; M];

    /// The residuals with their derivatives along `(dq, dv) = (in_q, 1) e_j`.
    fn residual_along(&self, t: f64, q: &[f64; N], v: &[f64; N], in_q: f64) -> [Dual<f64, N>; M];

    /// The rows along which the constraints act at a velocity: `A`, or `phi_v`.
    fn reaction_rows(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> [[f64; N]; M];

    /// The constraint with all its first derivatives; the reaction of the impulses is added to `w`, with its derivatives to `w_q`.
    fn constraint_slopes(
        &self,
        t: f64,
        state: (&[f64; N], &[f64; N]),
        impulse: &[f64; M],
        w: (&mut [f64; N], &mut [[f64; N]; N]),
    ) -> ConstraintSlopes<N, M>;

    /// Whether some constraint is not affine in the velocities.
    fn is_nonlinear(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> bool;

    /// Adds `sum_k factors[k] d^2 phi_k / dv dv` to a matrix.
    fn add_reaction_curvature(
        &self,
        t: f64,
        state: (&[f64; N], &[f64; N]),
        factors: &[f64; M],
        matrix: &mut [[f64; N]; N],
    );

    /// Whether positions are constrained.
    fn constrains_positions(&self, t: f64, q: &[f64; N]) -> bool;

    /// The functions of the constraints on positions; `None` if there are none.
    fn positions(&self, t: f64, q: &[f64; N]) -> Option<[Option<f64>; M]>;

    /// The misses of the constraints on positions with their gradients, zero within rounding; `None` if there are no such constraints.
    fn position_misses(&self, t: f64, q: &[f64; N]) -> Option<[Option<Dual<f64, N>>; M]>;

    /// Adds `sum_k factors[k] d^2 g_k / dq dq` of the constraints on positions to a matrix.
    fn add_position_curvature(&self, t: f64, q: &[f64; N], factors: &[f64; M], matrix: &mut [[f64; N]; N]);

    /// The basis of admissible velocities; `None` if there is none.
    fn basis(&self, t: f64, q: &[f64; N]) -> Option<AdmissibleBasis<f64, N, M>>;

    /// Shows the system with its basis for the neighbourhood of a configuration, and the number of that basis, if bases of the system hold
    /// near a configuration only; [`System::near`](lagrangian::System::near) explains `basis`. Returns whether they do.
    fn near(&self, t: f64, q: &[f64; N], basis: u64, then: &mut dyn FnMut(u64, &dyn Mechanics<N, M>)) -> bool;

    /// Accelerations and multipliers of the continuous system.
    ///
    /// # Errors
    /// [`MotionError`] if the mass matrix or the constraint is degenerate.
    fn motion(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Result<Motion<N, M>, MotionError>;

    /// The velocity `W xi + v_b` of quasi-velocities.
    ///
    /// # Errors
    /// [`ReducedError`] if there is no basis, or a degenerate one.
    fn velocity_of(&self, t: f64, q: &[f64; N], xi: &[f64; N]) -> Result<[f64; N], ReducedError>;

    /// The quasi-velocities of a velocity.
    ///
    /// # Errors
    /// As [`velocity_of`](Self::velocity_of).
    fn quasi_velocities(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Result<[f64; N], ReducedError>;

    /// The reduced equations.
    ///
    /// # Errors
    /// [`ReducedError`] if there is no basis, or if equations are degenerate.
    fn reduced_slope(&self, t: f64, q: &[f64; N], xi: &[f64; N]) -> Result<ReducedSlope<N>, ReducedError>;

    /// The inverse of the mass matrix on the distribution.
    ///
    /// # Errors
    /// [`Singular`](lagrangian::linear::Singular) if the Lagrangian does not determine the quasi-velocities.
    fn inverse_reduced_mass(
        &self,
        t: f64,
        q: &[f64; N],
        v: &[f64; N],
        basis: &AdmissibleBasis<f64, N, M>,
    ) -> Result<[[f64; N]; N], lagrangian::linear::Singular>;

    /// The bracket of the dual of the distribution at eight points; `None` without a basis.
    fn bracket(&self, t: Lanes, q: &[Lanes; N], xi: &[Lanes; N]) -> Option<Bracket<Lanes, N, M>>;

    /// The slope of the energy at eight points; `None` without a basis.
    fn energy_slope(&self, t: Lanes, q: &[Lanes; N], xi: &[Lanes; N]) -> Option<EnergySlope<Lanes, N>>;

    /// The forces at eight points.
    fn force_at_eight(&self, t: Lanes, q: &[Lanes; N], v: &[Lanes; N]) -> Option<[Lanes; N]>;

    /// Computes the stages of a collocation all at once in the vector registers of the machine; `None` if it has no such registers.
    fn collocate(&self, stages: Collocation<'_, N>) -> Option<CollocationOutcome<N>>;
}

impl<const N: usize, const M: usize> fmt::Debug for dyn Mechanics<N, M> + '_ {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a system of {N} coordinates and {M} constraints")
    }
}
