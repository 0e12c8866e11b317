//! `noslip ensemble`: many variants of a scene.

mod about;
mod members;
mod parts;
mod result;
mod rows;
mod spool;
mod totals;

pub(crate) use parts::{Share, merge};
pub use parts::{SweepPlan, plan};

use crate::args::EnsembleArguments;
use crate::error::{CliError, unless_interrupted};
use crate::file_roles::FileRoles;
use crate::files::check_file;
use crate::format::Format;
use crate::interrupt::Interrupt;
use crate::lock::PartFile;
use crate::{inspect, program, progress, terminal};
use about::About;
use dla::Checkpoint;
use harness::ensemble::in_order;
use members::{MemberRow, Members, Summed, method_of};
use result::Shape;
use scene::Sweep;
use spool::{Spool, SpoolRequest};
use std::ops::{ControlFlow, Range};
use std::time::Instant;
use totals::EnsembleTotals;

/// Computes the members of a sweep in order, writes a row for each, and says what they came to.
pub(crate) fn ensemble(arguments: &EnsembleArguments) -> Result<(), CliError> {
    let names = inspect::method_names();
    let sweep = Sweep::load_with(&arguments.sweep, &arguments.set.set, &names)?;
    let method = method_of(&sweep, sweep.scene.run())?;
    let (identity, summed) = (identity(&sweep), Summed::of(&sweep)?);
    let about = About::new((&arguments.sweep, &arguments.set), &sweep, &summed, &identity);
    let members = Members { sweep: &sweep, method, names: &names, summed: &summed };
    if let Some(share) = arguments.part {
        return parts::make(arguments, &about, &members, share);
    }
    let out = match &arguments.out {
        Some(path) => {
            let format = Format::of(path, None)?;
            FileRoles::of(&arguments.sweep).rows("--out", Some(path)).check()?;
            check_file(path, arguments.force || arguments.resume && PartFile::path_of(path).exists())?;
            format.check_metadata(path, arguments.force || arguments.resume)?;
            Some((path.as_path(), format))
        }
        None => None,
    };
    let (interrupt, all) = (listen(), 0..sweep.count());
    let mut totals = EnsembleTotals::new(&about, 0);
    let mut spool = match out {
        Some((path, _)) => {
            let of = (identity.as_str(), all.clone(), about.columns().len());
            let asked = SpoolRequest { resume: arguments.resume, force: arguments.force };
            Some(Spool::open(path, of, asked, |text| totals.take(text))?)
        }
        None => None,
    };
    let (seconds, computed) = compute(&members, (all, ""), &mut spool, &mut totals, &interrupt)?;
    let stopped = totals.count() < sweep.count();
    let written = match (spool, out) {
        (Some(spool), Some((path, format))) if !stopped => {
            let (columns, metadata) = (about.columns(), about.metadata(path, format));
            let shape = Shape { format, columns: &columns, count: sweep.count(), metadata: &metadata };
            spool.finish(path, &shape, arguments.force)
        }
        _ => Ok(()),
    };
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
    unless_interrupted(made, None, failed)
}

/// Computes the members `all` that are not in the spool yet, as far as a signal lets it come, and returns the time (s) and the number of members.
/// Each row is in the spool, and in the totals, as soon as it and those before it are done.
fn compute(
    members: &Members<'_>,
    (all, of): (Range<u64>, &str),
    spool: &mut Option<Spool>,
    totals: &mut EnsembleTotals,
    interrupt: &Interrupt,
) -> Result<(f64, u64), CliError> {
    let lines = spool.as_ref().map(Spool::lines).cloned();
    let todo = spool.as_ref().map_or(all.start, Spool::next)..all.end;
    let (begin, done) = (Instant::now(), totals.count());
    let bar = progress::bar(&format!("{}{of}", members.method.info().name), all.end - all.start);
    bar.inc(done);
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
    let outcome = in_order(todo, || interrupt.asked(), each, sink);
    bar.finish_and_clear();
    match outcome {
        ControlFlow::Break(error) => Err(error),
        ControlFlow::Continue(()) => Ok((begin.elapsed().as_secs_f64(), totals.count() - done)),
    }
}

/// The signals to a sweep.
fn listen() -> Interrupt {
    Interrupt::listen_saying("stopping after the members that have begun; Ctrl-C again ends at once")
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
