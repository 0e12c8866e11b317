//! `noslip ensemble`: many variants of a scene.

mod about;
mod lines;
mod members;
mod merge;
mod parts;
mod plan;
mod result;
mod rows;
pub(crate) mod share;
mod spool;
mod totals;

pub(crate) use merge::merge;
pub use plan::{SweepPlan, plan};

use crate::args::EnsembleArguments;
use crate::error::CliError;
use crate::file_roles::FileRoles;
use crate::files::check_file;
use crate::format::Format;
use crate::interrupt::Interrupt;
use crate::part::PartFile;
use crate::provenance::metadata_of;
use crate::{compare, inspect, program, progress, terminal};
use about::About;
use dla::Checkpoint;
use harness::ensemble::in_order;
use indicatif::ProgressBar;
use members::{MemberRow, Members, Summed, method_of};
use result::Shape;
use scene::Sweep;
use spool::{Spool, SpoolRequest};
use std::ops::ControlFlow;
use std::time::Instant;
use totals::EnsembleTotals;

/// Computes the members of a sweep in order, writes a row for each, and says what they came to.
pub(crate) fn ensemble(arguments: &EnsembleArguments) -> Result<(), CliError> {
    let names = inspect::method_names();
    let sweep = Sweep::load(&arguments.sweep, &names)?;
    let method = method_of(&sweep, sweep.scene.run())?;
    let (identity, summed) = (identity(&sweep), Summed::of(&sweep)?);
    let about = About::new(&arguments.sweep, &sweep, &summed, &identity);
    let members = Members { sweep: &sweep, method, names: &names, summed: &summed };
    if let Some(share) = arguments.part {
        return parts::make(arguments, &about, &members, share);
    }
    let out = match &arguments.out {
        Some(path) => {
            let format = Format::of(path, None)?;
            FileRoles::of(&arguments.sweep).rows("--out", Some(path)).check()?;
            check_file(path, arguments.force || arguments.resume && PartFile::path_of(path).exists())?;
            if format.is_text() {
                check_file(&metadata_of(path), arguments.force || arguments.resume)?;
            }
            Some((path.as_path(), format))
        }
        None => None,
    };
    let interrupt = Interrupt::listen_saying("stopping after the members that have begun; Ctrl-C again ends at once");
    let mut totals = EnsembleTotals::new(&about, 0);
    let mut spool = match out {
        Some((path, _)) => {
            let of = (identity.as_str(), 0..sweep.count(), about.columns().len());
            let asked = SpoolRequest { resume: arguments.resume, force: arguments.force };
            Some(Spool::open(path, of, asked, |values, error| totals.add(values, error))?)
        }
        None => None,
    };
    let done = spool.as_ref().map_or(0, Spool::next);
    let bar = progress::bar(members.method.info().name, sweep.count());
    bar.inc(done);
    let begin = Instant::now();
    let outcome = compute(&members, sweep.count(), &mut spool, &mut totals, &interrupt, &bar);
    bar.finish_and_clear();
    let seconds = begin.elapsed().as_secs_f64();
    outcome?;
    let stopped = totals.count() < sweep.count();
    let written = match (spool, out) {
        (Some(spool), Some((path, format))) if !stopped => {
            let (columns, metadata) = (about.columns(), about.metadata(path, format));
            let shape = Shape { format, columns: &columns, count: sweep.count(), metadata: &metadata };
            spool.finish(path, &shape, arguments.force)
        }
        _ => Ok(()),
    };
    let computed = totals.count() - done;
    if arguments.json {
        terminal::print_json(&totals.json(&about, seconds, computed))?;
    } else {
        let file = out.map(|(path, _)| path).filter(|_| written.is_ok() && !stopped);
        terminal::print(&totals.text(&about, seconds, computed, file))?;
    }
    let failed = CliError::of_failures(totals.failures()).and(written);
    let made = stopped.then(|| {
        let on = if out.is_some() { "; the same command with --resume continues" } else { "" };
        format!("{} of {} members finished{on}", totals.count(), sweep.count())
    });
    compare::unless_interrupted(made, None, failed)
}

/// Computes the members up to `end` that are not there yet, as far as a signal lets it come; each row is in the spool, and in the totals, as soon
/// as it and those before it are done.
fn compute(
    members: &Members<'_>,
    end: u64,
    spool: &mut Option<Spool>,
    totals: &mut EnsembleTotals,
    interrupt: &Interrupt,
    bar: &ProgressBar,
) -> Result<(), CliError> {
    let lines = spool.as_ref().map(Spool::lines).cloned();
    let todo = spool.as_ref().map_or(0, Spool::next)..end;
    let each = |member| {
        let row = members.row(member);
        let text = lines.as_ref().map(|lines| lines.line(&row)).unwrap_or_default();
        (row, text)
    };
    let sink = |rows: Vec<(MemberRow, String)>| {
        rows.iter().for_each(|(row, _)| totals.add(&row.values, row.error.as_deref()));
        let text: String = rows.iter().map(|(_, text)| text.as_str()).collect();
        bar.inc(rows.len() as u64);
        match spool.as_mut().map_or(Ok(()), |spool| spool.add(&text, rows.len() as u64)) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => ControlFlow::Break(error),
        }
    };
    match in_order(todo, || interrupt.asked(), each, sink) {
        ControlFlow::Break(error) => Err(error),
        ControlFlow::Continue(()) => Ok(()),
    }
}

/// Identifies a sweep, by all that its rows depend on.
fn contents(sweep: &Sweep) -> String {
    Checkpoint::fingerprint(&sweep.contents())
}

/// Identifies its rows, to the last bit.
fn identity(sweep: &Sweep) -> String {
    let (version, instructions) = (program::version(), program::instructions());
    format!("noslip ensemble {version} on {instructions}, rows with checksums {}", contents(sweep))
}
