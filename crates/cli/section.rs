use crate::args::SectionArguments;
use crate::chart_file::ChartFile;
use crate::command_line::CommandLine;
use crate::compare::unless_interrupted;
use crate::coordinate::Coordinate;
use crate::error::CliError;
use crate::exponents::{asked, free};
use crate::interrupt::Interrupt;
use crate::provenance::Provenance;
use crate::starts::spread;
use crate::trigger::{doubts, in_doubt};
use crate::{inspect, json, notes, progress, table, terminal};
use dla::{Close, Event, RunError};
use harness::Method;
use harness::analysis::in_parallel;
use report::{Chart, Layer};
use scene::{AnyScene, Built, Column, Quantity, StartPlace};
use serde_json::{Value, json};

/// Default duration of each motion (s).
const DURATION: f64 = 2000.0;
/// The most starts, and the most crossings of all of them.
const MOST_STARTS: u64 = 100_000;

/// `noslip section`: the crossings of a plane by motions.
pub(crate) fn section(arguments: &SectionArguments) -> Result<(), CliError> {
    let shared = &arguments.scene;
    let duration = shared.duration.or(Some(DURATION));
    let from = (shared.scene.as_str(), &shared.set);
    let scene = inspect::load_any_with(from, Some(&arguments.method), shared.step, duration, shared.alpha)?;
    let method = inspect::method(scene.run())?;
    if arguments.axes.as_ref().is_some_and(|axes| axes.len() != 2 || axes[0].trim() == axes[1].trim()) {
        let problem = "--axes: accepted are two different quantities, for example heading,speed";
        return Err(CliError::Request(problem.to_owned()));
    }
    if arguments.starts > MOST_STARTS {
        return Err(CliError::Request(format!("--starts: accepted is a whole number from 1 to {MOST_STARTS}")));
    }
    if arguments.plane.period().is_some_and(|period| period < scene.run().actual_step()) {
        return Err(CliError::Request(
            "--plane: the period is shorter than a step; choose a shorter --step".to_owned(),
        ));
    }
    let file = arguments.out.as_deref().map(|path| ChartFile::of(path, &shared.scene, shared.force)).transpose()?;
    notes::moves(&scene);
    let built = free(&scene)?;
    Sections { arguments, scene: &scene, method, file }.on(&built.system(), (&built.q, &built.v))
}

struct Sections<'a> {
    arguments: &'a SectionArguments,
    scene: &'a AnyScene,
    method: Method,
    file: Option<ChartFile<'a>>,
}

/// The crossings of one start.
struct PlaneCrossing {
    /// The number of the start.
    start: usize,
    points: Vec<SectionPoint>,
    failure: Option<RunError>,
    /// Which may not be all.
    close: Option<Close>,
    /// Whether a signal ended it early.
    interrupted: bool,
}

/// A crossing.
struct SectionPoint {
    /// The time (s).
    t: f64,
    /// The quantities that tell the state.
    state: Vec<f64>,
    /// The two that are shown.
    shown: [f64; 2],
}

/// The columns of a section: the quantities of the system that tell its state, and the ones shown.
struct Told {
    state: Vec<Column>,
    axes: [Quantity; 2],
}

impl Sections<'_> {
    fn on(self, system: &Built<'_>, (q, v): (&[f64], &[f64])) -> Result<(), CliError> {
        let plane = &self.arguments.plane;
        let asked_for = |flag: &'static str| move |problem: String| CliError::Request(format!("{flag}: {problem}"));
        let surface = plane.on(system).map_err(asked_for("--plane"))?;
        let axis = |name: &str| Coordinate::of(system, name).map_err(asked_for("--axes"));
        let axes = match self.arguments.axes.as_deref() {
            Some([across, up]) => [axis(across)?, axis(up)?],
            _ => {
                let [across, up] = plane.axes(system);
                [axis(&across)?, axis(&up)?]
            }
        };
        if self.scene.depends_on_time() && plane.period().is_none() {
            terminal::say(
                "note",
                &"the scene depends on time, so a point of this section does not determine the motion after it; \
                    --plane t=PERIOD takes all points at the same phase",
            );
        }
        let interrupt = Interrupt::listen();
        let first = asked(system, (q.to_vec(), v.to_vec()), self.arguments.energy)?;
        let sleigh = if let AnyScene::Sleigh(scene) = self.scene { Some(&scene.sleigh) } else { None };
        let starts: Vec<StartPlace> = spread(system, &first, sleigh, self.arguments.starts);
        let schedule = self.scene.schedule();
        let bar = progress::bar("starts", starts.len() as u64);
        let in_state = system.in_state();
        let cross = |i: usize| {
            if interrupt.asked() {
                return None;
            }
            let function = |t: f64, q: &[f64], v: &[f64]| surface.value(system, t, q, v);
            let event = Event::new(plane.text.clone(), function);
            let event =
                if plane.period().is_some() { event } else { event.in_direction(self.arguments.direction.into()) };
            let found = harness::analysis::section(
                &*system.mechanism(),
                &self.method,
                &schedule,
                (&starts[i].0, &starts[i].1),
                &event,
            );
            let point = |crossing: &dla::Crossing| {
                let (t, q, v) = (crossing.t, crossing.state.unwrapped(), crossing.state.v());
                surface.holds(system, t, &q, v).then(|| SectionPoint {
                    t,
                    state: (0..in_state).map(|k| system.value(k, t, &q, v)).collect(),
                    shown: axes.each_ref().map(|axis| axis.shown(system, t, &q, v)),
                })
            };
            bar.inc(1);
            Some(PlaneCrossing {
                start: i,
                points: found.crossings.iter().filter_map(point).collect(),
                failure: found.failure,
                close: found.close,
                interrupted: found.interrupted,
            })
        };
        let crossed = interrupt.attend(|| in_parallel(starts.len(), cross));
        bar.finish_and_clear();
        let done: Vec<PlaneCrossing> = crossed.into_iter().flatten().collect();
        let whole = done.iter().filter(|one| !one.interrupted).count();
        let made = (whole < starts.len()).then(|| {
            let begun = if whole < done.len() { ", those that had begun as far as they came" } else { "" };
            format!("{whole} of {} starts finished{begun}", starts.len())
        });
        let state = system.quantities().iter().take(in_state).map(Quantity::column).collect();
        let told = Told { state, axes: axes.map(|axis| axis.quantity) };
        let written = self.tell(&told, &done, made.as_deref());
        unless_interrupted(made, None, written)
    }
}

