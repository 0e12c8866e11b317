use crate::args::SectionArguments;
use crate::chart_file::ChartFile;
use crate::compare::unless_interrupted;
use crate::coordinate::Coordinate;
use crate::error::CliError;
use crate::interrupt::Interrupt;
use crate::lyapunov::{asked, imposed};
use crate::starts::{Start, place, spread};
use crate::trigger::in_doubt;
use crate::{inspect, progress, table, terminal};
use dla::{Close, Event};
use harness::Method;
use harness::analysis::in_parallel;
use harness::report::{Chart, Layer};
use scene::{Scene, SceneSystem, Visitor};
use serde_json::{Value, json};

/// How long each motion is followed where nobody says (s).
const DURATION: f64 = 2000.0;
/// The most starts, and the most crossings of all of them.
const MOST_STARTS: u64 = 100_000;

/// `noslip section`: where motions cross a plane.
pub(crate) fn section(arguments: &SectionArguments) -> Result<(), CliError> {
    let shared = &arguments.scene;
    let duration = shared.duration.or(Some(DURATION));
    let scene =
        inspect::load_with((&shared.scene, &shared.set), Some(&arguments.method), shared.step, duration, shared.alpha)?;
    let method = Method::named(&scene.run.method, scene.run.alpha)?;
    let axes = match &arguments.axes {
        Some(axes) => match axes[..] {
            [across, up] if across.name != up.name => [across, up],
            _ => {
                return Err(CliError::Request(
                    "--axes: accepted are two different quantities, as in heading,speed".to_owned(),
                ));
            }
        },
        None => {
            let named = arguments.plane.axes().map(str::parse);
            let [Ok(across), Ok(up)] = named else { return Err(CliError::Request("--axes: which?".to_owned())) };
            [across, up]
        }
    };
    if arguments.starts > MOST_STARTS {
        return Err(CliError::Request(format!("--starts: accepted are from 1 to {MOST_STARTS}")));
    }
    if arguments.plane.period().is_some_and(|period| period < scene.run.actual_step()) {
        return Err(CliError::Request(
            "--plane: the period is shorter than a step; --step makes that shorter".to_owned(),
        ));
    }
    let file = arguments.out.as_deref().map(|path| ChartFile::of(path, shared.force)).transpose()?;
    scene.visit_free(Sections { arguments, scene: &scene, method, axes, file })?.ok_or_else(imposed)?
}

struct Sections<'a> {
    arguments: &'a SectionArguments,
    scene: &'a Scene,
    method: Method,
    axes: [Coordinate; 2],
    file: Option<ChartFile<'a>>,
}

/// The crossings of one start.
struct Crossed {
    /// The number of the start.
    start: usize,
    /// Time (s), `x`, `y`, heading, speed, turn rate, and the two quantities shown.
    points: Vec<[f64; 8]>,
    failure: Option<String>,
    /// Which may not be all.
    close: Option<Close>,
}

impl Visitor for Sections<'_> {
    type Output = Result<(), CliError>;

    fn visit<const N: usize, const M: usize>(
        self,
        system: &dyn SceneSystem<N, M>,
        q: [f64; N],
        v: [f64; N],
    ) -> Self::Output {
        if self.scene.depends_on_time() && self.arguments.plane.period().is_none() {
            terminal::say(
                "note",
                &"the scene depends on time, and so does where a motion goes from a point of this section; --plane t=PERIOD takes \
                  all points at the same phase",
            );
        }
        let first = asked(system, (q, v), self.arguments.energy)?;
        let starts: Vec<Start<N>> = spread(system, &first, &self.scene.sleigh, self.arguments.starts);
        let schedule = inspect::schedule(self.scene);
        let interrupt = Interrupt::of_starts();
        let bar = progress::bar("starts", starts.len() as u64);
        let plane = &self.arguments.plane;
        let crossed = in_parallel(starts.len(), |i| {
            if interrupt.asked() {
                return None;
            }
            let at = |state: &dla::State<N>| place(system, &state.unwrapped(), state.v());
            let surface = Event::new(plane.text.clone(), |t, state| plane.value(t, &at(state)));
            let surface =
                if plane.period().is_some() { surface } else { surface.in_direction(self.arguments.direction.into()) };
            let found = harness::analysis::section(&system, &self.method, &schedule, starts[i], &surface);
            let shown = |crossing: &dla::Crossing<N>| {
                let place = at(&crossing.state);
                let state = place.state;
                let [a, b] = self.axes.map(|axis| axis.at(&place));
                plane.holds(&place).then_some([
                    crossing.t,
                    state.x,
                    state.y,
                    state.heading,
                    state.speed,
                    state.turn_rate,
                    a,
                    b,
                ])
            };
            bar.inc(1);
            Some(Crossed {
                start: i,
                points: found.crossings.iter().filter_map(shown).collect(),
                failure: found.failure.map(|failure| failure.to_string()),
                close: found.close,
            })
        });
        bar.finish_and_clear();
        let done: Vec<Crossed> = crossed.into_iter().flatten().collect();
        let made = (done.len() < starts.len()).then(|| format!("{} of {} starts are done", done.len(), starts.len()));
        unless_interrupted(made, None, self.tell(&done))
    }
}

