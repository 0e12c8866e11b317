//! Other people's integrators on the sleigh. Reads a request on standard input, writes measured points, both JSON; the
//! Python side of these benches makes the one and judges the other.

mod dop853;
mod implicit;
mod number;
mod problem;
mod rk4;

use problem::{Effect, Free, Loads, OneBowl, OneEggCrate, Problem, Sleigh};
use rustix::time::{ClockId, clock_gettime};
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Where a run ends, and its number of steps, tried ones included.
pub struct Outcome<const D: usize> {
    /// The unknowns at the end.
    pub end: [f64; D],
    /// Steps tried.
    pub steps: u64,
}

#[derive(Deserialize)]
struct Request {
    problem: Problem,
    tolerances: Vec<f64>,
    /// Numbers of equal steps.
    steps: Vec<u64>,
    /// A line ends with the first run that takes longer (s).
    limit: f64,
    /// Beginnings of the names of methods that are wanted; all where there is none.
    #[serde(default)]
    methods: Vec<String>,
    /// What is spent on repeating a run (s).
    budget: f64,
}

#[derive(Serialize)]
struct Point {
    method: String,
    package: &'static str,
    form: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<f64>,
    steps: u64,
    wall_seconds: f64,
    cpu_seconds: f64,
    repeats: usize,
    end: [f64; 3],
}

#[derive(Serialize)]
struct Failure {
    method: String,
    value: f64,
    message: String,
}

#[derive(Serialize, Default)]
struct Answer {
    points: Vec<Point>,
    failures: Vec<Failure>,
}

/// A row of the ladder: a tolerance or a number of steps.
#[derive(Clone, Copy)]
enum Rung {
    Tolerance(f64),
    Steps(u64),
}

/// The processor's time that this program has used (s).
fn cpu() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Medians of repeated runs.
struct Times {
    /// On the wall (s).
    wall: f64,
    /// Of the processor (s).
    cpu: f64,
    repeats: usize,
}

/// The times of a run, and the outcome of its first.
fn timed<const D: usize>(
    budget: f64,
    mut run: impl FnMut() -> Result<Outcome<D>, String>,
) -> Result<(Outcome<D>, Times), String> {
    // The clock of the processor is a system call: short runs are timed in groups that take this long (s).
    const GROUP: f64 = 2e-4;
    let outcome = run()?;
    // Runs longer than this (s) are timed once.
    const LONG: f64 = 1.0;
    let (begin, begin_cpu) = (Instant::now(), cpu());
    run()?;
    let second = begin.elapsed().as_secs_f64().max(1e-9);
    if second > LONG {
        return Ok((outcome, Times { wall: second, cpu: cpu() - begin_cpu, repeats: 1 }));
    }
    let size = (GROUP / second).ceil().max(1.0);
    let groups = ((budget / (second * size)) as usize).clamp(3, 1001) | 1;
    let (mut wall, mut processor) = (Vec::with_capacity(groups), Vec::with_capacity(groups));
    for _ in 0..groups {
        let (begin, begin_cpu) = (Instant::now(), cpu());
        for _ in 0..size as usize {
            std::hint::black_box(run()?.end);
        }
        processor.push((cpu() - begin_cpu) / size);
        wall.push(begin.elapsed().as_secs_f64() / size);
    }
    let median = |times: &mut Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times[groups / 2]
    };
    Ok((outcome, Times { wall: median(&mut wall), cpu: median(&mut processor), repeats: groups * size as usize }))
}

impl Request {
    /// Appends the ladder of one method.
    fn line<const D: usize>(
        &self,
        answer: &mut Answer,
        (method, package, form): (&str, &'static str, &'static str),
        rungs: &[Rung],
        run: impl Fn(Rung) -> Result<Outcome<D>, String>,
    ) {
        if !self.methods.is_empty() && !self.methods.iter().any(|name| method.starts_with(name.as_str())) {
            return;
        }
        for &rung in rungs {
            let duration = self.problem.duration;
            let (value, tolerance, step) = match rung {
                Rung::Tolerance(t) => (t, Some(t), None),
                Rung::Steps(n) => (duration / n as f64, None, Some(duration / n as f64)),
            };
            match timed(self.budget, || run(rung)) {
                Ok((Outcome { end, steps }, Times { wall: wall_seconds, cpu: cpu_seconds, repeats })) => {
                    let method = method.into();
                    let end = [end[0], end[1], end[2]];
                    answer.points.push(Point {
                        method,
                        package,
                        form,
                        tolerance,
                        step,
                        steps,
                        wall_seconds,
                        cpu_seconds,
                        repeats,
                        end,
                    });
                    if wall_seconds > self.limit {
                        break;
                    }
                }
                Err(message) => answer.failures.push(Failure { method: method.into(), value, message }),
            }
        }
    }

    /// Every peer on one kind of loads.
    fn all<L: Loads>(&self, loads: L) -> Answer {
        let mut answer = Answer::default();
        let sleigh = Sleigh::new(&self.problem, loads);
        let (start, duration) = (self.problem.start, self.problem.duration);
        let (s, c) = start[2].sin_cos();
        let start6 = [start[0], start[1], start[2], start[3] * c, start[3] * s, start[4]];
        let tolerances: Vec<_> = self.tolerances.iter().copied().map(Rung::Tolerance).collect();
        let steps: Vec<_> = self.steps.iter().copied().map(Rung::Steps).collect();
        let reduced = |y: &[f64; 5]| sleigh.reduced(y);
        let full = |y: &[f64; 6]| sleigh.full(y);
        let tolerance = |rung| if let Rung::Tolerance(t) = rung { t } else { f64::NAN };
        let count = |rung| if let Rung::Steps(n) = rung { n } else { 1 };

        self.line(&mut answer, ("ode_solvers dop853", "ode_solvers", "reduced"), &tolerances, |r| {
            dop853::ode_solvers(reduced, start, duration, tolerance(r))
        });
        self.line(&mut answer, ("ode_solvers dop853 full", "ode_solvers", "full"), &tolerances, |r| {
            dop853::ode_solvers(full, start6, duration, tolerance(r))
        });
        self.line(
            &mut answer,
            ("differential-equations dop853", "differential-equations", "reduced"),
            &tolerances,
            |r| dop853::differential_equations(reduced, start, duration, tolerance(r)),
        );
        for method in implicit::METHODS {
            self.line(&mut answer, (&format!("diffsol {method}"), "diffsol", "reduced"), &tolerances, |r| {
                implicit::integrate(method, &sleigh, start, duration, tolerance(r))
            });
        }
        self.line(&mut answer, ("rk4 by hand", "by hand", "reduced"), &steps, |r| {
            let steps = count(r);
            Ok(Outcome { end: rk4::rk4(reduced, start, duration, steps), steps })
        });
        self.line(&mut answer, ("rk4 by hand full", "by hand", "full"), &steps, |r| {
            let steps = count(r);
            Ok(Outcome { end: rk4::rk4(full, start6, duration, steps), steps })
        });
        answer
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let request: Request = serde_json::from_reader(std::io::stdin().lock())?;
    let answer = match request.problem.effects.as_slice() {
        [] => request.all(Free),
        &[Effect::Bowl { stiffness, center }] => request.all(OneBowl { stiffness, center }),
        &[Effect::EggCrate { height, wave_number }] => request.all(OneEggCrate { height, wave_number }),
        effects => request.all(effects.to_vec()),
    };
    serde_json::to_writer(std::io::stdout().lock(), &answer)?;
    Ok(())
}
