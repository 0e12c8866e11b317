use crate::{Mechanics, OneStep, OwnStep, State, StepError, StepReport};

/// A method on systems whose basis of admissible velocities holds near a configuration only: the basis is changed at nodes, where it
/// becomes badly conditioned.
///
/// Within a step the basis is one and the same, so that a method has the order that it has in any basis. Of a system whose basis holds
/// everywhere the method makes its steps by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rebased<Method> {
    method: Method,
    /// The number of the basis; none before the first step.
    basis: u64,
    /// Whether bases of the system are local; not known before the first step.
    local: Option<bool>,
}

impl<Method> Rebased<Method> {
    /// The method, with its basis changed where the system asks for that.
    pub fn new(method: Method) -> Self {
        Self { method, basis: 0, local: None }
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
        let (mut outcome, q) = (None, *state.q());
        let Self { method, basis, local } = self;
        let known = *basis;
        system.near(t, &q, known, &mut |number, near| {
            let (before, remembered) = (*state, method.memory());
            if number != known {
                // What is remembered is in the other basis.
                method.recall(&[], state);
                state.advance(&[0.0; N], *before.v(), None);
            }
            let made = method.step(near, t, h, state);
            if made.is_ok() {
                *basis = number;
            } else if number != known {
                *state = before;
                method.recall(&remembered, state);
            }
            outcome = Some(made);
        });
        *local = Some(outcome.is_some());
        match outcome {
            Some(made) => made,
            None => self.method.step(system, t, h, state),
        }
    }

    /// What the method remembers, and behind it the number of the basis in which that is.
    fn memory(&self) -> Vec<f64> {
        numbered(self.method.memory(), self.basis as f64)
    }

    fn recall(&mut self, memory: &[f64], state: &State<N>) {
        let (basis, own) = memory.split_last().unwrap_or((&0.0, &[]));
        self.basis = *basis as u64;
        self.method.recall(own, state);
    }

    fn own_steps(
        &self,
        system: &dyn Mechanics<N, M>,
        step: (f64, f64),
        state: &State<N>,
        memory: &mut Vec<f64>,
        see: &mut OwnStep<'_, N>,
    ) -> Result<(), StepError> {
        let basis = memory.pop().unwrap_or(0.0);
        let mut outcome = None;
        system.near(step.0, state.q(), basis as u64, &mut |number, near| {
            let mut start = *state;
            if number != basis as u64 {
                memory.clear();
                start.advance(&[0.0; N], *state.v(), None);
            }
            outcome = Some(self.method.own_steps(near, step, &start, memory, see));
            *memory = numbered(std::mem::take(memory), number as f64);
        });
        outcome.unwrap_or_else(|| {
            let made = self.method.own_steps(system, step, state, memory, see);
            *memory = numbered(std::mem::take(memory), basis);
            made
        })
    }
}

/// A memory with the number of a basis behind it; nothing where there is neither.
fn numbered(mut memory: Vec<f64>, basis: f64) -> Vec<f64> {
    if !memory.is_empty() || basis != 0.0 {
        memory.push(basis);
    }
    memory
}
