//! Ensembles: the same rows on any number of threads and from any group on, and summaries that lanes and single runs share.

use approx::assert_abs_diff_eq;
use dla::{LaneState, Schedule};
use harness::Method;
use harness::ensemble::{Summary, Watching, in_order, summarise, watch};
use lagrangian::{With, velocity_of};
use sleigh::{ClosedEnsemble, Sleigh, SleighState};
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicU64, Ordering};

const W: usize = 16;

fn start(member: u64) -> ([f64; 3], [f64; 3]) {
    ([0.1, 0.2, 0.3], [-1.0, 0.1 + 0.01 * member as f64, 0.0])
}

fn words(state: &SleighState) -> [f64; 3] {
    [state.x, state.speed, state.turn_rate]
}

/// The summaries of some members by the closed map.
fn group(members: Range<u64>) -> Vec<Option<Summary<[f64; 3]>>> {
    let sleighs = [Sleigh::new(1.0, 1.0, 0.5).unwrap(); W];
    let starts: Vec<_> = members.map(start).collect();
    let state = LaneState::new(&starts, [false, false, true]);
    let mut ensemble = ClosedEnsemble::new(sleighs, 0.05, state);
    let of = |_: f64, q: &[f64; 3], v: &[f64; 3]| words(&SleighState::from_coordinates(q, v));
    let schedule = Schedule { t0: 0.0, step: 0.05, steps: 101 };
    let systems = sleighs.each_ref().map(|sleigh| sleigh as &dyn dla::Mechanics<3, 1>);
    watch(&mut ensemble, &systems, &Watching { schedule, every: 10, of: &of })
}

fn all(members: Range<u64>, threads: usize) -> Vec<Option<Summary<[f64; 3]>>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let mut rows = Vec::new();
    let outcome: ControlFlow<()> = pool.install(|| {
        in_order(
            members,
            W as u64,
            || false,
            group,
            |groups| {
                rows.extend(groups.into_iter().flatten());
                ControlFlow::Continue(())
            },
        )
    });
    assert!(outcome.is_continue());
    rows
}

#[test]
fn threads_and_where_it_begins_change_no_bit() {
    let one = all(0..160, 1);
    assert!(one.len() == 160 && one[0] != one[159]);
    assert_eq!(one, all(0..160, 3));
    assert_eq!(one[48..], all(48..160, 2));
}

#[test]
fn the_sink_ends_it() {
    let mut seen = Vec::new();
    let begin = |range: Range<u64>| range.start;
    let outcome = in_order(
        0..160_000,
        16,
        || false,
        begin,
        |begins| {
            seen.extend(begins);
            if seen.len() >= 3 { ControlFlow::Break("enough") } else { ControlFlow::Continue(()) }
        },
    );
    assert_eq!(outcome, ControlFlow::Break("enough"));
    let expected: Vec<u64> = (0..seen.len() as u64).map(|group| 16 * group).collect();
    assert_eq!(seen, expected);
}

#[test]
fn a_stop_keeps_what_has_begun() {
    let begun = AtomicU64::new(0);
    let mut seen = 0;
    let each = |range: Range<u64>| {
        begun.fetch_add(1, Ordering::SeqCst);
        range.start
    };
    let outcome: ControlFlow<()> = in_order(
        0..100_000,
        1,
        || begun.load(Ordering::SeqCst) >= 70,
        each,
        |begins| {
            for begin in begins {
                assert_eq!(begin, seen);
                seen += 1;
            }
            ControlFlow::Continue(())
        },
    );
    assert!(outcome.is_continue());
    assert!(seen >= 70 && seen == begun.load(Ordering::SeqCst), "{seen}");
}

#[test]
fn a_slow_group_holds_the_others_up_when_they_are_far_ahead() {
    let (handed, most) = (AtomicU64::new(0), AtomicU64::new(0));
    let each = |range: Range<u64>| {
        if range.start == 0 {
            // Until the others have come as far as they may, or are done.
            while most.load(Ordering::SeqCst) < 4000 {
                std::thread::yield_now();
            }
        }
        most.fetch_max(range.start - handed.load(Ordering::SeqCst).min(range.start), Ordering::SeqCst);
        range.start
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let outcome: ControlFlow<()> = pool.install(|| {
        in_order(
            0..50_000,
            1,
            || false,
            each,
            |begins| {
                handed.store(begins[begins.len() - 1], Ordering::SeqCst);
                ControlFlow::Continue(())
            },
        )
    });
    assert!(outcome.is_continue() && handed.into_inner() == 49_999);
    // A count of groups, and the few that may begin between two looks at it.
    assert!(most.into_inner() <= 2 * 4096);
}

#[test]
fn lanes_are_summed_up_as_single_runs_are() {
    let system = With { body: Sleigh::new(1.0, 1.0, 0.5).unwrap(), effects: () };
    let schedule = Schedule { t0: 0.0, step: 0.05, steps: 101 };
    let of = |_: f64, q: &[f64; 3], v: &[f64; 3]| words(&SleighState::from_coordinates(q, v));
    let watching = Watching { schedule, every: 10, of: &of };
    let method = Method::named("dla", None).unwrap();
    let mut worst = 0.0f64;
    for (member, in_lanes) in group(0..16).into_iter().enumerate() {
        let in_lanes = in_lanes.unwrap();
        let (q, xi) = start(member as u64);
        let v = velocity_of(&system, 0.0, &q, &xi).unwrap();
        let (alone, failure) = summarise(&system, &method, (q, v), &watching);
        assert!(failure.is_none());
        let alone = alone.unwrap();
        // A hundred steps of numbers below 10, rounded.
        let tolerance = 100.0 * 10.0 * f64::EPSILON;
        let numbers = |s: &Summary<[f64; 3]>| [s.end, s.low, s.high].concat();
        for (a, b) in numbers(&in_lanes).iter().zip(numbers(&alone)) {
            assert_abs_diff_eq!(*a, b, epsilon = tolerance);
        }
        assert_abs_diff_eq!(in_lanes.t, 5.05, epsilon = 1e-14);
        assert_abs_diff_eq!(in_lanes.energy_deviation, alone.energy_deviation, epsilon = tolerance);
        assert!(in_lanes.constraint < 1e-15 && in_lanes.low[1] < in_lanes.high[1]);
        worst = worst.max(in_lanes.energy_deviation);
    }
    // The map does not keep the energy; that it is looked at shows in that.
    assert!(worst > 1e-6, "{worst:e}");
}

#[test]
fn a_run_that_fails_is_summed_up_as_far_as_it_goes() {
    let system = With { body: Sleigh::new(1.0, 1.0, 0.5).unwrap(), effects: () };
    let of = |_: f64, q: &[f64; 3], v: &[f64; 3]| words(&SleighState::from_coordinates(q, v));
    let schedule = Schedule { t0: 0.0, step: 2.9, steps: 10 };
    let method = Method::named("dla", None).unwrap();
    let start = ([0.0; 3], [-1.5, 0.0, 1e-3]);
    let (summary, failure) = summarise(&system, &method, start, &Watching { schedule, every: 1, of: &of });
    let (summary, failure) = (summary.unwrap(), failure.unwrap());
    assert_abs_diff_eq!(summary.t, failure.time, epsilon = 0.0);
    assert!(summary.end.iter().all(|x| x.is_finite()));
}
