use super::NO_BASIS;
use crate::convergence::tolerances::BLIND;
use crate::{Mechanics, State, StepError};
use lagrangian::linear::{larger, largest};
use lagrangian::{Lanes, MotionError, MotionRounding, Scalar, Twofold, from_fn, mapped};

/// The beginning of a step on `D*`.
#[derive(Debug, Clone, Copy)]
pub(super) struct EnergyStart<const N: usize> {
    /// The state, whose configuration is carried with more digits than it shows.
    pub(super) state: State<N>,
    /// Quasi-velocities.
    pub(super) xi: [f64; N],
    /// The quasi-momenta of `xi`.
    pub(super) pi: [f64; N],
    /// The part of the quasi-momenta that the rounding of the quasi-velocities lost.
    pub(super) rest: [f64; N],
    /// `dxi/dpi`.
    pub(super) inverse_mass: [[f64; N]; N],
}

impl<const N: usize> EnergyStart<N> {
    /// # Errors
    /// [`StepError::Unsupported`] if the methods on `D*` cannot integrate the system; [`StepError::Motion`] if its mass matrix is
    /// degenerate.
    pub(super) fn new<const M: usize>(
        system: &dyn Mechanics<N, M>,
        t0: f64,
        h: f64,
        state: &State<N>,
    ) -> Result<Self, StepError> {
        let (q, v) = (state.q(), state.v());
        let basis = system.basis(t0, q).ok_or(NO_BASIS)?;
        autonomous(system, t0, h, q, v)?;
        let singular = |source| StepError::Motion(MotionError { time: t0, source });
        let mut xi = state.quasi_velocities(system, t0)?;
        xi[basis.vectors().len()..].fill(0.0);
        let v = basis.combine(&xi);
        let inverse_mass = system.inverse_reduced_mass(t0, q, &v, &basis).map_err(singular)?;
        // In the arithmetic that ended the step before: between two sines that differ in their last digits the quasi-momenta
        // would lose the same part of an ulp at every step.
        let here = system.bracket(Lanes::constant(t0), &mapped(q, Lanes::constant), &mapped(&xi, Lanes::constant));
        let pi = here.ok_or(NO_BASIS)?.quasi_momenta().map(|pi| pi.0[0]);
        let rest = state.quasi_momenta().map_or([0.0; N], |carried| rounding(&carried, &pi));
        Ok(Self { state: *state, xi, pi, rest, inverse_mass })
    }
}

impl<const N: usize> EnergyStart<N> {
    /// The largest entry of the inverse mass matrix.
    #[inline(always)]
    pub(super) fn largest_inverse_mass(&self) -> f64 {
        largest(self.inverse_mass.as_flattened())
    }

