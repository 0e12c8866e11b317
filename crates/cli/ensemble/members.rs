use crate::inspect;
use dla::Schedule;
use harness::analysis::{LyapunovRequest, lyapunov};
use harness::ensemble::{Summary, Watching, summarise, watch};
use harness::{Kind, Method};
use scene::{Built, LANES, LaneMethod, Scene, Sweep, Visitor, in_lanes};
use sleigh::SleighState;
use std::array::from_fn;
use std::ops::Range;

/// What is summed up of a sleigh.
const QUANTITIES: usize = 5;

/// The columns after those of the keys, with their units.
pub(super) const COLUMNS: [(&str, &str); 17] = [
    ("t", "s"),
    ("x", "m"),
    ("y", "m"),
    ("heading", "rad"),
    ("speed", "m/s"),
    ("turn_rate", "rad/s"),
    ("x_min", "m"),
    ("x_max", "m"),
    ("y_min", "m"),
    ("y_max", "m"),
    ("speed_min", "m/s"),
    ("speed_max", "m/s"),
    ("turn_rate_min", "rad/s"),
    ("turn_rate_max", "rad/s"),
    ("energy", "J"),
    ("energy_deviation", "J"),
    ("constraint", "m/s"),
];

/// A member that was computed.
pub(super) struct Row {
    pub(super) member: u64,
    /// Keys, columns, and the exponent where it is wanted; NaN where there is none.
    pub(super) values: Vec<f64>,
    /// Why it ended early, if it did.
    pub(super) error: Option<String>,
}

/// The members of a sweep by one method.
pub(super) struct Members<'a> {
    pub(super) sweep: &'a Sweep,
    pub(super) method: Method,
    pub(super) names: &'a [&'static str],
}

type Told = (Option<Summary<QUANTITIES>>, Option<String>);

impl Members<'_> {
    fn schedule(&self) -> Schedule {
        inspect::schedule(&self.sweep.scene)
    }

    /// How many members are computed together: those of one register, or one. They are the same at any time, since a member in lanes may
    /// share its numbers with the others there.
    pub(super) fn group(&self) -> u64 {
        let (mut lanes, schedule) = (false, self.schedule());
        if let Some(method) = self.lane_method() {
            in_lanes(&[&self.sweep.scene], method, (schedule.t0, schedule.step), &mut |_, _| lanes = true);
        }
        if lanes { LANES as u64 } else { 1 }
    }

    fn lane_method(&self) -> Option<LaneMethod> {
        let info = self.method.info();
        match info.kind {
            _ if !info.lanes => None,
            Kind::Dla => Some(LaneMethod::Closed),
            Kind::Gauss(4) => Some(LaneMethod::Gauss8),
            Kind::Gauss(8) => Some(LaneMethod::Gauss16),
            _ => None,
        }
    }

    /// Some members, in order.
    pub(super) fn rows(&self, range: Range<u64>) -> Vec<Row> {
        let made: Vec<_> = range.map(|member| (member, self.sweep.member(member, self.names))).collect();
        let scenes: Vec<&Scene> = made.iter().filter_map(|(_, scene)| scene.as_ref().ok()).collect();
        let mut in_lanes = self.in_lanes(&scenes).into_iter();
        let row = |(member, scene): &(u64, Result<Scene, scene::SweepError>)| {
            let mut values = self.sweep.values(*member);
            let (summary, mut error) = match scene {
                Ok(scene) => match in_lanes.next().flatten() {
                    Some(summary) => (Some(summary), None),
                    None => self.alone(scene),
                },
                Err(error) => (None, Some(error.to_string())),
            };
            values.extend(numbers(summary.as_ref()));
            if self.sweep.exponent {
                let exponent = scene.as_ref().ok().filter(|_| error.is_none()).map(|scene| self.exponent(scene));
                values.push(exponent.as_ref().and_then(|found| found.as_ref().ok()).copied().unwrap_or(f64::NAN));
                error = error.or(exponent.and_then(Result::err));
            }
            Row { member: *member, values, error }
        };
        made.iter().map(row).collect()
    }

    /// One by itself: any scene, any method.
    fn alone(&self, scene: &Scene) -> Told {
        let alone = Alone { method: &self.method, schedule: self.schedule(), every: self.sweep.every };
        scene.visit(alone).unwrap_or_else(|error| (None, Some(error.to_string())))
    }

    /// The largest Lyapunov exponent (1/s), after a tenth of the run.
    fn exponent(&self, scene: &Scene) -> Result<f64, String> {
        let found = scene.visit_free(Exponent { method: &self.method, schedule: self.schedule() });
        match found {
            Ok(Some(found)) => found,
            Ok(None) => Err("the scene imposes velocities, and has no exponents".to_owned()),
            Err(error) => Err(error.to_string()),
        }
    }

    /// In lanes, where there are lanes for it; none of a member that needs to be looked at by itself.
    fn in_lanes(&self, scenes: &[&Scene]) -> Vec<Option<Summary<QUANTITIES>>> {
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

fn quantities(q: &[f64; 3], v: &[f64; 3]) -> [f64; QUANTITIES] {
    words(&SleighState::from_coordinates(q, v))
}

fn words(state: &SleighState) -> [f64; QUANTITIES] {
    [state.x, state.y, state.heading, state.speed, state.turn_rate]
}

/// The numbers of the columns.
fn numbers(summary: Option<&Summary<QUANTITIES>>) -> [f64; COLUMNS.len()] {
    let Some(Summary { t, end, low, high, energy, energy_deviation, constraint }) = summary else {
        return [f64::NAN; COLUMNS.len()];
    };
    let [x, y, heading, speed, turn_rate] = *end;
    // The heading has no extremes that mean anything.
    let [[x_min, x_max], [y_min, y_max], _, [u_min, u_max], [w_min, w_max]] = from_fn(|k| [low[k], high[k]]);
    [
        *t,
        x,
        y,
        heading,
        speed,
        turn_rate,
        x_min,
        x_max,
        y_min,
        y_max,
        u_min,
        u_max,
        w_min,
        w_max,
        energy[1],
        *energy_deviation,
        *constraint,
    ]
}

struct Alone<'a> {
    method: &'a Method,
    schedule: Schedule,
    every: u64,
}

impl Visitor for Alone<'_> {
    type Output = Told;

    fn visit<const N: usize, const M: usize>(self, system: Built<'_, N, M>, q: [f64; N], v: [f64; N]) -> Told {
        let of = |q: &[f64; N], v: &[f64; N]| from_fn(|k| system.value(k, 0.0, q, v));
        let watching = Watching { schedule: self.schedule, every: self.every, of: &of };
        let (summary, failure) = summarise(&system, self.method, (q, v), &watching);
        (Some(summary), failure.map(|failure| failure.to_string()))
    }
}

struct Exponent<'a> {
    method: &'a Method,
    schedule: Schedule,
}

impl Visitor for Exponent<'_> {
    type Output = Result<f64, String>;

    fn visit<const N: usize, const M: usize>(self, system: Built<'_, N, M>, q: [f64; N], v: [f64; N]) -> Self::Output {
        let settle = self.schedule.steps / 10;
        let schedule = Schedule { steps: self.schedule.steps - settle, ..self.schedule };
        let request = LyapunovRequest { schedule, settle, exponents: Some(1), q, v };
        let found = lyapunov((&*system, &system), self.method, &request, &mut ()).map_err(|error| error.to_string())?;
        match found.failure {
            Some(failure) => Err(failure.to_string()),
            None => Ok(found.exponents[0]),
        }
    }
}
