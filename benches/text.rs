//! What a system of text costs: as a tape, of a scene read at run time, beside the same text compiled by `system!`.
//!
//! Each row is a bundled scene, its start and its duration. First the time of the compiled system to an error at the end, by the cheapest
//! of the methods; then how many times as long the tape takes for the same steps, or tolerances, by each method: the geometric mean.

#![allow(missing_docs, dead_code, clippy::unwrap_used, clippy::expect_used)]

#[path = "text/systems.rs"]
mod systems;

use harness::precision::{LEVELS, PrecisionPoint};
use noslip::prelude::{Piecewise, System};
use noslip::{PrecisionError, WorkPrecision};
use scene::{AnyScene, Built, Visitor};
use std::array::from_fn;

const METHODS: [&str; 5] = ["gauss-adaptive", "gauss16", "gauss8", "dla", "rk4-reduced"];
/// The longest run of a ladder (s).
const LONGEST: f64 = 0.02;

/// Measures a scene, and tells its start.
struct Tape(f64);

impl Visitor for Tape {
    type Output = (Result<WorkPrecision, PrecisionError>, Vec<f64>, Vec<f64>);

    fn visit<const N: usize, const M: usize>(self, system: Built<'_, N, M>, q: [f64; N], v: [f64; N]) -> Self::Output {
        let measured = noslip::precision(&system, &METHODS, (q, v), self.0, LONGEST);
        (measured, q.to_vec(), v.to_vec())
    }
}

/// The geometric mean of the ratios of times of points that are of the same steps or tolerance.
fn ratio(tape: &[PrecisionPoint], compiled: &[PrecisionPoint]) -> Option<f64> {
    let same = |a: &PrecisionPoint, b: &PrecisionPoint| a.steps == b.steps && a.setting == b.setting;
    let ratios = tape.iter().filter_map(|a| {
        let b = compiled.iter().find(|b| same(a, b))?;
        Some((a.seconds()? / b.seconds()?).ln())
    });
    let ratios: Vec<f64> = ratios.collect();
    (!ratios.is_empty()).then(|| (ratios.iter().sum::<f64>() / ratios.len() as f64).exp())
}

/// Measures a system in both forms, and prints its row.
fn row<Sys: System<N, M> + Piecewise, const N: usize, const M: usize>(name: &str, system: &Sys) {
    let known: Vec<&str> = harness::METHODS.iter().map(|info| info.name).collect();
    let scene = AnyScene::load(name, &known).expect("a bundled scene");
    let duration = scene.run().duration;
    let (tape, q, v) = scene.visit(Tape(duration)).expect("a system");
    // A shape with more coordinates than the system has them first.
    let start = (from_fn(|i| q[i]), from_fn(|i| v[i]));
    let compiled = noslip::precision(system, &METHODS, start, duration, LONGEST);
    let (tape, compiled) = match (tape, compiled) {
        (Ok(tape), Ok(compiled)) => (tape, compiled),
        (Err(error), _) | (_, Err(error)) => return println!("| `{name}` | {error} |"),
    };
    print!("| `{name}` |");
    for cheapest in compiled.cheapest() {
        match cheapest.methods.first() {
            Some((method, seconds)) => print!(" {method} {:.3} |", 1e6 * seconds),
            None => print!(" - |"),
        }
    }
    for (tape, compiled) in tape.curves.iter().zip(&compiled.curves) {
        match ratio(&tape.points, &compiled.points) {
            Some(ratio) => print!(" {ratio:.1} |"),
            None => print!(" - |"),
        }
    }
    println!();
}

fn main() {
    let of = LEVELS.map(|error| format!(" us to {error:e} |")).concat();
    println!("| scene |{of} {} |", METHODS.map(|method| format!("tape / compiled, {method}")).join(" | "));
    println!("|---{}|", "|---".repeat(LEVELS.len() + METHODS.len()));
    row("knife-edge", &systems::KnifeEdge::default());
    row("rolling-disk", &systems::RollingDisk::default());
    row("roller-racer", &systems::RollerRacer::default());
    row("snakeboard", &systems::Snakeboard::default());
    row("chaplygin-ball", &systems::ChaplyginBall::default());
    row("two-wheeled-robot", &systems::Robot::default());
    row("car-and-trailer", &systems::Car::default());
    row("falling-disk", &systems::FallingDisk::default());
}
