//! Hard cases: what a case is, what a run of it shows, and which methods claim it.
//!
//! A case is run by whoever has its system; what it recorded, a [`Recorded`], is given to small functions in [`check`],
//! each of which gives a [`Finding`], a measured number and its bar. [`judge`] makes a [`Verdict`] of them. Nothing here
//! knows which method made a run, so the same checks can be shown to see a stepper that is broken.

pub mod check;
mod claim;
mod recorded;
mod verdict;

pub use check::Finding;
pub use claim::{Claim, claims};
pub use recorded::{Recorded, Recorder, Seen, VALUES};
pub use verdict::{Outcome, Trial, Verdict, judge};

/// A hard case, in words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Case {
    /// Its name in commands.
    pub name: &'static str,
    /// Why it is hard.
    pub hard: &'static str,
    /// The result of a correct code.
    pub shows: &'static str,
    /// The bar, and what it follows from.
    pub bar: &'static str,
    /// The claim of the methods that must meet it.
    pub claim: Claim,
    /// Whether an error value is an answer: the step or the numbers are beyond what a method can do.
    pub refusable: bool,
}
