use assembly::parts::{Trailer, Train};
use assembly::{AssemblyMethod, AssemblyState, Solver, SparseDla};
use lagrangian::With;
use sleigh::effects::{Bowl, Drag, Hill, Hills};
use sleigh::{Sleigh, SleighState};

/// A train of `blades` blades, with hitches behind the axles.
pub(crate) fn train(blades: usize) -> Train {
    let trailer = Trailer::new(0.5, 0.1, 0.1, 0.2, 0.8).unwrap();
    Train::new(Sleigh::new(1.0, 1.0, 0.5).unwrap(), vec![trailer; blades - 1], |trailer| trailer.sleigh).unwrap()
}

/// Turning, each blade a little beside the one before.
pub(crate) fn bent(train: &Train) -> AssemblyState {
    let headings: Vec<f64> = (1..=train.trailers().len()).map(|k| 0.3 * (0.37 * k as f64).sin()).collect();
    train.start(&SleighState { speed: 1.0, turn_rate: 0.3, ..SleighState::default() }, &headings)
}

pub(crate) fn run(train: &Train, solver: Solver, h: f64, steps: u32, state: &mut AssemblyState) {
    let mut method = SparseDla::new(&train.assembly, solver).unwrap();
    for k in 0..steps {
        method.step(&train.assembly, f64::from(k) * h, h, state).unwrap();
    }
}

/// The end of a run of the bent train.
pub(crate) fn end(train: &Train, duration: f64, method: &mut dyn AssemblyMethod, steps: u32) -> AssemblyState {
    let (mut state, h) = (bent(train), duration / f64::from(steps));
    for k in 0..steps {
        method.step(&train.assembly, f64::from(k) * h, h, &mut state).unwrap();
    }
    state
}

/// The slope of a line through points.
pub(crate) fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

/// A chain of unlike blades, on each of which hills and bowl weigh by its mass; with a drag along every blade (kg/s).
pub(crate) fn weighted(blades: usize, drag: f64) -> Train {
    let ground = |mass: f64| {
        let hill = |height, x, y, width| Hill { height: 2.0 * mass * height, x, y, width };
        let hills = vec![hill(0.2, 1.5, 0.5, 0.8), hill(0.15, -2.0, 1.0, 1.0), hill(-0.15, 0.5, -2.0, 0.9)];
        let bowl = Bowl::new([0.1 * mass, 0.12 * mass], [0.0, 0.0]).unwrap();
        (bowl, (Hills::new(hills).unwrap(), Drag::new(drag, 0.0).unwrap()))
    };
    let trailer =
        |k: usize| Trailer::new(0.4 + 0.1 * (k % 3) as f64, 0.1, 0.05, 0.1, 0.6 + 0.05 * (k % 4) as f64).unwrap();
    let body = |sleigh: Sleigh| With { body: sleigh, effects: ground(sleigh.mass()) };
    let lead = body(Sleigh::new(1.0, 1.0, 0.5).unwrap());
    Train::new(lead, (1..blades).map(trailer).collect(), |trailer| body(trailer.sleigh)).unwrap()
}
