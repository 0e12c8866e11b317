//! Cases that need another system than a scene: a few methods make them, the rest of each family shares their code.

use crate::HardCaseError;
use crate::lab::Lab;
use crate::two_rows::TwoRows;
use dla::{Dependency, Dla, Energy, Gauss, InChart, Lobatto, Schedule, State, StepError, Stepper, drive};
use harness::stability::check::{constant, follows, measured};
use harness::stability::{Case, Claim, Recorded, Recorder, Seen, VALUES};
use harness::{Method, MethodKind, Rk4Reduced};
use lagrangian::System;
use models::CompoundPendulum;
use sleigh::{Exact, Sleigh, SleighState};
use std::f64::consts::PI;

/// The methods that make these cases.
pub(crate) const METHODS: [MethodKind; 5] =
    [MethodKind::Dla, MethodKind::Lobatto(3), MethodKind::Gauss(4), MethodKind::Energy(1), MethodKind::Rk4Reduced];

/// What is looked at in a state.
type Look<'a, const N: usize> = &'a dyn Fn(&State<N>) -> [f64; VALUES];

/// How far a place is from where its coordinates end; a thousandth and less is too near.
type Regularity<'a, const N: usize> = &'a dyn Fn(&[f64; N]) -> f64;

/// A run of one of [`METHODS`], with place and velocity of each node; nothing of any other.
pub(crate) fn record<Sys, const M: usize>(
    lab: &Lab,
    system: &Sys,
    start: ([f64; 3], [f64; 3]),
    schedule: &Schedule,
) -> Recorded
where
    Sys: System<3, M>,
{
    record_in_chart(lab, system, start, schedule, &|_| 1.0)
}

/// The same in coordinates that end where `regularity` vanishes.
pub(crate) fn record_in_chart<Sys, const M: usize>(
    lab: &Lab,
    system: &Sys,
    start: ([f64; 3], [f64; 3]),
    schedule: &Schedule,
    regularity: Regularity<'_, 3>,
) -> Recorded
where
    Sys: System<3, M>,
{
    let look = |state: &State<3>| {
        let ([x, y, z], [vx, vy, vz]) = (state.unwrapped(), *state.v());
        [x, y, z, vx, vy, vz]
    };
    record_seen(lab, system, start, schedule, (&look, regularity))
}

/// The same with what `look` sees, in coordinates that end where `regularity` vanishes.
pub(crate) fn record_seen<Sys, const N: usize, const M: usize>(
    lab: &Lab,
    system: &Sys,
    (q, v): ([f64; N], [f64; N]),
    schedule: &Schedule,
    (look, regularity): (Look<'_, N>, Regularity<'_, N>),
) -> Recorded
where
    Sys: System<N, M>,
{
    let mut state = State::new(q, v, system.angles());
    let mut recorder = Recorder::new(1, look);
    let outcome = stepper(&lab.method).map_or(Ok(0), |method| {
        let mut method = InChart::new(method, "angles from a pole", regularity);
        drive(system, &mut method, schedule, &mut state, &mut recorder)
    });
    recorder.recorded(outcome.err())
}

/// One of [`METHODS`]; none where it is another.
fn stepper<const N: usize, const M: usize>(method: &Method) -> Option<Stepper<'static, N, M>> {
    let kind = method.info().kind;
    if !METHODS.contains(&kind) {
        return None;
    }
    // The shapes of scenes are compiled elsewhere, and for another the few are enough.
    if const { N == 3 } {
        return Some(method.stepper());
    }
    Some(match kind {
        MethodKind::Dla => Box::new(Dla::midpoint()),
        MethodKind::Lobatto(3) => Box::new(Lobatto::<3>::new()),
        MethodKind::Gauss(4) => Box::new(Gauss::new::<4>()),
        MethodKind::Energy(1) => Box::new(Energy::new::<1>()),
        MethodKind::Rk4Reduced => Box::new(Rk4Reduced),
        _ => return None,
    })
}

pub(crate) const PARALLEL_BLADES: Case = Case {
    name: "parallel-blades",
    hard: "Two parallel blades side by side: A M^-1 A' is singular, and no method can tell the two forces apart.",
    shows: "The motion is that with one blade, in closed form; or an error that names the rows.",
    bar: "The method's order over the run, and rounding.",
    claim: Claim::Order,
    refusable: true,
};

