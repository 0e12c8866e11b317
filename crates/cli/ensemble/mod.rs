//! `noslip ensemble`: many variants of a scene.

mod lines;
mod members;
mod result;
mod spool;
mod totals;

use crate::args::EnsembleArguments;
use crate::error::CliError;
use crate::files::check_file;
use crate::interrupt::Interrupt;
use crate::trajectory_file::Format;
use crate::{compare, inspect, progress, terminal};
use dla::Checkpoint;
use harness::Method;
use harness::analysis::has_tangents;
use harness::ensemble::in_order;
use indicatif::ProgressBar;
use members::{COLUMNS, Members, Row};
use scene::Sweep;
use spool::{Asked, Spool};
use std::ops::{ControlFlow, Range};
use std::time::Instant;
use totals::Totals;

/// Computes the members of a sweep in order, writes a row for each, and says what they came to.
pub(crate) fn ensemble(arguments: &EnsembleArguments) -> Result<(), CliError> {
    let names = inspect::method_names();
    let sweep = Sweep::load(&arguments.sweep, &names)?;
    let run = &sweep.scene.run;
    let method = Method::of(&run.method, run.alpha, run.tolerance)?;
    if sweep.exponent {
        has_tangents(&method).map_err(|reason| CliError::Request(format!("output.exponent: {reason}")))?;
    }
    let out = match &arguments.out {
        Some(path) => {
            let format = Format::of(path)?;
            check_file(path, arguments.force)?;
            Some((path.as_path(), format))
        }
        None => None,
    };
    let interrupt = Interrupt::listen_saying("stopping after the members that have begun; Ctrl-C again ends at once");
    let mut totals = Totals::new(sweep.keys().count());
    let identity = identity(&sweep);
    let mut spool = match out {
        Some((path, _)) => {
            let of = (identity.as_str(), sweep.count(), header(&sweep).len());
            let asked = Asked { resume: arguments.resume, force: arguments.force };
            Some(Spool::open(path, of, asked, |values, error| totals.add(values, error))?)
        }
        None => None,
    };
    let done = spool.as_ref().map_or(0, Spool::rows);
    let bar = progress::bar(method.info().name, sweep.count());
    bar.inc(done);
    let begin = Instant::now();
    let outcome = compute(&Members { sweep: &sweep, method, names: &names }, &mut spool, &mut totals, &interrupt, &bar);
    bar.finish_and_clear();
    let seconds = begin.elapsed().as_secs_f64();
    outcome?;
    let stopped = totals.count() < sweep.count();
    let written = match (spool, out) {
        (Some(spool), Some((path, format))) if !stopped => {
            spool.finish(path, format, &header(&sweep), (sweep.count(), arguments.force))
        }
        _ => Ok(()),
    };
    let computed = totals.count() - done;
    if arguments.json {
        terminal::print_json(&totals.json(&sweep, seconds, computed))?;
    } else {
        let file = out.map(|(path, _)| path).filter(|_| written.is_ok() && !stopped);
        terminal::print(&totals.text(&sweep, seconds, computed, file))?;
    }
    let failed = CliError::of_failures(totals.failures()).and(written);
    let made = stopped.then(|| {
        let on = if out.is_some() { "; the same command with --resume goes on" } else { "" };
        format!("{} of {} members are done{on}", totals.count(), sweep.count())
    });
    compare::unless_interrupted(made, None, failed)
}

/// Computes the members that are not there yet, as far as a signal lets it come; each group is in the spool, and in the totals, as soon
/// as it and those before it are done.
fn compute(
    members: &Members<'_>,
    spool: &mut Option<Spool>,
    totals: &mut Totals,
    interrupt: &Interrupt,
    bar: &ProgressBar,
) -> Result<(), CliError> {
    let (size, count) = (members.group(), members.sweep.count());
    let lines = spool.as_ref().map(Spool::lines).cloned();
    let mut done = spool.as_ref().map_or(0, Spool::rows);
    let todo = done - done % size..count;
    let each = |range: Range<u64>| {
        let rows = members.rows(range);
        let texts: Vec<String> = lines.iter().flat_map(|lines| rows.iter().map(|row| lines.line(row))).collect();
        (rows, texts)
    };
    let sink = |groups: Vec<(Vec<Row>, Vec<String>)>| {
        let mut text = String::new();
        let before = done;
        for (rows, texts) in &groups {
            // A group that had begun is made again, without the rows that are there of it.
            let fresh = rows.iter().take_while(|row| row.member < before).count();
            rows[fresh..].iter().for_each(|row| totals.add(&row.values, row.error.as_deref()));
            text.extend(texts.iter().skip(fresh).map(String::as_str));
            done += (rows.len() - fresh) as u64;
        }
        bar.inc(done - before);
        match spool.as_mut().map_or(Ok(()), |spool| spool.add(&text, done - before)) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => ControlFlow::Break(error),
        }
    };
    match in_order(todo, size, || interrupt.asked(), each, sink) {
        ControlFlow::Break(error) => Err(error),
        ControlFlow::Continue(()) => Ok(()),
    }
}

/// What tells a sweep from others: all that its rows depend on.
fn identity(sweep: &Sweep) -> String {
    let contents = Checkpoint::fingerprint(&format!("{sweep:?}"));
    format!("noslip ensemble {} rows with checksums {contents}", env!("CARGO_PKG_VERSION"))
}

/// Names and units of the columns.
fn header(sweep: &Sweep) -> Vec<(String, &'static str)> {
    let exponent = sweep.exponent.then(|| ("exponent".to_owned(), "1/s"));
    let keys = sweep.keys().map(|key| (key.to_owned(), ""));
    let columns = COLUMNS.iter().map(|(name, unit)| ((*name).to_owned(), *unit));
    std::iter::once(("member".to_owned(), "")).chain(keys).chain(columns).chain(exponent).collect()
}
