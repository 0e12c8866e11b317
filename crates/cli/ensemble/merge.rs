use super::lines::Lines;
use super::parts::{self, chain, found};
use super::result::Shape;
use super::totals::EnsembleTotals;
use crate::args::MergeArguments;
use crate::error::CliError;
use crate::files::check_file;
use crate::format::Format;
use crate::provenance::metadata_of;
use crate::terminal;
use std::io::Error;
use std::path::PathBuf;

/// `noslip merge`: the result of a sweep of its parts, with the bytes that one process would have written.
pub(crate) fn merge(arguments: &MergeArguments) -> Result<(), CliError> {
    let MergeArguments { folder, out, force, json } = arguments;
    let (about, all) = found(folder)?;
    let out: PathBuf = out.clone().unwrap_or_else(|| folder.with_extension("csv"));
    let format = Format::of(&out, None)?;
    check_file(&out, *force)?;
    if format.is_text() {
        check_file(&metadata_of(&out), *force)?;
    }
    let parts = chain(all, about.members).map_err(|missing| {
        let (first, last) = (missing.start, missing.end.saturating_sub(1));
        let problem = format!(
            "{}: no part continues the others with members {first} to {last} of \
            {}",
            folder.display(),
            about.members
        );
        CliError::Request(format!("{problem}; compute the missing parts, then merge"))
    })?;
    let (columns, header) = (about.columns(), format!("{}\n", about.identity));
    let lines = Lines::new(&about.identity, columns.len());
    let rows = || -> Result<_, Error> { Ok(parts::rows((&lines, &header), &parts)) };
    let unreadable = |source| CliError::Read { path: folder.clone(), source };
    let mut totals = EnsembleTotals::new(&about, 0);
    let mut all = rows().map_err(unreadable)?;
    while let Some(text) = all.next().map_err(unreadable)? {
        totals.take(text);
    }
    let metadata = about.metadata(&out, format);
    let shape = Shape { format, columns: &columns, count: about.members, metadata: &metadata };
    shape.write(&out, *force, &rows)?;
    match json {
        true => terminal::print_json(&totals.json(&about, 0.0, 0))?,
        false => terminal::print(&totals.text(&about, 0.0, 0, Some(&out)))?,
    }
    CliError::of_failures(totals.failures())
}
