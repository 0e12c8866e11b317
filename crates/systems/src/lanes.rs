//! Members of a sweep in the lanes of vector registers, where a body has a method for that.

use crate::{AnyEffect, EffectList};
use dla::{Each, Ensemble, GaussEnsemble, LaneState, Mechanics, Same};
use lagrangian::{System, With};
use sleigh::effects::Bowl;
use sleigh::{ClosedEnsemble, Sleigh, SleighState};

/// So many trajectories are moved at once.
pub const LANES: usize = 16;

/// A method that moves trajectories in lanes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LaneMethod {
    /// `dla`, by the closed map of the free sleigh.
    Closed,
    /// `gauss8`.
    Gauss8,
    /// `gauss16`.
    Gauss16,
}

/// A member of a sweep.
#[derive(Debug, Clone)]
pub struct Lane {
    /// The body.
    pub sleigh: Sleigh,
    /// Where it starts.
    pub start: SleighState,
    /// What acts on it.
    pub effects: Vec<AnyEffect>,
}

/// What is done with the trajectories, and the system of each.
pub type LaneRun<'a> = dyn FnMut(&mut dyn Ensemble<3, LANES>, &[&dyn Mechanics<3, 1>; LANES]) + 'a;

/// Hands sixteen trajectories over, of so many members that differ in numbers only; fewer are filled up with the last. `time` is when
/// they begin and the step (s). Whether there is such an ensemble: a free sleigh has one by each method, one in a bowl by collocations.
pub fn in_lanes(members: &[Lane], method: LaneMethod, (t0, step): (f64, f64), run: &mut LaneRun<'_>) -> bool {
    let Some(last) = members.last() else { return false };
    let lane = |i: usize| members.get(i).unwrap_or(last);
    let starts: Vec<_> = members
        .iter()
        .map(|member| {
            let SleighState { x, y, heading, speed, turn_rate } = member.start;
            ([x, y, heading], [speed, turn_rate, 0.0])
        })
        .collect();
    let state = LaneState::new(&starts, [false, false, true]);
    let sleighs = std::array::from_fn(|i| lane(i).sleigh);
    // One after the other they are the systems of scenes, whose functions are compiled already.
    let free = sleighs.map(|body| With { body, effects: () });
    let bowls: [Option<With<Sleigh, Bowl>>; LANES] = std::array::from_fn(|i| bowl(lane(i)));
    match (method, &last.effects[..]) {
        (LaneMethod::Closed, []) => {
            let mut ensemble = ClosedEnsemble::new(sleighs, step, state);
            run(&mut ensemble, &objects(&free));
            true
        }
        (LaneMethod::Gauss8, []) => collocated::<4, _>(&sleighs, (t0, step), state, &mut |e| run(e, &objects(&free))),
        (LaneMethod::Gauss16, []) => collocated::<8, _>(&sleighs, (t0, step), state, &mut |e| run(e, &objects(&free))),
        (_, [AnyEffect::Bowl(_)]) => {
            let bowls: Vec<_> = bowls.into_iter().flatten().collect();
            let Ok(bowls) = <Box<[_; LANES]>>::try_from(bowls.into_boxed_slice()) else { return false };
            let listed = bowls.each_ref().map(|bowl| With {
                body: bowl.body,
                effects: EffectList::from(vec![AnyEffect::Bowl(bowl.effects.clone())]),
            });
            let run = &mut |ensemble: &mut dyn Ensemble<3, LANES>| run(ensemble, &objects(&listed));
            match method {
                LaneMethod::Closed => false,
                LaneMethod::Gauss8 => collocated::<4, _>(&bowls, (t0, step), state, run),
                LaneMethod::Gauss16 => collocated::<8, _>(&bowls, (t0, step), state, run),
            }
        }
        _ => false,
    }
}

/// The collocation of some systems, which may be one and the same: then it takes less than half the time.
fn collocated<const S: usize, Sys: System<3, 1> + PartialEq>(
    systems: &[Sys; LANES],
    time: (f64, f64),
    state: LaneState<3, LANES>,
    run: &mut dyn FnMut(&mut dyn Ensemble<3, LANES>),
) -> bool {
    let [first, others @ ..] = systems;
    if others.iter().all(|other| other == first) {
        let ensemble = GaussEnsemble::<_, _, S, LANES, 3, 1>::new(Same(first), time, state);
        ensemble.map(|mut ensemble| run(&mut ensemble)).is_some()
    } else {
        let ensemble = GaussEnsemble::<_, _, S, LANES, 3, 1>::new(Each(systems), time, state);
        ensemble.map(|mut ensemble| run(&mut ensemble)).is_some()
    }
}

fn objects<Sys: System<3, 1>>(systems: &[Sys; LANES]) -> [&dyn Mechanics<3, 1>; LANES] {
    systems.each_ref().map(|system| system as &dyn Mechanics<3, 1>)
}

fn bowl(lane: &Lane) -> Option<With<Sleigh, Bowl>> {
    match &lane.effects[..] {
        [AnyEffect::Bowl(bowl)] => Some(With { body: lane.sleigh, effects: bowl.clone() }),
        _ => None,
    }
}
