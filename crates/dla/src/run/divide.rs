use lagrangian::Shown;
use std::ops::ControlFlow;
use thiserror::Error;

/// How far a step may be divided that cannot be made whole.
///
/// Its parts are halves, quarters, eighths, .. of it, each as long as it can be, on the grid of their own length: so they end
/// where the step does, and a part becomes twice as long again as soon as that grid is met. What is done depends on the
/// step alone, never on steps before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Substeps {
    halvings: u32,
    most: u64,
}

/// A step that has no solution in sub-steps either.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{source}; {tried} parts of the step were tried, the last of {} s from t = {} s", Shown(*part), Shown(*time))]
pub struct Undivided<E> {
    /// The parts that were tried, those that held among them.
    pub tried: u64,
    /// Where the last began (s).
    pub time: f64,
    /// How long it was (s).
    pub part: f64,
    /// Why the last that failed did.
    #[source]
    pub source: E,
}

impl Default for Substeps {
    /// As short as parts can be, and 2^22 tries: what needs more of them is not a matter of one step.
    fn default() -> Self {
        Self::new(53, 1 << 22)
    }
}

impl Substeps {
    /// Parts of `2^-halvings` of a step at the least, and so many tries in all. More than 53 halvings count as that, since shorter
    /// parts are lost in the end of the step.
    #[must_use]
    pub fn new(halvings: u32, most: u64) -> Self {
        Self { halvings: halvings.min(53), most }
    }

    /// Makes the step from time `t` to `t + h` (s) in parts, after it has failed as a whole; how many there were, or `Break`
    /// where `make` gave that.
    ///
    /// `make` is given the start and the length of a part (s) and which part of the step is done after it. Where it fails it
    /// must leave everything as it was. `mended` says whether a shorter part may hold after such a failure.
    ///
    /// # Errors
    /// [`Undivided`] with the last failure, where no shorter part mends it, or no more may be tried.
    pub fn divide<E>(
        &self,
        (t, h): (f64, f64),
        whole: E,
        mended: impl Fn(&E) -> bool,
        mut make: impl FnMut((f64, f64), f64) -> Result<ControlFlow<()>, E>,
    ) -> Result<ControlFlow<(), u64>, Undivided<E>> {
        let (mut done, mut part, shortest) = (0.0, 1.0, 0.5f64.powi(self.halvings as i32));
        let (mut tried, mut made, mut last) = (0, 0, (t, h));
        let (mut source, mut failed) = (whole, true);
        while done < 1.0 {
            if tried >= self.most || failed && (part <= shortest || !mended(&source)) {
                let (time, part) = last;
                return Err(Undivided { tried, time, part, source });
            }
            if failed {
                part *= 0.5;
            }
            tried += 1;
            last = (t + done * h, part * h);
            match make(last, done + part) {
                Ok(ControlFlow::Break(())) => return Ok(ControlFlow::Break(())),
                Ok(ControlFlow::Continue(())) => {
                    (done, made, failed) = (done + part, made + 1, false);
                    if part < 0.5 && (done / (2.0 * part)).fract() == 0.0 {
                        part *= 2.0;
                    }
                }
                Err(failure) => (source, failed) = (failure, true),
            }
        }
        Ok(ControlFlow::Continue(made))
    }
}
