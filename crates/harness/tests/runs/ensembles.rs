//! Ensembles: the same rows on any number of threads and from any member on, and summaries of runs that end early too.

use crate::common::sleigh_at;
use approx::assert_abs_diff_eq;
use dla::{Schedule, Subject};
use harness::Method;
use harness::ensemble::{Summary, in_order, summarise};
use lagrangian::{With, velocity_of};
use sleigh::Sleigh;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicU64, Ordering};

fn words(_t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
    let state = sleigh_at(q, v);
    vec![state.x, state.speed, state.turn_rate]
}

/// The summary of a member by the closed map.
fn member(k: u64) -> Summary {
    let system = With { body: Sleigh::new(1.0, 1.0, 0.5).unwrap(), effects: () };
    let (q, xi) = ([0.1, 0.2, 0.3], [-1.0, 0.1 + 0.01 * k as f64, 0.0]);
    let v = velocity_of(&system, 0.0, &q, &xi).unwrap();
    let schedule = Schedule { t0: 0.0, step: 0.05, steps: 101 };
    let method = Method::named("dla", None).unwrap();
    let (summary, failure) = summarise(&Subject::from(&system), &method, (&q, &v), (&schedule, 10), &words);
    assert!(failure.is_none());
    summary.unwrap()
}

fn all(members: Range<u64>, threads: usize) -> Vec<Summary> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let mut rows = Vec::new();
    let outcome: ControlFlow<()> = pool.install(|| {
        in_order(
            members,
            || false,
            member,
            |made| {
                rows.extend(made);
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
    let outcome = in_order(
        0..10_000,
        || false,
        |member| member,
        |members| {
            seen.extend(members);
            if seen.len() >= 3 { ControlFlow::Break("enough") } else { ControlFlow::Continue(()) }
        },
    );
    assert_eq!(outcome, ControlFlow::Break("enough"));
    let expected: Vec<u64> = (0..seen.len() as u64).collect();
    assert_eq!(seen, expected);
}

#[test]
fn a_stop_keeps_what_has_begun() {
    let begun = AtomicU64::new(0);
    let mut seen = 0;
    let each = |member: u64| {
        begun.fetch_add(1, Ordering::SeqCst);
        member
    };
    let outcome: ControlFlow<()> = in_order(
        0..100_000,
        || begun.load(Ordering::SeqCst) >= 70,
        each,
        |members| {
            for member in members {
                assert_eq!(member, seen);
                seen += 1;
            }
            ControlFlow::Continue(())
        },
    );
    assert!(outcome.is_continue());
    assert!(seen >= 70 && seen == begun.load(Ordering::SeqCst), "{seen}");
}

#[test]
fn a_slow_member_holds_the_others_up_when_they_are_far_ahead() {
    let (handed, most) = (AtomicU64::new(0), AtomicU64::new(0));
    let each = |member: u64| {
        if member == 0 {
            // Until the others have come as far as they may, or are done.
            while most.load(Ordering::SeqCst) < 4000 {
                std::thread::yield_now();
            }
        }
        most.fetch_max(member - handed.load(Ordering::SeqCst).min(member), Ordering::SeqCst);
        member
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let outcome: ControlFlow<()> = pool.install(|| {
        in_order(
            0..50_000,
            || false,
            each,
            |members| {
                handed.store(members[members.len() - 1], Ordering::SeqCst);
                ControlFlow::Continue(())
            },
        )
    });
    assert!(outcome.is_continue() && handed.into_inner() == 49_999);
    // A count of members, and the few that may begin between two looks at it.
    assert!(most.into_inner() <= 2 * 4096);
}

#[test]
fn a_run_is_summed_up() {
    let Summary { t, end, low, high, energy_deviation, constraint, .. } = member(0);
    assert_abs_diff_eq!(t, 5.05, epsilon = 1e-14);
    assert!((0..3).all(|k| low[k] <= end[k] && end[k] <= high[k]) && low[1] < high[1]);
    // The map does not keep the energy; that it is looked at shows in that.
    assert!(constraint < 1e-15 && energy_deviation > 1e-6, "{energy_deviation:e}");
}

#[test]
fn a_run_that_fails_is_summed_up_as_far_as_it_goes() {
    let system = With { body: Sleigh::new(1.0, 1.0, 0.5).unwrap(), effects: () };
    let schedule = Schedule { t0: 0.0, step: 2.9, steps: 10 };
    let method = Method::named("dla", None).unwrap();
    let start: (&[f64], &[f64]) = (&[0.0; 3], &[-1.5, 0.0, 1e-3]);
    let (summary, failure) = summarise(&Subject::from(&system), &method, start, (&schedule, 1), &words);
    let (summary, failure) = (summary.unwrap(), failure.unwrap());
    assert_abs_diff_eq!(summary.t, failure.time, epsilon = 0.0);
    assert!(summary.end.iter().all(|x| x.is_finite()));
}
