use crate::{Halved, Mechanics, OneStep, State, StepError, StepReport, Substeps, Undivided};
use lagrangian::PowerSources;
use std::ops::ControlFlow;

/// A method that makes a step of shorter ones where it finds none of the whole length.
///
/// It is for those who ask for it: the map is then neither symmetric nor the same function of the step everywhere, so that what
/// is said of the method in the long run holds only as far as no step is divided; [`divided`](Self::divided) tells how
/// many were. The constraint holds all the same, and so does the order: the parts are steps of the method.
///
/// What looks on sees a divided step as one; so where forces do work that the method does not measure, a step should be short for them all
/// the same ([`Work`](crate::Work)).
///
/// A step fails that has no solution in parts of `2^-halvings` either, or for a reason that no shorter step mends;
/// [`undivided`](Self::undivided) then tells what was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Substepping<Method> {
    /// The method.
    pub method: Method,
    limits: Substeps,
    resolving: bool,
    divided: u64,
    parts: u64,
    most: u64,
    undivided: Option<Undivided<StepError>>,
}

impl<Method> Substepping<Method> {
    /// The method with steps that may be halved so often, 53 times at most.
    pub fn new(method: Method, halvings: u32) -> Self {
        Self::within(method, Substeps::new(halvings, u64::MAX))
    }

    /// The method with steps that may be divided so far.
    pub fn within(method: Method, limits: Substeps) -> Self {
        Self { method, limits, resolving: false, divided: 0, parts: 0, most: 0, undivided: None }
    }

    /// The same, that divides also a step which the method makes though it does not resolve the motion: see [`Halved`]. Every
    /// step then takes the time of three.
    #[must_use]
    pub fn resolving(self) -> Self {
        Self { resolving: true, ..self }
    }

    /// How many steps have been divided.
    #[must_use]
    pub fn divided(&self) -> u64 {
        self.divided
    }

    /// Into how many parts, all together.
    #[must_use]
    pub fn parts(&self) -> u64 {
        self.parts
    }

    /// The most parts of one of them.
    #[must_use]
    pub fn most(&self) -> u64 {
        self.most
    }

    /// What was tried in the last step that could not be made in parts either.
    #[must_use]
    pub fn undivided(&self) -> Option<Undivided<StepError>> {
        self.undivided
    }

    /// The step in parts, each as long as it can be; the last error where they would have to be too short.
    #[cold]
    fn in_parts<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        step: (f64, f64),
        state: &mut State<N>,
        error: StepError,
    ) -> Result<StepReport<M>, StepError>
    where
        Method: OneStep<N, M> + Clone,
    {
        let (mut method, mut inner, resolving) = (self.method.clone(), *state, self.resolving);
        let mut total = StepReport::of(0);
        let made = self.limits.divide(step, error, StepError::may_hold_in_parts, |(t, h), _| {
            let (mut tried, mut ahead) = (method.clone(), inner);
            let report = tried.step(system, t, h, &mut ahead)?;
            if resolving {
                resolves(&method, system, (t, h), &inner, &ahead)?;
            }
            (method, inner) = (tried, ahead);
            total = total.then(&report);
            Ok(ControlFlow::Continue(()))
        });
        match made {
            Ok(ControlFlow::Continue(parts)) => {
                (self.divided, self.parts) = (self.divided + 1, self.parts + parts);
                (self.most, self.method, *state) = (self.most.max(parts), method, inner);
                Ok(total)
            }
            // Nothing breaks off.
            Ok(ControlFlow::Break(())) => Ok(total),
            Err(undivided) => {
                self.undivided = Some(undivided);
                Err(undivided.source)
            }
        }
    }
}

/// Whether a step that led from `before` to `after` resolves the motion, by halves that begin with what the method remembers.
#[cold]
fn resolves<Method, const N: usize, const M: usize>(
    method: &Method,
    system: &dyn Mechanics<N, M>,
    step: (f64, f64),
    before: &State<N>,
    after: &State<N>,
) -> Result<(), StepError>
where
    Method: OneStep<N, M> + Clone,
{
    let mut method = method.clone();
    Halved::resolves(step, before, after, |(t, h), state| method.step(system, t, h, state).map(|_| ()))
}

impl<Method, const N: usize, const M: usize> OneStep<N, M> for Substepping<Method>
where
    Method: OneStep<N, M> + Clone,
{
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        let before = self.resolving.then(|| (self.method.clone(), *state));
        let report = self.method.step(system, t, h, state).and_then(|report| match before {
            Some((method, before)) => match resolves(&method, system, (t, h), &before, state) {
                Ok(()) => Ok(report),
                Err(error) => {
                    (self.method, *state) = (method, before);
                    Err(error)
                }
            },
            None => Ok(report),
        });
        match report {
            Err(error) => self.in_parts(system, (t, h), state, error),
            report => report,
        }
    }

    fn memory(&self) -> Vec<f64> {
        self.method.memory()
    }

    fn recall(&mut self, memory: &[f64], state: &State<N>) {
        self.method.recall(memory, state);
    }

    fn measure_work(&mut self, sources: PowerSources) {
        self.method.measure_work(sources);
    }
}
