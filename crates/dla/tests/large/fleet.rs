//! Systems of many coordinates whose motion is known: every part moves by itself, and a reflection of all coordinates mixes them, so
//! that masses and constraint rows are full.

use dla::{OneStep, RunError, Schedule, State, drive};
use lagrangian::linear::largest;
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System, constraint_residual, from_fn};

/// `x = q - 2 u (u . q)`, its own inverse.
#[derive(Debug, Clone, Copy)]
pub struct Mirror<const N: usize>([f64; N]);

impl<const N: usize> Mirror<N> {
    pub fn new() -> Self {
        let along: [f64; N] = from_fn(|i| 1.0 + i as f64 / N as f64);
        let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
        Self(along.map(|x| x / length))
    }

    pub fn of<S: Scalar>(&self, q: &[S; N]) -> [S; N] {
        let along = (0..N).fold(S::zero(), |sum, i| sum + q[i] * (2.0 * self.0[i]));
        from_fn(|i| q[i] - along * self.0[i])
    }

    /// `sum m_k v_k^2 / 2` of parts with three coordinates each.
    fn kinetic<S: Scalar>(&self, v: &[S; N]) -> S {
        let w = self.of(v);
        (0..N).fold(S::zero(), |sum, i| sum + w[i] * w[i] * (0.5 + 0.05 * (i / 3) as f64))
    }
}

/// Skates, each free: circles. With a basis of the admissible velocities, or without.
#[derive(Debug, Clone, Copy)]
pub struct Fleet<const N: usize, const BASIS: bool>(pub Mirror<N>);

/// Points on unit spheres, constrained in their positions: great circles. The last row may say the same as the first.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(all(debug_assertions, not(clippy)), allow(dead_code, reason = "not every build has a shape of them"))]
pub struct Balls<const N: usize, const TWICE: bool>(pub Mirror<N>);

macro_rules! systems {
    ($($n:literal $m:literal),*) => { $(
        impl<const BASIS: bool> System<$n, $m> for Fleet<$n, BASIS> {
            fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; $n], v: &[S; $n]) -> S {
                self.0.kinetic(v)
            }
            fn constraint<S: Scalar>(&self, _t: S, q: &[S; $n]) -> Constraint<S, $n, $m> {
                let x = self.0.of(q);
                let mut a = [[S::zero(); $n]; $m];
                for (k, row) in a.iter_mut().enumerate() {
                    let (sin, cos) = x[3 * k + 2].sin_cos();
                    (row[3 * k], row[3 * k + 1]) = (-sin, cos);
                    *row = self.0.of(row);
                }
                (a, [S::zero(); $m])
            }
            fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; $n]) -> Option<AdmissibleBasis<S, $n, $m>> {
                let x = self.0.of(q);
                BASIS.then(|| {
                    AdmissibleBasis::from_fn(|b| {
                        let (k, mut w) = (b / 2, [S::zero(); $n]);
                        let (sin, cos) = x[3 * k + 2].sin_cos();
                        match b % 2 {
                            0 => (w[3 * k], w[3 * k + 1]) = (cos, sin),
                            _ => w[3 * k + 2] = S::constant(1.0),
                        }
                        self.0.of(&w)
                    })
                })
            }
        }

        impl<const TWICE: bool> System<$n, $m> for Balls<$n, TWICE> {
            fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; $n], v: &[S; $n]) -> S {
                self.0.kinetic(v)
            }
            fn constraint<S: Scalar>(&self, t: S, q: &[S; $n]) -> Constraint<S, $n, $m> {
                lagrangian::position_rows(self, t, q)
            }
            fn holonomic<S: Scalar>(&self, _t: S, q: &[S; $n]) -> Option<[Option<S>; $m]> {
                let x = self.0.of(q);
                Some(from_fn(|k| {
                    let k = if TWICE && k == $m - 1 { 0 } else { k };
                    Some((0..3).fold(S::constant(-0.5), |sum, i| sum + x[3 * k + i].squared() * 0.5))
                }))
            }
        }
    )* };
}
systems!(18 6, 30 10, 39 13, 60 20);

/// A known motion: its start, and its place at a time.
pub trait Known<const N: usize, const M: usize>: System<N, M> + Copy + Send + 'static {
    fn new() -> Self;
    fn mirror(&self) -> &Mirror<N>;
    /// Configuration and velocity, not mirrored.
    fn at(t: f64) -> ([f64; N], [f64; N]);
    /// By how much the functions of positions are missed.
    fn off(&self, q: &[f64; N]) -> f64 {
        lagrangian::position_residual(self, 0.0, q)
    }
}

