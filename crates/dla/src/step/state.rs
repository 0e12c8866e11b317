use crate::past::Past;
use crate::{Checkpoint, CheckpointError, Mechanics, StepError};
use lagrangian::{ReducedError, Twofold, added, from_fn, mapped, two_sum};
use std::f64::consts::{PI, TAU};

/// `2 pi` minus its nearest f64.
const TAU_REST: f64 = 2.449_293_598_294_706_4e-16;

/// An angle of this number of turns, `2^50`, is known to less than a radian.
const COUNTED: f64 = 1_125_899_906_842_624.0;

/// Configuration and velocity, as integrators carry them.
///
/// The coordinates are sums of many small increments, so their rounding errors are kept and added again (compensated
/// summation, Kahan 1965); angles stay within half a turn of zero, their full turns counted apart. Together they keep
/// the constraint and the energy at round-off over any length of run. A method that works with quasi-velocities leaves
/// them beside the velocity, so that the next step need not recover them; one that works with quasi-momenta leaves those
/// too, with twice the digits, since they too are sums of many increments. One that solves for the mean velocity leaves the
/// acceleration, from which the next step has its predictor; after three steps of one length the predictor is the increment extrapolated
/// from theirs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State<const N: usize> {
    q: [f64; N],
    rest: [f64; N],
    turns: [f64; N],
    /// The largest size of a coordinate: half a turn of an angle, otherwise any finite distance.
    bounds: [f64; N],
    v: [f64; N],
    left: Left<N>,
    past: Past<N>,
}

/// The results of the last step for the next, beside the velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Left<const N: usize> {
    Nothing,
    Velocities([f64; N]),
    Momenta([f64; N], [Twofold; N]),
    Acceleration([f64; N]),
}

impl<const N: usize> State<N> {
    /// A state at `q` with velocity `v`; `angles` says which coordinates are angles
    /// (see [`System::angles`](lagrangian::System::angles)).
    #[must_use]
    pub fn new(q: [f64; N], v: [f64; N], angles: [bool; N]) -> Self {
        let (rest, turns, left, past) = ([0.0; N], [0.0; N], Left::Nothing, Past::new());
        let mut state = Self { q, rest, turns, bounds: bounds(angles), v, left, past };
        state.wrap();
        state
    }

    /// Configuration, angles within a turn: what a system is evaluated at.
    #[must_use]
    #[inline(always)]
    pub fn q(&self) -> &[f64; N] {
        &self.q
    }

    /// Configuration, angles with their full turns: what a user wants to see.
    #[must_use]
    pub fn unwrapped(&self) -> [f64; N] {
        from_fn(|i| {
            let (q, turns) = (self.q[i], self.turns[i]);
            if turns == 0.0 { q } else { turns.mul_add(TAU, turns.mul_add(TAU_REST, q)) }
        })
    }

    /// Velocity.
    #[must_use]
    #[inline(always)]
    pub fn v(&self) -> &[f64; N] {
        &self.v
    }

    /// The velocity in the system's basis of admissible velocities; `None` if the last step did not know it.
    #[must_use]
    #[inline(always)]
    pub fn xi(&self) -> Option<[f64; N]> {
        // One comparison for what a step in closed form leaves, and no table of jumps.
        if let Left::Velocities(xi) = self.left {
            return Some(xi);
        }
        if let Left::Momenta(xi, _) = self.left { Some(xi) } else { None }
    }

    /// The quasi-momenta in that basis; `None` if the last step did not carry them.
    #[must_use]
    #[inline(always)]
    pub fn quasi_momenta(&self) -> Option<[Twofold; N]> {
        if let Left::Momenta(_, pi) = self.left { Some(pi) } else { None }
    }

    /// The approximate acceleration; `None` if the last step did not leave it.
    #[must_use]
    #[inline(always)]
    pub fn acceleration(&self) -> Option<[f64; N]> {
        if let Left::Acceleration(a) = self.left { Some(a) } else { None }
    }

