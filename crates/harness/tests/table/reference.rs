//! Reference states computed elsewhere in many digits, and closed forms.

use crate::table::case::{Case, Facts, Point, Row};
use crate::table::shapes::{Four, Place, Three};
use crate::table::systems::{Field, InField, at_centre};
use crate::table::tools::method;
use sleigh::{CentreOfMass, Sleigh};
use test_systems::{Attitude, KnifeEdge, Model, Particle, RollingDisk, Suslov};

fn row<PathShape, const N: usize>(
    name: &'static str,
    system: impl Into<PathShape>,
    start: Place<N>,
    duration: f64,
) -> Row<PathShape, N> {
    Row { name, system: system.into(), start, duration, facts: Facts::default() }
}

const HIGH: [&str; 6] = ["dla8", "lobatto5", "gauss8", "gauss12", "gauss16", "energy8"];

/// `m = I = 1`, `a = 1/2`, `t = 10`, from a computation in 30 digits: `(X, Y, theta, u, omega)` at the centre of mass.
fn in_thirty_digits(methods: &[&str], steps: u64) {
    let cases = [
        (
            "free",
            Field::Free,
            [0.0, 0.0, 0.0, 1.0, 0.3],
            [8.630050962159051, 5.777081619895769, 0.7128922085503294, 1.054738987164179, 0.004531574197290071],
        ),
        (
            "well",
            Field::Well,
            [0.5, 0.0, 0.3, 0.4, 0.7],
            [-0.6032875134127324, 0.7304442206425285, 6.937651159895837, -0.3519104363064872, 0.0303902814569294],
        ),
        (
            "egg-crate",
            Field::EggCrate,
            [0.5, 1.0, 0.3, 0.4, 0.7],
            [6.116263299104192, 12.39178403258227, 1.011883547635337, 0.4666370265451718, 0.0372610222581567],
        ),
    ];
    for (name, field, start, end) in cases {
        let sleigh = CentreOfMass(Sleigh::new(1.0, 1.0, 0.5).unwrap());
        let case: Row<Three, 3> = row(name, InField { sleigh, field }, at_centre(start, 0.5), 10.0);
        let end = Point::of(&at_centre(end, 0.5));
        for name in methods {
            let error = case.end(&method(name), steps).unwrap().distance(&end);
            println!("{}, {name}: {error:.1e}", case.name());
            assert!(error <= 1e-11, "{}, {name}: {error:e}", case.name());
        }
        // The control: an order of two does not reach them.
        assert!(case.end(&method("dla"), steps).unwrap().distance(&end) > 1e-6);
    }
}

test_systems::short_and_full! {
    sleighs_in_thirty_digits => in_thirty_digits(&["lobatto5", "gauss8"], 100);
    sleighs_in_thirty_digits_in_full => in_thirty_digits(&HIGH, 400);
}

/// Ends on the closed form, by methods of high order; and the error of `dla` is the one published with it, in runs of `first` steps and of
/// twice and four times as many.
fn on_the_closed_form(case: &dyn Case, (methods, steps): (&[&str], u64), published: Option<[f64; 3]>, first: u64) {
    let exact = case.exact_from(&case.start(), case.duration()).unwrap();
    for name in methods {
        let error = case.end(&method(name), steps).unwrap().distance(&exact);
        println!("{}, {name}: {error:.1e}", case.name());
        assert!(error <= 1e-11, "{}, {name}: {error:e}", case.name());
    }
    let Some(published) = published else { return };
    for (k, expected) in published.into_iter().enumerate() {
        let error = case.end(&method("dla"), first << k).unwrap().distance(&exact);
        println!("{}, dla: {error:.3e}, published {expected:.3e}", case.name());
        // Three digits are given, and the last of them may be rounded.
        assert!((error / expected - 1.0).abs() < 0.03, "{}: {error:e}, published {expected:e}", case.name());
    }
}

fn on_closed_forms(by: (&[&str], u64)) {
    let disk = RollingDisk { m: 1.0, R: 1.0, I: 1.0, J: 1.0 };
    let disk: Row<Four, 4> = row("disk", disk, disk.start(), 1.0);
    on_the_closed_form(&disk, by, Some([2.96e-3, 7.4e-4, 1.8e-4]), 10);
    let particle = Particle { m: 1.0, k: 0.0 };
    let particle: Row<Three, 3> = row("particle", particle, particle.start(), 3.0);
    on_the_closed_form(&particle, by, Some([2.04e-3, 5.10e-4, 1.27e-4]), 20);
    let edge = KnifeEdge { m: 1.0, I: 1.0, g: 0.7 };
    let edge: Row<Three, 3> =
        row("knife edge", edge, ([0.1, 0.2, 0.3], [0.4 * 0.3f64.cos(), 0.4 * 0.3f64.sin(), 0.8]), 5.0);
    on_the_closed_form(&edge, by, None, 0);
}

test_systems::short_and_full! {
    closed_forms => on_closed_forms((&["dla8", "lobatto5", "gauss8"], 40));
    closed_forms_in_full => on_closed_forms((&HIGH, 400));
}

/// The angular velocity of the Suslov problem is known in closed form, its attitude is not.
fn suslov_by(methods: &[&str], steps: u64) {
    let body = Suslov::new([1.0, 2.0, 1.5], 0.3, 0.5);
    let angular_velocity = |point: &Point| {
        let [q, v]: [[f64; 4]; 2] = [&point.q, &point.v].map(|x| std::array::from_fn(|i| x[i]));
        Attitude::new(q).body_velocity(&v)
    };
    for name in methods {
        // The length of the quaternion as a constraint on positions, where the method takes one.
        let body = if name.starts_with("energy") { body.norm_by_rate() } else { body };
        let case: Row<Four, 4> = row("Suslov", body, body.start(), 3.0);
        let [o1, o2, _] = angular_velocity(&case.start());
        let exact = body.exact_reduced([o1, o2], case.duration);
        let end = angular_velocity(&case.end(&method(name), steps).unwrap());
        let error = (end[0] - exact[0]).abs().max((end[1] - exact[1]).abs());
        println!("Suslov, {name}: {error:.1e}");
        assert!(error <= 1e-11, "{name}: {error:e}");
    }
}

test_systems::short_and_full! {
    suslov => suslov_by(&["dla8", "gauss8", "energy8"], 40);
    suslov_in_full => suslov_by(&HIGH, 400);
}
