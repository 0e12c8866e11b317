//! A system that counts how often it is evaluated.

use crate::{
    Collocation, CollocationOutcome, Diagnosis, Mechanics, NotANumber, ReducedSeries, RoundedMechanics, SecondSlopes,
    Slopes,
};
use lagrangian::linear::Singular;
use lagrangian::{
    AdmissibleBasis, Bracket, Constraint, ConstraintSlopes, Dependence, Dual, EnergySlope, HyperDual, Lanes, Motion,
    MotionError, MotionRounding, PowerSources, ReducedError, ReducedSlope, Rounded, RowSpace, Rows, Smoothness,
};
use std::cell::Cell;

/// A system, and how often its Lagrangian, its forces and its constraint have been evaluated.
pub(super) struct Counted<'a, const N: usize, const M: usize> {
    pub(super) system: &'a dyn Mechanics<N, M>,
    pub(super) evaluations: &'a Cell<u64>,
}

impl<const N: usize, const M: usize> Counted<'_, N, M> {
    fn count(&self, evaluations: u64) {
        self.evaluations.set(self.evaluations.get() + evaluations);
    }
}

/// Entries that pass on the answers of the system. Before each stands the number of evaluations that the answer takes; `some` is one if
/// there is an answer.
macro_rules! counted {
    ($($count:tt $name:ident($($argument:ident: $type:ty),*) $(-> $answer:ty)?;)*) => {
        $(fn $name(&self, $($argument: $type),*) $(-> $answer)? {
            counted!(@ $count self $name ($($argument),*))
        })*
    };
    (@ some $self:ident $name:ident ($($argument:ident),*)) => {{
        let answer = $self.system.$name($($argument),*);
        $self.count(u64::from(answer.is_some()));
        answer
    }};
    (@ $count:literal $self:ident $name:ident ($($argument:ident),*)) => {{
        $self.count($count);
        $self.system.$name($($argument),*)
    }};
}

