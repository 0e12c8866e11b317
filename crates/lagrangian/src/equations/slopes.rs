use crate::{
    AT_ONCE, BLOCK, Dual, Gradient, Scalar, System, by_places, from_fn, gradient_in_velocity, seed, with_nonlinear,
};

/// The residual of each constraint with its derivatives along `(dq, dv) = (part, 1) e_j`.
#[must_use]
#[inline(always)]
pub fn residual_along<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    part: f64,
) -> [Dual<f64, N>; M] {
    let affine = match const { N <= AT_ONCE } {
        true => by_places!(affine_along::<Sys, N, M>(system, t, q, v, part)),
        false => affine_by_blocks(system, t, q, v, part),
    };
    let in_q = from_fn(|i| Dual { re: q[i], eps: from_fn(|j| if i == j { part } else { 0.0 }) });
    with_nonlinear(system, Dual::fixed(t), &in_q, &Dual::variables(v), affine)
}

/// The residuals of affine constraints, `d(A v + b) = (A + part d(A v + b)/dq) dv`, by derivatives in `W` places.
#[inline(always)]
fn affine_along<Sys: System<N, M>, const N: usize, const M: usize, const W: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    part: f64,
) -> [Dual<f64, N>; M] {
    let (a, b) = system.constraint(Gradient::<f64, W>::fixed(t), &Gradient::variables(q));
    from_fn(|k| {
        let mut along = b[k];
        for i in 0..N {
            along += a[k][i] * v[i];
        }
        let in_q: [f64; N] = along.gradient();
        Dual { re: along.re, eps: from_fn(|j| a[k][j].re + part * in_q[j]) }
    })
}

/// As `affine_along`, for many coordinates, some at a time.
#[inline(never)]
fn affine_by_blocks<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    part: f64,
) -> [Dual<f64, N>; M] {
    let mut rows = [Dual::fixed(0.0); M];
    for from in (0..N).step_by(BLOCK) {
        let (a, b) = system.constraint(Gradient::<f64, BLOCK>::fixed(t), &Gradient::some_variables(q, from));
        for k in 0..M {
            let along = (0..N).fold(b[k], |sum, i| sum + a[k][i] * v[i]);
            rows[k].re = along.re;
            let in_q: [f64; BLOCK] = along.gradient();
            for (j, x) in (from..N).zip(in_q) {
                rows[k].eps[j] = a[k][j].re + part * x;
            }
        }
    }
    rows
}

/// `L_q` and `L_v`.
#[must_use]
#[inline(always)]
pub fn gradients<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> [[S; N]; 2] {
    let (_, l_v) = gradient_in_velocity(system, t, q, v);
    [gradient_in_place(system, t, q, v), l_v]
}

/// `L_q`.
#[inline(always)]
pub(crate) fn gradient_in_place<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> [S; N] {
    by_places!(in_place_by::<Sys, S, N, M>(system, t, q, v))
}

/// `L_q` by derivatives in `W` places.
#[inline(always)]
fn in_place_by<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize, const W: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> [S; N] {
    system.lagrangian(Gradient::<S, W>::fixed(t), &Gradient::variables(q), &Gradient::all_fixed(v)).gradient()
}

/// Time and configuration at the fraction `alpha` of a step.
#[must_use]
#[inline(always)]
pub fn on_line<S: Scalar, const N: usize>(alpha: f64, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> (S, [S; N]) {
    let part = h * alpha;
    (t0 + part, from_fn(|i| q0[i] + part * v[i]))
}

/// The constraint `g = A v + b` at a state, and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstraintSlopes<const N: usize, const M: usize> {
    /// The rows `A = g_v`.
    pub a: [[f64; N]; M],
    /// `A v + b`.
    pub g: [f64; M],
    /// Its derivatives in the coordinates.
    pub g_q: [[f64; N]; M],
}

impl<const N: usize, const M: usize> ConstraintSlopes<N, M> {
    /// At the state `(q, v)`; the reaction `A' l` of the impulses `l` is added to `w`, and its derivatives in the coordinates to
    /// `w_q`.
    #[must_use]
    #[inline(always)]
    pub fn reacting<Sys: System<N, M>>(
        system: &Sys,
        t: f64,
        (q, v): (&[f64; N], &[f64; N]),
        impulse: &[f64; M],
        (w, w_q): (&mut [f64; N], &mut [[f64; N]; N]),
    ) -> Self {
        let mut slopes = Self { a: [[0.0; N]; M], g: [0.0; M], g_q: [[0.0; N]; M] };
        match const { N <= AT_ONCE } {
            true => slopes.add::<Sys, N>(system, t, (q, v), impulse, (w, w_q), 0),
            false => slopes.add_by_blocks(system, t, (q, v), impulse, (w, w_q)),
        }
        slopes
    }

    #[inline(never)]
    fn add_by_blocks<Sys: System<N, M>>(
        &mut self,
        system: &Sys,
        t: f64,
        state: (&[f64; N], &[f64; N]),
        impulse: &[f64; M],
        (w, w_q): (&mut [f64; N], &mut [[f64; N]; N]),
    ) {
        for from in (0..N).step_by(BLOCK) {
            self.add::<Sys, BLOCK>(system, t, state, impulse, (w, w_q), from);
        }
    }

    /// With the derivatives in `P` coordinates, from number `from` on.
    #[inline(always)]
    fn add<Sys: System<N, M>, const P: usize>(
        &mut self,
        system: &Sys,
        t: f64,
        (q, v): (&[f64; N], &[f64; N]),
        impulse: &[f64; M],
        (w, w_q): (&mut [f64; N], &mut [[f64; N]; N]),
        from: usize,
    ) {
        let in_q: [Dual<f64, P>; N] = from_fn(|i| Dual { re: q[i], eps: seed(1.0, i, from) });
        let (rows, b) = system.constraint(Dual::fixed(t), &in_q);
        for k in 0..M {
            if from == 0 {
                self.g[k] = b[k].re;
            }
            for (j, e) in (from..N).zip(b[k].eps) {
                self.g_q[k][j] = e;
            }
            for i in 0..N {
                let a: Dual<f64, P> = rows[k][i];
                if from == 0 {
                    self.a[k][i] = a.re;
                    self.g[k] += a.re * v[i];
                    w[i] += a.re * impulse[k];
                }
                for (j, e) in (from..N).zip(a.eps) {
                    self.g_q[k][j] += e * v[i];
                    w_q[i][j] += e * impulse[k];
                }
            }
        }
    }
}