    /// The quasi-velocities that the last step left, else the quasi-velocities of the velocity.
    ///
    /// # Errors
    /// [`ReducedError`] if the system has no basis of admissible velocities, or a degenerate one.
    #[inline(always)]
    pub fn quasi_velocities<const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        t: f64,
    ) -> Result<[f64; N], ReducedError> {
        match self.xi() {
            Some(xi) => Ok(xi),
            None => system.quasi_velocities(t, &self.q, &self.v),
        }
    }

    /// The full turns of every angle.
    #[must_use]
    pub fn turns(&self) -> &[f64; N] {
        &self.turns
    }

    /// The configuration at the end of a step with this increment, before the state has moved there.
    #[must_use]
    #[inline(always)]
    pub fn ahead(&self, increment: &[f64; N]) -> [f64; N] {
        from_fn(|i| self.q[i] + (increment[i] + self.rest[i]))
    }

    /// Whether [`advance`](Self::advance) would lead to finite coordinates and velocities.
    ///
    /// # Errors
    /// [`StepError::NotFinite`].
    #[inline(always)]
    pub fn stays_finite(&self, increment: &[f64; N], v: &[f64; N]) -> Result<(), StepError> {
        let ahead = self.ahead(increment);
        // A sum is not finite if one of its terms is not.
        if (sum(&ahead) + sum(v)).abs() <= f64::MAX || too_large_together(ahead, *v) {
            Ok(())
        } else {
            Err(StepError::NotFinite)
        }
    }

    /// Moves the configuration by `increment` and sets the velocity, with its quasi-velocities if they are known.
    #[inline(always)]
    pub fn advance(&mut self, increment: &[f64; N], v: [f64; N], xi: Option<[f64; N]>) {
        self.past.forget();
        self.go(increment, v, xi.map_or(Left::Nothing, Left::Velocities));
    }

    /// [Moves](State::advance) the state if that [leads to finite numbers](State::stays_finite): both questions in one comparison.
    ///
    /// # Errors
    /// [`StepError::NotFinite`]; the state is then as it was.
    #[inline(always)]
    pub fn advance_where_finite(&mut self, increment: &[f64; N], v: [f64; N], xi: [f64; N]) -> Result<(), StepError> {
        let (mut q, mut rest, mut within) = ([0.0; N], [0.0; N], true);
        for i in 0..N {
            (q[i], rest[i]) = added(self.q[i], increment[i] + self.rest[i]);
            within &= q[i].abs() <= self.bounds[i];
        }
        let left = Left::Velocities(xi);
        // Most steps wrap no angle, and a coordinate within its bounds is finite: one comparison for both.
        if within & (sum(&v).abs() <= f64::MAX) {
            self.past.forget();
            (self.q, self.rest, self.v, self.left) = (q, rest, v, left);
            return Ok(());
        }
        self.stays_finite(increment, &v)?;
        self.past.forget();
        self.go(increment, v, left);
        Ok(())
    }

    #[inline(always)]
    fn go(&mut self, increment: &[f64; N], v: [f64; N], left: Left<N>) {
        for i in 0..N {
            (self.q[i], self.rest[i]) = added(self.q[i], increment[i] + self.rest[i]);
        }
        (self.v, self.left) = (v, left);
        self.wrap();
    }

    /// The increment of a step of length `h`, extrapolated from the last steps; `None` unless they had this length and are remembered.
    #[must_use]
    #[inline(always)]
    pub fn expected(&self, h: f64) -> Option<[f64; N]> {
        self.past.next(h)
    }

    /// [Moves](State::advance) the state and leaves its quasi-momenta to the next step.
    #[inline(always)]
    pub fn advance_with_momenta(&mut self, increment: &[f64; N], v: [f64; N], xi: [f64; N], pi: [Twofold; N]) {
        self.advance(increment, v, None);
        self.left = Left::Momenta(xi, pi);
    }

    /// [Moves](State::advance) the state by a step of length `h`, leaves about the acceleration to the next step, and remembers
    /// the increment.
    #[inline(always)]
    pub fn advance_with_acceleration(&mut self, h: f64, increment: &[f64; N], v: [f64; N], acceleration: [f64; N]) {
        let known = acceleration.iter().fold(true, |all, a| all & a.is_finite());
        self.past.push(h, increment);
        self.go(increment, v, if known { Left::Acceleration(acceleration) } else { Left::Nothing });
    }

    /// How far the configuration has moved since `before`, with the digits that the sums keep.
    #[must_use]
    pub fn moved_since(&self, before: &Self) -> [f64; N] {
        from_fn(|i| {
            let turns = self.turns[i] - before.turns[i];
            turns * TAU + ((self.q[i] - before.q[i]) + (self.rest[i] - before.rest[i] + turns * TAU_REST))
        })
    }

    /// The same place with the opposite velocity.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let flipped = |v: [f64; N]| mapped(&v, |v| -v);
        let left = match self.left {
            Left::Velocities(xi) | Left::Momenta(xi, _) => Left::Velocities(flipped(xi)),
            left => left,
        };
        Self { v: flipped(self.v), left, past: Past::new(), ..*self }
    }

    /// The configuration with the rest of its sums and its full turns, as a list.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = f64> {
        self.q.into_iter().chain(self.rest).chain(self.turns)
    }

    /// The state at the configuration that [`numbers`](Self::numbers) gave, at rest.
    pub(crate) fn with_numbers(&self, numbers: &[f64]) -> Self {
        let row = |from: usize| from_fn(|i| numbers.get(from + i).copied().unwrap_or(f64::NAN));
        let (q, rest, turns) = (row(0), row(N), row(2 * N));
        Self { q, rest, turns, v: [0.0; N], left: Left::Nothing, past: Past::new(), ..*self }
    }

    /// Writes every bit of the state to a checkpoint; all but which coordinates are angles, which the system knows.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put("q", &self.q);
        checkpoint.put("rest", &self.rest);
        checkpoint.put("turns", &self.turns);
        checkpoint.put("v", &self.v);
        let [xi, acceleration] = [self.xi(), self.acceleration()];
        checkpoint.put("xi", xi.as_ref().map_or(&[], |xi| &xi[..]));
        checkpoint.put("acceleration", acceleration.as_ref().map_or(&[], |a| &a[..]));
        let halves = self.quasi_momenta().map(|pi| [mapped(&pi, |pi| pi.hi), mapped(&pi, |pi| pi.lo)]);
        checkpoint.put("pi", halves.as_ref().map_or(&[], |[hi, _]| &hi[..]));
        checkpoint.put("pi_rest", halves.as_ref().map_or(&[], |[_, lo]| &lo[..]));
        self.past.save(checkpoint);
    }

    /// The state that [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// [`CheckpointError`] if the checkpoint has no state of `N` coordinates.
    pub fn load(checkpoint: &Checkpoint, angles: [bool; N]) -> Result<Self, CheckpointError> {
        let some = |name: &str| -> Result<Option<[f64; N]>, CheckpointError> {
            if checkpoint.list(name)?.is_empty() { Ok(None) } else { checkpoint.get(name).map(Some) }
        };
        let pi = some("pi")?.zip(some("pi_rest")?);
        let pi = pi.map(|(hi, lo)| from_fn(|a| Twofold::new(hi[a], lo[a])));
        let left = match (some("xi")?, pi, some("acceleration")?) {
            (Some(xi), Some(pi), _) => Left::Momenta(xi, pi),
            (Some(xi), None, _) => Left::Velocities(xi),
            (None, _, Some(a)) => Left::Acceleration(a),
            (None, _, None) => Left::Nothing,
        };
        Ok(Self {
            q: checkpoint.get("q")?,
            rest: checkpoint.get("rest")?,
            turns: checkpoint.get("turns")?,
            bounds: bounds(angles),
            v: checkpoint.get("v")?,
            left,
            past: Past::load(checkpoint)?,
        })
    }

    #[inline(always)]
    fn wrap(&mut self) {
        for i in 0..N {
            if self.q[i].abs() > self.bounds[i] {
                // By value, since few steps come here: in all other steps the numbers stay in registers.
                let turns;
                (self.q[i], self.rest[i], turns) = wrapped(self.q[i], self.rest[i]);
                self.turns[i] += turns;
            }
        }
    }
}

