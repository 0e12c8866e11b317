//! The equations of a sleigh that is guided or carries masses.
//!
//! The velocity of the contact point is `P' = u e + s n`, where `s` is that of the plane below it, and a mass `m` of the body at
//! `r = r_x e + r_y n` has the acceleration
//!
//! ```text
//! u' - omega s - r_x omega^2 - r_y omega' - 2 omega r_y' + r_x''     along e,
//! s' + omega u + r_x omega' - r_y omega^2 + 2 omega r_x' + r_y''     along n.
//! ```
//!
//! Newton's law for all masses along `e`, and about the blade, has the [`Moments`] of the body for coefficients:
//!
//! ```text
//! M u'    - S_y omega' = F   + M omega s + S_x omega^2 + 2 omega S_y' - S_x'',
//! J omega' - S_y u'    = tau - S_x (s' + omega u) - S_y omega s - 2 omega D - H,
//! ```
//!
//! with `M = sum m`, `S = sum m r`, `D = sum m r . r'`, `H = sum m (r_x r_y'' - r_y r_x'')`.

use super::guided::Guide;
use super::moments::Moments;
use crate::Guided;
use lagrangian::{Motion, Reduced, ReducedError, Scalar, System};

impl<const K: usize> Guided<K> {
    /// `u` and `omega`: imposed ones from the guides, free ones from the quasi-velocities `xi`.
    #[inline(always)]
    fn own<S: Scalar>(&self, t: S, q: &[S; 3], xi: &[S; 3]) -> [S; 2] {
        if const { K == 0 } {
            return [xi[0], xi[1]];
        }
        match &self.guides[..] {
            [Guide::Speed(u), Guide::TurnRate(omega)] => [u.value(t), omega.value(t)],
            [Guide::Speed(u)] => [u.value(t), xi[0]],
            [Guide::TurnRate(omega)] => [xi[0], omega.value(t)],
            [Guide::TracerX(path), ..] if K > 1 => {
                // C' = P' + a omega n.
                let (sin, cos) = q[2].sin_cos();
                let [x, y] = path.velocity(t).map(|rate| rate.carried_as(t));
                let across = cos * y - sin * x - self.swept(q);
                [cos * x + sin * y, across / self.sleigh.offset()]
            }
            _ => [xi[0], xi[1]],
        }
    }

    /// `s = Omega n . (-y, x)`.
    #[inline(always)]
    pub(super) fn swept<S: Scalar>(&self, q: &[S; 3]) -> S {
        let (sin, cos) = q[2].sin_cos();
        if self.table_rate == 0.0 { S::zero().carried_as(sin) } else { (q[0] * cos + q[1] * sin) * self.table_rate }
    }

    /// The rate of `s`.
    #[inline(always)]
    fn swept_rate<S: Scalar>(&self, q: &[S; 3], [u, omega]: [S; 2]) -> S {
        let [x, y, theta] = *q;
        if self.table_rate == 0.0 {
            return S::zero().carried_as(theta);
        }
        let (sin, cos) = theta.sin_cos();
        (u + omega * (y * cos - x * sin)) * self.table_rate
    }

    /// The right sides of Newton's law without forces, along `e` and about the blade.
    #[inline(always)]
    fn inertial<S: Scalar>(moments: &Moments<S>, [u, omega]: [S; 2], [s, s_rate]: [S; 2]) -> [S; 2] {
        let Moments { mass, first: [sx, sy], first_rate: [_, vy], first_curvature: [ax, _], growth, twist, .. } =
            *moments;
        [
            mass * omega * s + sx * omega * omega + omega * vy * 2.0 - ax,
            -(sx * (s_rate + omega * u)) - sy * omega * s - omega * growth * 2.0 - twist,
        ]
    }

    /// `u'` and `omega'` by the right sides of Newton's law, where nothing is imposed.
    #[inline(always)]
    fn solved<S: Scalar>(moments: &Moments<S>, [along, about]: [S; 2]) -> [S; 2] {
        let Moments { mass, first: [_, sy], inertia, .. } = *moments;
        let determinant = (mass * inertia - sy * sy).recip();
        [(inertia * along + sy * about) * determinant, (sy * along + mass * about) * determinant]
    }

