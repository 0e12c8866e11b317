//! The table: one row for every system. A new row is under every check.

use crate::table::case::{Case, Facts, Row};
use crate::table::shapes::{Five, Four, Place, Seven, Six, Three};
use crate::table::systems::{Field, Forces, InField, Magnetic, Moving, Thrust, Turntable, at_centre};
use lagrangian::With;
use sleigh::{CentreOfMass, Sleigh, SleighState};
use test_systems::{
    ChaplyginBall, ContactOscillator, KnifeEdge, Model, Particle, QuarticOscillator, RollerRacer, RollingDisk,
    Snakeboard, Suslov,
};

impl<Sys, const N: usize> Row<Sys, N> {
    fn new(name: &'static str, system: impl Into<Sys>, start: Place<N>, duration: f64, facts: Facts) -> Self {
        Self { name, system: system.into(), start, duration, facts }
    }
}

/// A model from its own start, reversible where its label says so.
fn model<PathShape: From<Mo> + 'static, Mo, const N: usize, const M: usize>(
    model: Mo,
    duration: f64,
    facts: Facts,
) -> Box<dyn Case>
where
    Mo: Model<N, M>,
    Row<PathShape, N>: Case,
{
    let (name, start, reversible) = (model.name(), model.start(), model.reversible());
    Box::new(Row::<PathShape, N>::new(name, model, start, duration, Facts { reversible, ..facts }))
}

fn three(name: &'static str, system: impl Into<Three>, start: Place<3>, duration: f64, facts: Facts) -> Box<dyn Case> {
    Box::new(Row::<Three, 3>::new(name, system, start, duration, facts))
}

/// The sleigh of the checks, no parameter equal to one.
pub fn sleigh() -> Sleigh {
    Sleigh::new(1.3, 0.8, 0.4).unwrap()
}

fn in_field(field: Field) -> InField {
    InField { sleigh: CentreOfMass(sleigh()), field }
}

