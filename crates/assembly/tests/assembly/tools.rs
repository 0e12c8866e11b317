use assembly::parts::{Trailer, Train};
use assembly::{Dla, OneStep, Solver, State};
use lagrangian::With;
use sleigh::effects::{Bowl, Hill, Hills};
use sleigh::{Sleigh, SleighState};

/// A train of so many blades in all, with hitches behind the axles.
pub(crate) fn train(blades: usize) -> Train {
    let trailer = Trailer::new(0.5, 0.1, 0.1, 0.2, 0.8).unwrap();
    Train::new(Sleigh::new(1.0, 1.0, 0.5).unwrap(), vec![trailer; blades - 1], |trailer| trailer.sleigh).unwrap()
}

/// Turning, each blade a little beside the one before.
pub(crate) fn bent(train: &Train) -> State {
    let headings: Vec<f64> = (1..=train.trailers().len()).map(|k| 0.3 * (0.37 * k as f64).sin()).collect();
    train.start(&SleighState { speed: 1.0, turn_rate: 0.3, ..SleighState::default() }, &headings)
}

pub(crate) fn run(train: &Train, solver: Solver, h: f64, steps: u32, state: &mut State) {
    let mut method = Dla::new(&train.assembly, solver).unwrap();
    for k in 0..steps {
        method.step(&train.assembly, f64::from(k) * h, h, state).unwrap();
    }
}

/// Hills in a wide bowl, so that what runs there comes back.
pub(crate) fn ground() -> (Bowl, Hills) {
    let hill = |height, x, y, width| Hill { height, x, y, width };
    let hills = vec![hill(0.4, 1.5, 0.5, 0.8), hill(0.3, -2.0, 1.0, 1.0), hill(-0.3, 0.5, -2.0, 0.9)];
    (Bowl::new([0.1, 0.12], [0.0, 0.0]).unwrap(), Hills::new(hills).unwrap())
}

/// The same train on hills, with their effects under every blade.
pub(crate) fn hilly(blades: usize) -> Train {
    let trailer = Trailer::new(0.5, 0.1, 0.1, 0.2, 0.8).unwrap();
    let lead = With { body: Sleigh::new(1.0, 1.0, 0.5).unwrap(), effects: ground() };
    let body = |trailer: &Trailer| With { body: trailer.sleigh, effects: ground() };
    Train::new(lead, vec![trailer; blades - 1], body).unwrap()
}
