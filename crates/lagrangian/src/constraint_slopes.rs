use crate::second::{AT_ONCE, BLOCK, seed};
use crate::{Dual, System, from_fn};

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
