//! The report of `noslip run` on steps divided into parts by `--substep`, and on steps that could be divided.

use crate::table;
use harness::{Record, SubstepSummary};
use serde_json::{Value, json};

/// Adds the count of divided steps to the object of a run, or adds the offer to divide steps to the hint of its failure.
pub(crate) fn add_json(object: &mut Value, record: &Record) {
    if let Some(SubstepSummary { divided, parts, most, undivided }) = &record.substeps {
        object["substeps"] = json!({"divided": divided, "parts": parts, "most": most});
        if let Some(why) = undivided {
            object["failure"]["parts"] = json!({"tried": why.tried, "time": why.time, "shortest": why.part});
        }
    } else if let Some(offer) = offer(record) {
        let hint = object["failure"]["hint"].as_str().map_or_else(String::new, |hint| format!("{hint}, or "));
        object["failure"]["hint"] = json!(hint + offer);
    }
}

/// A line for a person; `None` if the run could not divide steps.
pub(crate) fn told(record: &Record) -> Option<(String, String)> {
    let SubstepSummary { divided, parts, most, .. } = record.substeps?;
    let told = match divided {
        0 => format!("none of {} steps was divided", record.steps),
        _ => format!("{divided} of {} steps divided, into {parts} parts in all and {most} parts at most", record.steps),
    };
    Some(("substeps".to_owned(), told))
}

/// The failure of a run, with the outcome of its substeps or with the offer to make substeps.
pub(crate) fn failure(record: &Record) -> Option<String> {
    let failure = table::failure(record)?;
    let more = match &record.substeps {
        Some(SubstepSummary { undivided: Some(why), .. }) => format!(
            "; the step failed in parts too: {} parts were tried, the last of {:e} s from t = {} s",
            why.tried, why.part, why.time
        ),
        _ => offer(record).map_or_else(String::new, |offer| format!(", or {offer}")),
    };
    Some(failure + &more)
}

/// The advice to divide a step that failed; `None` if that was tried or would not help.
fn offer(record: &Record) -> Option<&'static str> {
    let failed = record.failure.as_ref().filter(|_| record.substeps.is_none())?;
    failed.source.may_hold_in_parts().then_some("divide such steps into parts (--substep)")
}
