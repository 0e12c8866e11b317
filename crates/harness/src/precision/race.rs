use super::ladder::Rung;
use super::{Bench, digits};
use crate::Progress;
use crate::stopwatch::{Taken, take};
use dla::stops;
use std::hint::black_box;

/// Time of a batch of runs (s), long enough that reading the clock does not count; shorter if the longest run is shorter.
const BATCH: f64 = 5e-4;
/// Rounds; short runs have a batch in each.
pub(super) const ROUNDS: u64 = 81;
/// Batches of a run at least, and the time for all of its batches (s), if that is longer.
const FEWEST: u64 = 5;
const ALTOGETHER: f64 = 0.04;

/// The time of a run, from its batches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Measured {
    pub(super) wall: f64,
    pub(super) cpu: f64,
    pub(super) spread: f64,
}

/// Times all runs, and says how many rounds were made; each round is one batch of every run, so that a drift of the processor's clock is
/// the same for all of them.
///
/// A batch is warm: if its runs are short, one goes before it that does not count. A failed run has no time.
pub(super) fn race(
    bench: &Bench<'_>,
    rungs: &[&Rung],
    longest: f64,
    progress: &mut dyn Progress,
) -> (Vec<Option<Measured>>, u64) {
    let mut batches: Vec<Vec<Taken>> = vec![Vec::new(); rungs.len()];
    let mut made = 0;
    'rounds: for round in 0..ROUNDS {
        if progress.stops() {
            break;
        }
        for (rung, batches) in rungs.iter().zip(&mut batches) {
            if rung.error.is_none() || !has_turn(rung.seconds, round) {
                continue;
            }
            // The run that gave the error was cold: the first batch says how long a warm one is.
            let one = batches.first().map_or(rung.seconds, |taken| taken.cpu).max(1e-9);
            let runs = (BATCH.min(longest) / one).ceil().clamp(1.0, 1e6) as u32;
            let run = || {
                black_box((bench.end_error)(black_box(&rung.method), black_box(rung.steps)).is_ok());
            };
            if runs > 1 {
                run();
            }
            let taken = take(runs, run);
            if stops() {
                break 'rounds;
            }
            batches.push(taken);
        }
        made += 1;
        progress.advance(1);
    }
    (batches.iter().map(|batches| measured(batches)).collect(), made)
}

/// Whether a run that long (s) has a batch in a round: as many as there is time for, spread over all rounds.
fn has_turn(seconds: f64, round: u64) -> bool {
    let batches = ((ALTOGETHER / seconds.max(BATCH)) as u64).clamp(FEWEST, ROUNDS);
    round * batches % ROUNDS < batches
}

fn measured(batches: &[Taken]) -> Option<Measured> {
    let sorted = |of: fn(&Taken) -> f64| {
        let mut times: Vec<f64> = batches.iter().map(of).collect();
        times.sort_by(f64::total_cmp);
        times
    };
    let (wall, cpu) = (sorted(|taken| taken.wall), sorted(|taken| taken.cpu));
    let quarter = cpu.len() / 4;
    let (middle, low, high) = (cpu.get(cpu.len() / 2)?, cpu.get(quarter)?, cpu.get(cpu.len() - 1 - quarter)?);
    Some(Measured {
        wall: digits(*wall.get(wall.len() / 2)?),
        cpu: digits(*middle),
        spread: digits((high - low) / middle),
    })
}
