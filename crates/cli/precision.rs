use crate::args::PrecisionArguments;
use crate::command_line::CommandLine;
use crate::compare::{exact, place_at};
use crate::error::{CliError, unless_interrupted};
use crate::file_roles::FileRoles;
use crate::files::ClaimedFolder;
use crate::inspect::{listed, methods};
use crate::interrupt::Interrupt;
use crate::provenance::{Provenance, metadata_of};
use crate::{facts, files, inspect, points_file, precision_text, progress, terminal};
use harness::Method;
use harness::precision::{
    Bench, Clock, Curve, LadderLimits, Reference, ReferenceError, ReferenceMotion, mark_pareto, rounds, work_precision,
};
use scene::{AnyScene, Overrides};
use serde_json::json;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Longest default duration (s).
const DURATION: f64 = 20.0;
/// Error (m or rad) that the reference of a default duration should not exceed.
const KNOWN: f64 = 1e-12;
/// Maximum number of times that a default duration is halved to reach that error.
const HALVINGS: u32 = 6;

/// Errors below this multiple of the reference's error count as equal.
const CLEAR: f64 = 10.0;

/// The measurements of a scene.
pub(crate) struct Measurement {
    /// How long the motion takes (s).
    pub(crate) duration: f64,
    pub(crate) reference: KnownEnd,
    pub(crate) clock: Clock,
    pub(crate) facts: Vec<(String, String)>,
    pub(crate) curves: Vec<Curve>,
}

/// The reference for the end of the motion.
pub(crate) struct KnownEnd {
    /// True if the end is known in closed form; false if the method computed it.
    pub(crate) closed: bool,
    /// The method that computes it, or that the closed form is checked against.
    pub(crate) by: &'static str,
    /// Its steps.
    pub(crate) steps: u64,
    /// How far it may be off (m or rad).
    pub(crate) error: f64,
    end: Vec<f64>,
}

/// `noslip precision`: what accuracy costs in time.
pub(crate) fn precision(arguments: &PrecisionArguments) -> Result<(), CliError> {
    let run = Overrides { duration: arguments.duration, alpha: arguments.alpha, ..Overrides::default() };
    let mut scene = inspect::load_over((&arguments.scene, &arguments.set), run)?;
    let methods = methods(&listed(arguments.methods.as_deref()), scene.run().alpha, scene.run().tolerance)?;
    let mut others = Vec::new();
    for path in &arguments.with {
        let (curves, warnings) = points_file::read(path, scene.name())?;
        warnings.iter().for_each(|warning| terminal::say("warning", warning));
        others.extend(curves);
    }
    let roles = arguments.with.iter().fold(FileRoles::of(&arguments.scene), |roles, path| roles.reads(path));
    roles.rows("--csv", arguments.csv.as_deref()).writes("--report", arguments.report.as_deref()).check()?;
    let claimed = |folder: &PathBuf| ClaimedFolder::new(folder, arguments.force);
    let folder = arguments.report.as_ref().map(claimed).transpose()?;
    if let Some(path) = &arguments.csv {
        files::check_file(path, arguments.force)?;
        files::check_file(&metadata_of(path), arguments.force)?;
    }
    if arguments.duration.is_none() {
        scene.run_mut().duration = scene.run().duration.min(DURATION);
    }
    let chosen = arguments.duration.is_none();
    let interrupt = Interrupt::listen();
    let mut measured = measure(&scene, &methods, arguments.longest, chosen, &interrupt)?;
    let climbed = measured.curves.len();
    measured.curves.extend(others);
    mark_pareto(&mut measured.curves, CLEAR * measured.reference.error);

    let made = unfinished(&measured, climbed, methods.len()).filter(|_| interrupt.asked());
    let provenance = provenance(arguments, &scene, &measured).interrupted(made.as_deref());
    if let Some(path) = &arguments.csv {
        let text = precision_text::csv(&measured.curves);
        files::write_whole(path, arguments.force, |file| std::io::Write::write_all(file, text.as_bytes()))?;
        provenance.write_beside(path, &precision_text::described())?;
    }
    if let Some(folder) = &folder {
        let report = precision_text::report(&scene, &measured, &provenance);
        report::write(&report, folder.path()).map_err(CliError::Report)?;
    }
    if arguments.json {
        terminal::print_json(&precision_text::json(&scene, &measured))?;
    } else {
        terminal::print(&precision_text::text(&scene, &measured, arguments.wide))?;
        let page = arguments.report.as_ref().map(|folder| folder.join("index.html"));
        for (what, path) in [("points", arguments.csv.as_ref()), ("report", page.as_ref())] {
            path.map_or(Ok(()), |path| terminal::print(&format!("{what}: {}\n", path.display())))?;
        }
    }
    let named = arguments.methods.is_some();
    let failed = CliError::of_failures(measured.curves.iter().filter_map(|curve| failure(curve, named)));
    unless_interrupted(made, None, failed)
}

/// The unfinished part if a signal ended the work; `None` if all was done.
fn unfinished(measured: &Measurement, climbed: usize, methods: usize) -> Option<String> {
    let (made, all) = (measured.clock.rounds, rounds());
    if climbed < methods {
        return Some(format!("{climbed} of {methods} methods finished"));
    }
    (made < all)
        .then(|| format!("all {methods} methods have their errors, and their times are of {made} of {all} rounds"))
}

