use dla::{History, Newton, NewtonError};
use lagrangian::linear::largest;

/// The stopping rule of [`Newton`] for unknowns whose number is not known to the compiler.
///
/// Every component settles by itself, as there, but that the next correction is predicted by the linear convergence of a matrix
/// that is kept, `d (d / d_before)`. What is below the rounding of the largest component counts as settled too: of thousands of
/// components whose corrections are rounding, some would always shrink a little.
#[derive(Debug)]
pub(crate) struct Settling {
    pub(crate) newton: Newton,
    last: Vec<f64>,
    rounding: Vec<bool>,
    size: f64,
    before: f64,
    growths: u32,
    history: History,
    /// The sizes of the first two corrections.
    pub(crate) first: [f64; 2],
    pub(crate) made: u32,
}

/// What linear convergence leaves out is the same in every step, and not to be seen in the sum of many.
const BIAS: f64 = f64::EPSILON / 64.0;

impl Settling {
    /// So many times in all the largest correction may grow.
    const GROWTHS: u32 = 3;
    /// Where the second correction is below this part of the first, there is one solution near the start.
    const CONTRACTION: f64 = 0.25;

    pub(crate) fn new(unknowns: usize) -> Self {
        Self {
            newton: Newton::default(),
            last: vec![0.0; unknowns],
            rounding: vec![false; unknowns],
            size: 0.0,
            before: f64::INFINITY,
            growths: 0,
            history: History::new(),
            first: [0.0; 2],
            made: 0,
        }
    }

    /// A new search begins at `x`.
    pub(crate) fn begin(&mut self, x: &[f64]) {
        self.last.fill(f64::INFINITY);
        self.rounding.fill(false);
        (self.size, self.before, self.growths) = (largest(x), f64::INFINITY, 0);
        (self.history, self.first, self.made) = (History::new(), [0.0; 2], 0);
    }

    /// The search so far, for an error.
    pub(crate) fn history(&self) -> History {
        self.history.relative_to(self.size)
    }

    /// Whether the search contracted from its start, so that what it found is the solution near there.
    pub(crate) fn is_certain(&self) -> bool {
        let [first, second] = self.first;
        second <= Self::CONTRACTION * first || second <= Newton::rounding(self.size)
    }

    /// Adds a correction to `x`, and says whether every component is settled.
    pub(crate) fn correct(&mut self, x: &mut [f64], correction: &[f64]) -> Result<bool, NewtonError> {
        self.made += 1;
        let iteration = self.made;
        for (x, d) in x.iter_mut().zip(correction) {
            *x += d;
        }
        let now = largest(x);
        if !now.is_finite() {
            return Err(NewtonError::NotFinite { iteration, history: self.history() });
        }
        self.size = self.size.max(now);
        let (step, size) = (largest(correction), self.size);
        self.history.push(step);
        if let Some(first) = self.first.get_mut(iteration as usize - 1) {
            *first = step;
        }
        let converged = step <= Newton::rounding(size);
        let (tolerance, least) = (self.newton.tolerance, self.newton.tolerance * size);
        // Where the next correction is predicted to be rounding in all components, those that have not settled never will.
        let over = converged && step * (step / self.before).min(1.0) <= BIAS * size;
        let mut settled = true;
        let before = self.last.iter_mut().zip(self.rounding.iter_mut());
        for ((x, d), (last, rounding)) in x.iter().zip(correction).zip(before) {
            let (d, shrink) = (d.abs(), d.abs() / *last);
            *rounding |= converged && shrink >= 0.25;
            let predicts = last.is_finite() && d <= x.abs();
            let next = if predicts { d * shrink } else { d };
            settled &= *rounding || d <= least || d <= tolerance * x.abs() || next <= BIAS * x.abs();
            *last = d;
        }
        if settled || over {
            return Ok(true);
        }
        if step > self.before && !converged {
            self.growths += 1;
            if self.growths == Self::GROWTHS {
                let (correction, before) = (step / size, self.before / size);
                return Err(NewtonError::Diverged { iteration, correction, before, history: self.history() });
            }
        }
        self.before = step;
        if iteration >= self.newton.max_iterations {
            let correction = step / size;
            return Err(NewtonError::IterationLimit { iterations: iteration, correction, history: self.history() });
        }
        Ok(false)
    }
}
