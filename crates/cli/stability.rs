//! `noslip stability`: the hard cases, method by method.

mod case;
mod formulas;
mod run;

use crate::args::StabilityArguments;
use crate::error::{CliError, unless_interrupted};
use crate::inspect::{listed, methods};
use crate::interrupt::Interrupt;
use crate::{progress, table, terminal};
use case::HardCase;
use harness::stability::{Case, Outcome, Verdict};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The cases, in words.
pub(crate) fn cases() -> Result<Vec<Case>, CliError> {
    Ok(case::all()?.cases.iter().map(HardCase::case).collect())
}

/// A case, a method, and what came of them.
struct CaseRow {
    case: &'static str,
    method: &'static str,
    verdict: Verdict,
}

pub(crate) fn stability(arguments: &StabilityArguments) -> Result<(), CliError> {
    let cases = case::all()?;
    let chosen: Vec<_> = match &arguments.case {
        None => cases.cases.iter().collect(),
        Some(name) => vec![named(name)?],
    };
    let methods = methods(&listed(arguments.methods.as_deref()), None, None)?;
    let pairs: Vec<_> = chosen
        .iter()
        .flat_map(|case| methods.iter().map(move |method| (*case, method)))
        .filter(|(case, method)| case.takes(method))
        .collect();
    let interrupt = Interrupt::listen_saying("stopping after the cases that have begun; Ctrl-C again ends at once");
    let rows = progress::in_parallel("cases", pairs.len(), &interrupt, |i| {
        let (case, method) = pairs[i];
        let verdict = case.verdict(cases, method)?;
        Ok(CaseRow { case: case.case().name, method: method.info().name, verdict })
    });
    let rows: Vec<CaseRow> = rows.into_iter().flatten().collect::<Result<_, CliError>>()?;
    if arguments.json {
        terminal::print_json(&json!({"cases": rows.iter().map(object).collect::<Vec<_>>()}))?;
    } else {
        terminal::print(&text(&rows))?;
    }
    let failed = rows.iter().filter(|row| row.verdict.outcome == Outcome::Failed);
    let failed = failed.map(|row| format!("{}, {} failed: {}", row.case, row.method, row.verdict.why));
    let made = (rows.len() < pairs.len()).then(|| format!("{} of {} rows finished", rows.len(), pairs.len()));
    unless_interrupted(made, None, CliError::of_failures(failed))
}

fn named(name: &str) -> Result<&'static HardCase, CliError> {
    let wanted = name.trim().replace('_', "-");
    let names: Vec<_> = cases()?.iter().map(|case| case.name).collect();
    let found = case::all()?.cases.iter().find(|case| case.case().name == wanted);
    found.ok_or_else(|| CliError::Case {
        name: name.to_owned(),
        nearest: scene::nearest(name, names.iter().copied()).map(str::to_owned),
        names: names.join(", "),
    })
}

fn object(row: &CaseRow) -> Value {
    let worst = row.verdict.worst;
    // A number that is none has no place in JSON.
    let number = |x: Option<f64>| x.filter(|x| x.is_finite());
    json!({
        "case": row.case,
        "method": row.method,
        "outcome": row.verdict.outcome.to_string(),
        "measured": number(worst.map(|worst| worst.measured)),
        "bar": number(worst.map(|worst| worst.bar)),
        "why": row.verdict.why,
    })
}

fn text(rows: &[CaseRow]) -> String {
    let number = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), |x| format!("{x:.1e}"));
    let cells: Vec<_> = rows
        .iter()
        .map(|row| {
            let worst = row.verdict.worst;
            let (measured, bar) = (worst.map(|worst| worst.measured), worst.map(|worst| worst.bar));
            let outcome = row.verdict.outcome.to_string();
            vec![row.case.to_owned(), row.method.to_owned(), outcome, number(measured), number(bar)]
        })
        .collect();
    let table = table::right_aligned(&["case", "method", "outcome", "measured", "bar"], &cells);
    let mut text = String::new();
    // The line that says why is as long as it must be.
    let whys = std::iter::once("why").chain(rows.iter().map(|row| row.verdict.why.as_str()));
    for (line, why) in table.lines().zip(whys) {
        let _ = writeln!(text, "{line}  {why}");
    }
    let count = |outcome| rows.iter().filter(|row| row.verdict.outcome == outcome).count();
    let [pass, refused, failed] = [Outcome::Pass, Outcome::Refused, Outcome::Failed].map(count);
    let _ = writeln!(text, "{pass} pass, {refused} refused, {failed} failed");
    text
}
