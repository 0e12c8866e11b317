use dla::{Composition, Dla, Energy, Gauss, Lobatto, Mechanics, OneStep, RunError, Schedule, State, drive};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};

/// A cart on a rail between two springs, with drag: `V = k1/2 (x - a)^2 + k2/2 (x - b)^2`, `y' = 0`.
#[derive(Debug, Clone, Copy)]
pub struct Cart<const BASIS: bool> {
    pub ends: [f64; 2],
    pub stiffness: [f64; 2],
    pub drag: f64,
}

impl<const BASIS: bool> Cart<BASIS> {
    /// Where the springs balance.
    pub fn balance(&self) -> f64 {
        let ([a, b], [k1, k2]) = (self.ends, self.stiffness);
        (a * k1 + b * k2) / (k1 + k2)
    }

    /// The frequency about it (rad/s).
    pub fn frequency(&self) -> f64 {
        self.stiffness.iter().sum::<f64>().sqrt()
    }
}

impl<const BASIS: bool> System<2, 1> for Cart<BASIS> {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 2], v: &[S; 2]) -> S {
        let spring = |i: usize| (q[0] - self.ends[i]).squared() * (0.5 * self.stiffness[i]);
        (v[0] * v[0] + v[1] * v[1]) * 0.5 - spring(0) - spring(1)
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Constraint<S, 2, 1> {
        ([[S::zero(), S::constant(1.0)]], [S::zero()])
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> Option<[S; 2]> {
        (self.drag != 0.0).then(|| v.map(|v| v * -self.drag))
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Option<AdmissibleBasis<S, 2, 1>> {
        BASIS.then(|| AdmissibleBasis::new([[S::constant(1.0), S::zero()]]))
    }
}

/// A point of unit mass on a circle of radius 1 m in `x` and `y`, `y` upward, with drag.
#[derive(Debug, Clone, Copy)]
pub struct Pendulum {
    pub drag: f64,
}

pub const GRAVITY: f64 = 9.81;

impl System<2, 1> for Pendulum {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 2], v: &[S; 2]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * 0.5 - q[1] * GRAVITY
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 2]) -> Constraint<S, 2, 1> {
        ([*q], [S::zero()])
    }
    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 2]) -> Option<[Option<S>; 1]> {
        Some([Some((q[0] * q[0] + q[1] * q[1] - 1.0) * 0.5)])
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> Option<[S; 2]> {
        (self.drag != 0.0).then(|| v.map(|v| v * -self.drag))
    }
}

/// A balanced skate of unit mass and inertia on a slope that falls along `SLOPE` (m/s^2): across it the blade bears the weight.
#[derive(Debug, Clone, Copy)]
pub struct Skate<const BASIS: bool>;

pub const SLOPE: [f64; 2] = [5.3, -8.2];

impl<const BASIS: bool> System<3, 1> for Skate<BASIS> {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5 + q[0] * SLOPE[0] + q[1] * SLOPE[1]
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let (sin, cos) = q[2].sin_cos();
        ([[-sin, cos, S::zero()]], [S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let ((sin, cos), zero, one) = (q[2].sin_cos(), S::zero(), S::constant(1.0));
        BASIS.then(|| AdmissibleBasis::new([[cos, sin, zero], [zero, zero, one]]))
    }
    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }
}

/// Runs a system by a method, and shows its state at the end.
pub type Run<Sys, const N: usize> = fn(&Sys, &Schedule, State<N>) -> Result<State<N>, RunError>;

fn run<Sys: System<N, M>, Method: OneStep<N, M> + Default, const N: usize, const M: usize>(
    system: &Sys,
    schedule: &Schedule,
    mut state: State<N>,
) -> Result<State<N>, RunError> {
    drive(system, &mut Method::default(), schedule, &mut state, ()).map(|_| state)
}

macro_rules! by_default {
    ($name:ident, $method:ty, $make:expr) => {
        #[derive(Debug, Clone)]
        struct $name($method);
        impl Default for $name {
            fn default() -> Self {
                Self($make)
            }
        }
        impl<const N: usize, const M: usize> OneStep<N, M> for $name
        where
            $method: OneStep<N, M>,
        {
            fn step(
                &mut self,
                system: &dyn Mechanics<N, M>,
                t: f64,
                h: f64,
                state: &mut State<N>,
            ) -> Result<dla::StepReport<M>, dla::StepError> {
                self.0.step(system, t, h, state)
            }
        }
    };
}
by_default!(Middle, Dla, Dla::midpoint());
by_default!(Ends, Dla, Dla::trapezoid());
by_default!(Fourth, Composition<Dla>, Composition::suzuki4(Dla::midpoint()));

by_default!(Gauss8, Gauss, Gauss::new::<4>());
by_default!(Gauss16, Gauss, Gauss::new::<8>());
by_default!(Energy2, Energy, Energy::new::<1>());
by_default!(Energy4, Energy, Energy::new::<2>());
by_default!(Energy8, Energy, Energy::new::<4>());

/// The methods that need nothing but the Lagrangian and the constraint, by their names.
pub fn methods<Sys: System<N, M>, const N: usize, const M: usize>() -> Vec<(&'static str, Run<Sys, N>)> {
    vec![
        ("dla", run::<Sys, Middle, N, M>),
        ("dla-trapezoid", run::<Sys, Ends, N, M>),
        ("dla4", run::<Sys, Fourth, N, M>),
        ("lobatto3", run::<Sys, Lobatto<3>, N, M>),
        ("lobatto5", run::<Sys, Lobatto<5>, N, M>),
    ]
}

/// Those that need a basis of the admissible velocities besides.
pub fn in_basis<Sys: System<N, M>, const N: usize, const M: usize>() -> Vec<(&'static str, Run<Sys, N>)> {
    vec![
        ("gauss8", run::<Sys, Gauss8, N, M>),
        ("gauss16", run::<Sys, Gauss16, N, M>),
        ("energy2", run::<Sys, Energy2, N, M>),
        ("energy4", run::<Sys, Energy4, N, M>),
        ("energy8", run::<Sys, Energy8, N, M>),
    ]
}
