use crate::inspect;
use dla::Schedule;
use harness::analysis::has_tangents;
use harness::analysis::{LyapunovRequest, lyapunov_within};
use harness::ensemble::{Summary, Watching, summarise, watch};
use harness::{Method, MethodKind};
use scene::{
    AnyScene, Built, Column, LANES, LaneMethod, Quantity, RunSettings, Scene, Sweep, SweepError, Visitor, in_lanes,
};
use sleigh::SleighState;

use crate::error::CliError;
use std::ops::Range;

/// What is summed up of a sleigh.
const QUANTITIES: usize = 5;

/// What is summed up of the members of a sweep: the quantities that tell a state.
#[derive(Debug)]
pub(super) struct Summed {
    state: Vec<Quantity>,
    /// Those that have extremes that mean anything: angles have none.
    extremes: Vec<usize>,
    constraint: &'static str,
}

/// The quantities that tell a state.
struct MemberNames;

impl MemberNames {
    fn on(self, system: &Built<'_>, (_q, _v): (&[f64], &[f64])) -> Vec<Quantity> {
        let mut state = system.quantities();
        state.truncate(system.in_state());
        state
    }
}

impl Summed {
    pub(super) fn of(sweep: &Sweep) -> Result<Self, CliError> {
        let constraint = if matches!(sweep.scene, AnyScene::Sleigh(_)) { "m/s" } else { "" };
        let state = sweep.scene.visit(MemberNames)?;
        let extremes = (0..state.len()).filter(|k| !state[*k].angle).collect();
        Ok(Self { state, extremes, constraint })
    }

    /// The columns after those of the keys.
    pub(super) fn columns(&self) -> Vec<Column> {
        let of = |quantity: &Quantity, end: &str| Column::new(format!("{}{end}", quantity.name), quantity.unit.clone());
        let state = self.state.iter().map(|quantity| of(quantity, ""));
        let extremes = self.extremes.iter().flat_map(|k| ["_min", "_max"].map(|end| of(&self.state[*k], end)));
        let energy = [("energy", "J"), ("energy_deviation", "J"), ("constraint", self.constraint)];
        let last = energy.map(|(name, unit)| Column::new(name, unit));
        std::iter::once(Column::new("t", "s")).chain(state).chain(extremes).chain(last).collect()
    }

    /// The numbers of these columns; NaN where there is no summary.
    fn numbers<Q: AsRef<[f64]>>(&self, summary: Option<&Summary<Q>>) -> Vec<f64> {
        let Some(Summary { t, end, low, high, energy, energy_deviation, constraint }) = summary else {
            return vec![f64::NAN; 4 + self.state.len() + 2 * self.extremes.len()];
        };
        let (low, high) = (low.as_ref(), high.as_ref());
        let extremes = self.extremes.iter().flat_map(|k| [low[*k], high[*k]]);
        let last = [energy[1], *energy_deviation, *constraint];
        std::iter::once(*t).chain(end.as_ref().iter().copied()).chain(extremes).chain(last).collect()
    }
}

/// A member that was computed.
pub(super) struct MemberRow {
    pub(super) member: u64,
    /// Keys, columns, and the exponent where it is wanted; NaN where there is none.
    pub(super) values: Vec<f64>,
    /// Why it ended early, if it did.
    pub(super) error: Option<String>,
}

/// The members of a sweep by one method.
pub(super) struct Members<'a> {
    pub(super) sweep: &'a Sweep,
    /// That of all members, unless the sweep varies it.
    pub(super) method: Method,
    pub(super) names: &'a [&'static str],
    pub(super) summed: &'a Summed,
}

/// The numbers of the columns, and why the run ended early.
type Told = (Vec<f64>, Option<String>);

