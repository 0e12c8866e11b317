use super::Case;
use super::systems::{BOWL, bowl, built, drag, egg_crate, from, go, schedule, sleigh, start, three, with};
use dla::{Dla, Gauss, Mechanics, make_steps};
use lagrangian::With;
use scene::AnyEffect;
use sleigh::effects::{Hill, Hills, MovingMass, Slope, Thrust, Torque};
use sleigh::{Flywheel, Guide, Guided, SleighState};
use std::hint::black_box;

const DLA: &str = "effects, dla";
const GAUSS: &str = "effects, gauss8";

/// A step with every effect alone and with several, as types and from a scene; an absent effect must cost nothing.
///
/// The general midpoint step: its closed form knows no effects.
pub(super) fn cases() -> Vec<Case> {
    vec![
        Case::new(DLA, "the sleigh itself", |steps| dla(&sleigh(), steps)),
        Case::new(DLA, "none", |steps| dla(&with(()), steps)).same_as("the sleigh itself"),
        Case::new(DLA, "none, scene", |steps| scene("", steps)).same_as("the sleigh itself"),
        Case::new(DLA, "slope", |steps| dla(&with((slope(),)), steps)),
        Case::new(DLA, "bowl", |steps| dla(&with((bowl(),)), steps)),
        Case::new(DLA, "bowl, scene", |steps| scene(BOWL, steps)),
        Case::new(DLA, "egg_crate", |steps| dla(&with((egg_crate(),)), steps)),
        Case::new(DLA, "hills", |steps| dla(&with((hills(),)), steps)),
        Case::new(DLA, "drag", |steps| dla(&with((drag(),)), steps)),
        Case::new(DLA, "thrust", |steps| dla(&with((Thrust::new(-0.5).expect("finite"),)), steps)),
        Case::new(DLA, "torque", |steps| dla(&with((Torque::new(0.1).expect("finite"),)), steps)),
        Case::new(DLA, "moving_mass", |steps| dla(&with((moving_mass(),)), steps)),
        Case::new(DLA, "bowl + drag", |steps| dla(&with((bowl(), drag())), steps)),
        Case::new(DLA, "bowl + drag, list", |steps| {
            dla(&with(vec![AnyEffect::Bowl(bowl()), AnyEffect::Drag(drag())]), steps);
        }),
        Case::new(DLA, "bowl + drag + egg_crate", |steps| dla(&with((bowl(), drag(), egg_crate())), steps)),
        Case::new(DLA, "bowl + drag + egg_crate, list", |steps| dla(&with(three()), steps)),
        Case::new(DLA, "flywheel", |steps| {
            let body = Flywheel::new(sleigh(), 0.5, None).expect("positive");
            let ([x, y, heading], [vx, vy, omega]) = start();
            let start = ([x, y, heading, 0.0], [vx, vy, omega, 2.0]);
            from(&With { body, effects: () }, Dla::midpoint(), steps, start);
        }),
        Case::new(DLA, "flywheel, scene", |steps| scene(FLYWHEEL, steps)).same_as("flywheel"),
        Case::new(DLA, "servo", |steps| {
            // Forward: backward the spin would grow without end.
            let body = Guided::<1>::servo(sleigh(), Guide::Speed(0.7.into())).expect("finite");
            let start = SleighState { speed: 0.7, turn_rate: 0.1, ..SleighState::default() }.to_coordinates();
            from(&With { body, effects: () }, Dla::midpoint(), steps, start);
        }),
        Case::new(DLA, "servo, scene", |steps| scene(SERVO, steps)).same_as("servo"),
        Case::new(DLA, "turntable", |steps| {
            dla(&With { body: Guided::turntable(sleigh(), 0.2).expect("finite"), effects: () }, steps);
        }),
        Case::new(DLA, "turntable, scene", |steps| scene(TURNTABLE, steps)).same_as("turntable"),
        Case::new(GAUSS, "the sleigh itself", |steps| gauss(&sleigh(), steps)),
        Case::new(GAUSS, "none", |steps| gauss(&with(()), steps)).same_as("the sleigh itself"),
        Case::new(GAUSS, "bowl", |steps| gauss(&with((bowl(),)), steps)),
    ]
}

const FLYWHEEL: &str = "\n[[effects]]\nkind = \"flywheel\"\ninertia = 0.5\nrotor_rate = 2.0\n";
const SERVO: &str = "\n[[effects]]\nkind = \"servo\"\nspeed = 0.7\n";
const TURNTABLE: &str = "\n[[effects]]\nkind = \"turntable\"\nrate = 0.2\n";

fn slope() -> Slope {
    Slope::new([0.1, 0.0]).expect("finite")
}

fn hills() -> Hills {
    Hills::new(vec![Hill { height: 0.1, x: 1.0, y: 1.0, width: 0.5 }]).expect("a positive width")
}

fn moving_mass() -> MovingMass {
    MovingMass::new(0.1, 0.2, 0.1).expect("a positive mass")
}

fn dla<const M: usize>(system: &dyn Mechanics<3, M>, steps: u64) {
    go(system, Dla::midpoint(), steps);
}

fn gauss(system: &dyn Mechanics<3, 1>, steps: u64) {
    go(system, Gauss::new::<4>(), steps);
}

/// The same through a scene file.
fn scene(effects: &str, steps: u64) {
    let built = built(effects);
    let system = built.system().mechanism();
    let mut state = system.state(black_box(&built.q), black_box(&built.v));
    make_steps(&*system, &mut *system.general_map(), &schedule(steps), 0..steps, &mut state, &mut ())
        .expect("the steps succeed");
    black_box(state);
}