impl Sections<'_> {
    fn tell(&self, crossed: &[Crossed]) -> Result<(), CliError> {
        let shared = &self.arguments.scene;
        let written = self.file.map_or(Ok(()), |file| {
            let row = |i: usize, point: &[f64; 8]| [&[i as f64][..], &point[..6], &point[6..]].concat();
            let rows: Vec<Vec<f64>> =
                crossed.iter().flat_map(|one| one.points.iter().map(move |point| row(one.start, point))).collect();
            let state = "x [m],y [m],heading [rad],speed [m/s],turn_rate [rad/s]";
            // A column of the state is another than the one that is shown: its heading counts the turns.
            let taken = |label: &str| state.split(',').any(|other| other == label);
            let [a, b] = self
                .axes
                .map(|axis| axis.label())
                .map(|label| if taken(&label) { format!("shown_{label}") } else { label });
            let header = format!("start,t [s],{state},{a},{b}");
            file.write(shared.force, &header, &rows, || self.chart(crossed))
        });
        let count: usize = crossed.iter().map(|start| start.points.len()).sum();
        if shared.json {
            terminal::print_json(&self.json(crossed))?;
        } else {
            let run = &self.scene.run;
            let duration = table::number(run.duration);
            let lines = [
                ("scene", format!("{} ({})", self.scene.title, self.scene.name)),
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
        let all =
            |all: Close, one: Close| Close { count: all.count + one.count, spacing: all.spacing.max(one.spacing) };
        if let Some(close) = crossed.iter().filter_map(|start| start.close).reduce(all) {
            terminal::say("warning", &format!("{}; a shorter --step looks at more places", in_doubt(&close)));
        }
        let failed = crossed
            .iter()
            .filter_map(|one| one.failure.as_ref().map(|failure| format!("start {}: {failure}", one.start)));
        CliError::of_failures(failed).and(written)
    }

    fn json(&self, crossed: &[Crossed]) -> Value {
        let one = |start: &Crossed| {
            let points: Vec<Value> = start.points.iter().map(|p| json!([p[0], p[6], p[7]])).collect();
            let mut object = json!({"points": points, "in_doubt": start.close.map_or(0, |close| close.count)});
            if let Some(failure) = &start.failure {
                object["failure"] = json!(failure);
            }
            object
        };
        json!({
            "scene": self.scene.name,
            "method": self.method.info().name,
            "step": self.scene.run.actual_step(),
            "duration": self.scene.run.duration,
            "plane": self.arguments.plane.text,
            "direction": self.arguments.direction.name(),
            "axes": self.axes.map(|axis| axis.name),
            "starts": crossed.iter().map(one).collect::<Vec<_>>(),
        })
    }

    fn chart(&self, crossed: &[Crossed]) -> Chart {
        Chart {
            title: format!("{}: section at {}", self.scene.title, self.arguments.plane.text),
            axes: self.axes.map(|axis| axis.label()),
            decades: [false; 2],
            layers: crossed
                .iter()
                .map(|start| Layer::Dots(start.points.iter().map(|p| [p[6], p[7]]).collect()))
                .collect(),
        }
    }
}
