//! Systems of up to sixty coordinates on threads with the stack that the methods count on, and no more.

#![allow(missing_docs, unreachable_pub, clippy::panic, clippy::unwrap_used, clippy::expect_used)]

mod fleet;

use dla::{
    Composition, Dla, Energy, Form, Gauss, GaussAdaptive, Gni, Hint, Lobatto, OneStep, RunError, Sensitivity,
    SensitivityError, StackUse, State, StepError, consistent_start,
};
use fleet::{Balls, Ended, Fleet, Known, Mirror, on_stack};
use lagrangian::{System, classify};

/// Methods that count what they take compare it with this; so no run may need more, the caller's part included.
const STACK: usize = StackUse::LIMIT;

/// A run that ends, on the constraint and no further from the motion than this.
fn ends(what: &str, run: Result<Ended, RunError>, error: f64) {
    let end = run.unwrap_or_else(|error| panic!("{what}: {error}"));
    println!("{what}: {end:?}");
    assert!(end.error <= error && end.slip <= 1e-13 && end.off <= 1e-14, "{what}: {end:?}");
}

/// A run that is refused before its first step, with the size of the system and what it would take.
fn is_too_large(what: &str, run: Result<Ended, RunError>, size: (usize, usize)) {
    let Err(RunError { step: 1, source, .. }) = run else { panic!("{what}: {run:?}") };
    let StepError::TooLarge { coordinates, constraints, bytes, limit } = source else { panic!("{what}: {source}") };
    assert_eq!((coordinates, constraints, limit), (size.0, size.1, StackUse::LIMIT));
    assert!(bytes > limit, "{what}: {bytes}");
    assert_eq!(source.hint(), Some(Hint::LessStack));
    let message = source.to_string();
    assert!(message.contains(&format!("{} coordinates and {} constraints", size.0, size.1)), "{message}");
}

/// Errors of the second order after twenty steps of a hundredth, and of the fourth.
const SECOND: f64 = 2e-4;
const FOURTH: f64 = 1e-8;
/// Of orders of which nothing but rounding is left.
const ROUNDING: f64 = 1e-12;

/// The discrete Lagrange-d'Alembert methods: in a basis, with multipliers, on positions, and composed.
fn discrete<const N: usize, const M: usize>()
where
    Fleet<N, true>: Known<N, M>,
    Fleet<N, false>: Known<N, M>,
    Balls<N, false>: Known<N, M>,
{
    ends("in the basis", on_stack::<Fleet<N, true>, _, N, M>(STACK, Dla::midpoint), SECOND);
    ends(
        "multipliers",
        on_stack::<Fleet<N, true>, _, N, M>(STACK, || Dla::midpoint().solved(Form::Multipliers)),
        SECOND,
    );
    ends("without a basis", on_stack::<Fleet<N, false>, _, N, M>(STACK, Dla::midpoint), SECOND);
    ends("positions", on_stack::<Balls<N, false>, _, N, M>(STACK, Dla::midpoint), SECOND);
    ends("order 4", on_stack::<Balls<N, false>, _, N, M>(STACK, || Composition::suzuki4(Dla::midpoint())), FOURTH);
}

#[test]
fn thirty_by_the_discrete_principle() {
    discrete::<30, 10>();
}

#[test]
fn thirty_nine_by_the_discrete_principle() {
    discrete::<39, 13>();
}

#[test]
fn sixty_by_the_discrete_principle() {
    discrete::<60, 20>();
}

/// Rows that depend on one another are found where equations have failed, which takes more than a step that succeeds.
#[test]
fn sixty_with_a_row_that_says_the_same() {
    ends("twice", on_stack::<Balls<60, true>, _, 60, 20>(STACK, Dla::midpoint), SECOND);
}

/// The counter-example holds the constraint in the mean of two steps only.
#[test]
fn sixty_by_reflections() {
    let end = on_stack::<Fleet<60, false>, _, 60, 20>(STACK, Gni::default).unwrap();
    assert!(end.error <= SECOND && end.slip <= 1e-3, "{end:?}");
    let error = on_stack::<Balls<60, false>, _, 60, 20>(STACK, Gni::default).unwrap_err();
    assert!(matches!(error.source, StepError::Unsupported { .. }));
}

#[test]
fn sixty_by_gauss_collocation() {
    ends("order 4", on_stack::<Fleet<60, true>, _, 60, 20>(STACK, Gauss::new::<2>), FOURTH);
    ends("order 16", on_stack::<Fleet<60, true>, _, 60, 20>(STACK, Gauss::new::<8>), ROUNDING);
    ends("adaptive", on_stack::<Fleet<60, true>, _, 60, 20>(STACK, || GaussAdaptive::new::<8>(1e-13)), ROUNDING);
}

