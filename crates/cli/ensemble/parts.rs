//! Parts of a sweep that are computed by processes of their own: files of rows in a folder, and one on the sweep.

use super::about::About;
use super::members::{Members, method_of};
use super::result::Shape;
use super::rows::{Lines, Source, SpoolRows};
use super::spool::{Spool, SpoolRequest};
use super::totals::EnsembleTotals;
use super::{compute, identity, listen};
use crate::args::{EnsembleArguments, MergeArguments};
use crate::error::{CliError, unless_interrupted};
use crate::files::check_file;
use crate::format::Format;
use crate::in_memory::Refusal;
use crate::{inspect, terminal};
use dla::Checkpoint;
use scene::Sweep;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Error;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The advice for a part that is not as it was written.
const ADVICE: &str = "`noslip ensemble SWEEP --out DIR --part I/N` computes the part again";

/// A file of rows of some members.
#[derive(Debug, Clone)]
struct SweepPart {
    path: PathBuf,
    members: Range<u64>,
}

/// The beginning of the names of the files of a sweep: a hash of all that its rows depend on.
fn stem(identity: &str) -> String {
    format!("{}-{}", Checkpoint::fingerprint(identity), env!("CARGO_PKG_VERSION"))
}

/// The name of the file of some members.
fn name(stem: &str, members: &Range<u64>) -> String {
    format!("{stem}-{}-{}.rows", members.start, members.end)
}

/// The members in such a name.
fn members_of(stem: &str, name: &str) -> Option<Range<u64>> {
    let (start, end) = name.strip_prefix(stem)?.strip_prefix('-')?.strip_suffix(".rows")?.split_once('-')?;
    Some(start.parse().ok()?..end.parse().ok()?)
}

/// A reader of the rows of parts that follow on each other.
fn rows_of<'a>(lines: &'a Lines, parts: &[SweepPart]) -> SpoolRows<'a> {
    let members = parts.first().map_or(0, |part| part.members.start)..parts.last().map_or(0, |part| part.members.end);
    SpoolRows::new(lines, parts.iter().map(|part| Source::At(part.path.clone())).collect(), members, ADVICE)
}

/// Computes a part of a sweep, unless it is there already; an interrupted one goes on.
pub(super) fn make(
    arguments: &EnsembleArguments,
    about: &About,
    members: &Members<'_>,
    share: Share,
) -> Result<(), CliError> {
    let Some(folder) = arguments.out.as_deref() else {
        return Err(CliError::Request("--part needs --out DIR, the folder of the parts".to_owned()));
    };
    std::fs::create_dir_all(folder).map_err(|source| CliError::Write { path: folder.to_owned(), source })?;
    let stem = stem(&about.identity);
    about.write(&folder.join(format!("{stem}.json")))?;
    let range = share.members(about.members);
    let path = folder.join(name(&stem, &range));
    let numbers = about.columns().len();
    let part = SweepPart { path: path.clone(), members: range.clone() };
    let mut totals = EnsembleTotals::new(about, range.start);
    let mut seconds = 0.0;
    let mut computed = 0;
    let there = !arguments.force && path.exists();
    if there && is_whole(&part, &Lines::new(&about.identity, numbers), &mut totals) {
        terminal::say("note", &format!("{}: the part exists already and is kept", path.display()));
    } else {
        if there {
            terminal::say("warning", &format!("{}: the part is damaged and is computed again", path.display()));
        }
        totals = EnsembleTotals::new(about, range.start);
        let interrupt = listen();
        // The same command goes on, as a batch system gives it again.
        let asked = SpoolRequest { resume: !arguments.force, force: true };
        let of = (about.identity.as_str(), range.clone(), numbers);
        let mut spool = Some(Spool::open(&path, of, asked, |text| totals.take(text))?);
        let of = (range.clone(), &*format!(" {share}"));
        (seconds, computed) = compute(members, of, &mut spool, &mut totals, &interrupt)?;
        let whole = range.end - range.start;
        if totals.count() < whole {
            let count = totals.count();
            let made = format!("{count} of {whole} members of the part finished; the same command continues");
            return unless_interrupted(Some(made), None, Ok(()));
        }
        if let Some(spool) = spool {
            spool.becomes_part(&path, range.end)?;
        }
    }
    // A member that failed is a row of the part: it is the merged result that tells of it by its exit code.
    if let Some(failures) = totals.failures() {
        terminal::say("warning", &failures);
    }
    match arguments.json {
        true => terminal::print_json(&totals.json(about, seconds, computed)),
        false => terminal::print(&totals.text(about, seconds, computed, Some(&path))),
    }
}

