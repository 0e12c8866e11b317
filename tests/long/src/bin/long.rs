//! `long METHOD STEPS [TURN_RATE]`: constraint and energy of `dla`, `energy4` or `gauss8` in the bowl, and how the energy
//! error grows.

use dla::{Dla, Energy, Gauss, Observer, Report, Schedule, View, drive};
use harness::{Blocks, Drift};
use noslip_long::{STEP, bowl};
use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

/// Of every `EVERY` steps one value of the energy error is kept.
const EVERY: u64 = 1000;
/// The least number of increments for an estimate.
const FEWEST: usize = 16;

#[derive(Default)]
struct Watch {
    initial: f64,
    /// `max |A(q) v|` (m/s).
    constraint: f64,
    /// `max |E - E0|` (J).
    error: f64,
    blocks: Blocks,
    kept: Vec<f64>,
}

impl Observer for Watch {
    fn start(&mut self, node: &View<'_>) {
        self.initial = node.energy();
        self.kept.push(0.0);
    }

    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        let error = node.energy() - self.initial;
        self.constraint = self.constraint.max(node.constraint());
        self.error = self.error.max(error.abs());
        self.blocks.add(node.t, error);
        if node.k.is_multiple_of(EVERY) {
            self.kept.push(error);
        }
        // At 1, 2 and 5 of every decade.
        let decade = 10_u64.pow(node.k.ilog10());
        if node.k >= 10_000 && [1, 2, 5].contains(&(node.k / decade)) && node.k.is_multiple_of(decade) {
            println!("{:>11} steps: constraint {:.2e} m/s, energy {:.2e} J", node.k, self.constraint, self.error);
        }
        ControlFlow::Continue(())
    }
}

/// The growth exponent of a series between two lags, `D(l) = mean (x_{i+l} - x_i)^2 ~ l^{2g}`, with half the width of its
/// 95 % interval.
///
/// Increments that do not overlap; of `n` of them, independent and normal, `log D` has the variance `2/n`. The lags double,
/// and the line through the `log D` is weighted by that. Estimates at several lags are from one series and depend on each
/// other: for a walk the covariance of `D(l)` and `D(2l)` is half the variance of the latter, which widens the interval of a
/// weighted line by less than the factor 2 that is put on it.
fn growth(series: &[f64], lags: &[usize]) -> Option<(f64, f64)> {
    let points: Vec<(f64, f64, f64)> = lags
        .iter()
        .filter_map(|&lag| {
            let nodes: Vec<f64> = series.iter().step_by(lag).copied().collect();
            let count = (nodes.len() - 1) as f64;
            let mean = nodes.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum::<f64>() / count;
            (mean > 0.0).then(|| ((lag as f64).ln(), mean.ln(), count / 2.0))
        })
        .collect();
    let weight: f64 = points.iter().map(|p| p.2).sum();
    let center = |pick: fn(&(f64, f64, f64)) -> f64| points.iter().map(|p| p.2 * pick(p)).sum::<f64>() / weight;
    let (x, y) = (center(|p| p.0), center(|p| p.1));
    let spread: f64 = points.iter().map(|p| p.2 * (p.0 - x).powi(2)).sum();
    let slope = points.iter().map(|p| p.2 * (p.0 - x) * (p.1 - y)).sum::<f64>() / spread;
    (points.len() >= 2).then(|| (0.5 * slope, 0.5 * 2.0 * 1.96 / spread.sqrt()))
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (method, steps, turn_rate) = match &arguments[..] {
        [method, steps] => (method, steps, 0.1),
        [method, steps, turn_rate] => (method, steps, turn_rate.parse()?),
        _ => return Err("usage: long METHOD STEPS [TURN_RATE]".into()),
    };
    let schedule = Schedule { t0: 0.0, step: STEP, steps: steps.parse::<f64>()? as u64 };
    let (system, mut state) = bowl(turn_rate)?;
    let mut watch = Watch::default();
    let begin = Instant::now();
    match method.as_str() {
        "dla" => drive::<3, 1>(&system, &mut Dla::midpoint(), &schedule, &mut state, &mut watch)?,
        "energy4" => drive::<3, 1>(&system, &mut Energy::new::<2>(), &schedule, &mut state, &mut watch)?,
        "gauss8" => drive::<3, 1>(&system, &mut Gauss::new::<4>(), &schedule, &mut state, &mut watch)?,
        other => return Err(format!("`{other}` is none of dla, energy4, gauss8").into()),
    };
    println!("{method}: {} steps of {STEP} s in {:.0} s", schedule.steps, begin.elapsed().as_secs_f64());
    let drift = Drift::of(&watch.blocks);
    let (slope, interval) = (drift.slope, drift.slope_ci.unwrap_or(f64::NAN));
    println!(
        "energy: {}, slope {slope:.2e} +- {interval:.1e} J/s, exponent of the blocks {:.2?}",
        drift.verdict, drift.exponent
    );
    let lags: Vec<usize> = (0..).map(|k| 1 << k).take_while(|lag| FEWEST * lag < watch.kept.len()).collect();
    for part in [&lags[..], &lags[lags.len() / 2..]] {
        if let (Some((exponent, half)), [first, .., last]) = (growth(&watch.kept, part), part) {
            let [first, last] = [first, last].map(|lag| *lag as u64 * EVERY);
            println!("growth exponent over {first} to {last} steps: {exponent:.3} +- {half:.3}");
        }
    }
    Ok(())
}
