use crate::dropping::{left_branch, turned_off};
use crate::{Dependent, Mechanics, OneStep, OwnStep, State, StepError, StepReport};
use lagrangian::{PowerSources, from_fn, mapped};
use std::ops::ControlFlow;

/// A method on systems whose basis of admissible velocities holds near a configuration only: the basis is changed at the nodes at which it
/// becomes badly conditioned.
///
/// Within a step the basis is one and the same, so that a method has the order that it has in any basis; a method that makes steps of its
/// own changes the basis between these too. If a step fails, bodies may have turned out of the neighbourhood in which the basis holds: the
/// step is made again in the basis that is best in its middle, and then in the basis that is best at its end. If the basis of a system
/// holds everywhere, the method makes its steps by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rebased<Method> {
    method: Method,
    /// The number of the basis; zero before the first step.
    basis: u64,
    /// Whether bases of the system are local; `None` before the first step.
    local: Option<bool>,
    /// Whether steps ask for the basis between their ends too.
    along: bool,
}

impl<Method> Rebased<Method> {
    /// The method, with its basis changed when the system asks for that.
    pub fn new(method: Method) -> Self {
        Self { method, basis: 0, local: None, along: false }
    }

    /// The method, if its steps ask for the basis between their ends too: the basis must be well conditioned there.
    #[must_use]
    pub fn along(self) -> Self {
        Self { along: true, ..self }
    }
}

/// Maximum number of steps that a method makes of its own within a step, in all bases together.
const MOST_STEPS: u32 = 100_000;

/// Whether the basis of this number is well conditioned at a node.
fn holds<const N: usize, const M: usize>(system: &dyn Mechanics<N, M>, number: u64, t: f64, q: &[f64; N]) -> bool {
    let mut best = number;
    system.near(t, q, number, &mut |number, _| best = number);
    best == number
}

impl<Method> Rebased<Method> {
    /// Makes the step, or the part of it in which the basis holds; returns the end time of that part. Counts the steps that the method
    /// makes of its own.
    fn part<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        step: (f64, f64),
        state: &mut State<N>,
        inner: &mut u32,
    ) -> Result<(StepReport<M>, Option<f64>), StepError>
    where
        Method: OneStep<N, M>,
    {
        let (t, h) = step;
        let before = *state;
        let outcome = self.part_near(system, (t, before.q(), self.basis), step, state, inner);
        self.local = Some(outcome.is_some());
        let made = match outcome {
            None => return Ok((self.method.step(system, t, h, state)?, None)),
            Some(Err(error)) if error.may_hold_in_parts() => Err(error),
            Some(Ok(made)) if self.along && made.1.is_none() && !self.held(system, step, &before, state) => {
                Err(StepError::LeavesBasis)
            }
            Some(made) => return made,
        };
        let mut tried = [self.basis; 2];
        for ahead in [0.5, 1.0] {
            let (t, q) = (t + ahead * h, before.ahead(&mapped(before.v(), |v| ahead * h * v)));
            let mut number = self.basis;
            system.near(t, &q, 0, &mut |best, _| number = best);
            if tried.contains(&number) {
                continue;
            }
            *state = before;
            if let Some(Ok(made)) = self.part_near(system, (t, &q, number), step, state, inner)
                && (made.1.is_some() || self.held(system, step, &before, state))
            {
                return Ok(made);
            }
            tried[1] = number;
        }
        made
    }

    /// Whether the basis is well conditioned in the middle and at the end of a step.
    fn held<const N: usize, const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        (t, h): (f64, f64),
        start: &State<N>,
        end: &State<N>,
    ) -> bool {
        let (from, to) = (start.unwrapped(), end.unwrapped());
        let middle = start.ahead(&from_fn(|i| 0.5 * (to[i] - from[i])));
        holds(system, self.basis, t + 0.5 * h, &middle) && holds(system, self.basis, t + h, end.q())
    }

    /// As [`Self::part`], in the basis `number` if it is good at a time and a place, else in the basis that is best there.
    fn part_near<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        (time, place, number): (f64, &[f64; N], u64),
        step: (f64, f64),
        state: &mut State<N>,
        inner: &mut u32,
    ) -> Option<Result<(StepReport<M>, Option<f64>), StepError>>
    where
        Method: OneStep<N, M>,
    {
        let mut outcome = None;
        let (first, (t, h)) = ((step.0, *state), step);
        let (mut last, mut dropped) = (first, None::<Dependent>);
        let Self { method, basis, .. } = self;
        let known = *basis;
        system.near(time, place, number, &mut |number, near| {
            if number != known {
                // The memory belongs to the other basis.
                method.forget(state);
                state.advance(&[0.0; N], *state.v(), None);
            }
            *basis = number;
            let mut look = |time: f64, node: &State<N>| {
                *inner += 1;
                dropped = left_branch(system, (last.0, time - last.0), &last.1, node)
                    .or_else(|| turned_off(system, &first, &last.1, (time, node)));
                last = (time, *node);
                match dropped.is_none() && *inner < MOST_STEPS && holds(system, number, time, node.q()) {
                    true => ControlFlow::Continue(()),
                    false => ControlFlow::Break(()),
                }
            };
            outcome = Some(method.step_until(near, step, state, &mut look));
        });
        if let Some(Ok((_, None))) = &outcome {
            dropped = left_branch(system, (last.0, t + h - last.0), &last.1, state);
        }
        match (outcome, dropped) {
            (Some(Ok(_)), Some(dropped)) => Some(Err(dropped.into())),
            (outcome, _) => outcome,
        }
    }
}

