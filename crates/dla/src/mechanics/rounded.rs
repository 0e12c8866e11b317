use lagrangian::{
    Constraint, Dual, MotionError, MotionRounding, Rounded, System, bracket_rounding, configuration_slope,
    constraint_residual, mapped, reduced_rounding, velocity_slope,
};

/// The functions of a system with bounds on the rounding of their terms, for convergence tests of corrections that stall.
pub trait RoundedMechanics<const N: usize, const M: usize> {
    /// `L_v`.
    fn momentum_rounded(&self, t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> [Rounded; N];

    /// `L_q`.
    fn slope_rounded(&self, t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> [Rounded; N];

    /// The generalised forces.
    fn force_rounded(&self, t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> Option<[Rounded; N]>;

    /// `A` and `b` of the constraint.
    fn constraint_rounded(&self, t: Rounded, q: &[Rounded; N]) -> Constraint<Rounded, N, M>;

    /// The residuals of the constraints.
    fn residual_rounded(&self, t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> [Rounded; M];

    /// The functions of the constraints on positions.
    fn positions_rounded(&self, t: Rounded, q: &[Rounded; N]) -> Option<[Option<Rounded>; M]>;

    /// The effect of rounding on the equations of motion.
    ///
    /// # Errors
    /// [`MotionError`] if they are degenerate.
    fn motion_rounding(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Result<MotionRounding<N>, MotionError>;

    /// The effect of rounding on the quasi-momenta and their rates; `None` without a basis.
    fn bracket_rounding(&self, t: f64, q: &[f64; N], xi: &[f64; N]) -> Option<[[f64; N]; 2]>;

    /// The effect of rounding on the reduced equations along a step; `None` if there are no reduced equations.
    fn reduced_rounding(&self, t: f64, q: &[f64; N], xi: &[f64; N], h: f64) -> Option<[[f64; N]; 2]>;
}

impl<Sys: System<N, M>, const N: usize, const M: usize> RoundedMechanics<N, M> for Sys {
    #[cold]
    fn momentum_rounded(&self, t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> [Rounded; N] {
        mapped(&velocity_slope(self, Dual::fixed(t), &mapped(q, Dual::fixed), &mapped(v, Dual::fixed)), |p| p.re)
    }

    #[cold]
    fn slope_rounded(&self, t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> [Rounded; N] {
        mapped(&configuration_slope(self, Dual::fixed(t), &mapped(q, Dual::fixed), &mapped(v, Dual::fixed)), |f| f.re)
    }

    #[cold]
    fn force_rounded(&self, t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> Option<[Rounded; N]> {
        System::force(self, t, q, v)
    }

    #[cold]
    fn constraint_rounded(&self, t: Rounded, q: &[Rounded; N]) -> Constraint<Rounded, N, M> {
        System::constraint(self, t, q)
    }

    #[cold]
    fn residual_rounded(&self, t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> [Rounded; M] {
        constraint_residual(self, t, q, v)
    }

    #[cold]
    fn positions_rounded(&self, t: Rounded, q: &[Rounded; N]) -> Option<[Option<Rounded>; M]> {
        self.holonomic(t, q)
    }

    #[cold]
    fn motion_rounding(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Result<MotionRounding<N>, MotionError> {
        MotionRounding::at(self, t, q, v)
    }

    #[cold]
    fn bracket_rounding(&self, t: f64, q: &[f64; N], xi: &[f64; N]) -> Option<[[f64; N]; 2]> {
        bracket_rounding(self, t, q, xi)
    }

    #[cold]
    fn reduced_rounding(&self, t: f64, q: &[f64; N], xi: &[f64; N], h: f64) -> Option<[[f64; N]; 2]> {
        reduced_rounding(self, t, q, xi, h)
    }
}
