use super::Case;
use super::systems::{from, sleigh};
use report::{Report, SceneReport, Series, write};
use sleigh::{ClosedMap, SleighState};
use std::thread;

pub(super) const ENSEMBLE: &str = "ensemble";
pub(super) const REPORT: &str = "report";

/// Steps of every sleigh of an ensemble.
const STEPS: u64 = 800;

/// Many runs, and what is written of one.
pub(super) fn cases() -> Vec<Case> {
    vec![
        Case::new(ENSEMBLE, "sleighs of 800 steps, one thread", |sleighs| run(0..sleighs)),
        Case::new(ENSEMBLE, "sleighs of 800 steps, two threads", |sleighs| {
            thread::scope(|scope| {
                scope.spawn(|| run(0..sleighs / 2));
                run(sleighs / 2..sleighs);
            });
        }),
        Case::new(REPORT, "a page of two methods with 2000 nodes", |times| {
            for _ in 0..times {
                let folder = tempfile::tempdir().expect("a temporary folder");
                write(&report(), folder.path()).expect("a writable folder");
            }
        }),
    ]
}

/// Turn-arounds with different spins.
fn run(sleighs: std::ops::Range<u64>) {
    for k in sleighs {
        let turn_rate = 0.05 + 1e-3 * (k % 100) as f64;
        let start = SleighState { speed: -1.0, turn_rate, ..SleighState::default() }.to_coordinates();
        from(&sleigh(), ClosedMap::of(sleigh()), STEPS, start);
    }
}

fn report() -> Report {
    let series = |label: &str| {
        let time: Vec<f64> = (0..2000).map(|k| 0.02 * f64::from(k)).collect();
        Series {
            label: label.to_owned(),
            path: time.iter().map(|t| [t.sin(), 1.0 - t.cos()]).collect(),
            heading: time.clone(),
            rotor: Vec::new(),
            followers: Vec::new(),
            constraint: time.iter().map(|t| 1e-16 * (1.0 + t)).collect(),
            energy_error: time.iter().map(|t| 1e-9 * t).collect(),
            time,
            ..Series::default()
        }
    };
    let scene = SceneReport {
        name: "circle".to_owned(),
        title: "A circle".to_owned(),
        columns: vec!["method".to_owned()],
        rows: vec![vec!["dla".to_owned()], vec!["rk4".to_owned()]],
        series: vec![series("dla"), series("rk4")],
        ..SceneReport::default()
    };
    Report { title: "A bench".to_owned(), scenes: vec![scene], ..Report::default() }
}
