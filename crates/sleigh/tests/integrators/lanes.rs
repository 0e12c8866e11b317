//! Taylor series in lanes are those of one trajectory.

use approx::assert_abs_diff_eq;
use dla::{Each, Ensemble, LaneState, OneStep, Same, State};
use lagrangian::{System, With, velocity_of};
use proptest::prelude::*;
use sleigh::effects::{Bowl, EggCrate};
use sleigh::series::InOwnAxes;
use sleigh::{RoundWell, Sleigh, Taylor, TaylorEnsemble};

const W: usize = 16;

/// One trajectory by the code of one trajectory.
fn alone<Sys>(system: &Sys, (h, epsilon): (f64, f64), (q, xi): ([f64; 3], [f64; 3])) -> Option<State<3>>
where
    Sys: System<3, 1> + InOwnAxes,
{
    let v = velocity_of(system, 0.0, &q, &xi).unwrap();
    let mut state = State::new(q, v, system.angles());
    let made =
        (0..3).try_for_each(|_| Taylor::of(system, epsilon).unwrap().step(system, 0.0, h, &mut state).map(|_| ()));
    made.ok().map(|()| state)
}

fn starts() -> impl Strategy<Value = ([f64; 3], [f64; 3])> {
    (proptest::array::uniform3(-2.0..2.0f64), -1.5..1.5f64, -1.5..1.5f64).prop_map(|(q, u, w)| (q, [u, w, 0.0]))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Each with its own sleigh and well, on the plane and in its own axes, forward and backward. The sums are taken in another order,
    /// and what differs by rounding at a step's beginning may give it another length, within the tolerance.
    #[test]
    fn lanes_are_alone(
        members in proptest::collection::vec((0.3..3.0f64, 0.3..3.0f64, -1.0..1.0f64, 0.0..0.3f64, starts()), W),
        center in proptest::array::uniform2(-2.0..2.0f64), backward: bool,
    ) {
        let h = if backward { -0.7 } else { 0.7 };
        let state = LaneState::new(&members.iter().map(|member| member.4).collect::<Vec<_>>(), [false, false, true]);
        let body = |i: usize| Sleigh::new(members[i].0, members[i].1, members[i].2).unwrap();
        let free: [_; W] = std::array::from_fn(body);
        let bowls: [_; W] = std::array::from_fn(|i| {
            With { body: body(i), effects: Bowl::new([members[i].3; 2], center).unwrap() }
        });
        let wells: [_; W] = std::array::from_fn(|i| RoundWell::new(body(i), members[i].3, center).unwrap());
        fn check<Sys: System<3, 1> + InOwnAxes>(systems: &[Sys; W], h: f64, state: LaneState<3, W>) {
            let mut ensemble = TaylorEnsemble::new(&Each(systems), (h, 1e-14), state).unwrap();
            ensemble.advance(3);
            for lane in 0..W {
                let expected = alone(&systems[lane], (h, 1e-14), (state.q(lane), state.xi(lane))).unwrap();
                let found = ensemble.state().lane(lane, *expected.v());
                for k in 0..3 {
                    // Some ten steps of errors of 1e-14, in numbers of some units that two seconds enlarge by e^6 at most.
                    assert_abs_diff_eq!(found.unwrapped()[k], expected.unwrapped()[k], epsilon = 1e-10);
                    assert_abs_diff_eq!(ensemble.state().xi(lane)[k], expected.xi().unwrap()[k], epsilon = 1e-10);
                }
            }
        }
        check(&free, h, state);
        check(&bowls, h, state);
        check(&wells, h, state);
    }
}

/// One that cannot be crossed is lost, and changes no bit of the others.
#[test]
fn a_lost_lane_is_alone() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let run = |wild: f64| {
        let starts: Vec<_> =
            (0..W).map(|i| ([0.0; 3], [-1.0, if i == 5 { wild } else { 0.1 + 0.01 * i as f64 }, 0.0])).collect();
        let state = LaneState::<3, W>::new(&starts, [false, false, true]);
        let mut ensemble = TaylorEnsemble::new(&Same(&sleigh), (20.0, 1e-9), state).unwrap();
        ensemble.advance(2);
        *ensemble.state()
    };
    let (tame, wild) = (run(0.1), run(1e60));
    assert!(tame.is_finite(5) && !wild.is_finite(5) && !run(f64::NAN).is_finite(5));
    for lane in (0..W).filter(|lane| *lane != 5) {
        assert_eq!(tame.q(lane).map(f64::to_bits), wild.q(lane).map(f64::to_bits));
        assert_eq!(tame.xi(lane).map(f64::to_bits), wild.xi(lane).map(f64::to_bits));
    }
}

#[test]
fn what_has_no_such_equations_has_no_ensemble() {
    let body = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let state = LaneState::<3, 8>::new(&[], [false, false, true]);
    let rough = With { body, effects: EggCrate::new(0.1, [1.0, 1.0]).unwrap() };
    assert!(TaylorEnsemble::new(&Same(&rough), (1.0, 1e-9), state).is_none());
    assert!(TaylorEnsemble::new(&Same(&body), (1.0, 1e-9), state).is_some());
}
