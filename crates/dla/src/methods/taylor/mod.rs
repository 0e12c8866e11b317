//! Taylor series of the reduced equations.

mod center;
mod extent;
mod pace;
mod polynomial;
mod root;
pub(crate) mod tangent;

use crate::{Mechanics, OneStep, OwnStep, State, StepError, StepReport};
use center::Center;
use lagrangian::PowerSources;
use polynomial::Polynomial;

/// Taylor series of the reduced equations, in steps of its own that do not depend on the steps of the run.
///
/// Each own step is a polynomial in time for the coordinates and the quasi-velocities, as long as its last terms allow
/// ([Jorba and Zou 2005](https://doi.org/10.1080/10586458.2005.10128904), Experimental Mathematics 14, 99-117). A node of the run within it
/// is a value of that polynomial: nodes cost an evaluation, not a step. The constraint holds to rounding, since velocities are
/// `W xi + v_b`.
///
/// Where `abs`, `min`, `max` or `sign` turn from one side to the other, a polynomial ends, and the next one begins on the other side.
#[derive(Debug, Clone)]
pub struct Taylor<const N: usize> {
    tolerance: f64,
    sources: PowerSources,
    polynomial: Option<Polynomial>,
    center: Option<Center<N>>,
    /// The node at which the polynomial began, and the end of the last step: times (s) and states.
    begun: Option<(f64, State<N>)>,
    reached: Option<(f64, State<N>)>,
}

impl<const N: usize> Taylor<N> {
    /// Own steps within a step of the run before it is given up.
    pub const MAX_STEPS: u32 = 10_000_000;

    /// The method with the tolerance `epsilon`: the error of an own step is kept near `epsilon (1 + |y|)` in every component.
    #[must_use]
    pub fn new(epsilon: f64) -> Self {
        Self {
            tolerance: epsilon,
            sources: PowerSources::NONE,
            polynomial: None,
            center: None,
            begun: None,
            reached: None,
        }
    }

    /// Whether the polynomial continues the motion from this node.
    fn continues(&self, t: f64, h: f64, state: &State<N>) -> bool {
        let near = |time: f64| (time - t).abs() <= 4.0 * f64::EPSILON * t.abs();
        let same = |node: &Option<(f64, State<N>)>| node.as_ref().is_some_and(|node| near(node.0) && node.1 == *state);
        let forward = |center: &Center<N>| center.forward == (h > 0.0);
        self.center.as_ref().is_some_and(forward) && (same(&self.reached) || same(&self.begun))
    }

    /// Crosses an interval, and shows the inner ends of own steps to `see`; returns the work, if it is asked for, and the time at which
    /// `see` stopped it.
    fn cross<const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        (t0, h): (f64, f64),
        state: &mut State<N>,
        mut see: Option<&mut OwnStep<'_, N>>,
    ) -> Result<(Option<f64>, Option<f64>), StepError> {
        let continues = self.continues(t0, h, state);
        let polynomial = match &mut self.polynomial {
            Some(polynomial) => polynomial,
            none => {
                let series = system.series().map_err(|reason| StepError::Unsupported { reason })?;
                none.insert(Polynomial::new(system, series, self.tolerance))
            }
        };
        polynomial.within(h);
        let center = match &mut self.center {
            Some(center) if continues => center,
            other => {
                self.begun = Some((t0, *state));
                other.insert(polynomial.begin(system, (t0, h), state)?)
            }
        };
        polynomial.refresh(center)?;
        let (end, mut from, mut work) = (t0 + h, t0, self.sources.any().then_some(0.0));
        for tries in 1..=Self::MAX_STEPS {
            let (to, inside) = center.toward(end, h, tries)?;
            let done = work.map(|work| work + polynomial.work(system, self.sources, center, [from, to]));
            if inside {
                *state = polynomial.at(system, center, end)?;
                self.reached = Some((end, *state));
                return Ok((done, None));
            }
            if !polynomial.go_on(system, center)? {
                continue;
            }
            (work, from) = (done, to);
            self.begun = None;
            if let Some(see) = &mut see {
                let node = polynomial.at(system, center, to)?;
                if see(to, &node).is_break() {
                    *state = node;
                    self.reached = Some((to, node));
                    return Ok((work, Some(to)));
                }
            }
        }
        Err(StepError::Tolerance { tries: Self::MAX_STEPS, step: center.full })
    }

    /// As [`cross`](Self::cross); after a failure everything is as before.
    fn crossed<const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        step: (f64, f64),
        state: &mut State<N>,
        see: Option<&mut OwnStep<'_, N>>,
    ) -> Result<(StepReport<M>, Option<f64>), StepError> {
        let before = (*state, self.center.clone(), self.begun, self.reached);
        match self.cross(system, step, state, see) {
            Ok((work, end)) => Ok((StepReport { work, ..StepReport::of(0) }, end)),
            Err(error) => {
                (*state, self.center, self.begun, self.reached) = before;
                if let Some(polynomial) = &mut self.polynomial {
                    polynomial.forget();
                }
                Err(error)
            }
        }
    }
}

impl<const N: usize, const M: usize> OneStep<N, M> for Taylor<N> {
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        Ok(self.crossed(system, (t, h), state, None)?.0)
    }

    fn step_until(
        &mut self,
        system: &dyn Mechanics<N, M>,
        step: (f64, f64),
        state: &mut State<N>,
        see: &mut OwnStep<'_, N>,
    ) -> Result<(StepReport<M>, Option<f64>), StepError> {
        self.crossed(system, step, state, Some(see))
    }

    fn memory(&self) -> Vec<f64> {
        match (&self.center, &self.reached) {
            (Some(center), Some((t, _))) => center.save(*t),
            _ => Vec::new(),
        }
    }

    fn recall(&mut self, memory: &[f64], state: &State<N>) {
        self.reached = None;
        if let Some((center, t)) = Center::load(memory, state) {
            (self.center, self.begun, self.reached) = (Some(center), None, Some((t, *state)));
            // It may be another one at the same time.
            self.polynomial.iter_mut().for_each(Polynomial::forget);
        }
    }

    fn forget(&mut self, _state: &State<N>) {
        (self.polynomial, self.center, self.begun, self.reached) = (None, None, None, None);
    }

    fn measure_work(&mut self, sources: PowerSources) {
        self.sources = sources;
    }

    fn own_steps(
        &self,
        system: &dyn Mechanics<N, M>,
        step: (f64, f64),
        state: &State<N>,
        memory: &mut Vec<f64>,
        see: &mut OwnStep<'_, N>,
    ) -> Result<(), StepError> {
        let (mut method, mut state) = (Self::new(self.tolerance), *state);
        OneStep::<N, M>::recall(&mut method, memory, &state);
        method.crossed(system, step, &mut state, Some(see))?;
        *memory = OneStep::<N, M>::memory(&method);
        Ok(())
    }
}