impl<const N: usize, const M: usize, const BASIS: bool> Known<N, M> for Fleet<N, BASIS>
where
    Self: System<N, M>,
{
    fn new() -> Self {
        Self(Mirror::new())
    }
    fn mirror(&self) -> &Mirror<N> {
        &self.0
    }
    fn at(t: f64) -> ([f64; N], [f64; N]) {
        let (mut x, mut w) = ([0.0; N], [0.0; N]);
        for k in 0..M {
            let f = k as f64;
            let (u, omega, start) = (1.0 + 0.05 * f, 0.5 + 0.02 * f, 0.1 * f);
            let heading = start + omega * t;
            x[3 * k] = f + u / omega * (heading.sin() - start.sin());
            x[3 * k + 1] = -u / omega * (heading.cos() - start.cos());
            x[3 * k + 2] = heading;
            (w[3 * k], w[3 * k + 1], w[3 * k + 2]) = (u * heading.cos(), u * heading.sin(), omega);
        }
        (x, w)
    }
}

impl<const N: usize, const M: usize, const TWICE: bool> Known<N, M> for Balls<N, TWICE>
where
    Self: System<N, M>,
{
    fn new() -> Self {
        Self(Mirror::new())
    }
    fn mirror(&self) -> &Mirror<N> {
        &self.0
    }
    fn at(t: f64) -> ([f64; N], [f64; N]) {
        let (mut x, mut w) = ([0.0; N], [0.0; N]);
        for k in 0..M {
            // Nothing holds the last point where its row is another's: it goes straight.
            let omega = 1.0 + 0.05 * k as f64;
            let (sin, cos) = (omega * t).sin_cos();
            (x[3 * k], x[3 * k + 1], w[3 * k], w[3 * k + 1]) = (cos, sin, -omega * sin, omega * cos);
            if TWICE && k == M - 1 {
                (x[3 * k], x[3 * k + 1], w[3 * k], w[3 * k + 1]) = (1.0, omega * t, 0.0, omega);
            }
        }
        (x, w)
    }
}

/// What a run ended with.
#[derive(Debug, Clone, Copy)]
pub struct Ended {
    /// The distance of the configuration from the known one.
    pub error: f64,
    /// The largest constraint residual.
    pub slip: f64,
    /// By how much constraints on positions are missed.
    pub off: f64,
}

pub const STEPS: u64 = 20;
pub const STEP: f64 = 0.01;

/// Calls a function on a thread with a stack of `bytes` bytes.
pub fn with_stack<T: Send + 'static>(bytes: usize, run: impl FnOnce() -> T + Send + 'static) -> T {
    // Without optimisation nothing shares its place in a frame, and a step in vector registers has one of megabytes.
    let bytes = if cfg!(debug_assertions) { 32 * bytes } else { bytes };
    std::thread::Builder::new().stack_size(bytes).spawn(run).unwrap().join().unwrap()
}

/// Runs a system on a thread with a stack of `bytes` bytes: a step that needs more would end the program.
pub fn on_stack<Sys, Method, const N: usize, const M: usize>(
    bytes: usize,
    method: impl FnOnce() -> Method + Send + 'static,
) -> Result<Ended, RunError>
where
    Sys: Known<N, M>,
    Method: OneStep<N, M>,
{
    for_steps::<Sys, Method, N, M>(STEPS, bytes, method)
}

/// The same for `steps` steps.
pub fn for_steps<Sys, Method, const N: usize, const M: usize>(
    steps: u64,
    bytes: usize,
    method: impl FnOnce() -> Method + Send + 'static,
) -> Result<Ended, RunError>
where
    Sys: Known<N, M>,
    Method: OneStep<N, M>,
{
    with_stack(bytes, move || {
        let system = Sys::new();
        let (mirror, start) = (*system.mirror(), Sys::at(0.0));
        let mut state = State::new(mirror.of(&start.0), mirror.of(&start.1), [false; N]);
        drive(&system, &mut method(), &Schedule { t0: 0.0, step: STEP, steps }, &mut state, ())?;
        let (x, end) = (mirror.of(state.q()), Sys::at(steps as f64 * STEP).0);
        Ok(Ended {
            error: largest(&from_fn::<f64, N, _>(|i| x[i] - end[i])),
            slip: largest(&constraint_residual(&system, 0.0, state.q(), state.v())),
            off: system.off(state.q()),
        })
    })
}
