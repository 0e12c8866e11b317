use super::step::{AssemblyStep, LastNode};
use assembly::{Assembly, AssemblyMethod, AssemblyState};
use dla::{Close, Zero, Zeros, close_crossings, zeros};
use std::fmt;

/// Of the time (s) and the state.
type AssemblyFunction<'a> = Box<dyn Fn(f64, &AssemblyState) -> f64 + 'a>;

/// Of the time (s), the state, and whether the function rises.
type AssemblyFilter<'a> = Box<dyn Fn(f64, &AssemblyState, bool) -> bool + 'a>;

/// A function of time and state whose crossings of zero are looked for along a run of an assembly.
pub struct AssemblyEvent<'a> {
    /// What it is called.
    pub name: String,
    /// Whether the first crossing ends the run.
    pub terminal: bool,
    function: AssemblyFunction<'a>,
    filter: AssemblyFilter<'a>,
}

impl<'a> AssemblyEvent<'a> {
    /// The event `function(t, state) = 0`, in both directions.
    pub fn new(name: impl Into<String>, terminal: bool, function: impl Fn(f64, &AssemblyState) -> f64 + 'a) -> Self {
        Self { name: name.into(), terminal, function: Box::new(function), filter: Box::new(|_, _, _| true) }
    }

    /// The same event, of which only those crossings count that `filter(t, state, rising)` says.
    #[must_use]
    pub fn where_true(self, filter: impl Fn(f64, &AssemblyState, bool) -> bool + 'a) -> Self {
        Self { filter: Box::new(filter), ..self }
    }
}

impl fmt::Debug for AssemblyEvent<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, terminal, .. } = self;
        f.debug_struct("AssemblyEvent").field("name", name).field("terminal", terminal).finish_non_exhaustive()
    }
}

/// An event that happened.
#[derive(Debug, Clone, PartialEq)]
pub struct AssemblyCrossing {
    /// Which one, by its place in the list of events.
    pub event: usize,
    /// The node before it.
    pub k: u64,
    /// When (s).
    pub t: f64,
    /// The interval of time that is known to hold the change of sign (s). The error of the method comes on top.
    pub within: f64,
    /// How far apart the samples are by which it was found (s).
    pub spacing: f64,
    /// Whether the function rises through zero.
    pub rising: bool,
    /// The state then: a step of the method, shortened to end there.
    pub state: AssemblyState,
}

impl AssemblyCrossing {
    /// Which of those of a run are so close to one another that others may have been missed (see [`dla::close_crossings`]).
    pub(super) fn close(crossings: &[Self]) -> Option<Close> {
        close_crossings(crossings.iter().map(|crossing| (crossing.event, crossing.t, crossing.spacing)), |_| false)
    }
}

/// Notes the crossings within a step, up to the first that ends the run: there it ends. The step is divided into so many parts; where an event
/// has no value at one of them, that is counted.
pub(super) fn ended(
    assembly: &Assembly,
    method: &mut dyn AssemblyMethod,
    step: &AssemblyStep<'_>,
    (events, samples): (&[AssemblyEvent<'_>], u32),
    (crossings, unseen): (&mut Vec<AssemblyCrossing>, &mut u64),
) -> Option<LastNode> {
    if events.is_empty() {
        return None;
    }
    let time = |part: f64| step.t0 + part * step.h;
    let mut after = |part: f64| match part {
        0.0 => Some(step.before.clone()),
        1.0 => Some(step.after.clone()),
        _ => {
            let mut state = step.before.clone();
            method.step(assembly, step.t0, part * step.h, &mut state).ok().map(|_| state)
        }
    };
    let samples = i64::from(samples.max(1));
    let parts = (-1..=samples + 1).map(|j| j as f64 / samples as f64);
    let states: Vec<(f64, Option<AssemblyState>)> = parts.map(|part| (part, after(part))).collect();
    let mut found = Vec::new();
    for (event, AssemblyEvent { function, filter, .. }) in events.iter().enumerate() {
        let at = |part: f64, state: Option<&AssemblyState>| state.map_or(f64::NAN, |state| function(time(part), state));
        let known: Vec<(f64, f64)> = states.iter().map(|(part, state)| (*part, at(*part, state.as_ref()))).collect();
        let Zeros { zeros, unseen: missing } = zeros(&known, 0.0, |_| true, |part| at(part, after(part).as_ref()));
        *unseen += u64::from(missing);
        for Zero { at, within, rising } in zeros {
            if let Some(state) = after(at).filter(|state| filter(time(at), state, rising)) {
                let (t, within, spacing) = (time(at), within * step.h.abs(), step.h.abs() / samples as f64);
                found.push((at, AssemblyCrossing { event, k: step.k, t, within, spacing, rising, state }));
            }
        }
    }
    found.sort_by(|one, other| f64::total_cmp(&one.0, &other.0));
    for (_, crossing) in found {
        let last = events[crossing.event].terminal.then(|| (crossing.t, crossing.state.clone()));
        crossings.push(crossing);
        if last.is_some() {
            return last;
        }
    }
    None
}
