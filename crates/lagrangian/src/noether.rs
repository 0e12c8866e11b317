use crate::linear::largest;
use crate::vector_field::rate_along;
use crate::{Dual, Motion, MotionError, System, VectorField, from_fn, mapped, reaction_rows};

/// The momentum `p . X` along a field `X`, and what changes it.
///
/// Along every motion `d/dt (L_v . X) = dL(X) + F . X + lambda . (A X)`, where `dL(X) = L_q . X + L_v . (dX/dq) v` is the rate of
/// `L` along the field, lifted to velocities: the Lagrange-d'Alembert principle with the variation `X`. For a symmetry
/// `dL(X) = 0`, and what is left is the nonholonomic momentum equation. (Bloch, Krishnaprasad, Marsden and Murray 1996,
/// Arch. Ration. Mech. Anal. 136, 21-99, theorem 4.5.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MomentumBalance<const M: usize> {
    /// `p . X`.
    pub momentum: f64,
    /// `dL(X)` (J): zero for a symmetry.
    pub lagrangian_rate: f64,
    /// `F . X` of the forces that no Lagrangian gives.
    pub force_rate: f64,
    /// `A X`: zero where the field is horizontal, that is, admissible.
    pub crossing: [f64; M],
    /// `lambda . (A X)`.
    pub reaction_rate: f64,
    /// The largest sums of sizes of terms: of `dL(X)`, of `F . X`, and of a row of `A X`. Rounding is relative to them.
    sizes: [f64; 3],
}

impl<const M: usize> MomentumBalance<M> {
    /// What is taken for rounding, relative to the terms of a sum.
    pub const ROUNDING: f64 = 1e-12;

    /// `d/dt (p . X)`.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.lagrangian_rate + self.force_rate + self.reaction_rate
    }

    /// Whether the Lagrangian does not change along the field.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        self.lagrangian_rate.abs() <= Self::ROUNDING * self.sizes[0]
    }

    /// Whether no force works along the field.
    #[must_use]
    pub fn is_unforced(&self) -> bool {
        self.force_rate.abs() <= Self::ROUNDING * self.sizes[1]
    }

    /// Whether the constraints admit the field, and so have no reaction along it.
    #[must_use]
    pub fn is_horizontal(&self) -> bool {
        largest(&self.crossing) <= Self::ROUNDING * self.sizes[2]
    }
}

/// The balance of the momentum along a field, at one state.
///
/// # Errors
/// [`MotionError`] where the equations of motion are degenerate.
pub fn momentum_balance<Sys: System<N, M>, X: VectorField<N>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    field: &X,
) -> Result<MomentumBalance<M>, MotionError> {
    let x = field.at(q);
    let turned = rate_along(field, q, v);
    let p = system.lagrangian(Dual::fixed(t), &mapped(q, Dual::fixed), &Dual::variables(v)).eps;
    let slope = system.lagrangian(Dual::fixed(t), &Dual::variables(q), &mapped(v, Dual::fixed)).eps;
    let force = system.force(t, q, v).unwrap_or([0.0; N]);
    let rows = reaction_rows(system, t, q, v);
    let dot = |a: &[f64; N], b: &[f64; N]| (0..N).map(|i| a[i] * b[i]).sum::<f64>();
    let size = |a: &[f64; N], b: &[f64; N]| (0..N).map(|i| (a[i] * b[i]).abs()).sum::<f64>();
    let crossing = mapped(&rows, |row| dot(&row, &x));
    let multiplier = Motion::of(system, t, q, v)?.multiplier;
    Ok(MomentumBalance {
        momentum: dot(&p, &x),
        lagrangian_rate: dot(&slope, &x) + dot(&p, &turned),
        force_rate: dot(&force, &x),
        crossing,
        reaction_rate: (0..M).map(|k| multiplier[k] * crossing[k]).sum(),
        sizes: [size(&slope, &x) + size(&p, &turned), size(&force, &x), largest(&mapped(&rows, |row| size(&row, &x)))],
    })
}

/// What the nonholonomic theorem of Noether says of the momentum along a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Conservation {
    /// A horizontal symmetry on which no force works: the momentum is conserved.
    Conserved,
    /// A symmetry that the constraints do not admit, or along which a force works: the momentum obeys the momentum equation.
    MomentumEquation,
    /// No symmetry: the Lagrangian changes along the field.
    NoSymmetry,
}

/// Tests a field for being a symmetry and horizontal at some states `(t, q, v)`, which should be in general position: what
/// holds at all of them is taken to hold.
///
/// # Errors
/// [`MotionError`] where the equations of motion are degenerate.
pub fn conservation<Sys: System<N, M>, X: VectorField<N>, const N: usize, const M: usize>(
    system: &Sys,
    states: &[(f64, [f64; N], [f64; N])],
    field: &X,
) -> Result<Conservation, MotionError> {
    let balances: Result<Vec<_>, _> =
        states.iter().map(|(t, q, v)| momentum_balance(system, *t, q, v, field)).collect();
    let balances = balances?;
    let all = |holds: fn(&MomentumBalance<M>) -> bool| balances.iter().all(holds);
    Ok(if !all(MomentumBalance::is_symmetric) {
        Conservation::NoSymmetry
    } else if all(MomentumBalance::is_horizontal) && all(MomentumBalance::is_unforced) {
        Conservation::Conserved
    } else {
        Conservation::MomentumEquation
    })
}

/// The field of a coordinate: `d/dq_k` at unit rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CoordinateField(pub usize);

impl<const N: usize> VectorField<N> for CoordinateField {
    fn at<S: crate::Scalar>(&self, _q: &[S; N]) -> [S; N] {
        from_fn(|i| S::constant(f64::from(u8::from(i == self.0))))
    }
}