    /// Takes the inverse mass matrix at the place to which the velocity leads in half the step: if masses double within the step,
    /// corrections with the mass matrix of the beginning grow. `None` if the matrix is singular.
    #[cold]
    #[inline(never)]
    pub(super) fn take_mass_ahead<const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t0: f64,
        h: f64,
    ) -> Option<()> {
        let (t, q) = (t0 + 0.5 * h, self.state.ahead(&mapped(self.state.v(), |v| 0.5 * h * v)));
        let basis = system.basis(t, &q)?;
        self.inverse_mass = system.inverse_reduced_mass(t, &q, &basis.combine(&self.xi), &basis).ok()?;
        Some(())
    }

    /// The rounding of the rates of the coordinates, of the rates of the quasi-momenta, and of the quasi-velocities, over a step from here:
    /// the larger of the values at its beginning and at the place to which its velocity leads. An iterate is no place for it: without a
    /// solution its numbers may be large. Zero if the motion is degenerate.
    #[cold]
    #[inline(never)]
    pub(super) fn rounding<const M: usize>(&self, system: &dyn Mechanics<N, M>, t0: f64, h: f64) -> [[f64; N]; 3] {
        let ahead = self.state.ahead(&mapped(self.state.v(), |v| h * v));
        let start = self.rounding_at(system, (t0, h), self.state.q());
        let end = self.rounding_at(system, (t0 + h, h), &ahead);
        let rounded = from_fn(|g| from_fn(|i| larger(start[g][i], end[g][i])));
        self.carried(system, (t0, h), rounded).unwrap_or(rounded)
    }

    /// With what the next iteration makes of it: rates at places and quasi-velocities that are rounded. A heading of little inertia is
    /// rounded by far more than its digits, and turns the velocity. `None` if the system has no basis.
    fn carried<const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        (t, h): (f64, f64),
        [mut q_rate, mut pi_rate, mut xi]: [[f64; N]; 3],
    ) -> Option<[[f64; N]; 3]> {
        let (q, places, speeds) = (self.state.q(), mapped(&q_rate, |rate| h * rate), xi);
        let here = rates(system, t, q, &self.xi)?;
        for k in 0..2 * N {
            let (mut place, mut speed) = (*q, self.xi);
            if k < N {
                place[k] += places[k];
            } else {
                speed[k - N] += speeds[k - N];
            }
            let [q_there, pi_there] = rates(system, t, &place, &speed)?;
            for i in 0..N {
                q_rate[i] += (q_there[i] - here[0][i]).abs();
                pi_rate[i] += (pi_there[i] - here[1][i]).abs();
            }
        }
        for (a, xi) in xi.iter_mut().enumerate() {
            *xi += (0..N).map(|b| self.inverse_mass[a][b].abs() * h.abs() * pi_rate[b]).sum::<f64>();
        }
        Some([q_rate, pi_rate, xi])
    }

    fn rounding_at<const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        (t, h): (f64, f64),
        q: &[f64; N],
    ) -> [[f64; N]; 3] {
        let Some(basis) = system.basis(t, q) else { return [[0.0; N]; 3] };
        let Some([pi, pi_rate]) = system.bracket_rounding(t, q, &self.xi) else { return [[0.0; N]; 3] };
        let moved: [f64; N] = from_fn(|b| pi[b] + h.abs() * pi_rate[b]);
        let xi: [f64; N] = from_fn(|a| (0..N).map(|b| self.inverse_mass[a][b].abs() * moved[b]).sum());
        let q_rate = from_fn(|i| basis.vectors().iter().zip(&xi).map(|(w, xi)| w[i].abs() * xi).sum());
        [q_rate, pi_rate, xi]
    }

    /// The second order of the rounding of the energy (J) over a step from here: the rounding of the forces, times the rounding of the
    /// place and the distance that the rounding of the forces moves it.
    #[cold]
    #[inline(never)]
    pub(super) fn energy_rounding<const M: usize>(&self, system: &dyn Mechanics<N, M>, t0: f64, h: f64) -> f64 {
        let q = self.state.q();
        let Some(basis) = system.basis(t0, q) else { return 0.0 };
        let motion = system.motion_rounding(t0, q, &basis.combine(&self.xi));
        motion.map_or(0.0, |MotionRounding { force, acceleration, .. }| {
            (0..N).map(|i| force[i] * (f64::EPSILON * q[i].abs() + h * h * acceleration[i])).sum()
        })
    }
}

/// The rates of coordinates and quasi-momenta.
fn rates<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    xi: &[f64; N],
) -> Option<[[f64; N]; 2]> {
    let (t, q, xi) = (Lanes::constant(t), mapped(q, Lanes::constant), mapped(xi, Lanes::constant));
    let bracket = system.bracket(t, &q, &xi)?;
    let (q_rate, mut pi_rate) = bracket.rates(&system.energy_slope(t, &q, &xi)?.h_q, &xi);
    if let Some(force) = system.force_at_eight(t, &q, &q_rate) {
        let along = bracket.along_basis(&force);
        for i in 0..N {
            pi_rate[i] += along[i];
        }
    }
    Some([q_rate, pi_rate].map(|rates| rates.map(|rate| rate.0[0])))
}

/// `carried - pi`; zero if it is more than rounding, as after a step with another system.
fn rounding<const N: usize>(carried: &[Twofold; N], pi: &[f64; N]) -> [f64; N] {
    let rest = from_fn(|a| (carried[a] - Twofold::from(pi[a])).hi);
    if largest(&rest) <= BLIND * largest(pi) { rest } else { [0.0; N] }
}

pub(super) const MOVING: StepError = StepError::Unsupported {
    reason: "the energy is conserved only under constraints with b = 0, and a constraint of \
        the system has another b",
};

/// Refuses `b != 0` and a Lagrangian, constraint or basis that changes with time.
///
/// The test compares the start with a time that a period of the system is unlikely to share with the step.
fn autonomous<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t0: f64,
    h: f64,
    place: &[f64; N],
    v: &[f64; N],
) -> Result<(), StepError> {
    let t = t0 + 0.381_966 * h;
    if system.constraints_move(t, place) {
        return Err(MOVING);
    }
    if system.depends_on_time(t, place, v) {
        return Err(StepError::Unsupported {
            reason: "the energy-preserving methods need systems that do not depend on time explicitly, and this \
                system does",
        });
    }
    Ok(())
}
