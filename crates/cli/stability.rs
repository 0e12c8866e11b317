//! `noslip stability`: the hard cases, method by method.

mod case;
mod formulas;
mod run;

use crate::args::StabilityArguments;
use crate::compare::{methods, unless_interrupted};
use crate::error::CliError;
use crate::inspect::method_names;
use crate::interrupt::Interrupt;
use crate::{progress, table, terminal};
use case::HardCase;
use harness::stability::{Case, Outcome, Verdict};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::sync::atomic::{AtomicUsize, Ordering};

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
    let names: Vec<&str> = match &arguments.methods {
        Some(names) => names.iter().map(|name| name.trim()).collect(),
        None => method_names(),
    };
    let methods = methods(&names, None, None)?;
    let pairs: Vec<_> = chosen
        .iter()
        .flat_map(|case| methods.iter().map(move |method| (*case, method)))
        .filter(|(case, method)| case.takes(method))
        .collect();
    let interrupt = Interrupt::listen_saying("stopping after the cases that have begun; Ctrl-C again ends at once");
    let bar = progress::bar("cases", pairs.len() as u64);
    let rows = in_parallel(&pairs, &interrupt, |(case, method)| {
        let verdict = case.verdict(cases, method);
        bar.inc(1);
        Ok(CaseRow { case: case.case().name, method: method.info().name, verdict: verdict? })
    })?;
    bar.finish_and_clear();
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

/// Each of the rows on whatever thread is free, in their order; after a signal those that have begun.
fn in_parallel<T: Sync, R: Send>(
    pairs: &[T],
    interrupt: &Interrupt,
    row: impl Fn(&T) -> Result<R, CliError> + Sync,
) -> Result<Vec<R>, CliError> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(pairs.len().max(1));
    let next = AtomicUsize::new(0);
    let work = || {
        let mut made = Vec::new();
        while !interrupt.asked()
            && let Some((at, pair)) =
                Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|at| Some((at, pairs.get(at)?)))
        {
            made.push((at, row(pair)));
        }
        made
    };
    let mut made = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
        let own = work();
        // A thread that panicked has said so; its rows are missing, and the count below tells.
        others.into_iter().filter_map(|other| other.join().ok()).fold(own, |mut all, more| {
            all.extend(more);
            all
        })
    });
    if made.len() < pairs.len() && !interrupt.asked() {
        return Err(CliError::Computation(vec![format!("only {} of {} rows finished", made.len(), pairs.len())]));
    }
    made.sort_by_key(|(at, _)| *at);
    made.into_iter().map(|(_, row)| row).collect()
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
