use lagrangian::Shown;
use std::ops::ControlFlow;
use thiserror::Error;

/// Limits on the division of a step that cannot be made whole.
///
/// The parts are halves, quarters, eighths, .. of the step, each as long as possible, on the grid of their own length: so the last part
/// ends with the step, and parts become twice as long again as soon as they meet the longer grid. The division depends on the step alone,
/// never on steps before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Substeps {
    halvings: u32,
    most: u64,
}

/// A step that has no solution in sub-steps either.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{source}; {tried} parts of the step were tried, the last of {} s from t = {} s", Shown(*part), Shown(*time))]
pub struct Undivided<E> {
    /// The number of parts that were tried, including the parts that succeeded.
    pub tried: u64,
    /// The beginning of the last part (s).
    pub time: f64,
    /// The length of the last part (s).
    pub part: f64,
    /// Why the last failing part failed.
    #[source]
    pub source: E,
}

impl Default for Substeps {
    /// The shortest possible parts, and 2^22 tries: a step that needs more has another cause of failure.
    fn default() -> Self {
        Self::new(53, 1 << 22)
    }
}

impl Substeps {
    /// Parts of at least `2^-halvings` of a step, and at most `most` tries in all. More than 53 halvings count as 53, since shorter parts
    /// are lost in the end of the step.
    #[must_use]
    pub fn new(halvings: u32, most: u64) -> Self {
        Self { halvings: halvings.min(53), most }
    }

    /// Makes the step from time `t` to `t + h` (s) in parts, after it has failed as a whole; returns their number, or `Break` if `make`
    /// gave that.
    ///
    /// `make` is given the start and the length of a part (s), and the fraction of the step that is done after it. If it fails it must
    /// leave everything as it was. `mended` says whether a shorter part may hold after such a failure.
    ///
    /// # Errors
    /// [`Undivided`] with the last failure, if no shorter part mends it, or no more may be tried.
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
