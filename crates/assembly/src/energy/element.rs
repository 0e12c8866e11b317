use crate::AssemblyError;
use lagrangian::quadrature::gauss_legendre;
use lagrangian::{Lanes, from_fn};

/// The Gauss rule with eight nodes along a step, by which gradients are averaged: exact to degree 15.
#[derive(Debug, Clone, Copy)]
pub struct Average {
    nodes: Lanes,
    weights: Lanes,
}

impl Average {
    pub(crate) fn new() -> Self {
        let (nodes, weights) = gauss_legendre::<{ Lanes::COUNT }>();
        Self { nodes: Lanes(nodes), weights: Lanes(weights) }
    }

    /// The points of a step along the line from `q0` with the velocity `v`.
    pub(super) fn points<const N: usize>(&self, h: f64, q0: &[f64; N], v: &[f64; N]) -> [Lanes; N] {
        from_fn(|i| self.nodes * (h * v[i]) + q0[i])
    }

    pub(super) fn of(&self, values: Lanes) -> f64 {
        (self.weights * values).0.iter().sum()
    }
}

/// A body along a step, matrices by rows.
#[derive(Debug)]
pub struct Swing<'a> {
    /// The mean velocity `W(q_m) xi`, `N`.
    pub v: &'a mut [f64],
    /// Its derivative in `xi`, with that of `q_m`: `N x K`.
    pub slope: &'a mut [f64],
    /// `W(q_m)`, `N x K`.
    pub frame: &'a mut [f64],
    /// `S(q_m, xi) xi` of the bracket, `K`.
    pub turning: &'a mut [f64],
    /// Its derivative, `K x K`.
    pub turning_slope: &'a mut [f64],
}

/// What an element says of a step that keeps the energy: see [`SparseEnergy`](crate::SparseEnergy).
pub trait EnergyElement {
    /// How many quasi-velocities it has as a body: as many as its basis of admissible velocities, or as coordinates where it has
    /// none. Rows that no basis meets are constraints of the assembly.
    fn quasi_velocities(&self) -> usize;

    /// The quasi-velocities `xi` of a body at the beginning of a step, and its mass in them, `W' L_vv W`.
    ///
    /// # Errors
    /// [`AssemblyError`] where the mass is singular, or the energy cannot be kept.
    fn rest(&self, t: f64, q: &[f64], v: &[f64], xi: &mut [f64], mass: &mut [f64]) -> Result<(), AssemblyError>;

    /// Whether its Lagrangian has a part in the velocities: one that is attached to the coordinates of others must not.
    fn has_inertia(&self, t: f64, q: &[f64], v: &[f64]) -> bool;

    /// Refuses what explicit time, moving constraints or velocities in a Lagrangian do, where they take the energy.
    ///
    /// # Errors
    /// [`AssemblyError::Unsupported`].
    fn keeps_energy(&self, t: f64, q: &[f64], v: &[f64]) -> Result<(), AssemblyError>;

    /// A body with the mean quasi-velocities `xi`, from `q0`; nothing where its basis ends.
    fn swing(&self, step: (f64, f64), q0: &[f64], xi: &[f64], out: Swing<'_>) -> Option<()>;

    /// `W(q)` of a body, `N x K` by rows.
    fn frame(&self, t: f64, q: &[f64], frame: &mut [f64]) -> Option<()>;

    /// What its potential and its forces push over a step, `h (mean of L_q + F)`, with about its derivative in `v`; returns the
    /// work of the forces (J).
    fn push(&self, step: (f64, f64), rule: &Average, q0: &[f64], v: &[f64], out: (&mut [f64], &mut [f64])) -> f64;

    /// Its constraint rows, those of constraints on positions averaged over the step: by these the functions change over it.
    fn mean_rows(&self, step: (f64, f64), rule: &Average, q0: &[f64], v: &[f64], rows: &mut [f64]);

    /// The energy, and the size of the numbers whose rounding it carries (J).
    fn energies(&self, t: f64, q: &[f64], v: &[f64]) -> [f64; 2];
}
