use crate::args::LyapunovArguments;
use crate::chart_file::ChartFile;
use crate::compare::unless_interrupted;
use crate::error::CliError;
use crate::exponents::{asked, free, provenance, refused, schedule};
use crate::interrupt::Interrupt;
use crate::progress::Interruptible;
use crate::{inspect, json, notes, progress, stability_map, table, terminal};
use dla::has_tangents;
use harness::Method;
use harness::analysis::{Lyapunov, LyapunovFailure, LyapunovRequest, MotionVerdict, kaplan_yorke};
use report::{Chart, Layer};
use scene::{AnyScene, Built, Column, MAX_STEPS};
use serde_json::{Value, json};

/// Default durations (s): of one motion, and of each motion of a map.
const DURATION: f64 = 10_000.0;
const MAP_DURATION: f64 = 500.0;

/// `noslip lyapunov`: the exponents of one motion, or the largest of many.
pub(crate) fn lyapunov(arguments: &LyapunovArguments) -> Result<(), CliError> {
    let usual = if arguments.map.is_empty() { DURATION } else { MAP_DURATION };
    let shared = &arguments.scene;
    let duration = shared.duration.or(Some(usual));
    let from = (shared.scene.as_str(), &shared.set);
    let scene = inspect::load_any_with(from, Some(&arguments.method), shared.step, duration, shared.alpha)?.uncut();
    let method = inspect::method(scene.run())?;
    has_tangents(&method).map_err(|reason| CliError::Request(format!("--method {}: {reason}", arguments.method)))?;
    check_settle(arguments, &scene)?;
    let file = arguments.out.as_deref().map(|path| ChartFile::of(path, &shared.scene, shared.force)).transpose()?;
    notes::moves(&scene);
    let built = free(&scene)?;
    let start = (&built.q[..], &built.v[..]);
    match &arguments.map[..] {
        [] => Exponents { arguments, scene: &scene, method, file }.on(&built.system(), start),
        [across, up] => {
            let axes = [across, up];
            stability_map::Map { arguments, scene: &scene, method, axes, file }.on(&built.system(), start)
        }
        _ => {
            let problem = "--map must be given twice: first the horizontal axis, then the vertical axis";
            Err(CliError::Request(problem.to_owned()))
        }
    }
}

/// Refuses a time before the run that has more steps than any run may have.
fn check_settle(arguments: &LyapunovArguments, scene: &AnyScene) -> Result<(), CliError> {
    let (settle, step) = (arguments.settle.unwrap_or(0.0), scene.run().actual_step());
    let most = MAX_STEPS as f64 * step;
    if settle <= most {
        return Ok(());
    }
    let problem =
        format!("--settle: {settle:e} s are more than 1e12 steps of {step:?} s; accepted: at most {most:e} s");
    Err(CliError::Request(problem))
}

struct Exponents<'a> {
    arguments: &'a LyapunovArguments,
    scene: &'a AnyScene,
    method: Method,
    file: Option<ChartFile<'a>>,
}

impl Exponents<'_> {
    fn on(self, system: &Built<'_>, (q, v): (&[f64], &[f64])) -> Result<(), CliError> {
        let (q, v) = asked(system, (q.to_vec(), v.to_vec()), self.arguments.energy)?;
        let (schedule, settle) = schedule(self.arguments, self.scene);
        let exponents = self.arguments.exponents.map(|count| count as usize);
        let request = LyapunovRequest { schedule, settle, exponents, q, v };
        let interrupt = Interrupt::listen();
        let bar = progress::bar(self.method.info().name, settle.saturating_add(schedule.steps));
        let mut progress = Interruptible { bar, interrupt: &interrupt };
        let mechanism = system.mechanism();
        let found = harness::analysis::lyapunov(&*mechanism, system.own(), &self.method, &request, &mut progress);
        progress.bar.finish_and_clear();
        let found = found.map_err(refused)?;
        let made = interrupt.asked().then(|| format!("the exponents cover {} s", table::number(found.time)));
        let told = self.tell(&found, mechanism.energy(0.0, &request.q, &request.v), made.as_deref());
        unless_interrupted(made, None, told)
    }
}

