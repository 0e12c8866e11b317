use approx::assert_relative_eq;
use dla::{FullMechanics, Subject, has_derivatives};
use harness::Method;
use harness::analysis::{DiscreteMap, Equilibrium, EquilibriumError, StepLimit};
use lagrangian::With;
use sleigh::effects::{Bowl, Drag, EggCrate, Slope, Thrust, Torque};
use sleigh::{Flywheel, Guide, Guided, Sleigh, SleighState, TimeFunction};

fn relative_equilibria<const N: usize, const M: usize>(
    system: &dyn FullMechanics<N, M>,
    q: &[f64; N],
    v: &[f64; N],
) -> Result<Vec<Equilibrium>, EquilibriumError> {
    harness::analysis::relative_equilibria(&Subject::new(system, &()), (N, M), q, v).map(|all| all.found)
}

fn sleigh() -> Sleigh {
    Sleigh::new(1.3, 0.7, 0.4).unwrap()
}

fn start(speed: f64, turn_rate: f64) -> ([f64; 3], [f64; 3]) {
    SleighState { heading: 0.3, speed, turn_rate, ..SleighState::default() }.to_coordinates()
}

fn named(name: &str) -> Method {
    Method::named(name, None).unwrap()
}

fn with_speed(found: &[Equilibrium], sign: f64) -> &Equilibrium {
    found.iter().find(|e| e.xi[0] * sign > 0.0).unwrap()
}

/// Of the flow `-m a u0/J` and 0, of the map `(1 - h c u0/2)/(1 + h c u0/2)` and 1: to 1e-12.
#[test]
fn straight_motion_has_the_eigenvalues_of_the_book() {
    let sleigh = sleigh();
    let (q, v) = start(-1.2, 0.3);
    let found = relative_equilibria(&sleigh, &q, &v).unwrap();
    let energy = 0.5 * sleigh.mass() * 1.2 * 1.2 + 0.5 * sleigh.pivot_inertia() * 0.3 * 0.3;
    let speed = (2.0 * energy / sleigh.mass()).sqrt();
    for sign in [1.0, -1.0] {
        let straight = with_speed(&found, sign);
        let u = straight.xi[0];
        assert_relative_eq!(u, sign * speed, max_relative = 1e-14);
        assert!(straight.xi[1].abs() < f64::MIN_POSITIVE);
        assert_eq!((straight.family, straight.shape.len()), (1, 0));
        let rate = -sleigh.spin_gain() * u;
        let mut expected = [rate, 0.0];
        expected.sort_by(|a, b| b.total_cmp(a));
        for (z, x) in straight.flow.iter().zip(expected) {
            assert_relative_eq!(z[0], x, epsilon = 1e-12);
            assert_relative_eq!(z[1], 0.0, epsilon = 1e-12);
        }
        assert_eq!(straight.stable, sign > 0.0);

        let (subject, method) = (Subject::new(&sleigh, &()), named("dla"));
        let map = DiscreteMap::new(&subject, (3, 1), &method);
        for h in [0.01, 0.3, 1.5] {
            let half = 0.5 * h * -rate;
            let mut expected = [(1.0 - half) / (1.0 + half), 1.0];
            expected.sort_by(|a, b| b.abs().total_cmp(&a.abs()));
            for (z, x) in map.spectrum(h, straight).unwrap().iter().zip(expected) {
                assert_relative_eq!(z[0], x, epsilon = 1e-12);
                assert_relative_eq!(z[1], 0.0, epsilon = 1e-12);
            }
        }
    }
    // Rest, too, is one of the family.
    assert!(found.iter().any(|e| e.xi[0].abs() < 1e-8));
}

/// No step is too long for `dla`; the polynomial of `rk4` limits its step to 2.7853 over the rate.
#[test]
fn the_step_has_the_limit_of_its_method() {
    let sleigh = sleigh();
    let (q, v) = start(1.2, 0.0);
    let found = relative_equilibria(&sleigh, &q, &v).unwrap();
    let straight = with_speed(&found, 1.0);
    let limit = |name| DiscreteMap::new(&Subject::new(&sleigh, &()), (3, 1), &named(name)).limit(0.05, straight);
    assert!(matches!(limit("dla"), StepLimit::Beyond(h) if h > 100.0), "{:?}", limit("dla"));
    let limit = limit("rk4");
    let rate = sleigh.spin_gain() * 1.2;
    // |1 - z + z^2/2 - z^3/6 + z^4/24| = 1, where the slope is 1.8; a size of one has the rounding of a double eigenvalue, 1.2e-7.
    assert_relative_eq!(limit.step().unwrap() * rate, 2.785_293_563_405_28, max_relative = 1e-7);
    assert!(matches!(limit, StepLimit::Unstable(_)));
}

/// The terminal speed of thrust against drag stands alone: `u = F/c`, with the rates `-c/m` and `-(m a u + c')/J`.
#[test]
fn thrust_against_drag_has_one_speed() {
    let effects = (Thrust::new(0.6).unwrap(), Drag::new(0.4, 0.1).unwrap());
    let system = With { body: sleigh(), effects };
    let (q, v) = start(1.0, 0.2);
    let found = relative_equilibria(&system, &q, &v).unwrap();
    assert_eq!(found.len(), 1, "{found:?}");
    let (s, one) = (sleigh(), &found[0]);
    assert_relative_eq!(one.xi[0], 1.5, max_relative = 1e-12);
    assert_eq!(one.family, 0);
    let mut expected = [-0.4 / s.mass(), -(s.mass() * s.offset() * 1.5 + 0.1) / s.pivot_inertia()];
    expected.sort_by(|a, b| b.total_cmp(a));
    for (z, x) in one.flow.iter().zip(expected) {
        assert_relative_eq!(z[0], x, epsilon = 1e-12);
    }
}

