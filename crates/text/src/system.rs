use crate::family::SeededText;
use crate::{TextFunctions, TextModel};
use dla::{
    Collocation, CollocationOutcome, Diagnosis, Mechanics, NotANumber, PiecewiseMechanics, ReducedSeries,
    RoundedMechanics, SecondSlopes, SeededMechanics, Slopes,
};
use lagrangian::linear::Singular;
use lagrangian::{
    AdmissibleBasis, Bracket, Constraint, ConstraintSlopes, Dependence, Dual, EnergySlope, Gradients, HyperDual, Lanes,
    Motion, MotionError, MotionRounding, PowerSources, Reduced, ReducedError, ReducedSlope, Rounded, RowSpace, Rows,
    Saddle, Scalar, Seeded, Smoothness, System, constraint_residual, from_fn, inverse_on_basis, reduced_from_motion,
    within_rounding,
};
use std::sync::Arc;

/// A system of text, of `N` coordinates and `M` constraints, which answers what methods ask at the cost of its own size.
///
/// First derivatives are formulas, and second derivatives are derivatives of the first along the directions of the system's own
/// coordinates, by dual numbers. What fills the shape is written as constants. What is asked seldom comes from the [functions](TextFunctions).
#[derive(Debug, Clone, PartialEq)]
pub struct TextSystem<const N: usize, const M: usize>(TextFunctions<N, M>);

/// What the methods that keep the energy ask of a point.
struct Frame<const N: usize, const M: usize> {
    basis: AdmissibleBasis<Lanes, N, M>,
    velocity: [Lanes; N],
    l_q: [Lanes; N],
    p: [Lanes; N],
    /// `p . dW_a/dq`, a covector for each vector of the basis.
    along: [[Lanes; N]; N],
}

impl<const N: usize, const M: usize> TextSystem<N, M> {
    /// As [`TextFunctions::new`].
    #[must_use]
    pub fn new(model: Arc<TextModel>, t: f64, q: &[f64]) -> Option<Self> {
        TextFunctions::new(model, t, q).map(Self)
    }

    /// The functions of the system.
    #[must_use]
    pub fn functions(&self) -> &TextFunctions<N, M> {
        &self.0
    }

    /// The model that the texts describe.
    #[must_use]
    pub fn model(&self) -> &Arc<TextModel> {
        self.0.model()
    }

    /// Shows a state on numbers with derivatives along `(dq, dv) = (in_q, in_v) e_j` of eight of the system's own coordinates at a time, and
    /// these coordinates, until all have been shown.
    fn along_each(
        &self,
        [q, v]: [&[f64; N]; 2],
        [in_q, in_v]: [f64; 2],
        mut see: impl FnMut(std::ops::Range<usize>, &[Seeded; N], &[Seeded; N]),
    ) {
        const AT_ONCE: usize = 8;
        for from in (0..self.0.n()).step_by(AT_ONCE) {
            let along = |x: &[f64; N], by: f64| -> [Seeded; N] {
                from_fn(|i| Dual { re: x[i], eps: from_fn(|k| if from + k == i { by } else { 0.0 }) })
            };
            see(from..self.0.n().min(from + AT_ONCE), &along(q, in_q), &along(v, in_v));
        }
    }

    /// The basis with its velocity, and the slopes there; `None` if the derivatives of the basis are too large.
    fn frame(&self, t: Lanes, q: &[Lanes; N], xi: &[Lanes; N]) -> Option<Frame<N, M>> {
        let (n, turning) = (self.0.n(), self.0.turning()?);
        let basis = self.0.basis_at(&[], t, q);
        let velocity = basis.combine(xi);
        let [l_q, p] = self.0.slopes_at(&[], t, q, &velocity);
        let mut along = [[Lanes::zero(); N]; N];
        turning.evaluate(n, self.0.point(&[], t, q, &[]), |k, slope| {
            along[k / (n * n)][k % n] += p[k / n % n] * slope;
        });
        Some(Frame { basis, velocity, l_q, p, along })
    }
}

/// Entries that the functions of the system answer, by automatic derivatives.
macro_rules! by_functions {
    ($of:ident: $($name:ident($($argument:ident: $type:ty),*) -> $answer:ty;)*) => {
        $(fn $name(&self, $($argument: $type),*) -> $answer {
            $of::$name(&self.0, $($argument),*)
        })*
    };
}

