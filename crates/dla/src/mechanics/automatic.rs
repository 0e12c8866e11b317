//! Every system answers by automatic derivatives.

use super::{Mechanics, ReducedSeries, SecondSlopes, Slopes};
use crate::gauss::{Collocation, CollocationOutcome, collocate};
use lagrangian::linear::Singular;
use lagrangian::{
    AdmissibleBasis, Bracket, Constraint, ConstraintSlopes, Dual, EnergySlope, HyperDual, Lanes, Motion, MotionError,
    PowerSources, ReducedError, ReducedSlope, Smoothness, System, add_position_curvature, add_reaction_curvature,
    constraint_residual, energy, energy_slope, force_power, from_fn, gradient_in_velocity, gradients,
    inverse_reduced_mass, lagrangian_power, mass_matrix, momentum, position_misses, quasi_velocities, reaction_rows,
    reduced_slope, residual_along, rows_along, second_along, vectorized, velocity_of,
};

impl<Sys: System<N, M>, const N: usize, const M: usize> Mechanics<N, M> for Sys {
    fn angles(&self) -> [bool; N] {
        System::angles(self)
    }

    fn lagrangian(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> f64 {
        System::lagrangian(self, t, q, v)
    }

    fn energy(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> f64 {
        energy(self, t, q, v)
    }

    fn momentum(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> [f64; N] {
        momentum(self, t, q, v)
    }

    fn momentum_and_rows(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> ([f64; N], Constraint<f64, N, M>) {
        (gradient_in_velocity(self, t, q, v).1, System::constraint(self, t, q))
    }

    fn mass_matrix(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> ([f64; N], [[f64; N]; N]) {
        mass_matrix(self, t, q, v)
    }

    fn slopes(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Slopes<N> {
        let [l_q, l_v] = gradients(self, t, q, v);
        Slopes { l_q, l_v, force: System::force(self, t, q, v) }
    }

    fn second_slopes(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> SecondSlopes<N> {
        let (along_q, along_v) = ([1.0, 0.0], [0.0, 1.0]);
        let in_q = second_along(self, t, (q, v), along_q, None);
        let l_qv = second_along(self, t, (q, v), along_q, Some(along_v)).e12;
        let (l_v, l_vv) = mass_matrix(self, t, q, v);
        let in_place = self.force_along(t, q, v, 1.0, 0.0);
        let force = in_place.and_then(|in_place| Some([in_place, self.force_along(t, q, v, 0.0, 1.0)?]));
        SecondSlopes { l_q: in_q.e1, l_qq: in_q.e12, l_qv, l_v, l_vv, force }
    }

    fn at_node(&self, t: f64, q: &[f64; N], v: &[f64; N], back: f64, ahead: f64) -> HyperDual<f64, N, N> {
        second_along(self, t, (q, v), [back, -1.0], Some([ahead, 1.0]))
    }

    fn force(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<[f64; N]> {
        System::force(self, t, q, v)
    }

    fn smoothness(&self) -> Smoothness {
        Smoothness::of(self)
    }

    fn series(&self) -> Result<ReducedSeries, &'static str> {
        super::series::traced(self)
    }

    fn power_sources(&self) -> PowerSources {
        PowerSources::of(self)
    }

    fn force_power(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<f64> {
        force_power(self, t, q, v)
    }

    fn lagrangian_power(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> f64 {
        lagrangian_power(self, t, q, v)
    }

    #[inline]
    fn force_along(&self, t: f64, q: &[f64; N], v: &[f64; N], in_q: f64, in_v: f64) -> Option<[Dual<f64, N>; N]> {
        let along = |x: &[f64; N], by: f64| -> [Dual<f64, N>; N] {
            from_fn(|i| Dual { re: x[i], eps: from_fn(|j| if i == j { by } else { 0.0 }) })
        };
        System::force(self, Dual::fixed(t), &along(q, in_q), &along(v, in_v))
    }

    fn constraint(&self, t: f64, q: &[f64; N]) -> Constraint<f64, N, M> {
        System::constraint(self, t, q)
    }

    #[cold]
    fn rows_along(&self, t: f64, q: &[f64; N], in_t: f64, in_q: &[f64; N]) -> [[Dual<f64, 1>; N]; M] {
        rows_along(self, (t, in_t), q, in_q)
    }

    fn residual(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> [f64; M] {
        constraint_residual(self, t, q, v)
    }

    fn residual_along(&self, t: f64, q: &[f64; N], v: &[f64; N], in_q: f64) -> [Dual<f64, N>; M] {
        residual_along(self, t, q, v, in_q)
    }

    fn reaction_rows(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> [[f64; N]; M] {
        reaction_rows(self, t, q, v)
    }

    fn constraint_slopes(
        &self,
        t: f64,
        state: (&[f64; N], &[f64; N]),
        impulse: &[f64; M],
        w: (&mut [f64; N], &mut [[f64; N]; N]),
    ) -> ConstraintSlopes<N, M> {
        ConstraintSlopes::reacting(self, t, state, impulse, w)
    }

    fn is_nonlinear(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> bool {
        self.nonlinear(t, q, v).is_some()
    }

    fn add_reaction_curvature(
        &self,
        t: f64,
        state: (&[f64; N], &[f64; N]),
        factors: &[f64; M],
        matrix: &mut [[f64; N]; N],
    ) {
        add_reaction_curvature(self, t, state, factors, matrix);
    }

    fn constrains_positions(&self, t: f64, q: &[f64; N]) -> bool {
        self.holonomic(t, q).is_some()
    }

    fn positions(&self, t: f64, q: &[f64; N]) -> Option<[Option<f64>; M]> {
        self.holonomic(t, q)
    }

    fn position_misses(&self, t: f64, q: &[f64; N]) -> Option<[Option<Dual<f64, N>>; M]> {
        position_misses(self, t, q)
    }

    fn add_position_curvature(&self, t: f64, q: &[f64; N], factors: &[f64; M], matrix: &mut [[f64; N]; N]) {
        add_position_curvature(self, t, q, factors, matrix);
    }

    fn basis(&self, t: f64, q: &[f64; N]) -> Option<AdmissibleBasis<f64, N, M>> {
        self.admissible_basis(t, q)
    }

    fn near(&self, t: f64, q: &[f64; N], basis: u64, then: &mut dyn FnMut(u64, &dyn Mechanics<N, M>)) -> bool {
        match System::near(self, t, q, basis) {
            Some((near, number)) => {
                then(number, &near);
                true
            }
            None => false,
        }
    }

    fn motion(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Result<Motion<N, M>, MotionError> {
        Motion::of(self, t, q, v)
    }

    fn velocity_of(&self, t: f64, q: &[f64; N], xi: &[f64; N]) -> Result<[f64; N], ReducedError> {
        velocity_of(self, t, q, xi)
    }

    fn quasi_velocities(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Result<[f64; N], ReducedError> {
        quasi_velocities(self, t, q, v)
    }

    fn reduced_slope(&self, t: f64, q: &[f64; N], xi: &[f64; N]) -> Result<ReducedSlope<N>, ReducedError> {
        reduced_slope(self, t, q, xi)
    }

    fn inverse_reduced_mass(
        &self,
        t: f64,
        q: &[f64; N],
        v: &[f64; N],
        basis: &AdmissibleBasis<f64, N, M>,
    ) -> Result<[[f64; N]; N], Singular> {
        inverse_reduced_mass(self, t, q, v, basis)
    }

    fn bracket(&self, t: Lanes, q: &[Lanes; N], xi: &[Lanes; N]) -> Option<Bracket<Lanes, N, M>> {
        vectorized(
            #[inline(always)]
            || Bracket::at(self, t, q, xi),
        )
    }

    fn energy_slope(&self, t: Lanes, q: &[Lanes; N], xi: &[Lanes; N]) -> Option<EnergySlope<Lanes, N>> {
        vectorized(
            #[inline(always)]
            || energy_slope(self, t, q, xi),
        )
    }

    fn force_at_eight(&self, t: Lanes, q: &[Lanes; N], v: &[Lanes; N]) -> Option<[Lanes; N]> {
        vectorized(
            #[inline(always)]
            || System::force(self, t, q, v),
        )
    }

    fn collocate(&self, stages: Collocation<'_, N>) -> Option<CollocationOutcome<N>> {
        collocate(self, stages)
    }
}