pub(crate) fn parallel_blades(lab: &mut Lab) -> Result<(), HardCaseError> {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5)?;
    let start = SleighState { speed: -1.0, turn_rate: 0.3, ..SleighState::default() };
    let exact = Exact::new(&sleigh, &start)?;
    let schedule = Schedule { t0: 0.0, step: 0.05, steps: 400 };
    let run = record(lab, &TwoRows::Parallel(sleigh), start.to_coordinates(), &schedule);
    // kappa + U/k, over 20 s.
    let (rate, time) = (1.4, 20.0);
    let bar = lab.accuracy(0.05 * rate, rate * time, schedule.steps) * time;
    let at = |t| {
        let now = exact.at(t);
        [now.heading, now.turn_rate]
    };
    lab.judge("", &run, [follows(&run, [2, 5], at, bar)]);
    Ok(())
}

pub(crate) const DROPPING_ROW: Case = Case {
    name: "dropping-row",
    hard: "A guide that lets go: its row of the constraint vanishes at x = 1 m, and exists before and after.",
    shows: "An error that names the row, where the rank drops.",
    bar: "The error comes at x = 1 m, not before and not later, and is that of dependent rows.",
    claim: Claim::Order,
    refusable: true,
};

pub(crate) fn dropping_row(lab: &mut Lab) -> Result<(), HardCaseError> {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5)?;
    // A sixteenth of a metre a step, without rounding.
    let schedule = Schedule { t0: 0.0, step: 0.0625, steps: 32 };
    let start = ([0.0; 3], [1.0, 0.0, 0.0]);
    let run = record(lab, &TwoRows::Guide(sleigh), start, &schedule);
    let named = match run.failure.map(|failure| failure.source) {
        Some(StepError::Dependent(found)) => found.dependency == Dependency::RankDrops && found.rows.contains(1),
        Some(error) if error.hint() == Some(dla::Hint::OtherMethod) => true,
        Some(error) => error.hint() == Some(dla::Hint::Constraints),
        None => false,
    };
    let reached = run.nodes.last().map_or(f64::NAN, |node| node.values[0]);
    let unsupported = run.failure.is_some_and(|failure| failure.hint() == Some(dla::Hint::OtherMethod));
    let off = if unsupported { 0.0 } else { (reached - 1.0).abs() };
    let found = [
        measured("distance from where the row vanishes", off, schedule.step),
        measured("runs that go on, or fail without naming the constraints", f64::from(u8::from(!named)), 0.0),
    ];
    // The error is what is asked for, and no failure of the case; that of a method for no such system is another.
    let told = if named && !unsupported { Recorded { failure: None, ..run } } else { run };
    lab.judge("", &told, found);
    Ok(())
}

pub(crate) const PSEUDO_HOLONOMIC: Case = Case {
    name: "pseudo-holonomic",
    hard: "A pendulum whose hinge is given by its rates alone: nothing pulls it back to where it was.",
    shows: "The hinge moves to and fro by O(h^p) and does not wander.",
    bar: "The method's order over one swing, of the length of the arm, for the run; rounding.",
    claim: Claim::Symmetry,
    refusable: false,
};

pub(crate) fn pseudo_holonomic(lab: &mut Lab) -> Result<(), HardCaseError> {
    let fault = |_| HardCaseError::Impossible("the pendulum of the case has impossible parameters");
    let arm = 0.9;
    let pendulum = CompoundPendulum::new(1.3, 0.4, arm, 9.81).map_err(fault)?.pseudo_holonomic();
    let (step, steps) = (0.02, 10_000);
    let schedule = Schedule { t0: 0.0, step, steps };
    let run = record(lab, &TwoRows::Pendulum(pendulum), pendulum.state_at(1.2, 0.3), &schedule);
    // sqrt(m g a/(I + m a^2)), and the rate at the lowest point.
    let inertia = 0.4 + 1.3 * arm * arm;
    let swing = (1.3 * 9.81 * arm / inertia).sqrt();
    let rate = swing + (0.09 + 2.0 * swing * swing * (1.0 - 1.2f64.cos())).sqrt();
    let bar = arm * lab.accuracy(step * rate, 2.0 * PI, steps);
    let off = |node: &Seen| {
        let [x, y] = pendulum.hinge(&[node.values[0], node.values[1], node.values[2]]);
        x.hypot(y)
    };
    lab.judge("", &run, [constant(&run, off, bar)]);
    Ok(())
}
