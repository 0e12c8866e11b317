//! What a system of text costs: as a tape, of a scene read at run time, beside the same text compiled by `system!`.
//!
//! Each row is a bundled scene, its start and its duration. First the time of the compiled system to an error at the end, by the cheapest
//! of the methods; then how many times as long the tape takes for the same steps, or tolerances, by each method: the geometric mean.
//!
//! `--points SCENE DURATION METHODS` prints the points of the compiled system of one scene instead, for the race with other programs.

#![allow(missing_docs, dead_code, clippy::unwrap_used, clippy::expect_used)]

#[path = "text/systems.rs"]
mod systems;

use dla::{Mechanism, PiecewiseMechanics};
use harness::Method;
use harness::precision::{Bench, LEVELS, LadderLimits, PrecisionPoint, Reference, ReferenceMotion, work_precision};
use lagrangian::linear::larger;
use noslip::{PrecisionError, WorkPrecision};
use scene::{AnyScene, BuiltScene};
use std::ffi::OsStr;
use std::path::Path;

const METHODS: [&str; 5] = ["gauss-adaptive", "gauss16", "gauss8", "dla", "rk4-reduced"];
/// The longest run of a ladder (s).
const LONGEST: f64 = 0.02;

/// Measures a system from a start.
fn measured(
    system: &dyn Mechanism,
    methods: &[&str],
    (q, v): (&[f64], &[f64]),
    duration: f64,
) -> Result<WorkPrecision, PrecisionError> {
    let methods = methods.iter().map(|name| Method::named(name, None)).collect::<Result<Vec<_>, _>>()?;
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |most, (a, b)| larger(most, (a - b).abs()));
    let motion = ReferenceMotion::new(system, q, v, duration);
    let reference = Reference::converged(&motion, &apart)?;
    let end_error = |method: &Method, steps: u64| motion.end(method, steps).map(|q| apart(&q, &reference.q));
    let aligned = |steps: u64| motion.aligned(steps);
    let bench = Bench { duration, reference_error: reference.error, end_error: &end_error, aligned: &aligned };
    let limits = LadderLimits { fewest: motion.aligned(2), longest: LONGEST };
    let (curves, _) = work_precision(&bench, &methods, &limits, &mut ());
    Ok(WorkPrecision { curves, reference_error: reference.error })
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
fn row<const N: usize, const M: usize>(name: &str, system: &impl PiecewiseMechanics<N, M>) {
    let scene = load(name);
    let duration = scene.run().duration;
    let built = scene.built().expect("a system");
    let tape = measured(&*built.system().mechanism(), &METHODS, (&built.q, &built.v), duration);
    let compiled = noslip::precision(system, &METHODS, start(&built), duration, LONGEST);
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

/// The start of a scene for the compiled system: a shape with more coordinates than the system has them first.
fn start<const N: usize>(scene: &BuiltScene) -> ([f64; N], [f64; N]) {
    let of = |x: &[f64]| *x.first_chunk().expect("as many coordinates");
    (of(&scene.q), of(&scene.v))
}

/// Measures the compiled system from the start of a scene, and prints its points as `noslip precision --json` does.
fn points<const N: usize, const M: usize>(race: &Race, system: &impl PiecewiseMechanics<N, M>) {
    let start = start(&load(&race.scene).built().expect("a system"));
    let methods: Vec<&str> = race.methods.iter().map(String::as_str).collect();
    let measured = noslip::precision(system, &methods, start, race.duration, LONGEST).expect("a reference");
    let point = |point: &PrecisionPoint| {
        let [error, seconds] = point.measured()?;
        Some(format!(r#"{{"method": "{}", "error": {error:e}, "cpu_seconds": {seconds:e}}}"#, point.method))
    };
    let points: Vec<String> = measured.curves.iter().flat_map(|curve| curve.points.iter().filter_map(point)).collect();
    println!("{{\"points\": [{}]}}", points.join(", "));
}

fn load(scene: &str) -> AnyScene {
    let known: Vec<&str> = harness::METHODS.iter().map(|info| info.name).collect();
    AnyScene::load(scene, &known).expect("a scene")
}

/// What the race with other programs asks for: `--points SCENE DURATION METHODS`.
struct Race {
    scene: String,
    duration: f64,
    methods: Vec<String>,
}

impl Race {
    fn asked() -> Option<Self> {
        let mut words = std::env::args().skip_while(|word| word != "--points").skip(1);
        let scene = words.next()?;
        let duration = words.next()?.parse().expect("a duration (s)");
        let methods = words.next()?.split(',').map(str::to_owned).collect();
        Some(Self { scene, duration, methods })
    }

    /// The name of the scene, without its folder.
    fn name(&self) -> &str {
        Path::new(&self.scene).file_stem().and_then(OsStr::to_str).unwrap_or(&self.scene)
    }
}

fn main() {
    if let Some(race) = Race::asked() {
        match race.name() {
            "knife-edge" => points(&race, &systems::KnifeEdge::default()),
            "rolling-disk" => points(&race, &systems::RollingDisk::default()),
            "roller-racer" => points(&race, &systems::RollerRacer::default()),
            "snakeboard" => points(&race, &systems::Snakeboard::default()),
            "chaplygin-ball" => points(&race, &systems::ChaplyginBall::default()),
            "quartic-oscillator" => points(&race, &systems::QuarticOscillator::default()),
            "two-wheeled-robot" => points(&race, &systems::Robot::default()),
            "car-and-trailer" => points(&race, &systems::Car::default()),
            "falling-disk" => points(&race, &systems::FallingDisk::default()),
            "ball-in-bowl" => points(&race, &systems::BallInBowl::default()),
            "driven-robot" => points(&race, &systems::DrivenRobot::default()),
            "model-car" => points(&race, &systems::ModelCar::default()),
            "coin" => points(&race, &systems::Coin::default()),
            "two-sleighs" => points(&race, &systems::TwoSleighs::default()),
            other => unreachable!("no system `{other}` is compiled here"),
        }
        return;
    }
    let of = LEVELS.map(|error| format!(" us to {error:e} |")).concat();
    println!("| scene |{of} {} |", METHODS.map(|method| format!("tape / compiled, {method}")).join(" | "));
    println!("|---{}|", "|---".repeat(LEVELS.len() + METHODS.len()));
    row("knife-edge", &systems::KnifeEdge::default());
    row("rolling-disk", &systems::RollingDisk::default());
    row("roller-racer", &systems::RollerRacer::default());
    row("snakeboard", &systems::Snakeboard::default());
    row("chaplygin-ball", &systems::ChaplyginBall::default());
    row("ball-in-bowl", &systems::BallInBowl::default());
    row("two-wheeled-robot", &systems::Robot::default());
    row("car-and-trailer", &systems::Car::default());
    row("falling-disk", &systems::FallingDisk::default());
}
