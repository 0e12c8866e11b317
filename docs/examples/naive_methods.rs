//! Naive methods fail: explicit Euler and Runge-Kutta, with and without projection, beside the discrete principle.
//!
//! `cargo run --example naive_methods [FOLDER]`; the folder receives a report with the pictures.

use harness::report::{self, Report, SceneReport, Series};
use harness::{Rk4, Rk4Projected};
use noslip::dla::{Composition, onto_constraint};
use noslip::sleigh::effects::Bowl;
use noslip::{
    Dla, OneStep, RunError, Schedule, Sleigh, SleighState, State, StepError, StepReport, System, Trajectory, With,
    drive,
};
use std::path::Path;

/// Explicit Euler on the equations of motion with the multiplier eliminated: no method of the library, but a [`OneStep`].
struct Euler;

impl<Sys: System<N, M>, const N: usize, const M: usize> OneStep<Sys, N, M> for Euler {
    fn step(&mut self, system: &Sys, t: f64, h: f64, state: &mut State<N>) -> Result<StepReport<M>, StepError> {
        let motion = system.motion(t, state.q(), state.v()).map_err(StepError::Motion)?;
        let (q, v) = (state.v().map(|v| h * v), *state.v());
        state.advance(&q, std::array::from_fn(|i| v[i] + h * motion.acceleration[i]), None);
        Ok(StepReport::of(0))
    }
}

/// The same, with the velocity projected onto the constraint after every step, orthogonally in the kinetic energy.
struct EulerProjected;

impl<Sys: System<N, M>, const N: usize, const M: usize> OneStep<Sys, N, M> for EulerProjected {
    fn step(&mut self, system: &Sys, t: f64, h: f64, state: &mut State<N>) -> Result<StepReport<M>, StepError> {
        let report = Euler.step(system, t, h, state)?;
        onto_constraint(system, t + h, state)?;
        Ok(report)
    }
}

type Basin = With<Sleigh, Bowl>;

/// 300 s in steps of 0.1 s, from the start of the bundled scene `bowl`.
fn series<M: OneStep<Basin, 3, 1>>(basin: &Basin, label: &str, mut method: M) -> Result<Series, RunError> {
    let (q, v) = SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }.to_coordinates();
    let mut state = State::new(q, v, basin.angles());
    let mut trajectory = Trajectory::<3, 1>::every(1);
    drive(basin, &mut method, &Schedule { t0: 0.0, step: 0.1, steps: 3000 }, &mut state, &mut trajectory)?;
    let nodes = trajectory.nodes();
    Ok(Series {
        label: label.to_owned(),
        path: nodes.iter().map(|node| [node.q[0], node.q[1]]).collect(),
        heading: nodes.iter().map(|node| node.q[2]).collect(),
        time: nodes.iter().map(|node| node.t).collect(),
        constraint: nodes.iter().map(|node| node.constraint).collect(),
        energy_error: nodes.iter().map(|node| (node.energy - nodes[0].energy).abs()).collect(),
        ..Series::default()
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let basin = With { body: Sleigh::new(1.0, 1.0, 0.5)?, effects: Bowl::new([0.1, 0.1], [0.0, 0.0])? };
    let all = vec![
        series(&basin, "euler", Euler)?,
        series(&basin, "euler-projected", EulerProjected)?,
        series(&basin, "rk4", Rk4)?,
        series(&basin, "rk4-projected", Rk4Projected)?,
        series(&basin, "dla", Dla::midpoint())?,
        series(&basin, "dla4", Composition::suzuki4(Dla::midpoint()))?,
    ];
    let columns = ["method", "constraint [m/s]", "energy, first half [J]", "second half [J]"];
    println!("{:<16} {:>18} {:>24} {:>17}", columns[0], columns[1], columns[2], columns[3]);
    let mut rows = Vec::new();
    for run in &all {
        let largest = |values: &[f64]| values.iter().fold(0.0f64, |a, b| a.max(*b));
        let (early, late) = run.energy_error.split_at(run.energy_error.len() / 2);
        let numbers = [largest(&run.constraint), largest(early), largest(late)].map(|x| format!("{x:.1e}"));
        println!("{:<16} {:>18} {:>24} {:>17}", run.label, numbers[0], numbers[1], numbers[2]);
        rows.push([&[run.label.clone()], &numbers[..]].concat());
    }

    if let Some(folder) = std::env::args().nth(1) {
        let scene = SceneReport {
            name: "naive".to_owned(),
            title: "Naive methods beside the discrete principle".to_owned(),
            columns: columns.map(str::to_owned).to_vec(),
            rows,
            series: all,
            ..SceneReport::default()
        };
        let report = Report { title: scene.title.clone(), intro: String::new(), scenes: vec![scene] };
        report::write(&report, Path::new(&folder), false)?;
        println!("written: {folder}");
    }
    Ok(())
}