impl<const N: usize, const M: usize> Mechanics<N, M> for Counted<'_, N, M> {
    fn slopes(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Slopes<N> {
        let slopes = self.system.slopes(t, q, v);
        self.count(2 + u64::from(slopes.force.is_some()));
        slopes
    }

    fn second_slopes(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> SecondSlopes<N> {
        let slopes = self.system.second_slopes(t, q, v);
        self.count(3 + 2 * u64::from(slopes.force.is_some()));
        slopes
    }

    fn near(&self, t: f64, q: &[f64; N], basis: u64, then: &mut dyn FnMut(u64, &dyn Mechanics<N, M>)) -> bool {
        self.system.near(t, q, basis, &mut |number, system| {
            then(number, &Counted { system, evaluations: self.evaluations });
        })
    }

    counted! {
        0 angles() -> [bool; N];
        1 lagrangian(t: f64, q: &[f64; N], v: &[f64; N]) -> f64;
        1 energy(t: f64, q: &[f64; N], v: &[f64; N]) -> f64;
        1 momentum(t: f64, q: &[f64; N], v: &[f64; N]) -> [f64; N];
        2 momentum_and_rows(t: f64, q: &[f64; N], v: &[f64; N]) -> ([f64; N], Constraint<f64, N, M>);
        1 mass_matrix(t: f64, q: &[f64; N], v: &[f64; N]) -> ([f64; N], [[f64; N]; N]);
        1 at_node(t: f64, q: &[f64; N], v: &[f64; N], back: f64, ahead: f64) -> HyperDual<f64, N, N>;
        some force(t: f64, q: &[f64; N], v: &[f64; N]) -> Option<[f64; N]>;
        0 smoothness() -> Smoothness;
        0 series() -> Result<ReducedSeries, &'static str>;
        0 power_sources() -> PowerSources;
        some force_power(t: f64, q: &[f64; N], v: &[f64; N]) -> Option<f64>;
        1 lagrangian_power(t: f64, q: &[f64; N], v: &[f64; N]) -> f64;
        some force_along(t: f64, q: &[f64; N], v: &[f64; N], in_q: f64, in_v: f64) -> Option<[Dual<f64, N>; N]>;
        1 constraint(t: f64, q: &[f64; N]) -> Constraint<f64, N, M>;
        1 rows_along(t: f64, q: &[f64; N], in_t: f64, in_q: &[f64; N]) -> [[Dual<f64, 1>; N]; M];
        1 residual(t: f64, q: &[f64; N], v: &[f64; N]) -> [f64; M];
        1 residual_along(t: f64, q: &[f64; N], v: &[f64; N], in_q: f64) -> [Dual<f64, N>; M];
        1 reaction_rows(t: f64, q: &[f64; N], v: &[f64; N]) -> [[f64; N]; M];
        1 constraint_slopes(t: f64, state: (&[f64; N], &[f64; N]), impulse: &[f64; M], w: (&mut [f64; N], &mut [[f64; N]; N])) -> ConstraintSlopes<N, M>;
        0 is_nonlinear(t: f64, q: &[f64; N], v: &[f64; N]) -> bool;
        0 add_reaction_curvature(t: f64, state: (&[f64; N], &[f64; N]), factors: &[f64; M], matrix: &mut [[f64; N]; N]);
        0 constrains_positions(t: f64, q: &[f64; N]) -> bool;
        0 positions(t: f64, q: &[f64; N]) -> Option<[Option<f64>; M]>;
        0 position_misses(t: f64, q: &[f64; N]) -> Option<[Option<Dual<f64, N>>; M]>;
        0 add_position_curvature(t: f64, q: &[f64; N], factors: &[f64; M], matrix: &mut [[f64; N]; N]);
        0 basis(t: f64, q: &[f64; N]) -> Option<AdmissibleBasis<f64, N, M>>;
        3 motion(t: f64, q: &[f64; N], v: &[f64; N]) -> Result<Motion<N, M>, MotionError>;
        1 velocity_of(t: f64, q: &[f64; N], xi: &[f64; N]) -> Result<[f64; N], ReducedError>;
        1 quasi_velocities(t: f64, q: &[f64; N], v: &[f64; N]) -> Result<[f64; N], ReducedError>;
        2 reduced_slope(t: f64, q: &[f64; N], xi: &[f64; N]) -> Result<ReducedSlope<N>, ReducedError>;
        1 inverse_reduced_mass(t: f64, q: &[f64; N], v: &[f64; N], basis: &AdmissibleBasis<f64, N, M>) -> Result<[[f64; N]; N], Singular>;
        1 bracket(t: Lanes, q: &[Lanes; N], xi: &[Lanes; N]) -> Option<Bracket<Lanes, N, M>>;
        1 energy_slope(t: Lanes, q: &[Lanes; N], xi: &[Lanes; N]) -> Option<EnergySlope<Lanes, N>>;
        some force_at_eight(t: Lanes, q: &[Lanes; N], v: &[Lanes; N]) -> Option<[Lanes; N]>;
        0 collocate(stages: Collocation<'_, N>) -> Option<CollocationOutcome<N>>;
    }
}

impl<const N: usize, const M: usize> RoundedMechanics<N, M> for Counted<'_, N, M> {
    counted! {
        1 momentum_rounded(t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> [Rounded; N];
        1 slope_rounded(t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> [Rounded; N];
        some force_rounded(t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> Option<[Rounded; N]>;
        1 constraint_rounded(t: Rounded, q: &[Rounded; N]) -> Constraint<Rounded, N, M>;
        1 residual_rounded(t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> [Rounded; M];
        0 positions_rounded(t: Rounded, q: &[Rounded; N]) -> Option<[Option<Rounded>; M]>;
        3 motion_rounding(t: f64, q: &[f64; N], v: &[f64; N]) -> Result<MotionRounding<N>, MotionError>;
        2 bracket_rounding(t: f64, q: &[f64; N], xi: &[f64; N]) -> Option<[[f64; N]; 2]>;
        2 reduced_rounding(t: f64, q: &[f64; N], xi: &[f64; N], h: f64) -> Option<[[f64; N]; 2]>;
    }
}

impl<const N: usize, const M: usize> Diagnosis<N, M> for Counted<'_, N, M> {
    counted! {
        0 not_a_number(t: f64, q: &[f64; N], v: &[f64; N]) -> Option<NotANumber>;
        1 row_space(t: f64, q: &[f64; N], v: &[f64; N], tolerance: f64) -> RowSpace<N, M>;
        2 redundant_rows(t: f64, q: &[f64; N], v: &[f64; N]) -> Option<Rows>;
        1 rank_is_constant(t: f64, q: &[f64; N], v: &[f64; N], space: &RowSpace<N, M>) -> bool;
        1 rows_are_consistent(t: f64, q: &[f64; N], v: &[f64; N], dependence: &Dependence<M>) -> bool;
        1 constraints_move(t: f64, q: &[f64; N]) -> bool;
        2 depends_on_time(t: f64, q: &[f64; N], v: &[f64; N]) -> bool;
    }
}
