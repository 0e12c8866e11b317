//! Pictures of the hard cases: what a correct code shows, mostly beside one that is broken in the way that the case is about.
//!
//! `cargo run --example hard_cases FOLDER [NOSLIP]`; the folder receives a picture for each case that has no scene in
//! `docs/stability`, and the program `NOSLIP` makes the runs (`target/release/noslip` unless another is given).

#[path = "hard_cases/broken.rs"]
mod broken;
#[path = "hard_cases/curves.rs"]
mod curves;
#[path = "hard_cases/forces.rs"]
mod forces;
#[path = "hard_cases/free.rs"]
mod free;
#[path = "hard_cases/numbers.rs"]
mod numbers;
#[path = "hard_cases/program.rs"]
mod program;
#[path = "hard_cases/systems.rs"]
mod systems;

use program::Program;
use report::{Chart, chart_svg};
use std::error::Error;
use std::fs;
use std::path::PathBuf;

type Draw = fn(&Program) -> Result<Chart, Box<dyn Error>>;

/// The cases, and what draws them.
const PICTURES: [(&str, Draw); 22] = [
    ("tiny-spin", free::tiny_spin),
    ("subnormal-spin", free::subnormal_spin),
    ("there-and-back", free::there_and_back),
    ("long-step", free::long_step),
    ("step-lengths", free::step_lengths),
    ("negative-substeps", free::negative_substeps),
    ("offsets", free::offsets),
    ("far-away", numbers::far_away),
    ("many-turns", numbers::many_turns),
    ("late", numbers::late),
    ("masses", numbers::masses),
    ("light-inertia", numbers::light_inertia),
    ("fast", numbers::fast),
    ("stiff-bowl", forces::stiff_bowl),
    ("turning-points", forces::turning_points),
    ("heavy-drag", forces::heavy_drag),
    ("fast-rotor", forces::fast_rotor),
    ("jumps", forces::jumps),
    ("parallel-blades", systems::parallel_blades),
    ("dropping-row", systems::dropping_row),
    ("pseudo-holonomic", systems::pseudo_holonomic),
    ("gauge", systems::gauge),
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let folder = arguments.next().ok_or("usage: hard_cases FOLDER [NOSLIP]")?;
    let program = Program::at(&arguments.next().unwrap_or_else(|| "target/release/noslip".into()))?;
    fs::create_dir_all(&folder)?;
    for (case, draw) in PICTURES {
        let chart = draw(&program).map_err(|error| format!("{case}: {error}"))?;
        fs::write(folder.join(format!("stability-{case}.svg")), chart_svg(&chart))?;
        println!("{case}: {}", chart.title);
    }
    Ok(())
}
