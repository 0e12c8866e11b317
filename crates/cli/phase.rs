use crate::args::PhaseArguments;
use crate::chart_file::{check_picture, write_picture};
use crate::error::CliError;
use crate::{inspect, progress, table, terminal};
use dla::Schedule;
use harness::analysis::{Rounds, weighted_mean};
use harness::{Method, Run};
use report::{Chart, Layer};
use scene::{MAX_STEPS, RunSettings, Scene, SceneEffect, Started};
use serde_json::{Value, json};
use sleigh::planimeter::Holonomy;
use sleigh::{ClosedPath, SleighError};
use std::f64::consts::{PI, TAU};

/// Loops for the curvature are smaller by 2, 4, .. 2^6.
const HALVINGS: i32 = 6;
/// Points of the curve of a picture.
const POINTS: u32 = 360;

/// `noslip phase`: what the tracer's loops turn the blade by.
pub(crate) fn phase(arguments: &PhaseArguments) -> Result<(), CliError> {
    let (shared, picture) = (&arguments.scene, arguments.picture.as_deref());
    let run = shared.run(arguments.method.as_deref(), shared.duration);
    let scene = Scene::load_with(&shared.scene, &shared.set.set, &run, &inspect::method_names())?;
    let method = inspect::method(&scene.run)?;
    let path = scene.effects.iter().find_map(|effect| match effect {
        SceneEffect::Tracer { path } => Some(path),
        _ => None,
    });
    let Some(path) = path else { return Err(CliError::WithoutTracer { scene: scene.name.clone() }) };
    check_picture(picture, shared)?;
    let loops = arguments.loops.unwrap_or((scene.run.duration / path.period()).floor().max(1.0) as u64);
    let measured = MeasuredPhase::of(&scene, path, &method, loops)?;
    write_picture(picture, shared, || measured.circle_map(&scene))?;
    if shared.json { terminal::print_json(&measured.object(&scene)) } else { terminal::print(&measured.text(&scene)) }
}

/// The measurements.
struct MeasuredPhase {
    method: &'static str,
    step: f64,
    period: f64,
    turns: Vec<f64>,
    area: f64,
    curvature: Option<f64>,
    exact: Option<Holonomy>,
    heading: f64,
    offset: f64,
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

/// The turns of the blade, loop by loop, over `loops` loops of `steps` steps in `period` (s).
fn turns(scene: &Scene, method: &Method, [loops, steps]: [u64; 2], period: f64) -> Result<Vec<f64>, CliError> {
    let Started { system, q, v } = scene.system()?;
    let (mechanism, name) = (system.mechanism(), method.info().name);
    let schedule = Schedule { t0: 0.0, step: period / steps as f64, steps: loops * steps };
    let bar = progress::bar(name, schedule.steps);
    let mut rounds = Rounds::new(2, steps);
    let mut advance = |steps| bar.inc(steps);
    let mut state = mechanism.state(&q, &v);
    let outcome = Run::of(&*mechanism, method).observe(&mut rounds).progress(&mut advance).moves(&schedule, &mut state);
    bar.finish_and_clear();
    outcome.map(|_| rounds.each()).map_err(|error| CliError::Computation(vec![format!("{name}: {error}")]))
}

impl MeasuredPhase {
    /// Measures the turns of the scene's loops along `path`.
    fn of(scene: &Scene, path: &ClosedPath, method: &Method, loops: u64) -> Result<Self, CliError> {
        let period = path.period();
        let steps = steps_of_a_loop(scene, period, loops)?;
        let turned = |scene: &Scene, loops: u64| turns(scene, method, [loops, steps], period);
        let turns = turned(scene, loops)?;
        let (area, offset) = (path.area(), scene.sleigh.offset());
        let moving = scene.effects.iter().any(|effect| matches!(effect, SceneEffect::Turntable { .. }));
        let exact = (!moving).then(|| path.holonomy(offset)).transpose()?;
        let mut curvature = None;
        if area != 0.0 && !moving {
            let mut ratios = Vec::new();
            for k in 1..=HALVINGS {
                let size = 0.5_f64.powi(k);
                ratios.push((size, turned(&smaller(scene, size)?, 1)?[0] / (size * size * area)));
            }
            curvature = Some(-at_zero(&ratios));
        }
        let step = period / steps as f64;
        let (method, heading) = (method.info().name, scene.start.heading);
        Ok(Self { method, step, period, turns, area, curvature, exact, heading, offset })
    }

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

    fn circle_map(&self, scene: &Scene) -> Chart {
        let points = self.headings().zip(&self.turns).map(|(heading, turn)| vec![[heading, *turn]]).collect();
        let mut layers = Vec::new();
        if let Some(exact) = &self.exact {
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

    fn object(&self, scene: &Scene) -> Value {
        let exact = self.exact.as_ref().map(|exact| {
            json!({
                "turn": exact.turn(self.heading),
                "mean_turn": exact.mean_turn(),
                "trace": exact.map().trace(),
                "matrix": exact.map().matrix(),
                "fixed_headings": exact.map().fixed_headings(),
            })
        });
        json!({
            "scene": scene.name,
            "method": self.method,
            "step": self.step,
            "period": self.period,
            "loops": self.turns.len(),
            "turn": self.turns.first(),
            "last_turn": self.turns.last(),
            "mean_turn": self.mean(),
            "area": self.area,
            "area_law": self.area_law(),
            "curvature": self.curvature,
            "class": self.exact.as_ref().map(|exact| exact.map().class().name()),
            "exact": exact,
        })
    }

    fn text(&self, scene: &Scene) -> String {
        let law = self.area_law();
        let [first, last] = [self.turns.first(), self.turns.last()].map(|turn| turn.copied().unwrap_or(f64::NAN));
        let mut lines = vec![
            ("scene", format!("{} ({})", scene.title, scene.name)),
            ("method", format!("{}, steps of {} s", self.method, table::number(self.step))),
            ("loops", self.turns.len().to_string()),
            (
                "turn",
                format!("{} rad in the first loop, {} rad in the last", table::number(first), table::number(last)),
            ),
            ("mean turn", format!("{} rad a loop", table::number(self.mean()))),
            ("area", format!("{} m^2; area / a^2 = {} rad", table::number(self.area), table::number(law))),
        ];
        if let Some(curvature) = self.curvature {
            let known = -1.0 / (self.offset * self.offset);
            lines.push((
                "curvature",
                format!("{} 1/m^2 in the limit; -1/a^2 = {}", table::number(curvature), table::number(known)),
            ));
        }
        if let Some(exact) = &self.exact {
            let map = exact.map();
            let (turn, mean) = (exact.turn(self.heading), exact.mean_turn());
            lines.push((
                "exact",
                format!("{} rad in the first loop, {} rad in the mean", table::number(turn), table::number(mean)),
            ));
            lines.push(("map", format!("{}, |trace| = {}", map.class().name(), table::number(map.trace()))));
            let fixed = map.fixed_headings();
            if let Some(first) = fixed.first() {
                let what = if fixed.len() == 1 { "that stays" } else { "that attracts all others" };
                lines.push(("heading", format!("{} rad {what}", table::number(*first))));
            }
        }
        table::aligned(&lines)
    }
}
