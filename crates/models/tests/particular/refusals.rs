//! Parameters that are refused.

use models::{
    ChaplyginBall, CompoundPendulum, ContactOscillator, GaugedOscillator, IsokineticParticle, KnifeEdge, ModelError,
    Particle, QuarticOscillator, RollerRacer, RollingDisk, SleighOnArm, Snakeboard, Suslov, TurntableBall,
};
use std::array::from_fn;

#[test]
fn bad_parameters_are_refused() {
    let refused = |name: &str, position: usize, build: &dyn Fn(f64) -> Option<ModelError>, bad: &[f64]| {
        assert_eq!(build(1.0), None, "{name}, {position}");
        for value in bad {
            let error = build(*value).unwrap_or_else(|| panic!("{name}, {position}: {value}"));
            let shown = match error {
                ModelError::NotPositive { value, .. }
                | ModelError::Negative { value, .. }
                | ModelError::NotFinite { value, .. }
                | ModelError::NotPositiveDefinite { determinant: value } => value,
            };
            assert!(shown.to_bits() == value.to_bits() || matches!(error, ModelError::NotPositiveDefinite { .. }));
            assert!(error.to_string().contains(&shown.to_string()), "{error}");
        }
    };
    let positive = [0.0, -1.0, f64::NAN, f64::INFINITY];
    let not_negative = [-1e-9, f64::NAN, f64::INFINITY];
    let not_finite = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let put = |k: usize, x: f64| -> [f64; 5] { from_fn(|i| if i == k { x } else { 1.0 }) };
    for k in 0..5 {
        if k < 4 {
            refused(
                "disk",
                k,
                &|x| {
                    let p = put(k, x);
                    RollingDisk::new(p[0], p[1], p[2], p[3]).err()
                },
                &positive,
            );
        }
        if k < 2 {
            refused(
                "edge",
                k,
                &|x| {
                    let p = put(k, x);
                    KnifeEdge::new(p[0], p[1], 1.0).err()
                },
                &positive,
            );
        }
        if k < 3 {
            refused(
                "Suslov",
                k,
                &|x| {
                    let p = put(k, x);
                    Suslov::new([p[0], p[1], p[2]], 0.1, 0.1).err()
                },
                &positive,
            );
        }
        refused(
            "ball",
            k,
            &|x| {
                let p = put(k, x);
                ChaplyginBall::new(p[0], p[1], [p[2], p[3], p[4]]).err()
            },
            &positive,
        );
        refused(
            "board",
            k,
            &|x| {
                let p = put(k, x);
                Snakeboard::new(p[0], p[1], p[2], p[3], p[4]).err()
            },
            &positive,
        );
        refused(
            "racer",
            k,
            &|x| {
                let p = put(k, x);
                RollerRacer::new(p[0], p[1], p[2], p[3], p[4]).err()
            },
            &positive,
        );
    }
    for k in 0..3 {
        let p = |x| put(k, x);
        refused("pendulum", k, &|x| CompoundPendulum::new(p(x)[0], p(x)[1], p(x)[2], 1.0).err(), &positive);
        refused("ball on a table", k, &|x| TurntableBall::new(p(x)[0], p(x)[1], p(x)[2], 1.0).err(), &positive);
        refused(
            "sleigh on an arm",
            k,
            &|x| SleighOnArm::new(p(x)[0], p(x)[1], 0.1, p(x)[2], 2.0, 1.0).err(),
            &positive,
        );
    }
    for k in 0..2 {
        let p = |x| put(k, x);
        refused("isokinetic", k, &|x| IsokineticParticle::new(p(x)[0], p(x)[1], 1.0).err(), &positive);
    }
    refused("pendulum", 3, &|x| CompoundPendulum::new(1.0, 1.0, 1.0, x).err(), &not_finite);
    refused("ball on a table", 3, &|x| TurntableBall::new(1.0, 1.0, 1.0, x).err(), &not_finite);
    refused("isokinetic", 2, &|x| IsokineticParticle::new(1.0, 1.0, x).err(), &not_finite);
    refused("sleigh on an arm", 3, &|x| SleighOnArm::new(1.0, 1.0, x, 1.0, 2.0, 1.0).err(), &not_finite);
    refused("sleigh on an arm", 5, &|x| SleighOnArm::new(1.0, 1.0, 0.1, 1.0, 2.0, x).err(), &not_finite);
    // The arm must be longer than the hitch's distance: what is told is the difference.
    assert!(SleighOnArm::new(1.0, 1.0, 0.1, 1.0, 1.0, 0.0).is_err());
    refused("particle", 0, &|x| Particle::flat(x).err(), &positive);
    refused("particle", 1, &|x| Particle::in_well(1.0, x).err(), &not_negative);
    refused("edge", 2, &|x| KnifeEdge::new(1.0, 1.0, x).err(), &not_finite);
    refused("Suslov", 3, &|x| Suslov::new([2.0; 3], x, 0.5).err(), &not_finite);
    refused("Suslov", 4, &|x| Suslov::new([2.0; 3], 0.5, x).err(), &[2.0, f64::NAN]);
    refused("contact", 0, &|x| ContactOscillator::new(x).err(), &not_negative);
    refused("quartic", 0, &|x| QuarticOscillator::new(x).err(), &not_negative);
    let plain = ContactOscillator::new(0.0).unwrap();
    refused("gauged", 0, &|x| GaugedOscillator::new(plain, x).err(), &not_finite);
}