/// The provenance of the points.
fn provenance(arguments: &PrecisionArguments, scene: &AnyScene, measured: &Measurement) -> Provenance {
    let PrecisionArguments { methods, alpha, longest, with, csv, report, .. } = arguments;
    let command = CommandLine::of("precision", &arguments.scene, &arguments.set);
    let command = command.maybe("--methods", methods.as_ref().map(|methods| methods.join(",")));
    let command = command.number("--duration", measured.duration);
    let command = command.maybe_number("--alpha", *alpha).number("--longest", *longest);
    let command = with.iter().fold(command, |command, path| command.with("--with", path.display()));
    let command = command.maybe("--csv", csv.as_ref().map(|path| path.display()));
    let command = command.maybe("--report", report.as_ref().map(|path| path.display()));
    let notes = json!({"duration": measured.duration, "reference": precision_text::reference(measured)});
    Provenance::on(scene, Some(&command), notes)
}

/// The reason that a method has no point at all; a refusal counts only if the user named the method.
fn failure(curve: &Curve, named: bool) -> Option<String> {
    if let Some(reason) = curve.refusal {
        return named.then(|| format!("{} refused: {reason}", curve.method));
    }
    let lost = curve.source.is_none() && curve.points.iter().all(|point| point.error.is_none());
    let reason = curve.points.last().and_then(|point| point.mark.as_ref()).map(ToString::to_string);
    lost.then(|| format!("{}: every run failed; the finest {}", curve.method, reason.unwrap_or_default()))
}

/// Measures what accuracy costs on a scene, by runs of `longest` (s) at most. A duration that is `chosen` for the user may be shortened.
pub(crate) fn measure(
    scene: &AnyScene,
    methods: &[Method],
    longest: f64,
    chosen: bool,
    interrupt: &Interrupt,
) -> Result<Measurement, CliError> {
    inspect::moves(scene);
    let built = scene.built()?;
    let (system, q, v) = (built.system(), &built.q, &built.v);
    let apart = |a: &[f64], b: &[f64]| system.distance(a, b);
    let mechanism = system.mechanism();
    let exact = exact(scene);
    let mut duration = scene.run().duration;
    let mut halvings = 0;
    let (motion, reference) = loop {
        let motion = ReferenceMotion::new(&*mechanism, q, v, duration);
        if system.is_assembly() {
            let reference = of_assembly(&motion, apart)?;
            break (motion, Ok(reference));
        }
        let reference = Reference::converged(&motion, &apart).map(|found| {
            let exact = exact.as_ref().map(|exact| place_at(exact, duration));
            known(exact, &found, apart)
        });
        let unsure = reference.as_ref().map_or(true, |reference| reference.error > KNOWN);
        if !(chosen && unsure && halvings < HALVINGS) {
            break (motion, reference);
        }
        duration *= 0.5;
        halvings += 1;
    };
    let reference = reference.map_err(|error: ReferenceError| CliError::Computation(vec![error.to_string()]))?;
    let end_error = |method: &Method, steps: u64| motion.end(method, steps).map(|q| apart(&q, &reference.end));
    let aligned = |steps: u64| motion.aligned(steps);
    let bench = Bench { duration, reference_error: reference.error, end_error: &end_error, aligned: &aligned };
    let limits = LadderLimits { fewest: motion.aligned(2), longest };
    let (label, steps) = (format!("{} precision", scene.name()), methods.len() as u64 + rounds());
    let (curves, clock) =
        progress::shown(&label, steps, interrupt, |progress| work_precision(&bench, methods, &limits, progress));
    let mut facts = facts::of(scene)?;
    // The last fact gives the scene's steps; these runs use the steps of the ladders.
    facts.pop();
    Ok(Measurement { duration, reference, clock, facts, curves })
}

/// The end in closed form, with its distance from the computed end as its error; the computed end if there is no closed form.
fn known(exact: Option<Vec<f64>>, computed: &Reference, apart: impl Fn(&[f64], &[f64]) -> f64) -> KnownEnd {
    let (end, steps, error) = (computed.q.clone(), computed.steps, computed.error);
    match exact {
        Some(exact) => {
            let error = apart(&exact, &end).max(f64::EPSILON);
            KnownEnd { closed: true, by: "gauss16", steps, error, end: exact }
        }
        None => KnownEnd { closed: false, by: "gauss16", steps, error, end },
    }
}

/// The end of a train by `dla8`, its steps doubled until two successive ends are no nearer than those before, or it takes too long.
fn of_assembly(motion: &ReferenceMotion<'_>, apart: impl Fn(&[f64], &[f64]) -> f64) -> Result<KnownEnd, CliError> {
    /// Of one run.
    const LONG: Duration = Duration::from_secs(10);
    const FEWEST: u64 = 32;
    let dla8 = Method::named("dla8", None)?;
    let mut best: Option<KnownEnd> = None;
    let (mut before, mut steps, mut failure) = (None, FEWEST, String::new());
    while steps <= FEWEST << 12 {
        let clock = Instant::now();
        match motion.end(&dla8, steps) {
            Ok(end) => {
                let error = before.as_ref().map(|before: &Vec<f64>| apart(before, &end));
                if let Some(error) = error {
                    if best.as_ref().is_some_and(|best| error >= best.error) {
                        break;
                    }
                    best = Some(KnownEnd { closed: false, by: "dla8", steps, error, end: end.clone() });
                }
                before = Some(end);
            }
            Err(error) => failure = error.to_string(),
        }
        if clock.elapsed() > LONG {
            break;
        }
        steps *= 2;
    }
    best.ok_or_else(|| CliError::Computation(vec![format!("the reference: too few runs of dla8 succeed: {failure}")]))
}
