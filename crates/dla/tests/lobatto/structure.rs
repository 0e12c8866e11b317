use crate::energy::systems::{Potential, at_centre, com, run};
use crate::lobatto::systems::{Forces, Moving, distance, sleigh};
use crate::support::{ByHand, Three};
use allocation_counter::measure;
use dla::{Dla, Lobatto, OneStep, State};
use lagrangian::{Motion, System, constraint_residual};

const MOVING: ([f64; 3], [f64; 3]) = ([0.3, 0.0, 0.0], [0.6, 0.5, -0.36]);

/// With a constant mass matrix, two stages are the trapezoidal rule: the same states and the same impulses.
#[test]
fn two_stages_are_the_trapezoid() {
    let system = com(0.5, (Potential::EggCrate, Forces));
    let (q, v) = at_centre([0.5, 1.0, 0.3, 0.4, 0.7], 0.5);
    let mut states = [State::new(q, v, system.angles()); 2];
    let (mut lobatto, mut trapezoid) = (Lobatto::<2>::new(), Dla::trapezoid());
    for k in 0..200 {
        let t = 0.1 * f64::from(k);
        let [left, right] = &mut states;
        let reports = [lobatto.step(&system, t, 0.1, left), trapezoid.step(&system, t, 0.1, right)].map(Result::unwrap);
        let apart = distance(left, &(right.unwrapped(), *right.v()));
        assert!(apart < 1e-13, "step {k}: {apart:e}");
        for end in 0..2 {
            let [a, b] = [0, 1].map(|i: usize| reports[i].impulses[end][0]);
            assert!((a - b).abs() < 1e-13, "step {k}, impulse {end}: {a} and {b}");
        }
    }
    // The control: with a mass matrix that depends on the heading they differ.
    let blade = ByHand::from(sleigh(0.5));
    let start = ([0.0; 3], [0.4, 0.0, 0.7]);
    let end = run(&blade, &mut trapezoid, &start, (1.0, 10));
    assert!(distance(&run(&blade, &mut lobatto, &start, (1.0, 10)), &(end.unwrapped(), *end.v())) > 1e-5);
}

/// How far from its start a run there and back ends; time runs back with negative steps.
fn return_error<Sys, Method>(system: &Sys, method: &mut Method, (q, v): ([f64; 3], [f64; 3])) -> f64
where
    Sys: System<3, 1>,
    Method: OneStep<3, 1>,
{
    let (h, steps) = (0.1, 50);
    let mut state = State::new(q, v, system.angles());
    for k in 0..steps {
        method.step(system, f64::from(k) * h, h, &mut state).unwrap();
    }
    for k in (0..steps).rev() {
        method.step(system, f64::from(k + 1) * h, -h, &mut state).unwrap();
    }
    distance(&state, &(q, v))
}

fn symmetric<const S: usize>() {
    let centre = at_centre([0.5, 1.0, 0.3, 0.4, 0.7], 0.5);
    let errors = [
        return_error(&com(0.5, Potential::EggCrate), &mut Lobatto::<S>::new(), centre),
        return_error(&com(0.5, Forces), &mut Lobatto::<S>::new(), centre),
        return_error(&Three::from(Moving), &mut Lobatto::<S>::new(), MOVING),
    ];
    println!("S = {S}: there and back {errors:?}");
    assert!(errors.iter().all(|error| *error < 1e-12), "S = {S}: {errors:?}");
}

#[test]
fn self_adjoint() {
    symmetric::<2>();
    // The control: a method that is not.
    let start = at_centre([0.5, 1.0, 0.3, 0.4, 0.7], 0.5);
    let one_sided = return_error(&com(0.5, Potential::EggCrate), &mut Dla::alpha(0.25).unwrap(), start);
    assert!(one_sided > 1e-4, "{one_sided:e}");
}

fn constrained<const S: usize>(steps: u32) {
    let (system, (q, v)) = (com(0.5, Potential::EggCrate), at_centre([0.5, 1.0, 0.3, 0.4, 0.7], 0.5));
    let h = 0.2;
    let mut state = State::new(q, v, system.angles());
    let mut method = Lobatto::<S>::new();
    let (mut largest, mut iterations) = (0.0f64, 0);
    for k in 0..steps {
        let t = h * f64::from(k);
        iterations += method.step(&system, t, h, &mut state).unwrap().iterations;
        let [slip] = constraint_residual(&system, t + h, state.q(), state.v());
        largest = largest.max(slip.abs());
    }
    let mean = f64::from(iterations) / f64::from(steps);
    println!("S = {S}, h = {h}: slip {largest:.1e}, {mean:.2} Newton iterations a step");
    assert!(largest <= 1e-13 && mean < 6.0, "S = {S}: slip {largest:e}, {mean} iterations");
}

#[test]
fn the_nodes_are_on_the_constraint() {
    constrained::<2>(400);
    constrained::<4>(400);
}

#[test]
#[ignore = "slow"]
fn the_nodes_are_on_the_constraint_in_full() {
    constrained::<2>(10_000);
    constrained::<4>(10_000);
}

/// The impulses of a step add up to the time integral of the multiplier.
#[test]
fn the_impulses_are_those_of_the_motion() {
    let system = com(0.5, Potential::EggCrate);
    let start = at_centre([0.5, 1.0, 0.3, 0.4, 0.7], 0.5);
    let h = 0.1;
    let mut state = State::new(start.0, start.1, system.angles());
    let report = Lobatto::<5>::new().step(&system, 0.0, h, &mut state).unwrap();
    let multiplier = |s: &State<3>| Motion::of(&system, 0.0, s.q(), s.v()).unwrap().multiplier[0];
    // Simpson's rule on a fine subdivision.
    let (mut fine, mut sum) = (State::new(start.0, start.1, system.angles()), 0.0);
    for k in 0..=20 {
        let weight = if k == 0 || k == 20 { 1.0 } else { 2.0 + 2.0 * f64::from(k % 2) };
        sum += weight * h / 60.0 * multiplier(&fine);
        Lobatto::<5>::new().step(&system, 0.0, h / 20.0, &mut fine).unwrap();
    }
    let total = report.impulses[0][0] + report.impulses[1][0];
    println!("impulse {total}, integral {sum}");
    assert!((total - sum).abs() < 1e-9 && sum.abs() > 1e-3);
}

fn free_of_allocation<const S: usize>() {
    let system = com(0.5, (Potential::EggCrate, Forces));
    let (q, v) = at_centre([0.5, 1.0, 0.3, 0.4, 0.7], 0.5);
    let (mut state, mut method) = (State::new(q, v, system.angles()), Lobatto::<S>::new());
    let counts = measure(|| {
        for k in 0..100 {
            method.step(&system, 0.1 * f64::from(k), 0.1, &mut state).unwrap();
        }
    });
    assert_eq!(counts.count_total, 0, "S = {S}");
}

/// Not even in the first step.
#[test]
fn nothing_is_allocated() {
    free_of_allocation::<2>();
    free_of_allocation::<3>();
    free_of_allocation::<5>();
    free_of_allocation::<8>();
    // The control: the counter counts.
    assert_eq!(measure(|| drop(std::hint::black_box(vec![1.0; 3]))).count_total, 1);
}
