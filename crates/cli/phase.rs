use crate::args::PhaseArguments;
use crate::error::CliError;
use crate::file_roles::FileRoles;
use crate::files::{check_file, write_whole};
use crate::{inspect, progress, table, terminal};
use dla::{Mechanism, RunError, Schedule};
use harness::analysis::{Rounds, weighted_mean};
use harness::{Method, Run};
use report::{Chart, Layer, chart_svg};
use scene::{MAX_STEPS, RunSettings, Scene, SceneEffect, Started};
use serde_json::{Value, json};
use sleigh::planimeter::Holonomy;
use sleigh::{ClosedPath, SleighError};
use std::f64::consts::{PI, TAU};

/// Loops for the curvature are smaller by 2, 4, .. 2^6.
const HALVINGS: i32 = 6;
/// Points of the curve of a picture.
const POINTS: u32 = 360;

/// The measurements.
struct MeasuredPhase {
    step: f64,
    turns: Vec<f64>,
    area: f64,
    curvature: Option<f64>,
    exact: Option<Holonomy>,
    heading: f64,
    offset: f64,
}

/// `noslip phase`: what the tracer's loops turn the blade by.
pub(crate) fn phase(arguments: &PhaseArguments) -> Result<(), CliError> {
    let scene = inspect::load(&arguments.scene, arguments.method.as_deref())?;
    let method = inspect::method(&scene.run)?;
    let path = scene.effects.iter().find_map(|effect| match effect {
        SceneEffect::Tracer { path } => Some(path),
        _ => None,
    });
    let Some(path) = path else { return Err(CliError::WithoutTracer { scene: scene.name.clone() }) };
    let period = path.period();
    if let Some(file) = &arguments.picture {
        FileRoles::of(&arguments.scene.scene).writes("--picture", Some(file)).check()?;
        check_file(file, arguments.scene.force)?;
    }
    let loops = arguments.loops.unwrap_or((scene.run.duration / period).floor().max(1.0) as u64);
    let steps = steps_of_a_loop(&scene, period, loops)?;
    let schedule = |loops: u64| Schedule { t0: 0.0, step: period / steps as f64, steps: loops * steps };

    let turned = |scene: &Scene, loops: u64| {
        let Started { system, q, v } = scene.system()?;
        let loops = Loops { method: &method, schedule: schedule(loops), every: steps };
        let turns = loops.on(&*system.mechanism(), (&q, &v));
        turns.map_err(|error| CliError::Computation(vec![format!("{}: {error}", method.info().name)]))
    };
    let turns = turned(&scene, loops)?;
    let moving = scene.effects.iter().any(|effect| matches!(effect, SceneEffect::Turntable { .. }));
    let mut measured = MeasuredPhase {
        step: schedule(1).step,
        turns,
        area: path.area(),
        curvature: None,
        exact: (!moving).then(|| path.holonomy(scene.sleigh.offset())).transpose()?,
        heading: scene.start.heading,
        offset: scene.sleigh.offset(),
    };
    if measured.area != 0.0 && !moving {
        let mut ratios = Vec::new();
        for k in 1..=HALVINGS {
            let size = 0.5_f64.powi(k);
            ratios.push((size, turned(&smaller(&scene, size)?, 1)?[0] / (size * size * measured.area)));
        }
        measured.curvature = Some(-at_zero(&ratios));
    }
    if let Some(file) = &arguments.picture {
        let picture = chart_svg(&circle_map(&scene, &measured));
        write_whole(file, arguments.scene.force, |out| std::io::Write::write_all(out, picture.as_bytes()))?;
    }
    if arguments.scene.json {
        terminal::print_json(&object(&scene, &method, path, &measured))
    } else {
        terminal::print(&text(&scene, &method, &measured))
    }
}

/// The steps of a loop: as many as one period has at the step of the scene, or as its pieces between corners need; refused if all loops
/// together have more steps than any run may have.
fn steps_of_a_loop(scene: &Scene, period: f64, loops: u64) -> Result<u64, CliError> {
    let step = scene.run.actual_step();
    let whole = (period / step).round().max(1.0);
    let most = MAX_STEPS as f64;
    if whole * loops as f64 > most {
        return Err(CliError::Request(format!(
            "--loops: {loops} loops of {whole:e} steps are more than 1e12 steps; accepted: at most {:e} loops, for the step of {step:?} s and the \
             period of {period:?} s",
            (most / whole).floor()
        )));
    }
    let mut one = scene.clone();
    one.run = RunSettings { step: period / whole, duration: period, ..one.run };
    Ok(one.schedule().steps)
}

/// The scene with a path that many times as large.
fn smaller(scene: &Scene, size: f64) -> Result<Scene, SleighError> {
    let mut scene = scene.clone();
    for effect in &mut scene.effects {
        if let SceneEffect::Tracer { path } = effect {
            *path = path.scaled(size)?;
        }
    }
    Ok(scene)
}