#[inline(always)]
fn sum<const N: usize>(x: &[f64; N]) -> f64 {
    x.iter().copied().reduce(|sum, x| sum + x).unwrap_or(0.0)
}

/// Whether all terms of a sum that is not finite are finite.
#[cold]
#[inline(never)]
fn too_large_together<const N: usize>(q: [f64; N], v: [f64; N]) -> bool {
    q.iter().chain(&v).all(|x| x.is_finite())
}

fn bounds<const N: usize>(angles: [bool; N]) -> [f64; N] {
    mapped(&angles, |angle| if angle { PI } else { f64::MAX })
}

/// An angle with its rest, wrapped, and the turns that were taken out of it.
// A function of its own, since few steps come here.
#[cold]
#[inline(never)]
pub(crate) fn wrapped(q: f64, rest: f64) -> (f64, f64, f64) {
    if q.abs() > PI && q.is_finite() { within_half_a_turn(q, rest) } else { (q, rest, 0.0) }
}

#[inline(always)]
fn within_half_a_turn(q: f64, rest: f64) -> (f64, f64, f64) {
    let turns = (q / TAU).round();
    let (q, rest) = if turns.abs() < COUNTED {
        // The first difference is exact; what many turns leave in the second belongs to the angle.
        two_sum((-turns).mul_add(TAU, q), rest - turns * TAU_REST)
    } else {
        // So far from zero the rest is below the last digit; and the velocity belongs to the angle without it.
        (within_many(q), 0.0)
    };
    (q, rest, turns)
}

/// Brings an angle within a turn by its sine and cosine, if two parts of a turn have too few digits for its number of turns.
#[cold]
#[inline(never)]
fn within_many(angle: f64) -> f64 {
    angle.sin().atan2(angle.cos())
}
