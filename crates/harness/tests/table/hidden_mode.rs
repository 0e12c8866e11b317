//! The hidden mode of the geometric nonholonomic integrator, and its absence from the maps on the distribution.

use crate::table::case::{Case, Facts, Row};
use crate::table::shapes::Three;
use crate::table::systems::{Field, InField};
use crate::table::tools::{Methods, all_methods, families, method, methods, refuses};
use dla::Schedule;
use harness::Trend;
use sleigh::{CentreOfMass, Sleigh, SleighState};

fn sleigh() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.5).unwrap()
}

/// About the stable straight motion the spin of the sleigh dies out; that of the counter-example grows at the rate
/// `asinh(kappa h)/h`, with alternating sign.
#[test]
fn it_grows_at_its_rate() {
    let kappa = sleigh().spin_gain();
    let sleigh = CentreOfMass(sleigh());
    let (q, v) = SleighState { speed: 1.0, turn_rate: 1e-12, ..SleighState::default() }.to_coordinates();
    let system: Three = InField { sleigh, field: Field::Free }.into();
    let case: Row<Three, 3> =
        Row { name: "straight", system, start: sleigh.from_blade(&q, &v), duration: 0.0, facts: Facts::default() };
    for h in [0.02, 0.05, 0.1] {
        let (mut growth, mut sign_changes, mut before) = (Trend::default(), 0, 0.0);
        let schedule = Schedule { t0: 0.0, step: h, steps: (40.0 / h) as u64 };
        case.run(&method("gni"), &case.start(), &schedule, &mut |node| {
            let spin = node.point().v[2];
            // From where the growing part has outgrown the decaying one, to where it is no longer small.
            if spin.abs() < 1e-3 && node.t() > 20.0 {
                growth.add(node.t(), spin.abs().ln());
                sign_changes += u32::from(spin * before < 0.0);
            }
            before = spin;
        })
        .unwrap();
        let (rate, theory) = (growth.slope().unwrap(), (kappa * h).asinh() / h);
        println!("h = {h}: the hidden mode grows at {rate:.5}, asinh(kappa h)/h = {theory:.5}");
        assert!((rate / theory - 1.0).abs() < 1e-3, "h = {h}: {rate}, expected {theory}");
        assert!(sign_changes > 50);
    }
}

/// No other method has such a mode: the stable straight motion stays straight, for as long as one looks.
///
/// In the last part of the run, after a time (s), the spin of `gni` is more than `grown`, whose mode has outgrown the start.
fn straight(methods: &Methods, schedule: &Schedule, after: f64, grown: f64) {
    let start = SleighState { speed: 1.0, turn_rate: 1e-6, heading: 0.3, ..SleighState::default() }.to_coordinates();
    let system: Three = sleigh().into();
    let case: Row<Three, 3> = Row { name: "straight", system, start, duration: 0.0, facts: Facts::default() };
    for info in methods.iter().filter(|info| refuses(info, case.facts()).is_none()) {
        let mut largest = 0.0f64;
        case.run(&method(info.name), &case.start(), schedule, &mut |node| {
            if node.t() > after {
                largest = largest.max(node.point().v[2].abs());
            }
        })
        .unwrap();
        println!("{:<15} spin at most {largest:.1e} after t = {after}", info.name);
        if info.name == "gni" {
            assert!(largest > grown, "the counter-example has lost its point: {largest:e}");
        } else {
            // Rounding may leave a spin of the size of rounding, and no more.
            assert!(largest < 1e-14, "{}: {largest:e}", info.name);
        }
    }
}

#[test]
fn no_other_method_has_it() {
    let mut some = families();
    some.extend(methods(&["gni"]));
    // The spin dies out as exp(-0.4 t): from 1e-6 to 2e-15.
    straight(&some, &Schedule { t0: 0.0, step: 0.4, steps: 150 }, 50.0, 1e-6);
}

/// In the second half of the run.
#[test]
#[ignore = "slow"]
fn no_other_method_has_it_in_full() {
    straight(&all_methods(), &Schedule { t0: 0.0, step: 0.05, steps: 4_000 }, 100.0, 1e-2);
}