/// All stages are one system of equations: fewer coordinates the more there are.
#[test]
fn by_lobatto_stages() {
    ends("two stages of 30", on_stack::<Balls<30, false>, _, 30, 10>(STACK, Lobatto::<2>::new), SECOND);
    ends("three of 30", on_stack::<Balls<30, false>, _, 30, 10>(STACK, Lobatto::<3>::new), FOURTH);
    ends("five of 30", on_stack::<Fleet<30, true>, _, 30, 10>(STACK, Lobatto::<5>::new), ROUNDING);
    ends("three of 39", on_stack::<Fleet<39, true>, _, 39, 13>(STACK, Lobatto::<3>::new), FOURTH);
    is_too_large("five of 39", on_stack::<Fleet<39, true>, _, 39, 13>(STACK, Lobatto::<5>::new), (39, 13));
    is_too_large("three of 60", on_stack::<Balls<60, false>, _, 60, 20>(STACK, Lobatto::<3>::new), (60, 20));
    is_too_large("five of 60", on_stack::<Fleet<60, true>, _, 60, 20>(STACK, Lobatto::<5>::new), (60, 20));
}

/// A basis at eight places at once takes the most.
#[test]
fn by_methods_that_keep_the_energy() {
    ends("order 2 of 18", on_stack::<Fleet<18, true>, _, 18, 6>(STACK, Energy::new::<1>), SECOND);
    ends("order 8 of 18", on_stack::<Fleet<18, true>, _, 18, 6>(STACK, Energy::new::<4>), ROUNDING);
    is_too_large("order 2", on_stack::<Fleet<30, true>, _, 30, 10>(STACK, Energy::new::<1>), (30, 10));
    is_too_large("order 8", on_stack::<Fleet<60, true>, _, 60, 20>(STACK, Energy::new::<4>), (60, 20));
}

/// A start moved onto the constraints, and what these are.
#[test]
fn sixty_begin() {
    let begin = || {
        let mirror = Mirror::new();
        let (mut x, w) = Balls::<60, false>::at(0.0);
        x[0] += 1e-3;
        let system = Balls::<60, false>(mirror);
        let start = consistent_start(&system, 0.0, &mirror.of(&x), &mirror.of(&w)).unwrap();
        let here = classify(&system, 0.0, &start.q, &start.v);
        (start.moved, lagrangian::position_residual(&system, 0.0, &start.q), here.rank, here.integrable())
    };
    let (moved, off, rank, integrable) =
        std::thread::Builder::new().stack_size(STACK).spawn(begin).unwrap().join().unwrap();
    // Back to the sphere along the radius.
    assert!((moved - 1e-3).abs() <= 1e-9 && off <= 1e-15, "{moved} {off}");
    assert_eq!((rank, integrable), (20, true));
}

/// The derivative of one step, on a thread of its own.
fn differentiated<Sys: Known<N, M>, const N: usize, const M: usize>() -> Result<f64, SensitivityError> {
    let step = || {
        let system = Sys::new();
        let (mirror, start) = (*system.mirror(), Sys::at(0.0));
        let mut state = State::new(mirror.of(&start.0), mirror.of(&start.1), [false; N]);
        let derivative = Sensitivity::of(&system).step(&mut Dla::midpoint(), 0.0, 0.01, &mut state)?;
        // Along the motion itself: q1 = q0 + h v, to first order in the velocity for circles at a constant turning rate.
        Ok((0..N).map(|i| derivative.from_v[i].q[i]).sum())
    };
    std::thread::Builder::new().stack_size(STACK).spawn(step).unwrap().join().unwrap()
}

#[test]
fn derivatives_of_steps() {
    let error = differentiated::<Fleet<60, true>, 60, 20>().unwrap_err();
    assert!(matches!(error, SensitivityError::Step(StepError::TooLarge { coordinates: 60, constraints: 20, .. })));
}

/// Nothing of it is on the heap instead.
#[test]
fn steps_allocate_nothing() {
    fn allocations<Sys: System<60, 20>, Method: OneStep<60, 20>>(
        system: &Sys,
        mut method: Method,
        state: &mut State<60>,
    ) -> u64 {
        allocation_counter::measure(|| {
            method.step(system, 0.0, 0.01, state).unwrap();
        })
        .count_total
    }
    let mirror = Mirror::new();
    let (x, w) = <Fleet<60, true> as Known<60, 20>>::at(0.0);
    let mut state = State::new(mirror.of(&x), mirror.of(&w), [false; 60]);
    assert_eq!(allocations(&Fleet::<60, true>(mirror), Dla::midpoint(), &mut state), 0);
    assert_eq!(allocations(&Fleet::<60, true>(mirror), Gauss::new::<4>(), &mut state), 0);
}

/// The count grows with the system, whatever the method, and small systems are far below the limit.
#[test]
fn counts() {
    const USE: StackUse = StackUse { squares: 20, rows: 20 };
    assert!(USE.bytes::<3, 1>() < USE.bytes::<3, 2>() && USE.bytes::<3, 2>() < USE.bytes::<4, 2>());
    assert!(USE.bytes::<3, 1>() < StackUse::LIMIT / 16 && !USE.exceeds::<8, 5>());
    assert!(USE.exceeds::<100, 90>());
}
