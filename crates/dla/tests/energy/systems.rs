use crate::support::{ByHand, Three};
use dla::{OneStep, Schedule, State, drive};
use lagrangian::{AdmissibleBasis, Constraint, Effect, Scalar, System, With};
use sleigh::{CentreOfMass, Sleigh};
use std::array::from_fn;

/// A potential at the centre of mass.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Potential {
    /// `(cos X + cos Y)/2`
    EggCrate,
    /// `Y^2/2`
    Valley,
    /// `cos(100 X)/1000`
    Ripple,
}

impl Potential {
    fn at<S: Scalar>(self, x: S, y: S) -> S {
        match self {
            Self::EggCrate => (x.cos() + y.cos()) * 0.5,
            Self::Valley => y * y * 0.5,
            Self::Ripple => (x * 100.0).cos() * 0.001,
        }
    }
}

impl Effect<CentreOfMass, 3> for Potential {
    fn lagrangian<S: Scalar>(&self, _body: &CentreOfMass, _t: S, q: &[S; 3], _v: &[S; 3]) -> Option<S> {
        Some(-self.at(q[0], q[1]))
    }
}

impl Effect<Sleigh, 3> for Potential {
    fn lagrangian<S: Scalar>(&self, body: &Sleigh, _t: S, q: &[S; 3], _v: &[S; 3]) -> Option<S> {
        let (sin, cos) = q[2].sin_cos();
        Some(-self.at(q[0] + cos * body.offset(), q[1] + sin * body.offset()))
    }
}

/// Friction, part of it cubic, on the velocities of the body's coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Friction;
impl<B> Effect<B, 3> for Friction {
    fn force<S: Scalar>(&self, _body: &B, _t: S, _q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        Some([-v[0] * 0.1, -v[1] * 0.1, -v[2] * v[2] * v[2] * 0.2 - v[2] * 0.05])
    }
}

/// A particle with `z' = y x'` whose masses depend on its place, in a magnetic field and a well, the energy not quadratic
/// in the velocities.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Particle {
    pub(crate) mass: f64,
    pub(crate) quartic: f64,
}
impl System<3, 1> for Particle {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let kinetic =
            (v[0] * v[0] * (q[1].squared() * 0.4 + 1.0) + v[1] * v[1] + v[2] * v[2] * 0.7) * (0.5 * self.mass);
        let quartic = (v[0] * v[0] + v[1] * v[1]).squared() * self.quartic;
        kinetic + quartic + q[2] * v[0] * 0.3
            - (q[0] * q[0] + q[1] * q[1] * 2.0 + q[2] * q[2]) * 0.5
            - q[0].cos() * q[2]
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        ([[-q[1], S::zero(), S::constant(1.0)]], [S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new([[one, zero, q[1]], [q[0] * 0.2, one, q[0] * q[1] * 0.2]]))
    }
}

/// The sleigh where the potential has the period `2 pi` in the place, or none of it: the place then is an angle to the
/// integrators, whose rounding would else be all that the energy shows far from the origin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wrapped(With<CentreOfMass, Potential>);

impl System<3, 1> for Wrapped {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        self.0.lagrangian(t, q, v)
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        self.0.constraint(t, q)
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        self.0.admissible_basis(t, q)
    }
    fn angles(&self) -> [bool; 3] {
        [true, matches!(self.0.effects, Potential::EggCrate), true]
    }
}

pub(crate) fn com<E>(offset: f64, effects: E) -> ByHand
where
    With<CentreOfMass, E>: Into<ByHand>,
{
    With { body: CentreOfMass(Sleigh::new(1.0, 1.0, offset).unwrap()), effects }.into()
}

pub(crate) fn wrapped(offset: f64, effects: Potential) -> Three {
    Wrapped(With { body: CentreOfMass(Sleigh::new(1.0, 1.0, offset).unwrap()), effects }).into()
}

/// Place, heading, blade speed `u`, turn rate: coordinates at the centre of mass, the offset `a` ahead of the blade.
pub(crate) fn at_centre([x, y, heading, u, omega]: [f64; 5], a: f64) -> ([f64; 3], [f64; 3]) {
    let (sin, cos) = f64::sin_cos(heading);
    ([x, y, heading], [u * cos - a * omega * sin, u * sin + a * omega * cos, omega])
}

pub(crate) fn run<Sys, Method, const N: usize, const M: usize>(
    system: &Sys,
    method: &mut Method,
    (q, v): &([f64; N], [f64; N]),
    (duration, steps): (f64, u64),
) -> State<N>
where
    Sys: System<N, M>,
    Method: OneStep<N, M>,
{
    let mut state = State::new(*q, *v, system.angles());
    let schedule = Schedule { t0: 0.0, step: duration / steps as f64, steps };
    drive(system, method, &schedule, &mut state, ()).expect("the steps succeed");
    state
}

/// The largest difference of two states, angles with their turns.
pub(crate) fn distance<const N: usize>(a: &State<N>, b: &State<N>) -> f64 {
    let (qa, qb) = (a.unwrapped(), b.unwrapped());
    let place: [f64; N] = from_fn(|i| (qa[i] - qb[i]).abs());
    let velocity: [f64; N] = from_fn(|i| (a.v()[i] - b.v()[i]).abs());
    place.iter().chain(&velocity).fold(0.0, |m, x| m.max(*x))
}
