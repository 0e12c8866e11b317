//! What `noslip run` says of steps that are made in parts, with `--substep`, and of those that could be.

use crate::table;
use harness::{Record, SubstepSummary};
use serde_json::{Value, json};

/// Adds to the object of a run what became of its divided steps, or to the hint of its failure that there is such a thing.
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

/// One line for a person; none of a run whose steps might not be divided.
pub(crate) fn told(record: &Record) -> String {
    let Some(SubstepSummary { divided, parts, most, .. }) = record.substeps else { return String::new() };
    let told = match divided {
        0 => format!("none of {} steps was divided", record.steps),
        _ => format!("{divided} of {} steps divided, into {parts} parts in all and {most} parts at most", record.steps),
    };
    table::aligned(&[("substeps", told)])
}

/// The failure of a run, with what its parts came to, or with the offer to make them.
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

/// What may be done about a step that is too long, where it has not been tried.
fn offer(record: &Record) -> Option<&'static str> {
    let failed = record.failure.as_ref().filter(|_| record.substeps.is_none())?;
    failed.source.may_hold_in_parts().then_some("divide such steps into parts (--substep)")
}