/// At rest at the bottom of a bowl: the centre of mass swings along the blade with `sqrt(k/m)`, and turns about the blade with
/// `a sqrt(k/J)`; `dla` keeps both on the unit circle for every step.
#[test]
fn at_the_bottom_of_a_bowl_it_swings() {
    let (s, k) = (sleigh(), 0.9);
    let system = With { body: s, effects: Bowl::new([k, k], [0.2, 0.1]).unwrap() };
    let (q, v) = start(0.3, 0.1);
    let found = relative_equilibria(&system, &q, &v).unwrap();
    let rest = &found[0];
    assert_eq!(rest.shape, [0, 1, 2]);
    assert!(rest.xi.iter().all(|x| x.abs() < 1e-9));
    let mut frequencies = [(k / s.mass()).sqrt(), s.offset() * (k / s.pivot_inertia()).sqrt(), 0.0];
    frequencies.sort_by(f64::total_cmp);
    let mut found: Vec<f64> = rest.flow.iter().map(|z| z[1].abs()).collect();
    found.sort_by(f64::total_cmp);
    for (z, x) in found.iter().zip([frequencies[0], frequencies[1], frequencies[1], frequencies[2], frequencies[2]]) {
        assert_relative_eq!(*z, x, epsilon = 1e-7);
    }
    assert!(rest.stable);
    let map = DiscreteMap::new(&Subject::new(&system, &()), (3, 1), &named("dla")).spectrum(0.2, rest).unwrap();
    assert!(map.iter().all(|[re, im]| (re.hypot(*im) - 1.0).abs() < 1e-7), "{map:?}");
}

/// The rotor's angle is cyclic, and its spin one more parameter of the family.
#[test]
fn a_free_rotor_spins_along() {
    let system = Flywheel::new(sleigh(), 0.2, None).unwrap();
    let (q, v) = start(1.0, 0.0);
    let found = relative_equilibria(&system, &[q[0], q[1], q[2], 0.0], &[v[0], v[1], v[2], 2.0]).unwrap();
    let straight = with_speed(&found, 1.0);
    assert_eq!((straight.family, straight.shape.len(), straight.flow.len()), (2, 0, 3));
}

/// From a start on a ridge, and where no force turns the blade: a skate runs straight across the slope at any speed.
#[test]
fn a_skate_runs_across_the_slope() {
    let skate = Sleigh::new(1.0, 1.0, 0.0).unwrap();
    let system = With { body: skate, effects: Slope::new([0.3, 0.0]).unwrap() };
    let (q, v) = SleighState { speed: 1.0, turn_rate: 0.2, ..SleighState::default() }.to_coordinates();
    let found = relative_equilibria(&system, &q, &v).unwrap();
    assert_eq!(found[0].shape, [2]);
    assert!(found.iter().all(|e| e.q[2].cos().abs() < 1e-10 && e.xi[1].abs() < 1e-10), "{found:?}");
}

/// A landscape of hollows: the centre of mass rests where the force on it is none.
#[test]
fn a_hollow_of_the_egg_crate_is_found() {
    let system = With { body: sleigh(), effects: EggCrate::new(0.5, [1.0, 1.0]).unwrap() };
    let (q, v) = SleighState { x: 2.6, y: 2.9, speed: 0.1, turn_rate: 0.1, ..SleighState::default() }.to_coordinates();
    let found = relative_equilibria(&system, &q, &v).unwrap();
    let rest = found.iter().find(|e| e.stable).unwrap();
    let centre = [rest.q[0] + 0.4 * rest.q[2].cos(), rest.q[1] + 0.4 * rest.q[2].sin()];
    for x in centre {
        assert_relative_eq!(x, std::f64::consts::PI, epsilon = 1e-9);
    }
}

#[test]
fn what_has_none_says_so() {
    // A thrust that nothing brakes: every sleigh gathers speed.
    check_what_has_none(&With { body: sleigh(), effects: Thrust::new(0.6).unwrap() });
}

#[test]
#[ignore = "slow"]
fn what_has_none_says_so_in_full() {
    // On a slope every sleigh gathers speed or turns.
    check_what_has_none(&With { body: sleigh(), effects: Slope::new([0.3, 0.0]).unwrap() });
}

fn check_what_has_none(restless: &dyn FullMechanics<3, 1>) {
    let (q, v) = start(1.0, 0.2);
    assert!(matches!(relative_equilibria(restless, &q, &v), Err(EquilibriumError::NoneFound { .. })));
    // At time zero its slope vanishes.
    let sine = TimeFunction::Sine { amplitude: 0.2, frequency: 1.0, phase: std::f64::consts::FRAC_PI_2 };
    let shaken = With { body: sleigh(), effects: Torque::new(sine).unwrap() };
    assert_eq!(relative_equilibria(&shaken, &q, &v), Err(EquilibriumError::TimeDependent));
    let servo = Guided::<2>::servo(sleigh(), 1.0.into(), 0.1.into()).unwrap();
    assert_eq!(relative_equilibria(&servo, &q, &v), Err(EquilibriumError::NothingFree));
    // The positive control: one velocity imposed leaves the other, and its rate.
    let towed = Guided::<1>::servo(sleigh(), Guide::Speed(1.5.into())).unwrap();
    let found = relative_equilibria(&towed, &q, &v).unwrap();
    assert_relative_eq!(found[0].flow[0][0], -sleigh().spin_gain() * 1.5, epsilon = 1e-12);
}

#[test]
fn methods_that_are_not_differentiated_here_are_none() {
    let found = |name| has_derivatives(&named(name));
    assert!(found("dla").is_ok() && found("rk4").is_ok() && found("dop853").is_err());
}
