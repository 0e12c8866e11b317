use super::{ClosedForm, ClosedStart, Memory};
use dla::{Dla, Mechanics, OneStep, State, StepError, StepReport};

/// The midpoint discrete Lagrange-d'Alembert map in the closed form that a body has of it, an integrator that agrees with
/// [`Dla::midpoint`] to round-off: of the free sleigh one unknown in some 20 ns, of a sleigh with forces two.
///
/// It is the map of the body that it is made of, and is to be driven on this body. A step that has no closed form, or is not found by it
/// quickly, is made by a general method on the system that is driven; one of which the closed form shows that it does not exist fails with
/// [`StepError::Closed`].
///
/// What a step leaves to the next, from which the search there is short, is kept here, and saved with the method's
/// [memory](OneStep::memory).
#[derive(Debug, Clone)]
pub struct ClosedMap<Body, General = Dla> {
    body: Body,
    memory: Memory,
    general: General,
}

impl<Body> ClosedMap<Body> {
    /// The map of this body, with [`Dla::midpoint`] for the other steps.
    #[must_use]
    pub fn of(body: Body) -> Self {
        Self::backed_by(body, Dla::midpoint())
    }
}

impl<Body, General> ClosedMap<Body, General> {
    /// The map of this body, with a method for the other steps, which should be the same map.
    #[must_use]
    pub fn backed_by(body: Body, general: General) -> Self {
        Self { body, memory: Memory::EMPTY, general }
    }
}

impl<Body, General, const N: usize, const M: usize> OneStep<N, M> for ClosedMap<Body, General>
where
    Body: ClosedForm<N, M>,
    General: OneStep<N, M>,
{
    #[inline]
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        let Self { body, memory, general } = self;
        let remembered = !memory.is_empty();
        let mut closed = body.closed_step(t, h, ClosedStart { q: state.q(), v: state.v(), xi: state.xi(), memory });
        if remembered && matches!(closed, Some(Err(_))) {
            // A search from the last step may lead to a solution too far away, where the one from the line of the motion does not.
            memory.forget();
            closed = body.closed_step(t, h, ClosedStart { q: state.q(), v: state.v(), xi: state.xi(), memory });
        }
        match closed {
            Some(Ok(step)) => {
                let moved = state.advance_where_finite(&step.increment, step.velocity, step.xi);
                moved.inspect_err(|_| memory.forget())?;
                Ok(StepReport { impulses: step.impulses, ..StepReport::of(step.iterations) })
            }
            Some(Err(source)) => {
                memory.forget();
                Err(StepError::Closed(source))
            }
            None => {
                memory.forget();
                general.step(system, t, h, state)
            }
        }
    }

    fn memory(&self) -> Vec<f64> {
        let own = if self.memory.is_empty() { Memory::EMPTY } else { self.memory };
        [&own.0[..], &self.general.memory()].concat()
    }

    fn recall(&mut self, memory: &[f64], state: &State<N>) {
        let (own, general) = memory.split_first_chunk().unwrap_or((&Memory::EMPTY.0, &[]));
        self.memory = Memory(*own);
        self.general.recall(general, state);
    }
}
