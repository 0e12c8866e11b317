//! Circles and straightening: the curvature of the blade's path against the time, for smaller and smaller offsets.
//!
//! `cargo run --example circles [FOLDER]`; the folder receives the two pictures.

use noslip::dla::Node;
use noslip::{Dla, Exact, RunError, Schedule, Sleigh, SleighState, State, System, Trajectory, drive};
use report::{Chart, Layer, SceneReport, Series, chart_svg, path_picture};
use std::array::TryFromSliceError;
use std::fs;
use std::path::Path;

const OFFSETS: [f64; 5] = [0.5, 0.2, 0.05, 0.01, 0.0];
const START: SleighState = SleighState { x: 0.0, y: 0.0, heading: 0.0, speed: 1.0, turn_rate: 0.5 };

/// The nodes of a run of `seconds` in steps of 0.05 s, one of them in every `every`.
fn nodes(sleigh: &Sleigh, seconds: u64, every: u64) -> Result<Trajectory, RunError> {
    let (q, v) = START.to_coordinates();
    let mut state = State::new(q, v, sleigh.angles());
    let mut trajectory = Trajectory::every(every);
    let schedule = Schedule { t0: 0.0, step: 0.05, steps: 20 * seconds };
    drive(sleigh, &mut Dla::midpoint(), &schedule, &mut state, &mut trajectory)?;
    Ok(trajectory)
}

/// How much the path bends, `w/u` (1/m).
fn curvature(state: &SleighState) -> f64 {
    state.turn_rate / state.speed
}

/// The same at a node.
fn bent(node: &Node) -> Result<f64, TryFromSliceError> {
    Ok(curvature(&SleighState::from_coordinates(node.q[..].try_into()?, node.v[..].try_into()?)))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("curvature w/u [1/m]; error: the largest difference from the closed form");
    println!("  a [m]       0 s      10 s      20 s      40 s      80 s     160 s      error   turn to come [rad]");
    let (mut series, mut curves, mut dots) = (Vec::new(), Vec::new(), Vec::new());
    for offset in OFFSETS {
        let sleigh = Sleigh::new(1.0, 1.0, offset)?;
        let exact = Exact::new(&sleigh, &START)?;
        let trajectory = nodes(&sleigh, 160, 200)?;
        let mut error = 0.0f64;
        print!("{offset:7.2}");
        for node in trajectory.nodes() {
            let bent = bent(node)?;
            error = error.max((bent - curvature(&exact.at(node.t))).abs());
            if [0.0, 10.0, 20.0, 40.0, 80.0, 160.0].iter().any(|t| (node.t - t).abs() < 1e-6) {
                print!(" {bent:9.2e}");
            }
        }
        // A time after which nothing is left of the spin, if there is such a time.
        let rest = if offset == 0.0 { f64::INFINITY } else { exact.at(100.0 / sleigh.spin_gain()).heading };
        println!(" {error:10.1e} {rest:20.2}");

        let path = nodes(&sleigh, 40, 4)?;
        let path = path.nodes();
        let bent = path.iter().map(|node| Ok([node.t, bent(node)?])).collect::<Result<_, TryFromSliceError>>()?;
        curves.push(Layer::Curves { label: format!("a = {offset} m"), curves: vec![bent] });
        dots.extend((0..=20).map(|k| 2.0 * f64::from(k)).map(|t| vec![[t, curvature(&exact.at(t))]]));
        series.push(Series {
            label: format!("a = {offset} m"),
            path: path.iter().map(|node| [node.q[0], node.q[1]]).collect(),
            heading: path.iter().map(|node| node.q[2]).collect(),
            time: path.iter().map(|node| node.t).collect(),
            ..Series::default()
        });
    }

    if let Some(folder) = std::env::args().nth(1) {
        let title = "Curvature of the blade's path".to_owned();
        let axes = ["t [s]".to_owned(), "w/u [1/m]".to_owned()];
        curves.push(Layer::Curves { label: "closed form".to_owned(), curves: dots });
        let chart = Chart { title, axes, decades: [false; 2], layers: curves };
        let scene =
            SceneReport { name: "circles".to_owned(), title: "Paths".to_owned(), series, ..SceneReport::default() };
        fs::create_dir(&folder)?;
        fs::write(Path::new(&folder).join("circles-curvature.svg"), chart_svg(&chart))?;
        fs::write(Path::new(&folder).join("circles-path.svg"), path_picture(&scene))?;
        println!("written: {folder}");
    }
    Ok(())
}
