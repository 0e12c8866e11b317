//! `noslip ensemble`: many variants of a scene.

mod members;
mod spool;
mod totals;

use crate::args::EnsembleArguments;
use crate::error::CliError;
use crate::files::check_file;
use crate::interrupt::Interrupt;
use crate::trajectory_file::Format;
use crate::{compare, inspect, progress, terminal};
use harness::Method;
use harness::analysis::has_tangents;
use harness::ensemble::in_order;
use members::{COLUMNS, GROUP, Members, Row};
use scene::Sweep;
use spool::Spool;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;
use totals::Totals;

/// Computes the members of a sweep in order, writes a row for each, and says what they came to.
pub(crate) fn ensemble(arguments: &EnsembleArguments) -> Result<(), CliError> {
    let names = inspect::method_names();
    let sweep = Sweep::load(&arguments.sweep, &names)?;
    let method = Method::named(&sweep.scene.run.method, sweep.scene.run.alpha)?;
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
    let mut totals = Totals::new(sweep.keys().count());
    let (mut spool, done) = opened(arguments, &sweep, out.map(|(path, _)| path), &mut totals)?;

    let interrupt = Interrupt::listen();
    let bar = progress::bar(method.info().name, sweep.count());
    bar.inc(done);
    let members = Members { sweep: &sweep, method, names: &names };
    let begin = Instant::now();
    let compute = |range: std::ops::Range<u64>| {
        if interrupt.asked() {
            return (Vec::new(), String::new());
        }
        let rows = members.rows(range);
        let text = rows.iter().map(spool::text).collect();
        (rows, text)
    };
    // A group that had begun is made again, without what is there of it.
    let mut skip = done % GROUP;
    let outcome = in_order(done - skip..sweep.count(), GROUP, compute, |(rows, text): (Vec<Row>, String)| {
        if rows.is_empty() {
            return ControlFlow::Break(Ok(()));
        }
        let fresh = std::mem::take(&mut skip) as usize;
        rows[fresh..].iter().for_each(|row| totals.add(&row.values, row.error.as_deref()));
        bar.inc((rows.len() - fresh) as u64);
        let from = text.split_inclusive('\n').take(fresh).map(str::len).sum();
        match spool.as_mut().map_or(Ok(()), |spool| spool.add(&text[from..])) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => ControlFlow::Break(Err(error)),
        }
    });
    bar.finish_and_clear();
    let seconds = begin.elapsed().as_secs_f64();
    let stopped = match outcome {
        ControlFlow::Break(Err(error)) => return Err(error),
        ControlFlow::Break(Ok(())) => true,
        ControlFlow::Continue(()) => false,
    };
    let written = match (spool, out) {
        (Some(mut spool), _) if stopped => spool.flush(),
        (Some(spool), Some((path, format))) => {
            spool.finish(path, format, &header(&sweep), sweep.count(), arguments.force)
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

/// The file of the rows, new or that of an interrupted run, and how many there are in it.
fn opened(
    arguments: &EnsembleArguments,
    sweep: &Sweep,
    out: Option<&Path>,
    totals: &mut Totals,
) -> Result<(Option<Spool>, u64), CliError> {
    let Some(out) = out else { return Ok((None, 0)) };
    let identity = identity(sweep);
    if arguments.resume {
        let (spool, done) = Spool::resume(out, &identity, |numbers, failed| {
            totals.add(numbers, failed.then_some("failed before"));
        })?;
        return Ok((Some(spool), done));
    }
    let part = Spool::path_of(out);
    if part.exists() && !arguments.force {
        return Err(CliError::Request(format!(
            "{} is there, of an interrupted run; --resume goes on, --force begins anew",
            part.display()
        )));
    }
    Spool::begin(out, &identity).map(|spool| (Some(spool), 0))
}

/// What tells a sweep from others: all that its rows depend on.
fn identity(sweep: &Sweep) -> String {
    let mut hasher = DefaultHasher::new();
    format!("{sweep:?}").hash(&mut hasher);
    format!("noslip ensemble {} {:016x}", env!("CARGO_PKG_VERSION"), hasher.finish())
}

/// Names and units of the columns.
fn header(sweep: &Sweep) -> Vec<(String, &'static str)> {
    let exponent = sweep.exponent.then(|| ("exponent".to_owned(), "1/s"));
    let keys = sweep.keys().map(|key| (key.to_owned(), ""));
    let columns = COLUMNS.iter().map(|(name, unit)| ((*name).to_owned(), *unit));
    std::iter::once(("member".to_owned(), "")).chain(keys).chain(columns).chain(exponent).collect()
}
