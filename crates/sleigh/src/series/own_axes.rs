use crate::Sleigh;
use lagrangian::With;

/// The reduced equations of a body on the plane in axes that turn with it, where they are of second degree and have the turn rate
/// for their only factor:
///
/// `u' = a omega^2 - d_u u + f_0 + f_1 X`, `omega' = -c u omega - d_omega omega + g_0 + g_1 Y`, `X' = u + omega Y`, `Y' = -omega X`,
/// `theta' = omega`.
///
/// `(X, Y)` is the place of the contact point in these axes (m), `xi = (u, omega)` the quasi-velocities (m/s, rad/s). No sine is
/// left, so that their Taylor series are sums of products. The heading is needed nowhere, which is the reduction of Bloch,
/// Krishnaprasad, Marsden and Murray 1996, Arch. Rational Mech. Anal. 136, 21-99, by the turns about a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnAxes {
    /// The point of the plane that the place is counted from (m), where that matters.
    pub center: Option<[f64; 2]>,
    /// The inverse mass (1/kg), and the inverse moment of inertia about the contact point (1/(kg m^2)).
    pub inverse: [f64; 2],
    /// The distance `a` of the centre of mass ahead of the contact point (m).
    pub lead: f64,
    /// The rate `c` by which turning dies out or grows (1/m).
    pub gain: f64,
    /// `f_0` (m/s^2) and `f_1` (1/s^2).
    pub along: [f64; 2],
    /// `g_0` (rad/s^2) and `g_1` (1/(m s^2)).
    pub turning: [f64; 2],
    /// `d_u` and `d_omega`, the rates by which drag takes the speed and the turn rate (1/s).
    pub damping: [f64; 2],
}

/// A force on such a body, `F_0 + F_1 X - D_u u` along it at the contact point (N) and the torque `T_0 + T_1 Y - D_omega omega` about it
/// (N m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnPush {
    /// The point of the plane that `(X, Y)` is counted from (m), where that matters.
    pub center: Option<[f64; 2]>,
    /// `F_0` (N) and `F_1` (N/m).
    pub along: [f64; 2],
    /// `T_0` (N m) and `T_1` (N).
    pub turning: [f64; 2],
    /// `D_u` (kg/s) and `D_omega` (kg m^2/s).
    pub drag: [f64; 2],
}

/// The point that both are counted from; none where they are two.
fn common(one: Option<[f64; 2]>, other: Option<[f64; 2]>) -> Option<Option<[f64; 2]>> {
    match (one, other) {
        (Some(one), Some(other)) if one.map(f64::to_bits) != other.map(f64::to_bits) => None,
        _ => Some(one.or(other)),
    }
}

impl OwnPush {
    /// No force.
    pub const NOTHING: Self = Self { center: None, along: [0.0; 2], turning: [0.0; 2], drag: [0.0; 2] };

    /// Both together; none where their places are counted from two points.
    #[must_use]
    pub fn and(self, other: Self) -> Option<Self> {
        let center = common(self.center, other.center)?;
        let sum = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        Some(Self {
            center,
            along: sum(self.along, other.along),
            turning: sum(self.turning, other.turning),
            drag: sum(self.drag, other.drag),
        })
    }
}

impl OwnAxes {
    /// Whether drag takes anything.
    pub(super) fn is_damped(&self) -> bool {
        self.damping.iter().any(|rate| *rate != 0.0)
    }

    /// The equations with a push added; `None` if the push is counted from another centre.
    #[must_use]
    pub fn pushed(self, push: OwnPush) -> Option<Self> {
        let [per_mass, per_inertia] = self.inverse;
        let center = common(self.center, push.center)?;
        let more = |a: [f64; 2], b: [f64; 2], factor: f64| [b[0].mul_add(factor, a[0]), b[1].mul_add(factor, a[1])];
        let (along, turning) = (more(self.along, push.along, per_mass), more(self.turning, push.turning, per_inertia));
        let [d_u, d_omega] = self.damping;
        let damping = [push.drag[0].mul_add(per_mass, d_u), push.drag[1].mul_add(per_inertia, d_omega)];
        Some(Self { center, along, turning, damping, ..self })
    }
}

/// A system whose reduced equations may be of second degree in axes that turn with its body.
pub trait InOwnAxes {
    /// The reduced equations of the body ([`System::reduced`](lagrangian::System::reduced)) in these axes; `None` if they are not of
    /// second degree.
    fn own_axes(&self) -> Option<OwnAxes>;
}

/// An effect whose force may be constant in time and of first degree, in axes that turn with the sleigh.
pub trait PushInOwnAxes {
    /// The force; `None`, the default, if it is not of this form.
    fn in_own_axes(&self, _sleigh: &Sleigh) -> Option<OwnPush> {
        None
    }
}

impl InOwnAxes for Sleigh {
    fn own_axes(&self) -> Option<OwnAxes> {
        Some(OwnAxes {
            center: None,
            inverse: self.inverse(),
            lead: self.offset(),
            gain: self.spin_gain(),
            along: [0.0; 2],
            turning: [0.0; 2],
            damping: [0.0; 2],
        })
    }
}

impl<E: PushInOwnAxes> InOwnAxes for With<Sleigh, E> {
    fn own_axes(&self) -> Option<OwnAxes> {
        self.body.own_axes()?.pushed(self.effects.in_own_axes(&self.body)?)
    }
}

/// No force.
impl PushInOwnAxes for () {
    fn in_own_axes(&self, _sleigh: &Sleigh) -> Option<OwnPush> {
        Some(OwnPush::NOTHING)
    }
}

impl<E: PushInOwnAxes> PushInOwnAxes for Vec<E> {
    fn in_own_axes(&self, sleigh: &Sleigh) -> Option<OwnPush> {
        self.iter().try_fold(OwnPush::NOTHING, |sum, effect| sum.and(effect.in_own_axes(sleigh)?))
    }
}

macro_rules! tuples_of_pushes {
    ($(($($effect:ident $index:tt),+))+) => {
        $(impl<$($effect: PushInOwnAxes),+> PushInOwnAxes for ($($effect,)+) {
            fn in_own_axes(&self, sleigh: &Sleigh) -> Option<OwnPush> {
                let sum = OwnPush::NOTHING;
                $(let sum = sum.and(self.$index.in_own_axes(sleigh)?)?;)+
                Some(sum)
            }
        })+
    };
}
tuples_of_pushes!((E0 0) (E0 0, E1 1) (E0 0, E1 1, E2 2) (E0 0, E1 1, E2 2, E3 3));
