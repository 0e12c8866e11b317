//! The ball on a turntable: constraints affine in the velocities, one on positions, and a moving energy.

use crate::constraints::tools::{Largest, assert_order, end, misses};
use crate::support::Six;
use dla::{Composition, Dla, Gauss, Lobatto, OneStep, Schedule, State, View, drive};
use test_systems::{Model, TurntableBall};

fn ball() -> TurntableBall {
    TurntableBall::new(1.3, 0.6, 0.4 * 1.3 * 0.36, 1.7)
}

/// Errors of the centre's place and velocity at the time 2, against its circle.
fn errors<Method: OneStep<6, 3> + Clone>(method: &Method) -> [f64; 4] {
    let ball = ball();
    let (place, velocity) = ball.centre_from(&ball.start(), 2.0);
    [20, 40, 80, 160].map(|steps| {
        let end = end(&Six::from(ball), &mut method.clone(), ball.start(), 2.0 / steps as f64, steps);
        (0..2).fold(0.0, |m, i| f64::max(m, (end.q()[i] - place[i]).abs()).max((end.v()[i] - velocity[i]).abs()))
    })
}

/// The largest error of the moving energy, and of the energy, over a run.
fn energies<Method: OneStep<6, 3>>(method: &mut Method, steps: u64) -> [f64; 2] {
    let ball = ball();
    let (q, v) = ball.start();
    let (moving, still) = (ball.moving_energy(&q, &v), lagrangian::energy(&ball, 0.0, &q, &v));
    let mut kept = Largest::of(|node: &View<'_>| {
        let state = node.state.typed().unwrap();
        (ball.moving_energy(state.q(), state.v()) - moving).abs()
    });
    let mut lost = Largest::of(|node: &View<'_>| (node.energy() - still).abs());
    let schedule = Schedule { t0: 0.0, step: 0.05, steps };
    drive(&Six::from(ball), method, &schedule, &mut State::new(q, v, [false; 6]), (&mut kept, &mut lost)).unwrap();
    [kept.value, lost.value]
}

#[test]
fn the_centre_runs_its_circle() {
    assert_order("dla", errors(&Dla::midpoint()), 2.0);
    assert_order("dla4", errors(&Composition::suzuki4(Dla::midpoint())), 4.0);
    assert_order("lobatto3", errors(&Lobatto::<3>::new()), 4.0);
    assert_order("gauss4", errors(&Gauss::new::<2>()), 4.0);
}

/// The variational methods keep the moving energy of this ball to round-off, Gauss collocation keeps it near, by its order;
/// none keeps the energy, which is not constant.
fn kept_by_variational_methods(steps: u64) -> f64 {
    // One rounding a step of terms of up to 4 J, adding up as a random walk does.
    let walk = 4.0 * 4.0 * f64::EPSILON * (steps as f64).sqrt();
    for (name, [kept, lost]) in
        [("dla", energies(&mut Dla::midpoint(), steps)), ("lobatto3", energies(&mut Lobatto::<3>::new(), steps))]
    {
        println!("{name}: moving energy {kept:e}, energy {lost:e}");
        assert!(kept <= walk && lost > 0.5, "{name}: moving energy {kept:e}, energy {lost:e}");
    }
    walk
}

/// Once around the circle.
#[test]
fn moving_energy() {
    let walk = kept_by_variational_methods(260);
    let [near, _] = energies(&mut Gauss::new::<2>(), 100);
    println!("gauss4: moving energy {near:e}");
    assert!(near > 10.0 * walk, "no longer a control: {near:e}");
}

#[test]
#[ignore = "slow"]
fn moving_energy_at_length() {
    let steps = 10_000;
    kept_by_variational_methods(steps);
    let [short, _] = energies(&mut Gauss::new::<2>(), steps / 10);
    let [long, _] = energies(&mut Gauss::new::<2>(), steps);
    println!("gauss4: moving energy {short:e}, {long:e}");
    assert!(short > 1e-8 && long <= 1.01 * short);
}

/// Contact and length of the quaternion.
fn contact_and_quaternion(dla: u64, gauss: u64) {
    let ball = ball();
    for [g, slip] in [
        misses(&Six::from(ball), &mut Dla::midpoint(), ball.start(), 0.05, dla),
        misses(&Six::from(ball), &mut Gauss::new::<2>(), ball.start(), 0.05, gauss),
    ] {
        println!("g {g:e}, slip {slip:e}");
        assert!(g <= 1e-14 && slip <= 1e-14);
    }
}

#[test]
fn contact_and_quaternion_hold() {
    contact_and_quaternion(1000, 300);
}

#[test]
#[ignore = "slow"]
fn contact_and_quaternion_hold_in_full() {
    contact_and_quaternion(100_000, 10_000);
}
