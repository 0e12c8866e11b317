use crate::hint::Hint;
use crate::{OneStep, State, StepError, StepReport};

/// A method that makes a step of shorter ones where it finds none of the whole length.
///
/// It is for those who ask for it: the map is then neither symmetric nor the same function of the step everywhere, so that what
/// is said of the method in the long run holds only as far as no step is divided; [`divided`](Self::divided) tells how
/// many were. The constraint holds all the same.
///
/// A step fails that has no solution in parts of `2^-halvings` either, or for a reason that no shorter step mends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Substepping<Method> {
    /// The method.
    pub method: Method,
    /// How often a step may be halved; 53 at most, since shorter parts of a step are lost in its end.
    pub halvings: u32,
    divided: u64,
}

impl<Method> Substepping<Method> {
    /// The method with steps that may be halved so often.
    pub fn new(method: Method, halvings: u32) -> Self {
        Self { method, halvings: halvings.min(53), divided: 0 }
    }

    /// How many steps have been divided.
    #[must_use]
    pub fn divided(&self) -> u64 {
        self.divided
    }

    /// The step in parts, each as long as it can be; the last error where they would have to be too short.
    #[cold]
    fn in_parts<Sys, const N: usize, const M: usize>(
        &mut self,
        system: &Sys,
        (t, h): (f64, f64),
        state: &mut State<N>,
        mut error: StepError,
    ) -> Result<StepReport<M>, StepError>
    where
        Method: OneStep<Sys, N, M> + Clone,
    {
        let (mut method, mut inner) = (self.method.clone(), *state);
        let mut total = StepReport::of(0);
        let (mut done, mut part, shortest) = (0.0, 1.0, 0.5f64.powi(self.halvings as i32));
        while done < 1.0 {
            if !matches!(error.hint(), Some(Hint::ShorterStep { .. })) || part <= shortest {
                return Err(error);
            }
            part *= 0.5;
            // The parts are on the grid of their own length, so that they end where the step does.
            while done < 1.0 {
                let mut tried = method.clone();
                match tried.step(system, t + done * h, part * h, &mut inner) {
                    Ok(report) => {
                        (method, done) = (tried, done + part);
                        total = total.then(&report);
                        if part < 0.5 && (done / (2.0 * part)).fract() == 0.0 {
                            part *= 2.0;
                        }
                    }
                    Err(failed) => {
                        error = failed;
                        break;
                    }
                }
            }
        }
        self.divided += 1;
        (self.method, *state) = (method, inner);
        Ok(total)
    }
}

impl<Sys, Method, const N: usize, const M: usize> OneStep<Sys, N, M> for Substepping<Method>
where
    Method: OneStep<Sys, N, M> + Clone,
{
    fn step(&mut self, system: &Sys, t: f64, h: f64, state: &mut State<N>) -> Result<StepReport<M>, StepError> {
        match self.method.step(system, t, h, state) {
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
}
