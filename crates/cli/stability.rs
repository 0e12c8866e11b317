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
        terminal::print(&text(&rows, arguments))?;
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

/// The outcome on the screen: a method that ran and missed a bar that it does not claim to meet has not refused.
fn outcome(verdict: &Verdict) -> String {
    let ran = verdict.worst.is_some_and(|worst| worst.measured.is_finite());
    if verdict.outcome == Outcome::Refused && ran { "missed".to_owned() } else { verdict.outcome.to_string() }
}

/// How many cases each method passes, refuses, misses and fails.
fn summary(rows: &[CaseRow]) -> String {
    let mut methods: Vec<&str> = Vec::new();
    for row in rows {
        if !methods.contains(&row.method) {
            methods.push(row.method);
        }
    }
    let counted = |method: &str| -> Vec<String> {
        let own = || rows.iter().filter(|row| row.method == method);
        let of = |word: &str| own().filter(|row| outcome(&row.verdict) == word).count().to_string();
        [method.to_owned(), own().count().to_string()].into_iter().chain(WORDS.map(of)).collect()
    };
    let cells: Vec<Vec<String>> = methods.into_iter().map(counted).collect();
    table::right_aligned(&[&["method", "cases"][..], &WORDS].concat(), &cells)
}

/// What may come of a case, on the screen.
const WORDS: [&str; 4] = ["pass", "refused", "missed", "failed"];

/// The rows of one case, or of all of them if the table may be `wide`.
fn details(rows: &[CaseRow], wide: bool) -> String {
    /// Longer reasons follow the table.
    const SHORT: usize = 32;
    let number = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), |x| format!("{x:.1e}"));
    let cells: Vec<_> = rows
        .iter()
        .map(|row| {
            let worst = row.verdict.worst;
            let (measured, bar) = (worst.map(|worst| worst.measured), worst.map(|worst| worst.bar));
            let cells = vec![row.method.to_owned(), outcome(&row.verdict), number(measured), number(bar)];
            if wide { [vec![row.case.to_owned()], cells].concat() } else { cells }
        })
        .collect();
    let headings = ["case", "method", "outcome", "measured", "bar"];
    let table = table::right_aligned(if wide { &headings } else { &headings[1..] }, &cells);
    let is_short = |why: &str| wide || why.chars().count() <= SHORT;
    let (mut text, mut left) = (String::new(), Vec::new());
    let whys = std::iter::once("why").chain(rows.iter().map(|row| row.verdict.why.as_str()));
    for (k, (line, why)) in table.lines().zip(whys).enumerate() {
        let _ = writeln!(text, "{}", format!("{line}  {}", if is_short(why) { why } else { "" }).trim_end());
        if let Some(row) = k.checked_sub(1).and_then(|k| rows.get(k)).filter(|_| !is_short(why)) {
            left.push((row.method.to_owned(), why.to_owned()));
        }
    }
    text + &table::by_reason(&left)
}

fn text(rows: &[CaseRow], arguments: &StabilityArguments) -> String {
    let one = arguments.case.is_some();
    let mut text = if one || arguments.wide { details(rows, arguments.wide) } else { summary(rows) };
    let count = |word: &str| rows.iter().filter(|row| outcome(&row.verdict) == word).count();
    let [pass, refused, missed, failed] = WORDS.map(count);
    let _ =
        writeln!(text, "{pass} pass, {refused} refused, {missed} missed a bar that is not claimed, {failed} failed");
    text
}
