//! Orders above eight, and that of the adaptive method.
//!
//! With long steps the error of Gauss collocation is governed by the singularities of the motion in complex time, and falls
//! unevenly; by where the power of the step is left alone, double precision is at its end. Motions without singularities
//! show the power over six decades. (One whose error changes its sign within them, as on the rolling disk, does not.)

use crate::table::case::{Case, Facts, Row, Rows};
use crate::table::rows::{kinds, table};
use crate::table::shapes::Three;
use crate::table::systems::{Field, InField, Thrust, Turntable};
use crate::table::tools::{fitted_order, method, methods};
use harness::{METHODS, MethodInfo};
use lagrangian::With;
use sleigh::{CentreOfMass, Sleigh, SleighState};
use test_systems::{KnifeEdge, Model};

/// Motions that are entire functions of time: the blade of a balanced sleigh turns evenly, and the rest is linear in the
/// place and the speed.
fn without_singularities() -> Vec<Row<Three, 3>> {
    let balanced = Sleigh::new(1.3, 0.8, 0.0).unwrap();
    let start = SleighState { x: 0.3, y: -0.2, heading: 0.5, speed: -0.9, turn_rate: 1.7 }.to_coordinates();
    let row = |name, system, start, facts| Row { name, system, start, duration: 40.0, facts };
    let well = InField { sleigh: CentreOfMass(balanced), field: Field::Well };
    let pushed = |frequency| With { body: well, effects: Thrust { force: -0.5, frequency } }.into();
    // Across the blade, y = 0 and heading 0: y' = rate x.
    let on_the_table = ([0.4, 0.0, 0.0], [0.7, 0.3 * 0.4, 1.4]);
    let edge = KnifeEdge { m: 1.3, I: 0.6, g: 1.7 };
    let forced = Facts { forced: true, ..Facts::default() };
    vec![
        row("knife edge on an incline", edge.into(), edge.start(), Facts::default()),
        row("balanced sleigh in a well", well.into(), start, Facts::default()),
        row("pushed in a well", pushed(0.0), start, forced),
        row("pushed to and fro in a well", pushed(0.7), start, Facts { timed: true, ..forced }),
        row("on a turntable", Turntable { sleigh: balanced, rate: 0.3 }.into(), on_the_table, Facts::default()),
    ]
}

/// The orders of methods by every so many steps; and by how many steps two references are made.
fn orders(cases: &[Row<Three, 3>], methods: &[(&MethodInfo, usize)], fine: [u64; 2]) {
    for case in cases {
        let fine = fine.map(|n| case.end(&method("gauss16"), n).unwrap());
        let reference = case.exact_from(&case.start(), case.duration).unwrap_or_else(|| fine[0].clone());
        let rounding = fine[1].apart(&reference).max(16.0 * f64::EPSILON * reference.size());
        // Where rounding is a fiftieth of the error, and where the higher powers of the step are small.
        let (least, most) = (50.0 * rounding, 2e-7 * reference.size());
        for (info, every) in methods {
            // A symmetric method has every other power.
            let (next, more) = if info.name == "dop853" { (1, 3) } else { (2, 1) };
            let error = |n: u64| case.end(&method(info.name), n).map_or(f64::INFINITY, |end| end.apart(&reference));
            let ladder: Vec<(f64, f64)> = (10..)
                .step_by(*every)
                .map(|n| (case.duration / (n * more) as f64, error(n * more)))
                .skip_while(|(_, error)| *error > most)
                .take_while(|(_, error)| *error > least)
                .collect();
            let order = fitted_order(&ladder, next, rounding);
            println!("{:<28} {:<8} order {order:.3}, {} steps", case.name, info.name, ladder.len());
            assert!(ladder.len() >= 7);
            assert!((order - f64::from(info.order)).abs() <= 0.1, "{}, {}: order {order}", case.name, info.name);
        }
    }
}

/// The motion that is known in closed form, by this method.
fn on_the_knife_edge(name: &str, every: usize) {
    orders(&without_singularities()[..1], &[(methods(&[name])[0], every)], [100, 120]);
}

#[test]
fn on_motions_without_singularities() {
    on_the_knife_edge("gauss10", 6);
    on_the_knife_edge("gauss12", 3);
}

#[test]
fn an_adaptive_method_that_makes_each_step_in_one() {
    on_the_knife_edge("dop853", 6);
}

#[test]
#[ignore = "slow"]
fn on_motions_without_singularities_at_length() {
    let by_steps = |info: &&MethodInfo| info.order > 8 && !info.kind.is_adaptive() || info.name == "dop853";
    let methods: Vec<(&MethodInfo, usize)> = METHODS.iter().filter(by_steps).map(|info| (info, 1)).collect();
    orders(&without_singularities(), &methods, [400, 500]);
}

/// On every row and at every step a stage more is worth its while, down to the rounding.
fn stages(rows: &Rows, fine: f64) {
    for case in rows.iter().filter(|case| !case.facts().without_basis) {
        let reference = case.end(&method("gauss16"), (case.duration() * fine) as u64).unwrap();
        let steps = (2.0 * case.duration()) as u64;
        let errors = ["gauss8", "gauss10", "gauss12", "gauss14", "gauss16"]
            .map(|name| case.end(&method(name), steps).unwrap().distance(&reference));
        println!("{:<32} 8 to 16: {errors:?}", case.name());
        for pair in errors.windows(2).filter(|pair| pair[0] > 1e-13 * reference.size()) {
            assert!(pair[1] < 0.5 * pair[0], "{}: {errors:?}", case.name());
        }
    }
}

test_systems::short_and_full! {
    more_stages_are_more_accurate => stages(&kinds(), 6.0);
    more_stages_are_more_accurate_in_full => stages(&table(), 100.0);
}
