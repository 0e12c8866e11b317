use super::{Case, Finding, Recorded, Seen};
use dla::Hint;
use lagrangian::Shown;
use std::fmt;

/// The outcome of a case for a method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It meets every bar.
    Pass,
    /// It says that it cannot, by an error value or beforehand.
    Refused,
    /// It does neither.
    Failed,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Pass => "pass",
            Self::Refused => "refused",
            Self::Failed => "failed",
        })
    }
}

/// One run of a case, with what it showed.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// Which run.
    pub label: String,
    /// The measurements in its valid part.
    pub findings: Vec<Finding>,
    /// A fault that no run may have: NaN, no end, an error that does not say what to change.
    pub broken: Option<String>,
    /// The error that ended it, and what to change.
    pub error: Option<String>,
    /// Whether that error is that the method cannot do the system at all.
    pub unsupported: bool,
}

impl Trial {
    /// A run with nothing measured yet.
    #[must_use]
    pub fn new(label: impl Into<String>, run: &Recorded) -> Self {
        let broken = if run.late {
            Some("takes too long".to_owned())
        } else {
            let number = |node: &&Seen| node.values.iter().any(|x| !x.is_finite());
            run.nodes
                .iter()
                .find(number)
                .map(|node| format!("not a finite number at t = {} s, and no error", Shown(node.t)))
        };
        let silent = run.failure.filter(|failure| failure.hint().is_none());
        let silent = silent.map(|failure| format!("an error that does not say what to change: {failure}"));
        let error = run.failure.map(|failure| match failure.hint() {
            Some(hint) => format!("{failure}; {hint}"),
            None => failure.to_string(),
        });
        let unsupported = run.failure.is_some_and(|failure| failure.hint() == Some(Hint::OtherMethod));
        Self { label: label.into(), findings: Vec::new(), broken: broken.or(silent), error, unsupported }
    }

    /// Adds findings.
    pub fn add(&mut self, findings: impl IntoIterator<Item = Finding>) {
        self.findings.extend(findings);
    }
}

/// The verdict on a case and a method.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// In a word.
    pub outcome: Outcome,
    /// The worst of the measured numbers, relative to its bar.
    pub worst: Option<Finding>,
    /// In a line.
    pub why: String,
}

/// Judges the runs of a case by a method that claims it, or does not for the reason given.
#[must_use]
pub fn judge(case: &Case, claim: Result<(), &'static str>, trials: &[Trial]) -> Verdict {
    let found = trials.iter().flat_map(|trial| trial.findings.iter().map(move |finding| (trial, finding)));
    let part = |finding: &Finding| if finding.part().is_nan() { f64::INFINITY } else { finding.part() };
    let worst = found.max_by(|a, b| part(a.1).total_cmp(&part(b.1)));
    let verdict = |outcome, why| Verdict { outcome, worst: worst.map(|(_, finding)| *finding), why };

    if let Some((trial, broken)) = trials.iter().find_map(|trial| Some((trial, trial.broken.as_ref()?))) {
        return verdict(Outcome::Failed, told(&trial.label, broken));
    }
    let above = worst.filter(|(_, finding)| !finding.holds());
    let refusals: Vec<_> = trials.iter().filter_map(|trial| Some((trial, trial.error.as_ref()?))).collect();
    let (held, all) = (trials.len() - refusals.len(), trials.len());
    match (above, refusals.first(), claim) {
        (Some((trial, finding)), _, Ok(())) => verdict(Outcome::Failed, told(&trial.label, finding.what)),
        (Some((trial, finding)), _, Err(reason)) => {
            verdict(Outcome::Refused, format!("not claimed, {reason}; {}", told(&trial.label, finding.what)))
        }
        (None, Some((trial, error)), Ok(())) if !case.refusable && !trial.unsupported => {
            verdict(Outcome::Failed, told(&trial.label, error))
        }
        (None, Some((trial, error)), Err(reason)) => verdict(
            Outcome::Refused,
            format!("not claimed, {reason}; {held} of {all} hold; {}", told(&trial.label, error)),
        ),
        (None, Some((trial, error)), Ok(())) => {
            verdict(Outcome::Refused, format!("{held} of {all} hold; {}", told(&trial.label, error)))
        }
        (None, None, Ok(())) => {
            verdict(Outcome::Pass, worst.map_or_else(String::new, |(trial, finding)| told(&trial.label, finding.what)))
        }
        (None, None, Err(reason)) => verdict(Outcome::Pass, format!("holds here; not claimed, {reason}")),
    }
}

fn told(label: &str, what: &str) -> String {
    if label.is_empty() { what.to_owned() } else { format!("{label}: {what}") }
}
