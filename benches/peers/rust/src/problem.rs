//! What a peer integrates: the sleigh and what acts on it, as numbers.

use crate::number::Number;
use serde::Deserialize;

/// A scene, as the Python side hands it over.
#[derive(Debug, Clone, Deserialize)]
pub struct Problem {
    /// Mass (kg).
    pub mass: f64,
    /// Moment of inertia about the centre of mass (kg m^2).
    pub inertia: f64,
    /// Centre of mass ahead of the blade (m).
    pub offset: f64,
    /// `x, y, heading, speed, turn_rate` at the start (m, m, rad, m/s, rad/s).
    pub start: [f64; 5],
    /// Length of the run (s).
    pub duration: f64,
    /// What acts on the sleigh.
    pub effects: Vec<Effect>,
}

/// What acts on the sleigh; signs and acting points as in `docs/scenes.md`.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Effect {
    /// `V = -m (gx X + gy Y)`.
    Slope { gravity: [f64; 2] },
    /// `V = kx/2 (X - cx)^2 + ky/2 (Y - cy)^2`.
    Bowl { stiffness: [f64; 2], center: [f64; 2] },
    /// The same at the blade.
    BladeBowl { stiffness: [f64; 2], center: [f64; 2] },
    /// `V = V0 (cos(kx X) + cos(ky Y))`.
    EggCrate { height: f64, wave_number: [f64; 2] },
    /// `V = h exp(-((X - x)^2 + (Y - y)^2) / (2 s^2))`.
    Hill { height: f64, x: f64, y: f64, width: f64 },
    /// Force `-along u`, torque `-turning omega`.
    Drag { along: f64, turning: f64 },
    /// A constant force along the blade.
    Thrust { force: f64 },
}

/// Forces on the sleigh.
#[derive(Debug, Clone, Copy)]
pub struct Load<S> {
    /// At the centre of mass (N).
    pub center: [S; 2],
    /// At the blade, along it (N).
    pub blade: S,
    /// On the heading (N m).
    pub torque: S,
}

impl<S: Number> Load<S> {
    #[inline(always)]
    fn none() -> Self {
        let zero = S::constant(0.0);
        Self { center: [zero; 2], blade: zero, torque: zero }
    }
}

/// Where the loads are asked for.
#[derive(Debug, Clone, Copy)]
pub struct Place<S> {
    /// Contact point of the blade (m).
    pub x: S,
    /// Contact point of the blade (m).
    pub y: S,
    /// Cosine of the heading.
    pub c: S,
    /// Sine of the heading.
    pub s: S,
    /// Speed along the blade (m/s).
    pub u: S,
    /// Turn rate (rad/s).
    pub w: S,
}

impl Effect {
    /// Adds the loads of the effect.
    #[inline(always)]
    fn add<S: Number>(&self, mass: f64, offset: f64, at: &Place<S>, load: &mut Load<S>) {
        let num = S::constant;
        let (x, y) = (at.x + at.c * offset, at.y + at.s * offset);
        let mut push = |fx: S, fy: S| load.center = [load.center[0] + fx, load.center[1] + fy];
        match *self {
            Self::Slope { gravity: [gx, gy] } => push(num(mass * gx), num(mass * gy)),
            Self::Bowl { stiffness: [kx, ky], center: [cx, cy] } => push((num(cx) - x) * kx, (num(cy) - y) * ky),
            Self::BladeBowl { stiffness: [kx, ky], center: [cx, cy] } => {
                // Across the blade its constraint force takes it up.
                load.blade = load.blade + (num(cx) - at.x) * kx * at.c + (num(cy) - at.y) * ky * at.s;
            }
            Self::EggCrate { height, wave_number: [kx, ky] } => {
                push((x * kx).sin_cos().0 * (height * kx), (y * ky).sin_cos().0 * (height * ky));
            }
            Self::Hill { height, x: xi, y: yi, width } => {
                let (dx, dy, s2) = (x - num(xi), y - num(yi), width * width);
                let f = ((dx * dx + dy * dy) * (-0.5 / s2)).exp() * (height / s2);
                push(f * dx, f * dy);
            }
            Self::Drag { along, turning } => {
                load.blade = load.blade - at.u * along;
                load.torque = load.torque - at.w * turning;
            }
            Self::Thrust { force } => load.blade = load.blade + num(force),
        }
    }
}

