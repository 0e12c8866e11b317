use crate::analysis::{Analysis, AnalysisResult, with_wanted_energy};
use crate::args::SectionArguments;
use crate::coordinate::Coordinate;
use crate::error::CliError;
use crate::interrupt::Interrupt;
use crate::starts::spread;
use crate::trigger::{doubts, in_doubt};
use crate::{json, progress, terminal};
use dla::{Close, Event, RunError};
use report::{Chart, Layer};
use scene::{AnyScene, Built, Column, Quantity, StartPlace};
use serde_json::{Value, json};

/// Default duration of each motion (s).
const DURATION: f64 = 2000.0;
/// The most starts.
const MOST_STARTS: u64 = 100_000;

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

/// `noslip section`: the crossings of a plane by motions.
pub(crate) fn section(arguments: &SectionArguments) -> Result<(), CliError> {
    let mut analysis = Analysis::open("section", &arguments.scene, &arguments.method, DURATION)?;
    let refused = |problem: &str| Err(CliError::Request(problem.to_owned()));
    if arguments.axes.as_ref().is_some_and(|axes| axes.len() != 2 || axes[0].trim() == axes[1].trim()) {
        return refused("--axes: accepted are two different quantities, for example heading,speed");
    }
    if arguments.starts > MOST_STARTS {
        return refused(&format!("--starts: accepted is a whole number from 1 to {MOST_STARTS}"));
    }
    if arguments.plane.period().is_some_and(|period| period < analysis.scene.run().actual_step()) {
        return refused("--plane: the period is shorter than a step; choose a shorter --step");
    }
    let built = analysis.begin(arguments.out.as_deref())?;
    let (system, plane) = (&built.system(), &arguments.plane);
    let wrong = |flag: &'static str| move |problem: String| CliError::Request(format!("{flag}: {problem}"));
    let surface = plane.on(system).map_err(wrong("--plane"))?;
    let axis = |name: &str| Coordinate::of(system, name).map_err(wrong("--axes"));
    let axes = match arguments.axes.as_deref() {
        Some([across, up]) => [axis(across)?, axis(up)?],
        _ => {
            let [across, up] = plane.axes(system);
            [axis(&across)?, axis(&up)?]
        }
    };
    if analysis.scene.depends_on_time() && plane.period().is_none() {
        terminal::say(
            "note",
            &"the scene depends on time, so a point of this section does not determine the motion after it; \
                --plane t=PERIOD takes all points at the same phase",
        );
    }
    let interrupt = Interrupt::listen();
    let first = with_wanted_energy(system, (built.q.clone(), built.v.clone()), arguments.energy)?;
    let sleigh = if let AnyScene::Sleigh(scene) = &analysis.scene { Some(&scene.sleigh) } else { None };
    let starts: Vec<StartPlace> = spread(system, &first, sleigh, arguments.starts);
    let (schedule, in_state) = (analysis.scene.schedule(), system.in_state());
    let cross = |start: usize| {
        let event = Event::new(plane.text.clone(), |t, q: &[f64], v: &[f64]| surface.value(system, t, q, v));
        let event = if plane.period().is_some() { event } else { event.in_direction(arguments.direction.into()) };
        let (q, v) = &starts[start];
        let found = harness::analysis::section(&*system.mechanism(), &analysis.method, &schedule, (q, v), &event);
        let point = |crossing: &dla::Crossing| {
            let (t, q, v) = (crossing.t, crossing.state.unwrapped(), crossing.state.v());
            surface.holds(system, t, &q, v).then(|| SectionPoint {
                t,
                state: (0..in_state).map(|k| system.value(k, t, &q, v)).collect(),
                shown: axes.each_ref().map(|axis| axis.shown(system, t, &q, v)),
            })
        };
        PlaneCrossing {
            start,
            points: found.crossings.iter().filter_map(point).collect(),
            failure: found.failure,
            close: found.close,
            interrupted: found.interrupted,
        }
    };
    let crossed = interrupt.attend(|| progress::in_parallel("starts", starts.len(), &interrupt, cross));
    let crossed: Vec<PlaneCrossing> = crossed.into_iter().flatten().collect();
    tell(arguments, &analysis, system, &axes.map(|axis| axis.quantity), (&crossed, starts.len()))
}

/// Shows the crossings; `starts` counts the starts that were asked for.
fn tell(
    arguments: &SectionArguments,
    analysis: &Analysis<'_>,
    system: &Built<'_>,
    axes: &[Quantity; 2],
    (crossed, starts): (&[PlaneCrossing], usize),
) -> Result<(), CliError> {
    let (plane, direction) = (&arguments.plane.text, arguments.direction.name());
    let names = axes.each_ref().map(|axis| axis.name.as_str());
    let whole = crossed.iter().filter(|one| !one.interrupted).count();
    let begun = if whole < crossed.len() { ", those that had begun as far as they came" } else { "" };

    let state: Vec<Column> = system.quantities().iter().take(system.in_state()).map(Quantity::column).collect();
    // A column of the state is another than the one that is shown: its angles count the turns.
    let own = |column: Column| match state.contains(&column) {
        true => Column { name: format!("shown_{}", column.name), ..column },
        false => column,
    };
    let shown = axes.each_ref().map(Quantity::column).map(own);
    let row = |start: usize, SectionPoint { t, state, shown }: &SectionPoint| {
        [&[start as f64, *t][..], state, shown].concat()
    };

    let command = analysis.again().with("--plane", plane).with("--direction", direction);
    let command = command.with("--axes", names.join(",")).with("--starts", arguments.starts);
    let duration = analysis.scene.run().duration;
    let mut lines = analysis.lines(duration, ", from each start");
    let count: usize = crossed.iter().map(|start| start.points.len()).sum();
    lines.push(("plane".to_owned(), format!("{plane}, {direction}")));
    lines.extend([("starts", crossed.len()), ("crossings", count)].map(|(name, k)| (name.to_owned(), k.to_string())));
    if count == 0 {
        let hint = "no motion crosses the plane so: try another value, --direction or --duration";
        lines.push((String::new(), hint.to_owned()));
    }
    let close = crossed.iter().filter_map(|start| start.close).reduce(Close::and);
    let failed = |one: &PlaneCrossing| Some(format!("start {}: {}", one.start, one.failure.as_ref()?));
    analysis.tell(AnalysisResult {
        columns: [&[Column::whole("start"), Column::new("t", "s")][..], &state, &shown].concat(),
        rows: &|| crossed.iter().flat_map(|one| one.points.iter().map(move |point| row(one.start, point))).collect(),
        chart: &|| Chart {
            title: format!("{}: section at {plane}", analysis.scene.title()),
            axes: axes.each_ref().map(Quantity::label),
            decades: [false; 2],
            layers: crossed.iter().map(|start| Layer::Dots(start.points.iter().map(|p| p.shown).collect())).collect(),
        },
        object: &|| {
            let starts: Vec<Value> = crossed.iter().map(object).collect();
            let more = json!({"plane": plane, "direction": direction, "axes": names, "starts": starts});
            analysis.object(duration, more)
        },
        lines,
        again: command.maybe_number("--energy", arguments.energy),
        notes: json!({"plane": plane, "direction": direction, "axes": names, "starts": arguments.starts}),
        warning: close.map(|close| format!("{}; a shorter --step samples more times", in_doubt(&close))),
        failures: crossed.iter().filter_map(failed).collect(),
        interrupted: (whole < starts).then(|| format!("{whole} of {starts} starts finished{begun}")),
    })
}

/// The crossings of a start for a program.
fn object(start: &PlaneCrossing) -> Value {
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
}
