//! Naive methods fail: explicit Euler and Runge-Kutta, with and without projection, beside the discrete principle.
//!
//! `cargo run --example naive_methods [FOLDER]`; the folder receives a report with the pictures.

use noslip::dla::{Composition, Rk4, Rk4Projected, onto_constraint};
use noslip::sleigh::effects::Bowl;
use noslip::{
    Dla, OneStep, Schedule, Sleigh, SleighError, SleighState, State, StepError, StepReport, System, Trajectory, With,
    drive,
};
use report::{Report, SceneReport, Series};
use std::path::Path;

/// Explicit Euler on the equations of motion with the multiplier eliminated: no method of the library, but a [`OneStep`].
struct Euler;

impl<const N: usize, const M: usize> OneStep<N, M> for Euler {
    fn step(
        &mut self,
        system: &dyn noslip::Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        let motion = system.motion(t, state.q(), state.v()).map_err(StepError::Motion)?;
        let (q, v) = (state.v().map(|v| h * v), std::array::from_fn(|i| state.v()[i] + h * motion.acceleration[i]));
        if !v.iter().all(|v: &f64| v.is_finite()) {
            return Err(StepError::NotFinite);
        }
        state.advance(&q, v, None);
        Ok(StepReport::of(0))
    }
}

/// The same, with the velocity projected onto the constraint after every step, orthogonally in the kinetic energy.
struct EulerProjected;

impl<const N: usize, const M: usize> OneStep<N, M> for EulerProjected {
    fn step(
        &mut self,
        system: &dyn noslip::Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        let report = Euler.step(system, t, h, state)?;
        onto_constraint(system, t + h, state)?;
        Ok(report)
    }
}

type Basin = With<Sleigh, Bowl>;

/// Seconds of a run, and of a step.
const DURATION: f64 = 3000.0;
const STEP: f64 = 0.1;

/// A run whose energy is off by so much (J) is lost.
const LOST: f64 = 1e3;

/// A run in a bowl, until it is lost.
fn series<M: OneStep<3, 1>>(basin: &Basin, start: &SleighState, label: &str, mut method: M) -> Series {
    let (q, v) = start.to_coordinates();
    let mut state = State::new(q, v, basin.angles());
    let mut trajectory = Trajectory::every(1);
    let schedule = Schedule { t0: 0.0, step: STEP, steps: (DURATION / STEP) as u64 };
    // A run that fails is lost too: its last nodes are infinite in all but name.
    let _ended = drive(basin, &mut method, &schedule, &mut state, &mut trajectory);
    let first = trajectory.nodes()[0].energy;
    let nodes: Vec<_> = trajectory.nodes().iter().take_while(|node| (node.energy - first).abs() < LOST).collect();
    Series {
        label: label.to_owned(),
        path: nodes.iter().map(|node| [node.q[0], node.q[1]]).collect(),
        heading: nodes.iter().map(|node| node.q[2]).collect(),
        time: nodes.iter().map(|node| node.t).collect(),
        constraint: nodes.iter().map(|node| node.constraint).collect(),
        energy_error: nodes.iter().map(|node| (node.energy - first).abs()).collect(),
        ..Series::default()
    }
}

/// The largest of the values up to a time (s).
fn largest(run: &Series, values: &[f64], end: f64) -> String {
    if run.time.last().is_none_or(|last| *last < end - STEP) {
        return "lost".to_owned();
    }
    let before = run.time.iter().zip(values).filter(|(time, _)| **time <= end);
    format!("{:.1e}", before.fold(0.0f64, |most, (_, value)| most.max(*value)))
}

const COLUMNS: [&str; 7] = ["method", "slip to 30 s", "300 s", "3000 s [m/s]", "energy to 30 s", "300 s", "3000 s [J]"];

fn scene(name: &str, offset: f64, start: &SleighState) -> Result<SceneReport, SleighError> {
    let basin = With { body: Sleigh::new(1.0, 1.0, offset)?, effects: Bowl::new([0.1, 0.1], [0.0, 0.0])? };
    println!("\n{name}: a = {offset} m, u = {} m/s, w = {} rad/s", start.speed, start.turn_rate);
    let series = vec![
        series(&basin, start, "euler", Euler),
        series(&basin, start, "euler-projected", EulerProjected),
        series(&basin, start, "rk4", Rk4),
        series(&basin, start, "rk4-projected", Rk4Projected),
        series(&basin, start, "dla", Dla::midpoint()),
        series(&basin, start, "dla4", Composition::suzuki4(Dla::midpoint())),
    ];
    let ends = [30.0, 300.0, DURATION];
    let rows: Vec<Vec<String>> = series
        .iter()
        .map(|run| {
            let slip = ends.map(|end| largest(run, &run.constraint, end));
            let energy = ends.map(|end| largest(run, &run.energy_error, end));
            std::iter::once(run.label.clone()).chain(slip).chain(energy).collect()
        })
        .collect();
    for row in [&COLUMNS.map(str::to_owned).to_vec()].into_iter().chain(&rows) {
        print!("{:<16}", row[0]);
        row[1..].iter().zip([13, 9, 14, 16, 9, 12]).for_each(|(cell, width)| print!("{cell:>width$}"));
        println!();
    }
    Ok(SceneReport {
        name: format!("naive-{name}"),
        title: format!("A {name} sleigh in a bowl"),
        columns: COLUMNS.map(str::to_owned).to_vec(),
        rows,
        series,
        ..SceneReport::default()
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scenes = vec![
        scene("balanced", 0.0, &SleighState { speed: 1.0, turn_rate: 0.7, ..SleighState::default() })?,
        scene("unbalanced", 0.5, &SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() })?,
    ];
    if let Some(folder) = std::env::args().nth(1) {
        let title = "Naive methods beside the discrete principle".to_owned();
        std::fs::create_dir(&folder)?;
        report::write(&Report { title, scenes, ..Report::default() }, Path::new(&folder))?;
        println!("written: {folder}");
    }
    Ok(())
}