impl Members<'_> {
    fn schedule(&self) -> Schedule {
        self.sweep.scene.schedule()
    }

    /// How many members are computed together: those of one register, or one. They are the same at any time, since a member in lanes may
    /// share its numbers with the others there.
    pub(super) fn group(&self) -> u64 {
        let (mut lanes, schedule) = (false, self.schedule());
        if let (Some(method), AnyScene::Sleigh(scene)) = (self.lane_method(), &self.sweep.scene) {
            in_lanes(&[scene], method, (schedule.t0, schedule.step), &mut |_, _| lanes = true);
        }
        if lanes { LANES as u64 } else { 1 }
    }

    /// The method and the steps of a member.
    fn run_of(&self, scene: &AnyScene) -> Result<(Method, Schedule), String> {
        if !self.sweep.varies_run() {
            return Ok((self.method, self.schedule()));
        }
        Ok((method_of(self.sweep, scene.run()).map_err(|error| error.to_string())?, scene.schedule()))
    }

    fn lane_method(&self) -> Option<LaneMethod> {
        let info = self.method.info();
        match info.kind {
            // Lanes make the same steps together.
            _ if !info.lanes || self.sweep.varies_run() => None,
            MethodKind::Dla => Some(LaneMethod::Closed),
            MethodKind::Gauss(4) => Some(LaneMethod::Gauss8),
            MethodKind::Gauss(8) => Some(LaneMethod::Gauss16),
            _ => None,
        }
    }

    /// Some members, in order.
    pub(super) fn rows(&self, range: Range<u64>) -> Vec<MemberRow> {
        let made: Vec<_> = range.map(|member| (member, self.sweep.member(member, self.names))).collect();
        let sleighs = made.iter().filter_map(|(_, scene)| match scene {
            Ok(AnyScene::Sleigh(scene)) => Some(&**scene),
            _ => None,
        });
        let mut in_lanes = self.in_lanes(&sleighs.collect::<Vec<_>>()).into_iter();
        let row = |(member, scene): &(u64, Result<AnyScene, SweepError>)| {
            let mut values = self.sweep.values(*member);
            let (numbers, mut error) = match scene {
                Ok(scene) => match in_lanes.next().flatten() {
                    Some(summary) => (self.summed.numbers(Some(&summary)), None),
                    None => self.alone(scene),
                },
                Err(error) => (self.summed.numbers::<Vec<f64>>(None), Some(error.to_string())),
            };
            values.extend(numbers);
            if self.sweep.exponent {
                let exponent = scene.as_ref().ok().filter(|_| error.is_none()).map(|scene| self.exponent(scene));
                values.push(exponent.as_ref().and_then(|found| found.as_ref().ok()).copied().unwrap_or(f64::NAN));
                error = error.or(exponent.and_then(Result::err));
            }
            MemberRow { member: *member, values, error }
        };
        made.iter().map(row).collect()
    }

    /// One by itself: any scene, any method.
    fn alone(&self, scene: &AnyScene) -> Told {
        let (method, schedule) = match self.run_of(scene) {
            Ok(run) => run,
            Err(error) => return (self.summed.numbers::<Vec<f64>>(None), Some(error)),
        };
        let alone = Alone { method: &method, schedule, every: self.sweep.every };
        let (summary, failure) = scene.visit(alone).unwrap_or_else(|error| (None, Some(error.to_string())));
        (self.summed.numbers(summary.as_ref()), failure)
    }

    /// The largest Lyapunov exponent (1/s), after a tenth of the run.
    fn exponent(&self, scene: &AnyScene) -> Result<f64, String> {
        let (method, schedule) = self.run_of(scene)?;
        let found = scene.visit_free(Exponent { method: &method, schedule });
        match found {
            Ok(Some(found)) => found,
            Ok(None) => Err("the scene imposes velocities, and has no exponents".to_owned()),
            Err(error) => Err(error.to_string()),
        }
    }

    /// In lanes, where there are lanes for it; none of a member that needs to be looked at by itself.
    fn in_lanes(&self, scenes: &[&Scene]) -> Vec<Option<Summary<[f64; QUANTITIES]>>> {
        let Some(method) = self.lane_method() else { return Vec::new() };
        let schedule = self.schedule();
        let watching = Watching { schedule, every: self.sweep.every, of: &quantities };
        // Register by register; the last one is filled up with its last member.
        let told = |scenes: &[&Scene]| {
            let mut found = vec![None; scenes.len()];
            in_lanes(scenes, method, (schedule.t0, schedule.step), &mut |ensemble, systems| {
                found = watch(ensemble, systems, &watching);
            });
            found.truncate(scenes.len());
            found
        };
        scenes.chunks(LANES).flat_map(told).collect()
    }
}

/// What tells the state of a sleigh, as [`Built::state`] has it.
fn quantities(_t: f64, q: &[f64; 3], v: &[f64; 3]) -> [f64; QUANTITIES] {
    let SleighState { x, y, heading, speed, turn_rate } = SleighState::from_coordinates(q, v);
    [x, y, heading, speed, turn_rate]
}

struct Alone<'a> {
    method: &'a Method,
    schedule: Schedule,
    every: u64,
}

impl Alone<'_> {
    fn on(self, system: &Built<'_>, (q, v): (&[f64], &[f64])) -> (Option<Summary<Vec<f64>>>, Option<String>) {
        let count = system.in_state();
        let of =
            |t: f64, q: &[f64], v: &[f64]| (0..count).map(|k| system.value(k, t, q, v)).collect::<Vec<f64>>();
        let watching = Watching { schedule: self.schedule, every: self.every, of: &of };
        let (summary, failure) = summarise(&system, self.method, (q, v), &watching);
        (summary, failure.map(|failure| failure.to_string()))
    }
}

struct Exponent<'a> {
    method: &'a Method,
    schedule: Schedule,
}

impl Exponent<'_> {
    fn on(self, system: &Built<'_>, (q, v): (&[f64], &[f64])) -> Result<f64, String> {
        let settle = self.schedule.steps / 10;
        let schedule = Schedule { steps: self.schedule.steps - settle, ..self.schedule };
        let request = LyapunovRequest { schedule, settle, exponents: Some(1), q, v };
        let found = lyapunov_within((&*system, &system), system.own(), self.method, &request, &mut ());
        let found = found.map_err(|error| error.to_string())?;
        match found.failure {
            Some(failure) => Err(failure.to_string()),
            None => Ok(found.exponents[0]),
        }
    }
}

/// The method of a member of a sweep that is run so.
pub(super) fn method_of(sweep: &Sweep, run: &RunSettings) -> Result<Method, CliError> {
    let method = inspect::method(run)?;
    if sweep.exponent {
        has_tangents(&method).map_err(|reason| CliError::Request(format!("output.exponent: {reason}")))?;
    }
    Ok(method)
}
