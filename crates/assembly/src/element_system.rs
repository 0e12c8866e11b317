use dla::Mechanics;
use lagrangian::{Motion, Piecewise, Saddle, System};

/// What an assembly asks of a system: what methods ask, and what only an assembly does.
pub(crate) trait ElementSystem<const N: usize, const M: usize>: Mechanics<N, M> + Send + Sync {
    /// The times at which it jumps, in the open interval from `from` to `to` (s).
    fn jumps_between(&self, from: f64, to: f64) -> Vec<f64>;

    /// The smooth piece that holds at the time `t` (s).
    fn piece_at(&self, t: f64) -> Box<dyn ElementSystem<N, M>>;

    /// The linear equations for the accelerations.
    fn equations(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Saddle<N, M>;
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
}