/// Every row.
pub fn table() -> Vec<Box<dyn Case>> {
    let plain = Facts { highest_order: 8, ..Facts::default() };
    let even = Facts { reversible: true, ..plain };
    let here_again = Facts { recurrent: true, ..even };
    let everything =
        Facts { timed: true, forced: true, affine: true, momentum_is_not_mass_times_velocity: true, ..plain };
    let through_the_turn = SleighState { x: 0.3, y: -0.2, heading: 0.5, speed: -0.9, turn_rate: 0.8 };
    let balanced = Sleigh::new(1.3, 0.8, 0.0).unwrap();
    let in_the_crate = at_centre([0.5, 1.0, 0.3, 0.4, 0.7], 0.4);
    // z' = y x' - sin(t + z) y'/2 - .3 cos t - .2 x
    let (q, [vx, vy]): ([f64; 3], [f64; 2]) = ([0.3, -0.2, 0.1], [0.6, 0.5]);
    let moving = (q, [vx, vy, q[1] * vx - 0.5 * q[2].sin() * vy - 0.3 - 0.2 * q[0]]);
    // Across the blade, y = 0 and heading 0: y' = rate x.
    let on_the_table = ([0.4, 0.0, 0.0], [0.7, 0.3 * 0.4, 0.5]);
    let contact = ContactOscillator { eps: 0.3, s: 0.0 };
    // Attitudes by unit quaternions: their length is a constraint on positions, or its rate alone.
    let suslov = Suslov::new([1.0, 2.0, 1.5], 0.3, 0.5);
    let ball = ChaplyginBall::new(1.2, 0.6, [0.5, 0.8, 1.1]);
    let on_positions = Facts { positions: true, one_rule: true, ..plain };
    vec![
        three("free sleigh", sleigh(), through_the_turn.to_coordinates(), 4.0, even),
        three(
            "balanced sleigh",
            balanced,
            through_the_turn.to_coordinates(),
            4.0,
            Facts { momenta: &["turn momentum"], ..here_again },
        ),
        three("sleigh in a well", in_field(Field::Well), in_the_crate, 4.0, Facts { highest_order: 6, ..here_again }),
        three("sleigh in the egg-crate", in_field(Field::EggCrate), in_the_crate, 4.0, here_again),
        three(
            "sleigh in a moving crate",
            in_field(Field::Tide),
            in_the_crate,
            4.0,
            Facts { timed: true, recurrent: true, ..plain },
        ),
        three(
            "sleigh under thrust",
            With { body: sleigh(), effects: Thrust { force: -0.5, frequency: 0.0 } },
            SleighState { turn_rate: 0.6, ..SleighState::default() }.to_coordinates(),
            6.0,
            Facts { forced: true, ..here_again },
        ),
        three(
            "sleigh with friction",
            With { body: sleigh(), effects: Forces },
            SleighState { x: 0.1, y: -0.2, heading: 0.3, speed: 0.8, turn_rate: 0.9 }.to_coordinates(),
            4.0,
            Facts { forced: true, ..plain },
        ),
        three(
            "sleigh on a turntable",
            Turntable { sleigh: sleigh(), rate: 0.3 },
            on_the_table,
            4.0,
            Facts { affine: true, ..plain },
        ),
        three("moving everything", Moving { basis: true }, moving, 4.0, everything),
        three(
            "moving everything, no basis",
            Moving { basis: false },
            moving,
            4.0,
            Facts { without_basis: true, ..everything },
        ),
        three(
            "magnetic particle",
            Magnetic { mass: 1.3, quartic: 0.2 },
            ([0.3, 0.5, -0.2], [0.6, -0.4, 0.3]),
            3.0,
            Facts { momentum_is_not_mass_times_velocity: true, highest_order: 6, recurrent: true, ..plain },
        ),
        model::<Three, _, 3, 1>(Particle { m: 1.4, k: 0.0 }, 3.0, Facts { highest_order: 6, ..plain }),
        model::<Three, _, 3, 1>(Particle { m: 1.4, k: 0.6 }, 4.0, Facts { highest_order: 6, ..here_again }),
        model::<Three, _, 3, 1>(
            KnifeEdge { m: 1.3, I: 0.6, g: 1.7 },
            4.0,
            Facts { momenta: &["turn momentum"], ..here_again },
        ),
        model::<Three, _, 3, 1>(contact, 6.0, Facts { highest_order: 6, ..here_again }),
        model::<Three, _, 3, 1>(
            ContactOscillator { s: 1.0, ..contact },
            6.0,
            Facts { momentum_is_not_mass_times_velocity: true, highest_order: 6, ..here_again },
        ),
        model::<Four, _, 4, 2>(
            RollingDisk { m: 1.3, R: 0.7, I: 0.5, J: 0.9 },
            3.0,
            Facts { momenta: &["spin momentum", "heading momentum"], ..here_again },
        ),
        model::<Four, _, 4, 2>(RollerRacer { m: 1.3, I1: 0.8, I2: 0.3, d1: 0.7, d2: 0.4 }, 2.0, plain),
        model::<Four, _, 4, 2>(suslov, 3.0, on_positions),
        model::<Four, _, 4, 2>(suslov.norm_by_rate(), 3.0, plain),
        model::<Six, _, 6, 3>(ball, 3.0, Facts { highest_order: 6, ..on_positions }),
        model::<Six, _, 6, 3>(ball.norm_by_rate(), 3.0, Facts { highest_order: 6, ..plain }),
        model::<Five, _, 5, 2>(
            Snakeboard { m: 1.3, l: 0.7, J: 0.3, Jr: 0.2, Jw: 0.1 },
            4.0,
            Facts { momenta: &["rotor momentum", "steering momentum"], ..plain },
        ),
        model::<Seven, _, 7, 1>(QuarticOscillator { c: 1.0 }, 2.0, here_again),
    ]
}

/// One row of every kind: free, in a field, with forces, with time everywhere, on a moving plane; with more constraints, with
/// constraints on positions, with more coordinates.
pub fn kinds() -> Vec<Box<dyn Case>> {
    rows(&[
        "free sleigh",
        "sleigh in the egg-crate",
        "sleigh with friction",
        "moving everything",
        "sleigh on a turntable",
        "vertical rolling disk",
        "Suslov problem",
        "snakeboard",
    ])
}

/// The rows of those names.
pub fn rows(names: &[&str]) -> Vec<Box<dyn Case>> {
    names.iter().map(|name| named(name)).collect()
}

/// The row of that name.
pub fn named(name: &str) -> Box<dyn Case> {
    table().into_iter().find(|case| case.name() == name).expect(name)
}
