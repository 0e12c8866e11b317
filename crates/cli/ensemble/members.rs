use crate::inspect;
use dla::{Mechanism, Schedule, has_tangents};
use harness::Method;
use harness::analysis::{LyapunovRequest, lyapunov};
use harness::ensemble::{Summary, summarise};
use scene::{AnyScene, Column, Quantity, RunSettings, Sweep};

use crate::error::CliError;

/// The quantities of the state that each member's row summarises.
#[derive(Debug)]
pub(super) struct Summed {
    state: Vec<Quantity>,
    /// Indices of the quantities whose extremes are recorded; angles have none.
    extremes: Vec<usize>,
    constraint: &'static str,
}

impl Summed {
    pub(super) fn of(sweep: &Sweep) -> Result<Self, CliError> {
        let constraint = if matches!(sweep.scene, AnyScene::Sleigh(_)) { "m/s" } else { "" };
        let built = sweep.scene.built_for_analysis()?;
        let system = built.system();
        let mut state = system.quantities();
        state.truncate(system.in_state());
        let extremes = (0..state.len()).filter(|k| !state[*k].angle).collect();
        Ok(Self { state, extremes, constraint })
    }

    /// The columns that follow the keys of the sweep.
    pub(super) fn columns(&self) -> Vec<Column> {
        let of = |quantity: &Quantity, end: &str| Column::new(format!("{}{end}", quantity.name), quantity.unit.clone());
        let state = self.state.iter().map(|quantity| of(quantity, ""));
        let extremes = self.extremes.iter().flat_map(|k| ["_min", "_max"].map(|end| of(&self.state[*k], end)));
        let energy = [("energy", "J"), ("energy_deviation", "J"), ("constraint", self.constraint)];
        let last = energy.map(|(name, unit)| Column::new(name, unit));
        std::iter::once(Column::new("t", "s")).chain(state).chain(extremes).chain(last).collect()
    }

    /// The numbers of these columns; all NaN if there is no summary.
    fn numbers(&self, summary: Option<&Summary>) -> Vec<f64> {
        let Some(Summary { t, end, low, high, energy, energy_deviation, constraint }) = summary else {
            return vec![f64::NAN; 4 + self.state.len() + 2 * self.extremes.len()];
        };
        let extremes = self.extremes.iter().flat_map(|k| [low[*k], high[*k]]);
        let last = [energy[1], *energy_deviation, *constraint];
        std::iter::once(*t).chain(end.iter().copied()).chain(extremes).chain(last).collect()
    }
}

/// A member that was computed.
pub(super) struct MemberRow {
    pub(super) member: u64,
    /// Keys, columns, and the exponent if requested; a missing number is NaN.
    pub(super) values: Vec<f64>,
    /// Why it ended early, if it did.
    pub(super) error: Option<String>,
}

/// The members of a sweep by one method.
pub(super) struct Members<'a> {
    pub(super) sweep: &'a Sweep,
    /// The method of all members, unless the sweep varies the run settings.
    pub(super) method: Method,
    pub(super) names: &'a [&'static str],
    pub(super) summed: &'a Summed,
}

impl Members<'_> {
    /// The row of a member.
    pub(super) fn row(&self, member: u64) -> MemberRow {
        let (mut summary, mut exponent) = (None, f64::NAN);
        let error = self.compute(member, &mut summary, &mut exponent).err();
        let mut values = self.sweep.values(member);
        values.extend(self.summed.numbers(summary.as_ref()));
        values.extend(self.sweep.exponent.then_some(exponent));
        MemberRow { member, values, error }
    }

    /// Computes the summary and the exponent, as far as the member comes.
    fn compute(&self, member: u64, summary: &mut Option<Summary>, exponent: &mut f64) -> Result<(), String> {
        let scene = self.sweep.member(member, self.names).map_err(|error| error.to_string())?;
        let (method, schedule) = &self.run_of(&scene)?;
        let built = scene.built_for_analysis().map_err(|error| error.to_string())?;
        let (system, start) = (built.system(), (&built.q[..], &built.v[..]));
        let mechanism = system.mechanism();
        let of = |t: f64, q: &[f64], v: &[f64]| (0..system.in_state()).map(|k| system.value(k, t, q, v)).collect();
        let failure;
        (*summary, failure) = summarise(&*mechanism, method, start, (schedule, self.sweep.every), &of);
        failure.map_or(Ok(()), |failure| Err(failure.to_string()))?;
        if self.sweep.exponent {
            if system.imposes_velocities() {
                return Err("the scene imposes velocities, and has no exponents".to_owned());
            }
            *exponent = largest_exponent(&*mechanism, system.own(), (method, schedule), start)?;
        }
        Ok(())
    }

    /// The method and the steps of a member.
    fn run_of(&self, scene: &AnyScene) -> Result<(Method, Schedule), String> {
        if !self.sweep.varies_run() {
            return Ok((self.method, self.sweep.scene.schedule()));
        }
        Ok((method_of(self.sweep, scene.run()).map_err(|error| error.to_string())?, scene.schedule()))
    }
}

/// The largest Lyapunov exponent (1/s), after a tenth of the run.
fn largest_exponent(
    system: &dyn Mechanism,
    own: (usize, usize),
    (method, schedule): (&Method, &Schedule),
    (q, v): (&[f64], &[f64]),
) -> Result<f64, String> {
    let settle = schedule.steps / 10;
    let schedule = Schedule { steps: schedule.steps - settle, ..*schedule };
    let request = LyapunovRequest { schedule, settle, exponents: Some(1), q: q.to_vec(), v: v.to_vec() };
    let found = lyapunov(system, own, method, &request, &mut ()).map_err(|error| error.to_string())?;
    found.failure.map_or_else(|| Ok(found.exponents[0]), |failure| Err(failure.to_string()))
}

/// The method of a member with these run settings.
pub(super) fn method_of(sweep: &Sweep, run: &RunSettings) -> Result<Method, CliError> {
    let method = inspect::method(run)?;
    if sweep.exponent {
        has_tangents(&method).map_err(|reason| CliError::Request(format!("output.exponent: {reason}")))?;
    }
    Ok(method)
}