impl<const N: usize, const M: usize> Mechanics<N, M> for TextSystem<N, M> {
    fn angles(&self) -> [bool; N] {
        System::angles(&self.0)
    }

    fn lagrangian(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> f64 {
        self.0.lagrangian_at(&[], t, q, v)
    }

    fn energy(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> f64 {
        let p = self.0.momentum_at(&[], t, q, v);
        (0..N).fold(-self.0.lagrangian_at(&[], t, q, v), |energy, i| energy + p[i] * v[i])
    }

    fn momentum(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> [f64; N] {
        self.0.momentum_at(&[], t, q, v)
    }

    fn momentum_and_rows(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> ([f64; N], Constraint<f64, N, M>) {
        (self.0.momentum_at(&[], t, q, v), self.0.constraint_at(&[], t, q))
    }

    fn mass_matrix(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> ([f64; N], [[f64; N]; N]) {
        let n = self.0.n();
        let (mut p, mut mass) = ([0.0; N], [[0.0; N]; N]);
        for i in n..N {
            (p[i], mass[i][i]) = (v[i], 1.0);
        }
        self.model().mass.evaluate(n, self.0.point(&[], t, q, v), |k, x| match k.checked_sub(n * n) {
            Some(i) => p[i] = x,
            None => mass[k / n][k % n] = x,
        });
        (p, mass)
    }

    fn slopes(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Slopes<N> {
        let [l_q, l_v] = self.0.slopes_at(&[], t, q, v);
        Slopes { l_q, l_v, force: self.0.force_at(&[], t, q, v) }
    }

    fn second_slopes(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> SecondSlopes<N> {
        let (mut l_q, mut l_qq, mut l_qv) = ([0.0; N], [[0.0; N]; N], [[0.0; N]; N]);
        self.along_each([q, v], [1.0, 0.0], |own, q, v| {
            let slopes = self.0.slopes_at(&[], Dual::fixed(t), q, v);
            for i in 0..N {
                l_q[i] = slopes[0][i].re;
                for (k, j) in own.clone().enumerate() {
                    l_qq[i][j] = slopes[0][i].eps[k];
                    l_qv[j][i] = slopes[1][i].eps[k];
                }
            }
        });
        let (l_v, l_vv) = self.mass_matrix(t, q, v);
        let in_place = self.force_along(t, q, v, 1.0, 0.0);
        let force = in_place.and_then(|in_place| Some([in_place, self.force_along(t, q, v, 0.0, 1.0)?]));
        SecondSlopes { l_q, l_qq, l_qv, l_v, l_vv, force }
    }

    fn at_node(&self, t: f64, q: &[f64; N], v: &[f64; N], back: f64, ahead: f64) -> HyperDual<f64, N, N> {
        let mut node = HyperDual::fixed(self.0.lagrangian_at(&[], t, q, v));
        for i in self.0.n()..N {
            (node.e1[i], node.e2[i], node.e12[i][i]) = (-v[i], v[i], -1.0);
        }
        self.along_each([q, v], [ahead, 1.0], |own, q, v| {
            let [l_q, l_v] = self.0.slopes_at(&[], Dual::fixed(t), q, v);
            for i in 0..self.0.n() {
                node.e1[i] = back * l_q[i].re - l_v[i].re;
                node.e2[i] = ahead * l_q[i].re + l_v[i].re;
                for (k, j) in own.clone().enumerate() {
                    node.e12[i][j] = back * l_q[i].eps[k] - l_v[i].eps[k];
                }
            }
        });
        node
    }

    fn series(&self) -> Result<ReducedSeries, &'static str> {
        self.0.series()
    }

    fn force(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<[f64; N]> {
        self.0.force_at(&[], t, q, v)
    }

    fn force_along(&self, t: f64, q: &[f64; N], v: &[f64; N], in_q: f64, in_v: f64) -> Option<[Dual<f64, N>; N]> {
        self.model().force.as_ref()?;
        let mut all = [Dual::fixed(0.0); N];
        self.along_each([q, v], [in_q, in_v], |own, q, v| {
            for (all, force) in all.iter_mut().zip(self.0.force_at(&[], Dual::fixed(t), q, v).iter().flatten()) {
                all.re = force.re;
                all.eps[own.clone()].copy_from_slice(&force.eps[..own.len()]);
            }
        });
        Some(all)
    }

    fn constraint(&self, t: f64, q: &[f64; N]) -> Constraint<f64, N, M> {
        self.0.constraint_at(&[], t, q)
    }

    fn residual(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> [f64; M] {
        constraint_residual(&self.0, t, q, v)
    }

    fn residual_along(&self, t: f64, q: &[f64; N], v: &[f64; N], in_q: f64) -> [Dual<f64, N>; M] {
        let mut residual = [Dual::fixed(0.0); M];
        self.along_each([q, v], [in_q, 0.0], |own, q, v| {
            let (a, b) = self.0.constraint_at(&[], Dual::fixed(t), q);
            for (k, all) in residual.iter_mut().enumerate() {
                let along: Seeded = (0..N).fold(b[k], |sum, i| sum + a[k][i] * v[i].re);
                all.re = along.re;
                if own.start == 0 {
                    all.eps = from_fn(|j| a[k][j].re);
                }
                for (eps, slope) in all.eps[own.clone()].iter_mut().zip(along.eps) {
                    *eps += slope;
                }
            }
        });
        residual
    }

    fn reaction_rows(&self, t: f64, q: &[f64; N], _v: &[f64; N]) -> [[f64; N]; M] {
        self.0.constraint_at(&[], t, q).0
    }

    fn constraint_slopes(
        &self,
        t: f64,
        (q, v): (&[f64; N], &[f64; N]),
        impulse: &[f64; M],
        (w, w_q): (&mut [f64; N], &mut [[f64; N]; N]),
    ) -> ConstraintSlopes<N, M> {
        let mut slopes = ConstraintSlopes { a: [[0.0; N]; M], g: [0.0; M], g_q: [[0.0; N]; M] };
        self.along_each([q, v], [1.0, 0.0], |own, q, v| {
            let (a, b): Constraint<Seeded, N, M> = self.0.constraint_at(&[], Dual::fixed(t), q);
            for k in 0..M {
                let along = (0..N).fold(b[k], |sum, i| sum + a[k][i] * v[i].re);
                slopes.g[k] = along.re;
                slopes.g_q[k][own.clone()].copy_from_slice(&along.eps[..own.len()]);
                for i in 0..N {
                    if own.start == 0 {
                        slopes.a[k][i] = a[k][i].re;
                        w[i] += a[k][i].re * impulse[k];
                    }
                    for (w_q, slope) in w_q[i][own.clone()].iter_mut().zip(a[k][i].eps) {
                        *w_q += slope * impulse[k];
                    }
                }
            }
        });
        slopes
    }

    fn is_nonlinear(&self, _t: f64, _q: &[f64; N], _v: &[f64; N]) -> bool {
        false
    }

    fn add_reaction_curvature(
        &self,
        _t: f64,
        _state: (&[f64; N], &[f64; N]),
        _factors: &[f64; M],
        _matrix: &mut [[f64; N]; N],
    ) {
    }

    fn constrains_positions(&self, _t: f64, _q: &[f64; N]) -> bool {
        self.model().positions() > 0
    }

    fn positions(&self, t: f64, q: &[f64; N]) -> Option<[Option<f64>; M]> {
        self.0.holonomic_at(&[], t, q)
    }

    fn position_misses(&self, t: f64, q: &[f64; N]) -> Option<[Option<Dual<f64, N>>; M]> {
        let g = self.0.holonomic_at(&[], t, q)?;
        // The rates of the functions are rows of the constraint.
        let (a, _) = self.0.constraint_at(&[], t, q);
        let miss = |k: usize, g: f64| Dual { re: g, eps: a[k] };
        Some(from_fn(|k| g[k].map(|g| within_rounding(q, miss(k, g)))))
    }

    fn add_position_curvature(&self, t: f64, q: &[f64; N], factors: &[f64; M], matrix: &mut [[f64; N]; N]) {
        let first = self.model().constraints() - self.model().positions();
        self.along_each([q, q], [1.0, 0.0], |own, q, _| {
            let (a, _) = self.0.constraint_at(&[], Dual::fixed(t), q);
            for k in first..self.model().constraints() {
                for (row, a) in matrix.iter_mut().zip(&a[k]) {
                    for (entry, slope) in row[own.clone()].iter_mut().zip(a.eps) {
                        *entry += factors[k] * slope;
                    }
                }
            }
        });
    }

    fn basis(&self, t: f64, q: &[f64; N]) -> Option<AdmissibleBasis<f64, N, M>> {
        Some(self.0.basis_at(&[], t, q))
    }

    fn near(&self, t: f64, q: &[f64; N], basis: u64, then: &mut dyn FnMut(u64, &dyn Mechanics<N, M>)) -> bool {
        System::near(&self.0, t, q, basis).map(|(near, number)| then(number, &Self(near))).is_some()
    }

    fn motion(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Result<Motion<N, M>, MotionError> {
        // Along the motion at frozen velocity, `(t', q', v') = (1, v, 0)`.
        let along_t = Dual { re: t, eps: [1.0] };
        let along_q = from_fn(|i| Dual { re: q[i], eps: [v[i]] });
        let [l_q, l_v] = self.0.slopes_at(&[], along_t, &along_q, &v.map(Dual::fixed));
        let (rows, b): Constraint<Dual<f64, 1>, N, M> = self.0.constraint_at(&[], along_t, &along_q);
        let force = self.0.force_at(&[], t, q, v);
        let a = rows.map(|row| row.map(|x| x.re));
        let saddle = Saddle {
            block: self.mass_matrix(t, q, v).1,
            transposed: a,
            rows: a,
            right: from_fn(|i| l_q[i].re + force.map_or(0.0, |f| f[i]) - l_v[i].eps[0]),
            level: from_fn(|k| -(0..N).fold(b[k].eps[0], |rate, i| rate + rows[k][i].eps[0] * v[i])),
        };
        Motion::solved(&saddle, t, Some(&self.0.basis_of(&[], t, q, || a)), || self.redundant_rows(t, q, v))
    }

    fn reduced_slope(&self, t: f64, q: &[f64; N], xi: &[f64; N]) -> Result<ReducedSlope<N>, ReducedError> {
        let velocity = self.velocity_of(t, q, xi)?;
        let acceleration = match self.0.reduced_motion(t, q, xi) {
            Some(acceleration) if acceleration[..N - M].iter().all(|x| x.is_finite()) => acceleration,
            // Of equations that are degenerate the motion tells where.
            _ => {
                let Motion { acceleration, .. } = self.motion(t, q, &velocity)?;
                reduced_from_motion(&self.0, t, q, xi, (&velocity, &acceleration))?
            }
        };
        Ok(ReducedSlope { velocity, acceleration })
    }

    fn inverse_reduced_mass(
        &self,
        t: f64,
        q: &[f64; N],
        v: &[f64; N],
        basis: &AdmissibleBasis<f64, N, M>,
    ) -> Result<[[f64; N]; N], Singular> {
        inverse_on_basis(&self.mass_matrix(t, q, v).1, basis)
    }

    fn bracket(&self, t: Lanes, q: &[Lanes; N], xi: &[Lanes; N]) -> Option<Bracket<Lanes, N, M>> {
        let Frame { basis, velocity, p, along, .. } = self.frame(t, q, xi)?;
        let lagrangian = self.0.lagrangian_at(&[], t, q, &velocity);
        Some(Bracket::of_slopes(basis, velocity, Dual { re: lagrangian, eps: p }, &along))
    }

    fn energy_slope(&self, t: Lanes, q: &[Lanes; N], xi: &[Lanes; N]) -> Option<EnergySlope<Lanes, N>> {
        let Frame { basis, l_q, p, along, .. } = self.frame(t, q, xi)?;
        let d = basis.vectors().len();
        let h_q = from_fn(|j| -(0..d).fold(l_q[j], |sum, a| sum + xi[a] * along[a][j]));
        Some(EnergySlope { h_q, pi: basis.products(&p) })
    }

    fn force_at_eight(&self, t: Lanes, q: &[Lanes; N], v: &[Lanes; N]) -> Option<[Lanes; N]> {
        self.0.force_at(&[], t, q, v)
    }

    by_functions! { Mechanics:
        smoothness() -> Smoothness;
        power_sources() -> PowerSources;
        force_power(t: f64, q: &[f64; N], v: &[f64; N]) -> Option<f64>;
        lagrangian_power(t: f64, q: &[f64; N], v: &[f64; N]) -> f64;
        rows_along(t: f64, q: &[f64; N], in_t: f64, in_q: &[f64; N]) -> [[Dual<f64, 1>; N]; M];
        velocity_of(t: f64, q: &[f64; N], xi: &[f64; N]) -> Result<[f64; N], ReducedError>;
        quasi_velocities(t: f64, q: &[f64; N], v: &[f64; N]) -> Result<[f64; N], ReducedError>;
        collocate(stages: Collocation<'_, N>) -> Option<CollocationOutcome<N>>;
    }
}

impl<const N: usize, const M: usize> Diagnosis<N, M> for TextSystem<N, M> {
    by_functions! { Diagnosis:
        not_a_number(t: f64, q: &[f64; N], v: &[f64; N]) -> Option<NotANumber>;
        row_space(t: f64, q: &[f64; N], v: &[f64; N], tolerance: f64) -> RowSpace<N, M>;
        redundant_rows(t: f64, q: &[f64; N], v: &[f64; N]) -> Option<Rows>;
        rank_is_constant(t: f64, q: &[f64; N], v: &[f64; N], space: &RowSpace<N, M>) -> bool;
        rows_are_consistent(t: f64, q: &[f64; N], v: &[f64; N], dependence: &Dependence<M>) -> bool;
        constraints_move(t: f64, q: &[f64; N]) -> bool;
        depends_on_time(t: f64, q: &[f64; N], v: &[f64; N]) -> bool;
    }
}

impl<const N: usize, const M: usize> RoundedMechanics<N, M> for TextSystem<N, M> {
    fn momentum_rounded(&self, t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> [Rounded; N] {
        self.0.momentum_at(&[], t, q, v)
    }

    fn slope_rounded(&self, t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> [Rounded; N] {
        self.0.slopes_at(&[], t, q, v)[0]
    }

    by_functions! { RoundedMechanics:
        force_rounded(t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> Option<[Rounded; N]>;
        constraint_rounded(t: Rounded, q: &[Rounded; N]) -> Constraint<Rounded, N, M>;
        residual_rounded(t: Rounded, q: &[Rounded; N], v: &[Rounded; N]) -> [Rounded; M];
        positions_rounded(t: Rounded, q: &[Rounded; N]) -> Option<[Option<Rounded>; M]>;
        motion_rounding(t: f64, q: &[f64; N], v: &[f64; N]) -> Result<MotionRounding<N>, MotionError>;
        bracket_rounding(t: f64, q: &[f64; N], xi: &[f64; N]) -> Option<[[f64; N]; 2]>;
        reduced_rounding(t: f64, q: &[f64; N], xi: &[f64; N], h: f64) -> Option<[[f64; N]; 2]>;
    }
}

impl<const N: usize, const M: usize> SeededMechanics<N, M> for TextSystem<N, M> {
    fn gradients(&self) -> Box<dyn Gradients<N, M> + '_> {
        Box::new(SeededText { functions: self.0.clone(), p: Vec::new() })
    }

    fn near_seeded(
        &self,
        t: f64,
        q: &[f64; N],
        basis: u64,
        then: &mut dyn FnMut(u64, &dyn SeededMechanics<N, M>),
    ) -> bool {
        System::near(&self.0, t, q, basis).map(|(near, number)| then(number, &Self(near))).is_some()
    }

    by_functions! { SeededMechanics:
        velocity_seeded(t: Seeded, q: &[Seeded; N], xi: &[Seeded; N]) -> Option<[Seeded; N]>;
        reduced_motion_seeded(t: Seeded, q: &[Seeded; N], xi: &[Seeded; N]) -> Option<[Seeded; N]>;
    }
}

impl<const N: usize, const M: usize> PiecewiseMechanics<N, M> for TextSystem<N, M> {
    fn jump_times(&self, from: f64, to: f64) -> Vec<f64> {
        // More than can be told are refused where the scene is read.
        self.model().jumps(from, to).unwrap_or_default()
    }

    fn smooth_piece(&self, t: f64) -> Box<dyn PiecewiseMechanics<N, M> + '_> {
        Box::new(Self(self.0.piece(t)))
    }
}