/// The value at zero of the polynomial through some points (Neville).
fn at_zero(points: &[(f64, f64)]) -> f64 {
    let mut values: Vec<f64> = points.iter().map(|(_, value)| *value).collect();
    for level in 1..points.len() {
        for k in 0..points.len() - level {
            let (a, b) = (points[k].0, points[k + level].0);
            values[k] = (a * values[k + 1] - b * values[k]) / (a - b);
        }
    }
    values.first().copied().unwrap_or(f64::NAN)
}

/// The turns of the blade, loop by loop.
struct Loops<'a> {
    method: &'a Method,
    schedule: Schedule,
    every: u64,
}

impl Loops<'_> {
    fn on(self, system: &dyn Mechanism, (q, v): (&[f64], &[f64])) -> Result<Vec<f64>, RunError> {
        let Self { method, schedule, every } = self;
        let bar = progress::bar(method.info().name, schedule.steps);
        let mut rounds = Rounds::new(2, every);
        let mut state = system.state(q, v);
        let mut advance = |steps| bar.inc(steps);
        let outcome = Run::of(system, method).observe(&mut rounds).progress(&mut advance).moves(&schedule, &mut state);
        bar.finish_and_clear();
        outcome.map(|_| rounds.each())
    }
}

impl MeasuredPhase {
    fn mean(&self) -> f64 {
        weighted_mean(&self.turns).unwrap_or(f64::NAN)
    }

    fn area_law(&self) -> f64 {
        self.area / (self.offset * self.offset)
    }

    /// The heading before each loop.
    fn headings(&self) -> impl Iterator<Item = f64> {
        let turned =
            self.turns.iter().scan(self.heading, |heading, turn| Some(std::mem::replace(heading, *heading + turn)));
        turned.map(|heading| (heading + PI).rem_euclid(TAU) - PI)
    }
}

fn circle_map(scene: &Scene, measured: &MeasuredPhase) -> Chart {
    let points = measured.headings().zip(&measured.turns).map(|(heading, turn)| vec![[heading, *turn]]).collect();
    let mut layers = Vec::new();
    if let Some(exact) = &measured.exact {
        let curve = (0..=POINTS).map(|k| {
            let heading = TAU * f64::from(k) / f64::from(POINTS) - PI;
            [heading, exact.turn(heading)]
        });
        layers.push(Layer::Curves { label: "exact".to_owned(), curves: vec![curve.collect()] });
    }
    layers.push(Layer::Curves { label: "measured".to_owned(), curves: points });
    Chart {
        title: format!("{}: turn of a loop", scene.title),
        axes: ["heading before the loop [rad]".to_owned(), "turn of the loop [rad]".to_owned()],
        decades: [false; 2],
        layers,
    }
}

fn object(scene: &Scene, method: &Method, path: &ClosedPath, measured: &MeasuredPhase) -> Value {
    let exact = measured.exact.as_ref().map(|exact| {
        json!({
            "turn": exact.turn(measured.heading),
            "mean_turn": exact.mean_turn(),
            "trace": exact.map().trace(),
            "matrix": exact.map().matrix(),
            "fixed_headings": exact.map().fixed_headings(),
        })
    });
    json!({
        "scene": scene.name,
        "method": method.info().name,
        "step": measured.step,
        "period": path.period(),
        "loops": measured.turns.len(),
        "turn": measured.turns.first(),
        "last_turn": measured.turns.last(),
        "mean_turn": measured.mean(),
        "area": measured.area,
        "area_law": measured.area_law(),
        "curvature": measured.curvature,
        "class": measured.exact.as_ref().map(|exact| exact.map().class().name()),
        "exact": exact,
    })
}

fn text(scene: &Scene, method: &Method, measured: &MeasuredPhase) -> String {
    let number = |x: f64| table::number(x);
    let law = measured.area_law();
    let [first, last] = [measured.turns.first(), measured.turns.last()].map(|turn| turn.copied().unwrap_or(f64::NAN));
    let mut lines = vec![
        ("scene", format!("{} ({})", scene.title, scene.name)),
        ("method", format!("{}, steps of {} s", method.info().name, number(measured.step))),
        ("loops", measured.turns.len().to_string()),
        ("turn", format!("{} rad in the first loop, {} rad in the last", number(first), number(last))),
        ("mean turn", format!("{} rad a loop", number(measured.mean()))),
        ("area", format!("{} m^2; area / a^2 = {} rad", number(measured.area), number(law))),
    ];
    if let Some(curvature) = measured.curvature {
        let known = -1.0 / (measured.offset * measured.offset);
        lines.push(("curvature", format!("{} 1/m^2 in the limit; -1/a^2 = {}", number(curvature), number(known))));
    }
    if let Some(exact) = &measured.exact {
        let map = exact.map();
        let (turn, mean) = (exact.turn(measured.heading), exact.mean_turn());
        lines.push(("exact", format!("{} rad in the first loop, {} rad in the mean", number(turn), number(mean))));
        lines.push(("map", format!("{}, |trace| = {}", map.class().name(), number(map.trace()))));
        let fixed = map.fixed_headings();
        if let Some(first) = fixed.first() {
            let what = if fixed.len() == 1 { "that stays" } else { "that attracts all others" };
            lines.push(("heading", format!("{} rad {what}", number(*first))));
        }
    }
    table::aligned(&lines)
}