impl Exponents<'_> {
    fn tell(&self, found: &Lyapunov, energy: f64, interrupted: Option<&str>) -> Result<(), CliError> {
        let shared = &self.arguments.scene;
        let written = self.file.map_or(Ok(()), |file| {
            let rows: Vec<Vec<f64>> = found.running.iter().map(|at| [&[at.time][..], &at.exponents].concat()).collect();
            let each = (1..=found.exponents.len()).map(|i| Column::new(format!("exponent_{i}"), "1/s"));
            let columns: Vec<Column> = std::iter::once(Column::new("t", "s")).chain(each).collect();
            let provenance = provenance(self.arguments, self.scene, interrupted);
            file.write(shared.force, &provenance, (&columns, &rows), || self.chart(found))
        });
        let whole = found.exponents.len() == found.most;
        if shared.json {
            terminal::print_json(&self.json(found, energy, whole))?;
        } else {
            terminal::print(&self.text(found, energy, whole))?;
            if let (Some(path), Ok(())) = (&self.arguments.out, &written) {
                terminal::print(&format!("written    {}\n", path.display()))?;
            }
        }
        CliError::of_failures(found.failure.map(|failure| format!("{}: {failure}", self.method.info().name)))
            .and(written)
    }

    fn json(&self, found: &Lyapunov, energy: f64, whole: bool) -> Value {
        let running: Vec<Value> =
            doublings(found).map(|at| json!({"time": at.time, "exponents": at.exponents})).collect();
        let mut object = json!({
            "scene": self.scene.name(),
            "method": self.method.info().name,
            "step": self.scene.run().actual_step(),
            "duration": found.time,
            "energy": energy,
            "exponents": found.exponents,
            "ci": found.ci,
            "sum": found.sum(),
            "divergence_mean": found.divergence_mean,
            "verdict": found.verdict.name(),
            "convergence": running,
        });
        if whole {
            object["dimension"] = json!(kaplan_yorke(&found.exponents));
        }
        if let MotionVerdict::Periodic { period, .. } = found.verdict {
            object["period"] = json!(period);
        }
        if let MotionVerdict::Steady { unstable } | MotionVerdict::Periodic { unstable, .. } = found.verdict {
            object["unstable"] = json!(unstable);
        }
        if let Some(failure) = found.failure {
            object["failure"] = json!(failure.to_string());
            if let LyapunovFailure::Step(failure) = &failure {
                object["failed_at"] = json::failure(failure);
            }
        }
        object
    }

    fn text(&self, found: &Lyapunov, energy: f64, whole: bool) -> String {
        let run = self.scene.run();
        let exponent = |(value, ci): (&f64, &Option<f64>)| match ci {
            Some(ci) => format!("{value:+.5} ± {ci:.5}"),
            None => format!("{value:+.5}"),
        };
        let each = |i: usize| exponent((&found.exponents[i], &found.ci[i]));
        let mut lines = vec![
            ("scene".to_owned(), format!("{} ({})", self.scene.title(), self.scene.name())),
            (
                "run".to_owned(),
                format!(
                    "{} s by {} with steps of {} s",
                    table::number(found.time),
                    run.method,
                    table::number(run.actual_step())
                ),
            ),
            ("energy".to_owned(), format!("{} J", table::number(energy))),
        ];
        // A run that fails before anything is counted has no exponents.
        if found.time > 0.0 {
            let named = |i: usize| (format!("exponent {}", i + 1), format!("{} 1/s", each(i)));
            lines.extend((0..found.exponents.len()).map(named));
            let divergence = format!("{:+.7} 1/s", found.divergence_mean);
            if whole {
                lines.push(("sum".to_owned(), format!("{:+.7} 1/s", found.sum())));
                lines.push(("mean divergence".to_owned(), divergence));
            } else {
                lines.push(("mean divergence".to_owned(), format!("{divergence}, the sum of all exponents")));
            }
            if whole && has_attractor(found.verdict) {
                let dimension = kaplan_yorke(&found.exponents);
                lines.push(("dimension".to_owned(), format!("{dimension:.3}, by the formula of Kaplan and Yorke")));
            }
        }
        lines.push(("verdict".to_owned(), found.verdict.to_string()));
        table::aligned(&lines)
    }

    fn chart(&self, found: &Lyapunov) -> Chart {
        let line = |i: usize| Layer::Curves {
            label: format!("exponent {}", i + 1),
            curves: vec![found.running.iter().map(|at| [at.time, at.exponents[i]]).collect()],
        };
        Chart {
            title: format!("{}: Lyapunov exponents over a run", self.scene.title()),
            axes: ["t [s]".to_owned(), "running mean [1/s]".to_owned()],
            decades: [true, false],
            layers: (0..found.exponents.len()).map(line).collect(),
        }
    }
}

/// Whether a motion may be on an attractor whose dimension its exponents tell: an unstable steady one is not, nor is one that
/// runs away.
fn has_attractor(verdict: MotionVerdict) -> bool {
    match verdict {
        MotionVerdict::Steady { unstable } | MotionVerdict::Periodic { unstable, .. } => !unstable,
        MotionVerdict::RunsAway => false,
        MotionVerdict::Regular | MotionVerdict::Chaotic | MotionVerdict::Undecided(_) => true,
    }
}

/// The estimates after a sixteenth of the run, an eighth, .., all.
fn doublings(found: &Lyapunov) -> impl Iterator<Item = &harness::analysis::Running> {
    let count = found.running.len();
    (0..5).rev().filter_map(move |k| found.running.get((count >> k).checked_sub(1)?))
}
