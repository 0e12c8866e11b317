use crate::Sleigh;
use crate::effects::MovingMass;
use lagrangian::Scalar;

/// The moments of a sleigh and of the masses that are moved in it, about the blade and in the body's frame: `r` is the place of each
/// mass `m` along `e` and `n`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moments<S> {
    /// `sum m` (kg).
    pub mass: S,
    /// `sum m r` (kg m).
    pub first: [S; 2],
    /// `sum m r'` (kg m/s).
    pub first_rate: [S; 2],
    /// `sum m r''` (kg m/s^2).
    pub first_curvature: [S; 2],
    /// The moment of inertia (kg m^2).
    pub inertia: S,
    /// `sum m r . r'`, half the rate of the moment of inertia (kg m^2/s).
    pub growth: S,
    /// `sum m (r_x r_y'' - r_y r_x'')` (kg m^2/s^2).
    pub twist: S,
}

impl<S: Scalar> Moments<S> {
    /// The moments at the time `t` (s).
    #[inline(always)]
    pub(super) fn of(sleigh: &Sleigh, masses: &[MovingMass], t: S) -> Self {
        let all = t.called(
            #[inline(always)]
            |t| {
                let none = constant(0.0, t);
                let bare = Self {
                    mass: constant(sleigh.mass(), t),
                    first: [constant(sleigh.mass() * sleigh.offset(), t), none],
                    first_rate: [none; 2],
                    first_curvature: [none; 2],
                    inertia: constant(sleigh.pivot_inertia(), t),
                    growth: none,
                    twist: none,
                };
                S::over(
                    masses,
                    bare,
                    #[inline(always)]
                    |sum, mass| sum.with(mass, t),
                )
            },
        );
        all.carried_as(t)
    }

    #[inline(always)]
    fn carried_as(self, t: S) -> Self {
        Self {
            mass: self.mass.carried_as(t),
            first: two(self.first, t),
            first_rate: two(self.first_rate, t),
            first_curvature: two(self.first_curvature, t),
            inertia: self.inertia.carried_as(t),
            growth: self.growth.carried_as(t),
            twist: self.twist.carried_as(t),
        }
    }

    #[inline(always)]
    fn with(self, moving: &MovingMass, t: S) -> Self {
        let m = moving.mass;
        let [[x, y], [vx, vy], [ax, ay]] = moving.path(t);
        Self {
            mass: self.mass + m,
            first: plus(self.first, [x, y], m),
            first_rate: plus(self.first_rate, [vx, vy], m),
            first_curvature: plus(self.first_curvature, [ax, ay], m),
            inertia: self.inertia + (x * x + y * y) * m,
            growth: self.growth + (x * vx + y * vy) * m,
            twist: self.twist + (x * ay - y * ax) * m,
        }
    }
}

/// A constant, carried as the time is: of numbers in registers a run must not decide how they are carried.
#[inline(always)]
fn constant<S: Scalar>(x: f64, t: S) -> S {
    S::constant(x).carried_as(t)
}

#[inline(always)]
fn two<S: Scalar>([a, b]: [S; 2], t: S) -> [S; 2] {
    [a.carried_as(t), b.carried_as(t)]
}

/// `a + m b`.
#[inline(always)]
fn plus<S: Scalar>(a: [S; 2], b: [S; 2], m: f64) -> [S; 2] {
    [a[0] + b[0] * m, a[1] + b[1] * m]
}
