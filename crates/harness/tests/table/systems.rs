//! Systems that no crate brings: fields, forces, explicit time, affine constraints.

use crate::table::shapes::{Known, Place};
use lagrangian::{AdmissibleBasis, Constraint, Effect, Scalar, System, With};
use sleigh::{CentreOfMass, Exact, Sleigh, SleighState};

/// A potential at the centre of mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Field {
    /// None.
    Free,
    /// `(X^2 + Y^2)/2`
    Well,
    /// `Y^2/2`
    Valley,
    /// `(cos X + cos Y)/2`
    EggCrate,
    /// The egg-crate, drawn along `x`: `(cos(X - 0.7 t) + cos Y)/2`
    Tide,
}

/// The sleigh in coordinates of its centre of mass, in a field.
///
/// Where the whole system has a period of `2 pi` in a coordinate, or does not depend on it, that coordinate is an angle
/// to the integrators: far from the origin its own rounding would be all that the energy shows.
#[derive(Debug, Clone, Copy)]
pub struct InField {
    pub sleigh: CentreOfMass,
    pub field: Field,
}

impl System<3, 1> for InField {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let free = self.sleigh.lagrangian(t, q, v);
        let [x, y, _] = *q;
        match self.field {
            Field::Free => free,
            Field::Well => free - (x * x + y * y) * 0.5,
            Field::Valley => free - y * y * 0.5,
            Field::EggCrate => free - (x.cos() + y.cos()) * 0.5,
            Field::Tide => free - ((x - t * 0.7).cos() + y.cos()) * 0.5,
        }
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        self.sleigh.constraint(t, q)
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        self.sleigh.admissible_basis(t, q)
    }
    fn angles(&self) -> [bool; 3] {
        match self.field {
            Field::Free | Field::Well => [false, false, true],
            Field::Valley => [true, false, true],
            Field::EggCrate | Field::Tide => [true; 3],
        }
    }
}

impl Known<3> for InField {}

impl Known<3> for Sleigh {
    fn exact_from(&self, (q, v): &Place<3>, t: f64) -> Option<Place<3>> {
        Exact::new(self, &SleighState::from_coordinates(q, v)).ok().map(|exact| exact.at(t).to_coordinates())
    }
    fn invariants(&self, q: &[f64; 3], v: &[f64; 3]) -> Vec<(&'static str, f64)> {
        let energy = ("energy", lagrangian::energy(self, 0.0, q, v));
        // Without offset the turn is a horizontal symmetry.
        vec![energy, ("turn momentum", self.pivot_inertia() * v[2])]
    }
}

/// A force (N) along the blade that swings with a frequency (rad/s), or is constant where that is zero.
#[derive(Debug, Clone, Copy)]
pub struct Thrust {
    pub force: f64,
    pub frequency: f64,
}

impl<B> Effect<B, 3> for Thrust {
    fn force<S: Scalar>(&self, _body: &B, t: S, q: &[S; 3], _v: &[S; 3]) -> Option<[S; 3]> {
        let (sin, cos) = q[2].sin_cos();
        let force = (t * self.frequency).cos() * self.force;
        Some([cos * force, sin * force, S::zero()])
    }
}

impl Known<3> for With<Sleigh, Thrust> {}
impl Known<3> for With<InField, Thrust> {}

/// A sideways force that grows with the turn rate, a couple, and friction, part of it cubic.
#[derive(Debug, Clone, Copy)]
pub struct Forces;

impl Effect<Sleigh, 3> for Forces {
    fn force<S: Scalar>(&self, _body: &Sleigh, _t: S, q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        let (sin, cos) = q[2].sin_cos();
        Some([cos * v[2] - v[0] * 0.2, sin - v[1] * 0.2, q[0] * 0.3 - v[2] * v[2] * v[2] * 0.1])
    }
}

impl Known<3> for With<Sleigh, Forces> {}

/// Time everywhere: masses that depend on time and place, a magnetic term, an affine constraint that moves, a force.
#[derive(Debug, Clone, Copy)]
pub struct Moving {
    /// Whether a basis of the admissible velocities is given.
    pub basis: bool,
}

impl System<3, 1> for Moving {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let mass = (t * 1.5).sin() * 0.3 + q[0] * q[0] * 0.2 + 1.0;
        let kinetic = (mass * v[0] * v[0] + v[1] * v[1] + v[2] * v[2] * (q[1].cos() * 0.3 + 1.5)) * 0.5;
        kinetic + q[1] * v[0] * 0.4 + (t * t) * v[2] * q[0] * 0.1 - (q[0] + t * 0.5).cos() * 0.6 - q[2] * q[2] * 0.5
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        ([[-q[1], (t + q[2]).sin() * 0.5, S::constant(1.0)]], [t.cos() * 0.3 + q[0] * 0.2])
    }
    fn force<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        Some([(t * 2.0).cos() * 0.4 - v[0] * 0.1, -(v[0] * v[1]) * 0.2, q[1] * v[2] * -0.3])
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        self.basis.then(|| AdmissibleBasis::new([[one, zero, q[1]], [zero, one, -((t + q[2]).sin() * 0.5)]]))
    }
}

impl Known<3> for Moving {}

/// The sleigh at its blade on a plane that turns about the origin at the given rate (rad/s).
#[derive(Debug, Clone, Copy)]
pub struct Turntable {
    pub sleigh: Sleigh,
    pub rate: f64,
}

impl System<3, 1> for Turntable {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        self.sleigh.lagrangian(t, q, v)
    }
    /// `n . (P' - rate (-y, x)) = 0`.
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let (sin, cos) = q[2].sin_cos();
        (self.sleigh.constraint(t, q).0, [-(sin * q[1] + cos * q[0]) * self.rate])
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        self.sleigh.admissible_basis(t, q)
    }
    fn angles(&self) -> [bool; 3] {
        self.sleigh.angles()
    }
}

impl Known<3> for Turntable {}

/// A particle with `z' = y x'` whose masses depend on its place, in a magnetic field and a well, the energy not quadratic
/// in the velocities.
#[derive(Debug, Clone, Copy)]
pub struct Magnetic {
    pub mass: f64,
    pub quartic: f64,
}

impl System<3, 1> for Magnetic {
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

impl Known<3> for Magnetic {}

/// Place and heading at the centre of mass, blade speed `u`, turn rate: the coordinates there, the offset `a` ahead of
/// the blade.
pub fn at_centre([x, y, heading, u, omega]: [f64; 5], a: f64) -> Place<3> {
    let (sin, cos) = f64::sin_cos(heading);
    ([x, y, heading], [u * cos - a * omega * sin, u * sin + a * omega * cos, omega])
}