impl Sections<'_> {
    /// The provenance of the points.
    fn provenance(&self, axes: &[Quantity; 2]) -> Provenance {
        let SectionArguments { scene: shared, plane, direction, starts, energy, out, .. } = self.arguments;
        let (run, step) = (self.scene.run(), self.scene.schedule().step);
        let axes = axes.each_ref().map(|axis| axis.name.as_str());
        let command = CommandLine::of("section", &shared.scene, &shared.set).run(run, step);
        let command = command.with("--plane", &plane.text).with("--direction", direction.name());
        let command = command.with("--axes", axes.join(",")).with("--starts", starts);
        let command = command.maybe("--energy", energy.map(|energy| format!("{energy:?}")));
        let command = command.maybe("--out", out.as_ref().map(|out| out.display()));
        let notes = json!({
            "method": run.method, "step": step, "duration": run.duration, "plane": plane.text,
            "direction": direction.name(), "axes": axes, "starts": starts,
        });
        Provenance::on((self.scene.title(), self.scene.to_toml().ok()), Some(&command), notes)
    }

    fn tell(&self, told: &Told, crossed: &[PlaneCrossing], interrupted: Option<&str>) -> Result<(), CliError> {
        let shared = &self.arguments.scene;
        let written = self.file.map_or(Ok(()), |file| {
            let row = |i: usize, SectionPoint { t, state, shown }: &SectionPoint| {
                [&[i as f64, *t][..], state, shown].concat()
            };
            let rows: Vec<Vec<f64>> =
                crossed.iter().flat_map(|one| one.points.iter().map(move |point| row(one.start, point))).collect();
            // A column of the state is another than the one that is shown: its angles count the turns.
            let own = |column: Column| match told.state.contains(&column) {
                true => Column { name: format!("shown_{}", column.name), ..column },
                false => column,
            };
            let mut columns = vec![Column::whole("start"), Column::new("t", "s")];
            columns.extend(told.state.iter().cloned());
            columns.extend(told.axes.each_ref().map(Quantity::column).map(own));
            let provenance = self.provenance(&told.axes).interrupted(interrupted);
            file.write(shared.force, &provenance, (&columns, &rows), || self.chart(told, crossed))
        });
        let count: usize = crossed.iter().map(|start| start.points.len()).sum();
        if shared.json {
            terminal::print_json(&self.json(told, crossed))?;
        } else {
            let run = self.scene.run();
            let duration = table::number(run.duration);
            let lines = [
                ("scene", format!("{} ({})", self.scene.title(), self.scene.name())),
                (
                    "run",
                    format!(
                        "{duration} s by {} with steps of {} s, from each start",
                        run.method,
                        table::number(run.actual_step())
                    ),
                ),
                ("plane", format!("{}, {}", self.arguments.plane.text, self.arguments.direction.name())),
                ("starts", crossed.len().to_string()),
                ("crossings", count.to_string()),
            ];
            terminal::print(&table::aligned(&lines.map(|(name, value)| (name.to_owned(), value))))?;
            if let (Some(path), Ok(())) = (&self.arguments.out, &written) {
                terminal::print(&format!("written    {}\n", path.display()))?;
            }
        }
        if let Some(close) = crossed.iter().filter_map(|start| start.close).reduce(Close::and) {
            terminal::say("warning", &format!("{}; a shorter --step samples more times", in_doubt(&close)));
        }
        let failed = crossed
            .iter()
            .filter_map(|one| one.failure.as_ref().map(|failure| format!("start {}: {failure}", one.start)));
        CliError::of_failures(failed).and(written)
    }

    fn json(&self, told: &Told, crossed: &[PlaneCrossing]) -> Value {
        let one = |start: &PlaneCrossing| {
            let points: Vec<Value> = start.points.iter().map(|p| json!([p.t, p.shown[0], p.shown[1]])).collect();
            let mut object = json!({"points": points, "in_doubt": start.close.map_or(0, doubts)});
            if start.interrupted {
                object["interrupted"] = json!(true);
            }
            if let Some(failure) = &start.failure {
                object["failure"] = json!(failure.to_string());
                object["failed_at"] = json::failure(failure);
            }
            object
        };
        json!({
            "scene": self.scene.name(),
            "method": self.method.info().name,
            "step": self.scene.run().actual_step(),
            "duration": self.scene.run().duration,
            "plane": self.arguments.plane.text,
            "direction": self.arguments.direction.name(),
            "axes": told.axes.each_ref().map(|axis| &axis.name),
            "starts": crossed.iter().map(one).collect::<Vec<_>>(),
        })
    }

    fn chart(&self, told: &Told, crossed: &[PlaneCrossing]) -> Chart {
        Chart {
            title: format!("{}: section at {}", self.scene.title(), self.arguments.plane.text),
            axes: told.axes.each_ref().map(Quantity::label),
            decades: [false; 2],
            layers: crossed.iter().map(|start| Layer::Dots(start.points.iter().map(|p| p.shown).collect())).collect(),
        }
    }
}
