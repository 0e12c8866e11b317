use dla::{Mechanics, OneStep, Schedule, State, drive};
use lagrangian::With;
use scene::{AnyEffect, BuiltScene, Scene};
use sleigh::effects::{Bowl, Drag, EggCrate};
use sleigh::{Sleigh, SleighState};
use std::hint::black_box;

pub(super) const STEP: f64 = 0.05;

pub(super) fn sleigh() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.5).expect("positive parameters")
}

pub(super) fn with<E>(effects: E) -> With<Sleigh, E> {
    With { body: sleigh(), effects }
}

pub(super) fn bowl() -> Bowl {
    Bowl::new([0.1; 2], [0.0; 2]).expect("finite")
}

pub(super) fn drag() -> Drag {
    Drag::new(0.01, 0.01).expect("positive")
}

pub(super) fn egg_crate() -> EggCrate {
    EggCrate::new(0.1, [1.0; 2]).expect("finite")
}

pub(super) fn three() -> Vec<AnyEffect> {
    vec![AnyEffect::Bowl(bowl()), AnyEffect::Drag(drag()), AnyEffect::EggCrate(egg_crate())]
}

pub(super) const BOWL: &str = "\n[[effects]]\nkind = \"bowl\"\nstiffness = [0.1, 0.1]\n";

/// The turn-around with these effects, through a scene file.
pub(super) fn built(effects: &str) -> BuiltScene {
    let text = Scene::template().split("[[effects]]").next().expect("a first part").to_owned() + effects;
    Scene::parse(&text, "bench.toml", &["dla"]).expect("a valid scene").built().expect("a valid scene")
}

pub(super) fn schedule(steps: u64) -> Schedule {
    Schedule { t0: 0.0, step: STEP, steps }
}

/// The start of the turn-around.
pub(super) fn start() -> ([f64; 3], [f64; 3]) {
    black_box(SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }).to_coordinates()
}

/// The first steps from that start.
pub(super) fn go<const M: usize>(system: &dyn Mechanics<3, M>, method: impl OneStep<3, M>, steps: u64) {
    let (q, v) = start();
    from(system, method, steps, (q, v));
}

/// The first steps from a start of its own.
pub(super) fn from<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    mut method: impl OneStep<N, M>,
    steps: u64,
    (q, v): ([f64; N], [f64; N]),
) {
    let mut state = State::new(q, v, system.angles());
    drive(black_box(system), &mut method, &schedule(steps), &mut state, ()).expect("the steps succeed");
    black_box(state);
}