/// Whether a part has every row; its members are added to the totals.
fn is_whole(part: &SweepPart, lines: &Lines, totals: &mut EnsembleTotals) -> bool {
    let mut rows = rows_of(lines, std::slice::from_ref(part));
    loop {
        match rows.next() {
            Ok(Some(text)) => totals.take(text),
            Ok(None) => return true,
            Err(_) => return false,
        }
    }
}

/// The parts that follow on each other from the first member to the last, of those that are there.
///
/// # Errors
/// The members that are missing.
fn chain(mut parts: Vec<SweepPart>, members: u64) -> Result<Vec<SweepPart>, Range<u64>> {
    // From the end: a part is of use if another one goes on from its end.
    parts.sort_by_key(|part| (std::cmp::Reverse(part.members.start), part.members.end));
    let mut onward: BTreeMap<u64, SweepPart> = BTreeMap::new();
    for part in &parts {
        let Range { start, end } = part.members;
        if start < end && (end == members || onward.contains_key(&end)) {
            onward.insert(start, part.clone());
        }
    }
    let mut chain = Vec::new();
    let mut at = 0;
    while at < members {
        let Some(part) = onward.get(&at) else { return Err(missing(&parts, members)) };
        at = part.members.end;
        chain.push(part.clone());
    }
    Ok(chain)
}

/// The first members that are in no part; of parts that overlap and do not follow on each other, those after the first such part.
fn missing(parts: &[SweepPart], members: u64) -> Range<u64> {
    let mut at = 0;
    while let Some(end) =
        parts.iter().filter(|part| part.members.start <= at && part.members.end > at).map(|part| part.members.end).max()
    {
        at = end;
    }
    let next = parts.iter().map(|part| part.members.start).filter(|start| *start > at).min();
    if at < members { at..next.unwrap_or(members).min(members) } else { 0..members }
}

/// The beginning of the name of a file of a sweep, whichever.
fn stem_of(name: &str) -> Option<&str> {
    let stem = match name.strip_suffix(".json") {
        Some(stem) => stem,
        None => {
            let (rest, _end) = name.strip_suffix(".part").unwrap_or(name).strip_suffix(".rows")?.rsplit_once('-')?;
            rest.rsplit_once('-')?.0
        }
    };
    let (hash, _) = stem.split_once('-')?;
    (hash.len() == 16 && hash.bytes().all(|digit| digit.is_ascii_hexdigit())).then_some(stem)
}

/// The sweep of the parts in a folder, and the parts.
fn found(folder: &Path) -> Result<(About, Vec<SweepPart>), CliError> {
    let unreadable = |source| CliError::Read { path: folder.to_owned(), source };
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        names.extend(entry.map_err(unreadable)?.file_name().into_string());
    }
    names.sort();
    let stems: BTreeSet<&str> = names.iter().filter_map(|name| stem_of(name)).collect();
    // Every sweep is told of before one of them is taken: the damaged one may be the one that is meant.
    let sweeps: Vec<About> = stems.iter().map(|stem| about(folder, stem)).collect::<Result<_, _>>()?;
    let [sweep] = &sweeps[..] else {
        return Err(CliError::Request(format!("{}: {}", folder.display(), told_apart(&sweeps))));
    };
    let stem = stem(&sweep.identity);
    let part = |name: &String| Some(SweepPart { path: folder.join(name), members: members_of(&stem, name)? });
    Ok((sweep.clone(), names.iter().filter_map(part).collect()))
}

/// The description of a sweep in a folder, whose files begin with `name`.
fn about(folder: &Path, name: &str) -> Result<About, CliError> {
    let path = folder.join(format!("{name}.json"));
    let known = About::read(&path).filter(|about| stem(&about.identity) == name);
    known.ok_or_else(|| {
        CliError::Request(format!(
            "{}: what this file says of its sweep is missing, damaged, or of another version of the program; `noslip ensemble \
             SWEEP --out DIR --part I/N` writes the file again",
            path.display()
        ))
    })
}