impl<Method, const N: usize, const M: usize> OneStep<N, M> for Rebased<Method>
where
    Method: OneStep<N, M>,
{
    #[inline]
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        if self.local == Some(false) {
            return self.method.step(system, t, h, state);
        }
        let (before, basis) = (*state, self.basis);
        // A step in one part has the length of the step, to the last bit.
        let (mut total, mut rest) = (None::<StepReport<M>>, (t, h));
        let mut inner = 0;
        loop {
            let found = match inner {
                ..MOST_STEPS => self.part(system, rest, state, &mut inner),
                tries => Err(StepError::Tolerance { tries, step: (rest.0 - t).abs() / f64::from(tries) }),
            };
            let ended = self.local == Some(true) && matches!(found, Ok((_, None)));
            let whole = ended.then(|| left_branch(system, (t, h), &before, state)).flatten();
            // Seen over the whole step too: in own steps of the method, and if bases change, the motion may turn little by little.
            let found = whole.map_or(found, |dropped| Err(dropped.into()));
            match found {
                Ok((report, end)) => {
                    let made = total.map_or(report, |total| total.then(&report));
                    let Some(end) = end else { return Ok(made) };
                    (total, rest) = (Some(made), (end, t + h - end));
                }
                Err(error) => {
                    *state = before;
                    if total.is_some() || self.basis != basis {
                        // The memory of the method belongs to another place or another basis.
                        self.basis = basis;
                        self.method.forget(state);
                    }
                    return Err(error);
                }
            }
        }
    }

    /// The memory of the method, and behind it the number of the basis to which the memory belongs.
    fn memory(&self) -> Vec<f64> {
        numbered(self.method.memory(), self.basis as f64)
    }

    fn recall(&mut self, memory: &[f64], state: &State<N>) {
        let (basis, own) = memory.split_last().unwrap_or((&0.0, &[]));
        if self.basis != *basis as u64 {
            self.basis = *basis as u64;
            self.method.forget(state);
        }
        self.method.recall(own, state);
    }

    fn measure_work(&mut self, sources: PowerSources) {
        self.method.measure_work(sources);
    }

    fn own_steps(
        &self,
        system: &dyn Mechanics<N, M>,
        step: (f64, f64),
        state: &State<N>,
        memory: &mut Vec<f64>,
        see: &mut OwnStep<'_, N>,
    ) -> Result<(), StepError> {
        let (mut rest, mut start) = (step, *state);
        loop {
            let basis = memory.pop().unwrap_or(0.0);
            let (mut outcome, mut turned, mut stopped) = (None, None, false);
            let q = *start.q();
            system.near(rest.0, &q, basis as u64, &mut |number, near| {
                if number != basis as u64 {
                    memory.clear();
                    start.advance(&[0.0; N], *start.v(), None);
                }
                let mut look = |time: f64, node: &State<N>| {
                    stopped = see(time, node).is_break();
                    if !stopped && holds(system, number, time, node.q()) {
                        return ControlFlow::Continue(());
                    }
                    turned = Some((time, *node));
                    ControlFlow::Break(())
                };
                outcome = Some(self.method.own_steps(near, rest, &start, memory, &mut look));
                *memory = numbered(std::mem::take(memory), number as f64);
            });
            match (outcome, turned) {
                (Some(Ok(())), Some((time, node))) if !stopped => {
                    (rest, start) = ((time, step.0 + step.1 - time), node);
                }
                (Some(made), _) => return made,
                (None, _) => {
                    let made = self.method.own_steps(system, step, state, memory, see);
                    *memory = numbered(std::mem::take(memory), basis);
                    return made;
                }
            }
        }
    }
}

/// A memory with the number of a basis behind it; empty if there is neither.
fn numbered(mut memory: Vec<f64>, basis: f64) -> Vec<f64> {
    if !memory.is_empty() || basis != 0.0 {
        memory.push(basis);
    }
    memory
}
