//! Every method on shapes of up to sixty coordinates: they take long to compile, and are compiled for builds with optimisation only.

use crate::large::fleet::{Balls, Ended, Fleet, Known, Mirror, on_stack};
use crate::large::{SECOND, STACK, ends, is_too_large, with_stack};
use dla::{
    Composition, Dla, Dop853, Energy, Form, Gauss, GaussAdaptive, Gni, ImplicitMidpoint, Lobatto, OneStep, Rk4,
    Rk4Projected, Rk4Reduced, Sensitivity, SensitivityError, State, StepError, consistent_start,
};
use lagrangian::{System, classify};

/// Errors of the fourth order after twenty steps of a hundredth.
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
#[ignore = "slow"]
fn thirty_by_the_discrete_principle_in_full() {
    discrete::<30, 10>();
}

#[test]
#[ignore = "slow"]
fn thirty_nine_by_the_discrete_principle() {
    discrete::<39, 13>();
}

#[test]
#[ignore = "slow"]
fn sixty_by_the_discrete_principle() {
    discrete::<60, 20>();
}

/// Rows that depend on one another are found where equations have failed, which takes more than a step that succeeds.
#[test]
#[ignore = "slow"]
fn sixty_with_a_row_that_says_the_same() {
    ends("twice", on_stack::<Balls<60, true>, _, 60, 20>(STACK, Dla::midpoint), SECOND);
}

/// The counter-example holds the constraint in the mean of two steps only.
#[test]
#[ignore = "slow"]
fn sixty_by_reflections() {
    let end = on_stack::<Fleet<60, false>, _, 60, 20>(STACK, Gni::default).unwrap();
    assert!(end.error <= SECOND && end.slip <= 1e-3, "{end:?}");
    let error = on_stack::<Balls<60, false>, _, 60, 20>(STACK, Gni::default).unwrap_err();
    assert!(matches!(error.source, StepError::Unsupported { .. }));
}

#[test]
#[ignore = "slow"]
fn sixty_by_gauss_collocation() {
    ends("order 4", on_stack::<Fleet<60, true>, _, 60, 20>(STACK, Gauss::new::<2>), FOURTH);
    ends("order 16", on_stack::<Fleet<60, true>, _, 60, 20>(STACK, Gauss::new::<8>), ROUNDING);
    ends("adaptive", on_stack::<Fleet<60, true>, _, 60, 20>(STACK, || GaussAdaptive::new::<8>(1e-13)), ROUNDING);
}

/// All stages are one system of equations: fewer coordinates the more there are.
#[test]
#[ignore = "slow"]
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
#[ignore = "slow"]
fn by_methods_that_keep_the_energy_in_full() {
    ends("order 2 of 18", on_stack::<Fleet<18, true>, _, 18, 6>(STACK, Energy::new::<1>), SECOND);
    ends("order 8 of 18", on_stack::<Fleet<18, true>, _, 18, 6>(STACK, Energy::new::<4>), ROUNDING);
    is_too_large("order 2", on_stack::<Fleet<30, true>, _, 30, 10>(STACK, Energy::new::<1>), (30, 10));
    is_too_large("order 8", on_stack::<Fleet<60, true>, _, 60, 20>(STACK, Energy::new::<4>), (60, 20));
}

/// A start moved onto the constraints, and what these are.
#[test]
#[ignore = "slow"]
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
    let (moved, off, rank, integrable) = with_stack(STACK, begin);
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
    with_stack(STACK, step)
}

#[test]
#[ignore = "slow"]
fn derivatives_of_steps() {
    let error = differentiated::<Fleet<60, true>, 60, 20>().unwrap_err();
    assert!(matches!(error, SensitivityError::Step(StepError::TooLarge { coordinates: 60, constraints: 20, .. })));
}

/// Nothing of it is on the heap instead.
#[test]
#[ignore = "slow"]
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

fn measured<Method: OneStep<60, 20>>(method: impl FnOnce() -> Method + Send + 'static) -> Ended {
    on_stack::<Fleet<60, true>, _, 60, 20>(STACK, method).unwrap()
}

/// Baselines, to the errors of their orders; only those in a basis, or projected, stay on the constraint.
#[test]
#[ignore = "slow"]
fn sixty_by_baselines() {
    for (end, error, slip) in [
        (measured(|| Rk4), 1e-8, 1e-8),
        (measured(|| Rk4Projected), 1e-8, 1e-13),
        (measured(|| Rk4Reduced), 1e-8, 1e-13),
        (measured(ImplicitMidpoint::default), 2e-4, 1e-4),
        (measured(|| Dop853::new(1e-10)), 1e-9, 1e-13),
    ] {
        assert!(end.error <= error && end.slip <= slip, "{end:?}");
    }
    let projected = on_stack::<Balls<60, false>, _, 60, 20>(STACK, || Rk4Projected).unwrap();
    assert!(projected.error <= 1e-8 && projected.slip <= 1e-13 && projected.off <= 1e-8, "{projected:?}");
}