    /// The accelerations of the velocities that are not imposed, under a force along `e` and a torque about the blade.
    #[inline(always)]
    fn accelerations<S: Scalar>(&self, t: S, q: &[S; 3], xi: &[S; 3], [force, torque]: [S; 2]) -> [S; 3] {
        let zero = S::zero();
        if const { K > 1 } {
            return [zero; 3];
        }
        let own = self.own(t, q, xi);
        let ([u, omega], [s, s_rate]) = (own, [self.swept(q), self.swept_rate(q, own)]);
        if self.masses.is_empty() {
            // u' = omega s + a omega^2 + F/m, omega' = -(m a/J) (s' + omega u) + tau/J.
            let [per_mass, per_inertia] = self.sleigh.inverse();
            let along = omega * s + omega * omega * self.sleigh.offset() + force * per_mass;
            let turn = (s_rate + omega * u) * -self.sleigh.spin_gain() + torque * per_inertia;
            if const { K == 0 } {
                return [along, turn, zero];
            }
            return [if matches!(self.guides.first(), Some(Guide::Speed(_))) { turn } else { along }, zero, zero];
        }
        let moments = Moments::of(&self.sleigh, &self.masses, t);
        let [along, about] = Self::inertial(&moments, own, [s, s_rate]);
        let (along, about, sy) = (along + force, about + torque, moments.first[1]);
        if const { K == 0 } {
            let [along, turn] = Self::solved(&moments, [along, about]);
            return [along, turn, zero];
        }
        match self.guides.first() {
            Some(Guide::Speed(u)) => [(about + sy * u.slope(t)) / moments.inertia, zero, zero],
            Some(Guide::TurnRate(omega)) => [(along + sy * omega.slope(t)) / moments.mass, zero, zero],
            _ => [zero; 3],
        }
    }
}

impl<const K: usize, const M: usize> Reduced<3, M> for Guided<K>
where
    Self: System<3, M>,
{
    /// In full coordinates where nothing is imposed, with the multiplier
    /// `lambda = M (s' + omega u) + S_x omega' - S_y omega^2 + 2 omega S_x' + S_y''`.
    #[inline]
    fn motion(&self, t: f64, q: &[f64; 3], v: &[f64; 3]) -> Option<Motion<3, M>> {
        if K > 0 {
            return None;
        }
        let (sin, cos) = q[2].sin_cos();
        let [u, s, omega] = [cos * v[0] + sin * v[1], cos * v[1] - sin * v[0], v[2]];
        let s_rate = self.swept_rate(q, [u, omega]);
        let moments = Moments::of(&self.sleigh, &self.masses, t);
        let [u_rate, turn] = Self::solved(&moments, Self::inertial(&moments, [u, omega], [s, s_rate]));
        // P'' = (u' - omega s) e + (s' + omega u) n.
        let (along, across) = (u_rate - omega * s, s_rate + omega * u);
        let Moments { mass, first: [sx, sy], first_rate: [vx, _], first_curvature: [_, ay], .. } = moments;
        Some(Motion {
            acceleration: [along * cos - across * sin, along * sin + across * cos, turn],
            multiplier: [mass * across + sx * turn - sy * omega * omega + 2.0 * omega * vx + ay; M],
        })
    }

    #[inline]
    fn response(&self, t: f64, q: &[f64; 3], &[fx, fy, tau]: &[f64; 3]) -> Option<Motion<3, M>> {
        if K > 0 {
            return None;
        }
        let (sin, cos) = q[2].sin_cos();
        let moments = Moments::of(&self.sleigh, &self.masses, t);
        let [along, turn] = Self::solved(&moments, [cos * fx + sin * fy, tau]);
        Some(Motion {
            acceleration: [along * cos, along * sin, turn],
            multiplier: [moments.first[0] * turn - (cos * fy - sin * fx); M],
        })
    }

    #[inline(always)]
    fn reduced_motion<S: Scalar>(&self, t: S, q: &[S; 3], xi: &[S; 3]) -> Option<[S; 3]> {
        Some(self.accelerations(t, q, xi, [S::zero(); 2]))
    }

    #[inline(always)]
    fn pushed_motion<S: Scalar>(&self, t: S, q: &[S; 3], xi: &[S; 3], &[fx, fy, tau]: &[S; 3]) -> Option<[S; 3]> {
        let (sin, cos) = q[2].sin_cos();
        Some(self.accelerations(t, q, xi, [cos * fx + sin * fy, tau]))
    }

    /// `u e + s n`, and `omega`.
    #[inline(always)]
    fn velocity<S: Scalar>(
        &self,
        t: S,
        q: &[S; 3],
        xi: &[S; 3],
        _derived: impl FnOnce() -> Result<[S; 3], ReducedError>,
    ) -> Result<[S; 3], ReducedError> {
        let (sin, cos) = q[2].sin_cos();
        let ([u, omega], s) = (self.own(t, q, xi), self.swept(q));
        Ok([u * cos - s * sin, u * sin + s * cos, omega])
    }

    /// The heading from the spin, and the place from the heading; on a plane that turns, the velocity depends on the place.
    #[inline(always)]
    fn reconstruction(&self) -> Option<u32> {
        (self.table_rate == 0.0 && K < 2).then_some(1)
    }
}
