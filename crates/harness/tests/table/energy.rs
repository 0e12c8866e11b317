//! The methods that promise the energy.

use crate::table::case::{Case, Facts, Row, Rows};
use crate::table::rows::{kinds, table};
use crate::table::shapes::{Place, Three};
use crate::table::systems::{Field, InField};
use crate::table::tools::{Methods, all_methods, method, methods, refuses};
use dla::Schedule;
use sleigh::{CentreOfMass, Sleigh, SleighState};

/// The largest relative change of the energy.
fn change_over(case: &dyn Case, name: &str, steps: u64) -> f64 {
    let (mut first, mut largest) = (None, 0.0f64);
    let schedule = Schedule { t0: 0.0, step: 0.05, steps };
    case.run(&method(name), &case.start(), &schedule, &mut |node| {
        let now = node.energy();
        let change = (now / *first.get_or_insert(now) - 1.0).abs();
        largest = if change.is_nan() { f64::INFINITY } else { largest.max(change) };
    })
    .unwrap();
    largest
}

/// Those among the methods that promise the energy keep it within the bound; on how many pairs of a row and a method, and on how
/// many rows the same measure sees the error of `dla`.
fn kept(rows: &Rows, methods: &Methods, steps: impl Fn(&dyn Case) -> u64, bound: f64) -> [u32; 2] {
    let (mut pairs, mut controls) = (0, 0);
    for case in rows.iter().filter(|case| !case.facts().forced) {
        let (facts, steps) = (case.facts(), steps(case.as_ref()));
        for info in methods.iter().filter(|info| info.keeps.contains("energy") && refuses(info, facts).is_none()) {
            let kept = change_over(case.as_ref(), info.name, steps);
            println!("{:<32} {}: {kept:.1e}", case.name(), info.name);
            assert!(kept <= bound, "{}, {}: {kept:e}", case.name(), info.name);
            pairs += 1;
        }
        if !facts.timed && !facts.affine {
            let control = change_over(case.as_ref(), "dla", steps);
            println!("{:<32} dla: {control:.1e}", case.name());
            controls += u32::from(control > 1e-6);
        }
    }
    [pairs, controls]
}

#[test]
fn energy_methods_keep_it() {
    // A rounding or two a step, of energies that are differences of terms up to ten times as large.
    let [pairs, controls] = kept(&kinds(), &methods(&["energy2", "energy4"]), |_| 20, 1e-13);
    assert_eq!(pairs, 8);
    assert!(controls >= 4, "the same measure sees the error of dla on {controls} rows only");
}

/// Through the time of the row and once more, where it comes back over two thousand steps.
#[test]
#[ignore = "slow"]
fn energy_methods_keep_it_at_length() {
    let steps = |case: &dyn Case| if case.facts().recurrent { 2000 } else { (2.0 * case.duration() / 0.05) as u64 };
    // A rounding or two a step, of energies that are differences of terms up to ten times as large.
    let [_, controls] = kept(&table(), &all_methods(), steps, 1e-12);
    assert!(controls >= 10, "the same measure sees the error of dla on {controls} rows only");
}

/// The free sleigh backward with some spin.
fn free(system: impl Into<Three>, start: Place<3>) -> Row<Three, 3> {
    Row { name: "free sleigh", system: system.into(), start, duration: 0.0, facts: Facts::default() }
}

/// Where the mass matrix and `A M^-1 A'` are constant, the trapezoidal method keeps the kinetic energy.
#[test]
fn the_trapezoid_at_the_centre_of_mass_keeps_it() {
    let (q, v) = SleighState { speed: -1.0, turn_rate: 0.4, ..SleighState::default() }.to_coordinates();
    for offset in [0.5, -0.3, 2.0] {
        let blade = Sleigh::new(1.3, 0.8, offset).unwrap();
        let sleigh = CentreOfMass(blade);
        let at_centre = free(InField { sleigh, field: Field::Free }, sleigh.from_blade(&q, &v));
        let steps = 2_000;
        let kept = change_over(&at_centre, "dla-trapezoid", steps);
        println!("a = {offset}: {kept:.1e}");
        // One rounding of the energy a step, at worst all in the same direction.
        assert!(kept <= f64::EPSILON * steps as f64, "a = {offset}: relative energy error {kept:e}");

        // The controls: the midpoint rule there, and the trapezoidal rule at the blade, do not.
        let midpoint = change_over(&at_centre, "dla", 400);
        let at_blade = change_over(&free(blade, (q, v)), "dla-trapezoid", 400);
        assert!(midpoint > 1e-8, "midpoint: {midpoint:e}");
        assert!(at_blade > 1e-8, "at the blade: {at_blade:e}");
    }
}

/// The error of the other symmetric members stays of second order while the sleigh turns, and freezes with the spin.
fn bounded(steps: [u64; 2]) {
    let start = SleighState { speed: -1.0, turn_rate: 0.4, ..SleighState::default() }.to_coordinates();
    let case = free(Sleigh::new(1.0, 1.0, 0.5).unwrap(), start);
    let [short, long] = steps.map(|steps| change_over(&case, "dla", steps));
    assert!(short < 1e-3);
    assert!((long - short).abs() < 1e-12, "the error of a motion that has died out still grows: {short:e}, {long:e}");
}

test_systems::short_and_full! {
    the_midpoint_rule_bounds_it_on_the_free_sleigh => bounded([500, 2_500]);
    the_midpoint_rule_bounds_it_on_the_free_sleigh_in_full => bounded([1_000, 20_000]);
}
