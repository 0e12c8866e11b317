use crate::energy::element::Swing;
use dla::Mechanics;
use lagrangian::{Bracket, Dual, HyperDual, Lanes, Motion, Piecewise, Saddle, Scalar, System, from_fn};

/// What an assembly asks of a system: what methods ask, and what only an assembly does.
pub(crate) trait ElementSystem<const N: usize, const M: usize>: Mechanics<N, M> + Send + Sync {
    /// The times at which it jumps, in the open interval from `from` to `to` (s).
    fn jumps_between(&self, from: f64, to: f64) -> Vec<f64>;

    /// The smooth piece that holds at the time `t` (s).
    fn piece_at(&self, t: f64) -> Box<dyn ElementSystem<N, M>>;

    /// The linear equations for the accelerations.
    fn equations(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Saddle<N, M>;

    /// Whether a constraint has another `b` than zero, or one that changes with time.
    fn has_moving_rows(&self, t: f64, q: &[f64; N]) -> bool;

    /// `L_q` at rest at eight places, and `L_qq` at rest in their middle.
    fn potential_slopes(&self, t: f64, path: &[Lanes; N], middle: &[f64; N]) -> ([Lanes; N], [[f64; N]; N]);

    /// The derivatives of the constraints on positions at eight places; none of a system without such constraints.
    fn position_slopes(&self, t: f64, path: &[Lanes; N]) -> Option<[Option<[Lanes; N]>; M]>;

    /// A body with the mean quasi-velocities `xi` over a step from `q0`; nothing where its basis ends.
    fn swing(&self, step: (f64, f64), q0: &[f64; N], xi: &[f64], out: Swing<'_>) -> Option<()>;
}

impl<Sys, const N: usize, const M: usize> ElementSystem<N, M> for Sys
where
    Sys: System<N, M> + Piecewise + Send + Sync + 'static,
{
    fn jumps_between(&self, from: f64, to: f64) -> Vec<f64> {
        self.jumps(from, to)
    }

    fn piece_at(&self, t: f64) -> Box<dyn ElementSystem<N, M>> {
        Box::new(self.piece(t))
    }

    fn equations(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Saddle<N, M> {
        Motion::equations(self, t, q, v)
    }

    fn has_moving_rows(&self, t: f64, q: &[f64; N]) -> bool {
        let (_, b) = System::constraint(self, Dual { re: t, eps: [1.0] }, &q.map(Dual::fixed));
        b.iter().any(|b: &Dual<f64, 1>| !b.is_zero())
    }

    fn potential_slopes(&self, t: f64, path: &[Lanes; N], middle: &[f64; N]) -> ([Lanes; N], [[f64; N]; N]) {
        let rest = [Dual::zero(); N];
        let l = System::lagrangian(self, Dual::fixed(Lanes::constant(t)), &Dual::variables(path), &rest);
        let unit = |i: usize| from_fn(|k| f64::from(u8::from(k == i)));
        let middle: [HyperDual<f64, N, N>; N] = from_fn(|i| HyperDual::linear(middle[i], unit(i), unit(i)));
        let l_qq = System::lagrangian(self, HyperDual::fixed(t), &middle, &[HyperDual::fixed(0.0); N]).e12;
        (l.eps, l_qq)
    }

    fn position_slopes(&self, t: f64, path: &[Lanes; N]) -> Option<[Option<[Lanes; N]>; M]> {
        let positions = self.holonomic(Dual::fixed(Lanes::constant(t)), &Dual::variables(path))?;
        Some(positions.map(|g: Option<Dual<Lanes, N>>| g.map(|g| g.eps)))
    }

    fn swing(&self, (t0, h): (f64, f64), q0: &[f64; N], xi: &[f64], out: Swing<'_>) -> Option<()> {
        /// However the basis turns, its turn in a step of less than a radian is found with fewer.
        const ITERATIONS: u32 = 60;
        let k = xi.len();
        let t = Dual::<f64, N>::fixed(t0 + 0.5 * h);
        let x = from_fn(|a| xi.get(a).map_or(Dual::zero(), |xi| Dual::variable(*xi, a)));
        let mut v = self.admissible_basis(t, &q0.map(Dual::fixed))?.combine(&x);
        let middle = |v: &[Dual<f64, N>; N]| from_fn(|i| v[i] * (0.5 * h) + q0[i]);
        for _ in 0..ITERATIONS {
            let next = self.admissible_basis(t, &middle(&v))?.combine(&x);
            let settled = next == v;
            v = next;
            if settled {
                break;
            }
        }
        let bracket = Bracket::at(self, t, &middle(&v), &x)?;
        let (_, rates) = bracket.rates(&[Dual::zero(); N], &x);
        for i in 0..N {
            out.v[i] = v[i].re;
            out.slope[i * k..][..k].copy_from_slice(&v[i].eps[..k]);
        }
        for a in 0..k {
            out.turning[a] = -rates[a].re;
            for b in 0..k {
                out.turning_slope[a * k + b] = -rates[a].eps[b];
            }
            for i in 0..N {
                out.frame[i * k + a] = bracket.basis.vectors()[a][i].re;
            }
        }
        Some(())
    }
}