/// What acts, as a type, so that a free sleigh pays for nothing.
pub trait Loads: Clone {
    /// The loads at a place.
    fn at<S: Number>(&self, mass: f64, offset: f64, place: &Place<S>) -> Load<S>;
}

/// Nothing acts.
#[derive(Debug, Clone, Copy)]
pub struct Free;

impl Loads for Free {
    #[inline(always)]
    fn at<S: Number>(&self, _: f64, _: f64, _: &Place<S>) -> Load<S> {
        Load::none()
    }
}

impl Loads for Vec<Effect> {
    #[inline(always)]
    fn at<S: Number>(&self, mass: f64, offset: f64, place: &Place<S>) -> Load<S> {
        let mut load = Load::none();
        for effect in self {
            effect.add(mass, offset, place, &mut load);
        }
        load
    }
}

macro_rules! single {
    ($($name:ident, $kind:ident { $($field:ident: $type:ty),* });*) => {$(
        /// One effect alone, known when compiled.
        #[derive(Debug, Clone, Copy)]
        pub struct $name { $(pub $field: $type),* }
        impl Loads for $name {
            #[inline(always)]
            fn at<S: Number>(&self, mass: f64, offset: f64, place: &Place<S>) -> Load<S> {
                let mut load = Load::none();
                Effect::$kind { $($field: self.$field),* }.add(mass, offset, place, &mut load);
                load
            }
        }
    )*};
}
single!(OneBowl, Bowl { stiffness: [f64; 2], center: [f64; 2] };
        OneEggCrate, EggCrate { height: f64, wave_number: [f64; 2] });

/// The equations of motion.
#[derive(Debug, Clone)]
pub struct Sleigh<L> {
    m: f64,
    a: f64,
    inverse_m: f64,
    inverse_j: f64,
    loads: L,
}

impl<L: Loads> Sleigh<L> {
    /// The sleigh of a problem under these loads.
    pub fn new(problem: &Problem, loads: L) -> Self {
        let j = problem.inertia + problem.mass * problem.offset * problem.offset;
        Self { m: problem.mass, a: problem.offset, inverse_m: problem.mass.recip(), inverse_j: j.recip(), loads }
    }

    /// `u' = a w^2 + F_e / m`, `w' = (a F_n + torque - m a u w) / J`.
    #[inline(always)]
    fn rates<S: Number>(&self, at: &Place<S>) -> (S, S) {
        let load = self.loads.at(self.m, self.a, at);
        let along = load.center[0] * at.c + load.center[1] * at.s + load.blade;
        let across = load.center[1] * at.c - load.center[0] * at.s;
        (
            at.w * at.w * self.a + along * self.inverse_m,
            (across * self.a + load.torque - at.u * at.w * (self.m * self.a)) * self.inverse_j,
        )
    }

    /// Slope of `(x, y, heading, u, omega)`: the blade's constraint is solved by the choice of unknowns.
    #[inline(always)]
    pub fn reduced<S: Number>(&self, y: &[S; 5]) -> [S; 5] {
        let (s, c) = y[2].sin_cos();
        let at = Place { x: y[0], y: y[1], c, s, u: y[3], w: y[4] };
        let (du, dw) = self.rates(&at);
        [at.u * c, at.u * s, at.w, du, dw]
    }

    /// Slope of `(x, y, heading, x', y', omega)`: the constraint differentiated, its multiplier eliminated.
    #[inline(always)]
    pub fn full(&self, y: &[f64; 6]) -> [f64; 6] {
        let (s, c) = y[2].sin_cos();
        let at = Place { x: y[0], y: y[1], c, s, u: y[3] * c + y[4] * s, w: y[5] };
        let (du, dw) = self.rates(&at);
        // P'' = u' e + u omega n
        [y[3], y[4], at.w, du * c - at.u * at.w * s, du * s + at.u * at.w * c, dw]
    }
}