/// How sweeps that are not one differ.
fn told_apart(sweeps: &[About]) -> String {
    let Some(first) = sweeps.first() else { return "the folder has no parts of a sweep".to_owned() };
    let all = |of: fn(&About) -> &String| {
        let values: BTreeSet<&String> = sweeps.iter().map(of).collect();
        (values.len() > 1).then(|| values.into_iter().map(String::as_str).collect::<Vec<_>>().join(" and "))
    };
    let count = sweeps.len();
    if sweeps.iter().any(|other| other.contents != first.contents) {
        return format!("the folder has parts of {count} sweeps: keep the parts of one sweep");
    }
    let versions = all(|about| &about.version).map(|both| format!("the versions {both} of the program"));
    let machines = all(|about| &about.instructions).map(|both| format!("machines with {both}"));
    let differ: Vec<String> = versions.into_iter().chain(machines).collect();
    format!(
        "the folder has parts of {count} sweeps: they are one, computed by {}, whose numbers differ in the last bits; keep the parts of one \
         of them",
        differ.join(" and ")
    )
}

/// `noslip merge`: the result of a sweep of its parts, with the bytes that one process would have written.
pub(crate) fn merge(arguments: &MergeArguments) -> Result<(), CliError> {
    let MergeArguments { folder, out, force, json } = arguments;
    let (about, all) = found(folder)?;
    let out: PathBuf = out.clone().unwrap_or_else(|| folder.with_extension("csv"));
    let format = Format::of(&out, None)?;
    check_file(&out, *force)?;
    format.check_metadata(&out, *force)?;
    let parts = chain(all, about.members).map_err(|missing| {
        let (first, last) = (missing.start, missing.end.saturating_sub(1));
        CliError::Request(format!(
            "{}: no part continues the others with members {first} to {last} of {}; compute the missing parts, then merge",
            folder.display(),
            about.members
        ))
    })?;
    let columns = about.columns();
    let lines = Lines::new(&about.identity, columns.len());
    let rows = || -> Result<_, Error> { Ok(rows_of(&lines, &parts)) };
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

/// The parts that a sweep is computed in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SweepPlan {
    /// The beginning of the names of its files: a hash of all that its rows depend on, and the version of the program.
    pub stem: String,
    /// How many members there are.
    pub members: u64,
    /// The names of the files of the parts, in order.
    pub parts: Vec<String>,
}

/// Splits the sweep in the file `sweep` into `parts` parts, or one part per member if there are fewer members.
///
/// # Errors
/// [`Refusal`] with the first error of the sweep, or if `parts` is zero.
pub fn plan(sweep: &str, parts: u64) -> Result<SweepPlan, Refusal> {
    Ok(made(sweep, parts)?)
}

fn made(sweep: &str, parts: u64) -> Result<SweepPlan, CliError> {
    if parts == 0 {
        return Err(CliError::Request("0 parts: accepted are whole numbers from 1".to_owned()));
    }
    let names = inspect::method_names();
    let sweep = Sweep::load(sweep, &names)?;
    method_of(&sweep, sweep.scene.run())?;
    let (stem, members) = (stem(&identity(&sweep)), sweep.count());
    let of = parts.min(members);
    let part = |number| name(&stem, &Share { number, of }.members(members));
    Ok(SweepPlan { parts: (1..=of).map(part).collect(), stem, members })
}

/// One of some equal parts of the members of a sweep, such as `3/64`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Share {
    number: u64,
    of: u64,
}

impl Share {
    /// The members of this part, in a sweep of `count` members.
    fn members(self, count: u64) -> Range<u64> {
        let until = |part: u64| (u128::from(count) * u128::from(part) / u128::from(self.of)) as u64;
        until(self.number - 1)..until(self.number)
    }
}

impl std::fmt::Display for Share {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Share {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers =
            text.split_once('/').and_then(|(number, of)| Some((number.trim().parse().ok()?, of.trim().parse().ok()?)));
        match numbers {
            Some((number, of)) if 1 <= number && number <= of => Ok(Self { number, of }),
            _ => Err("accepted is I/N, for example 3/64: part I of N parts, with I from 1 to N".to_owned()),
        }
    }
}
