//! A run that has blown up has the verdict `diverged`; what is merely large, late or rounded does not.

use harness::{Blocks, Drift, DriftVerdict, Energies};
use proptest::prelude::*;

/// The verdict on an error and a kinetic energy as functions of the share of the run, from a start of this energy (J).
fn verdict(start: f64, nodes: u32, of: impl Fn(f64) -> [f64; 2]) -> DriftVerdict {
    let (mut blocks, mut energies) = (Blocks::default(), Energies::of_start(start, of(0.0)[1]));
    for k in 0..nodes {
        let share = f64::from(k) / f64::from(nodes - 1);
        let [error, kinetic] = of(share);
        blocks.add(share, error);
        energies.see(share, error, 0.0, || kinetic);
    }
    Drift::of_energy(&blocks, &energies).verdict
}

#[test]
fn an_error_that_is_the_kinetic_energy_has_diverged() {
    // After the middle the motion is nothing but error; also where it comes back, and where the run is too short for batches.
    for nodes in [5, 20, 100, 5000] {
        let stays = |share: f64| if share > 0.5 { [1e6, 1e6] } else { [0.0, 1.0] };
        let returns = |share: f64| if (share - 0.5).abs() < 0.1 { [1e6, 1e6] } else { [0.0, 1.0] };
        let undefined = |share: f64| if share > 0.9 { [f64::INFINITY, f64::INFINITY] } else { [0.0, 1.0] };
        assert_eq!(verdict(1.0, nodes, stays), DriftVerdict::Diverged, "{nodes}");
        assert_eq!(verdict(1.0, nodes, returns), DriftVerdict::Diverged, "{nodes}");
        assert_eq!(verdict(1.0, nodes, undefined), DriftVerdict::Diverged, "{nodes}");
    }
}

#[test]
fn an_error_that_grows_exponentially_has_diverged() {
    // Twenty e-foldings and more; the kinetic energy of the motion grows as fast, so that the error is small beside it.
    for rate in [20.0, 60.0, 300.0] {
        let runs_away = |share: f64| [1e-3 * (rate * share).exp(), (rate * share).exp()];
        assert_eq!(verdict(0.5, 5000, runs_away), DriftVerdict::Diverged, "{rate}");
    }
    // On a ridge the energy is the difference of two that grow, and is now and then zero to the last digit: so in the 25th and the 30th of 32
    // batches.
    let rounded = |share: f64| {
        let zero = matches!((32.0 * share) as u32, 24 | 29);
        [if zero { 0.0 } else { 1e-16 * (95.0 * share).exp() }, (95.0 * share).exp()]
    };
    assert_eq!(verdict(0.18, 142, rounded), DriftVerdict::Diverged);
}

#[test]
fn what_does_not_blow_up_has_not_diverged() {
    let phase = |share: f64| (300.0 * share).sin();
    // An error of a third of the energy that swings; a start at rest that falls from zero energy; a drift, straight or bent.
    assert_eq!(verdict(1.0, 5000, |share| [0.3 * phase(share), 1.0]), DriftVerdict::Bounded);
    assert_eq!(verdict(0.0, 5000, |share| [1e-9 * phase(share) * share, share]), DriftVerdict::Bounded);
    assert_eq!(verdict(1.0, 5000, |share| [0.5 * share, 1.0]), DriftVerdict::LinearDrift);
    assert_eq!(verdict(1.0, 5000, |share| [0.5 * share * share, 1.0]), DriftVerdict::LinearDrift);
    // A hill at the end of the run: the largest error is there, but it does not grow from batch to batch.
    assert_ne!(verdict(1e-3, 5000, |share| [if share > 0.97 { 0.01 } else { 1e-16 }, 1.0]), DriftVerdict::Diverged);
    // Growth that ends far below the energy of the start.
    assert_ne!(verdict(1.0, 5000, |share| [1e-16 * (25.0 * share).exp(), 1.0]), DriftVerdict::Diverged);
    // At rest on a saddle of zero energy: rounding of the potential beside no kinetic energy at all.
    assert_eq!(verdict(0.0, 5000, |share| [1e-17 * phase(share), 1e-30]), DriftVerdict::Bounded);
}

/// An error that jumps to and fro by a tenth of the energy and more is not bounded.
#[test]
fn an_error_that_jumps_is_not_bounded() {
    let jumping = |size: f64| move |share: f64| [if (4999.0 * share).round() % 2.0 > 0.5 { size } else { -size }, 1.0];
    assert_eq!(verdict(1.0, 5000, jumping(0.1)), DriftVerdict::Undecided);
    assert_eq!(verdict(1.0, 5000, jumping(0.04)), DriftVerdict::Bounded);
    // The energy of a motion that is rounding beside its potential does not jump.
    assert_eq!(verdict(0.0, 5000, |share| [jumping(1e-10)(share)[0], 1e-30]), DriftVerdict::Bounded);
}

proptest! {
    #[test]
    fn an_error_below_the_kinetic_energy_has_not_diverged(
        start in 0.0..10.0,
        kinetic in 1e-3..1e3,
        part in 0.0..0.49,
        turns in 40.0..400.0,
        nodes in 5_u32..3000,
    ) {
        let of = |share: f64| [part * kinetic * f64::sin(turns * share), kinetic];
        prop_assert_ne!(verdict(start, nodes, of), DriftVerdict::Diverged);
    }

    #[test]
    fn an_error_beyond_all_energies_has_diverged(
        start in -10.0..10.0,
        kinetic in 1e-3..1e3,
        times in 2.0..1e200,
        from in 0.05..0.95,
        nodes in 30_u32..3000,
    ) {
        let error = times * f64::max(kinetic, 10.0);
        let of = |share: f64| if share > from { [error, error] } else { [0.0, kinetic] };
        prop_assert_eq!(verdict(start, nodes, of), DriftVerdict::Diverged);
    }
}
