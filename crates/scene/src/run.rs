use crate::error::SceneError;
use crate::fault::Fault;
use crate::finding::Excerpt;
use crate::keys;
use crate::keys::{ALPHA, DURATION, STEP, TOLERANCE};
use crate::suggest;
use crate::table::TomlTable;
use serde::Serialize;

/// The method of a scene that names none.
pub const DEFAULT_METHOD: &str = "dla";

/// Maximum number of steps in a run.
pub const MAX_STEPS: u64 = 1_000_000_000_000;

/// Settings that replace settings of a file, if given: method, step and duration (s), and alpha.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Overrides<'a> {
    /// The method.
    pub method: Option<&'a str>,
    /// The largest step (s).
    pub step: Option<f64>,
    /// The duration (s).
    pub duration: Option<f64>,
    /// The weight of `dla-alpha`.
    pub alpha: Option<f64>,
}

impl Overrides<'_> {
    /// Whether the setting of that key is given.
    fn have(&self, key: &str) -> bool {
        match key {
            "method" => self.method.is_some(),
            "alpha" => self.alpha.is_some(),
            "duration" => self.duration.is_some(),
            _ => self.step.is_some(),
        }
    }

    /// A fault of the run of the scene of that name: of the flag, where that is given.
    pub(crate) fn error(&self, fault: Fault, name: &str) -> SceneError {
        let given = self.have(fault.key);
        flag_error(fault, given, name)
    }

    /// As `error`, but without a flag the error is at its place in the table `[run]`.
    pub(crate) fn error_in(&self, table: &TomlTable<'_>, fault: Fault, name: &str) -> SceneError {
        if self.have(fault.key) { flag_error(fault, true, name) } else { table.fail(fault) }
    }
}

/// How to run a scene.
///
/// Unless an effect jumps between nodes (see [`Scene::schedule`](crate::Scene::schedule)), the run consists of [`steps`](Self::steps) equal
/// steps of size [`actual_step`](Self::actual_step), which is `step` where the duration is a multiple of it, and otherwise as little less as
/// makes the run end at `duration`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunSettings {
    /// Name of the integrator; `dla` when left out.
    pub method: String,
    /// Where in the step the method `dla-alpha` evaluates the Lagrangian, from 0 to 1; other methods do not read it.
    /// May be left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alpha: Option<f64>,
    /// The error of a step that a method aims for which chooses steps of its own; positive. Other methods do not read it. May be left
    /// out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// The largest step to take, in s; positive.
    pub step: f64,
    /// Length of the run, in s; positive and no less than the step.
    pub duration: f64,
}

impl RunSettings {
    /// Number of steps of the run, at least 1.
    ///
    /// The number is the ratio `duration / step` if that ratio is whole to within `1e-9`, or to within its own rounding error if
    /// that is more; otherwise the next whole number.
    #[must_use]
    pub fn steps(&self) -> u64 {
        // Of settings that were never checked, `max` drops a NaN and the conversion saturates.
        self.schedule().0.max(1.0) as u64
    }

    /// The step that the run takes (s): `step` itself, to the last bit, if `steps() * step` is `duration` within the tolerance of
    /// [`steps`](Self::steps); otherwise `duration / steps()`.
    #[must_use]
    pub fn actual_step(&self) -> f64 {
        match self.schedule() {
            (_, true) => self.step,
            (steps, false) => self.duration / steps,
        }
    }

    /// The number of steps, and whether the duration is a multiple of the step.
    fn schedule(&self) -> (f64, bool) {
        let ratio = self.duration / self.step;
        let nearest = ratio.round();
        // Step and duration come from decimals, each rounded to half a unit in the last place, and the division adds
        // as much again: beyond 1e6 steps that is more than 1e-9.
        let tolerance = f64::max(1e-9, 2.0 * f64::EPSILON * ratio);
        if (ratio - nearest).abs() <= tolerance { (nearest, true) } else { (ratio.ceil(), false) }
    }

    /// Reads `[run]`: `step` and `duration` are required. Consistency is checked after the overrides of the command line. `name` is the
    /// name of the scene.
    pub(crate) fn read(
        table: &TomlTable<'_>,
        overrides: &Overrides<'_>,
        name: &str,
        methods: &[&str],
    ) -> Result<Self, SceneError> {
        let accepted = format!("a string, one of {}", suggest::list(methods));
        let mut settings = Self {
            method: table.text("method", &accepted)?.unwrap_or(DEFAULT_METHOD).to_owned(),
            alpha: table.number(&ALPHA)?,
            tolerance: table.number(&TOLERANCE)?,
            step: table.required(&STEP)?,
            duration: table.required(&DURATION)?,
        };
        settings.replace(overrides, methods).map_err(|fault| overrides.error_in(table, fault, name))?;
        Ok(settings)
    }

    /// Replaces the settings that are given, and checks all of them.
    pub(crate) fn replace(&mut self, overrides: &Overrides<'_>, methods: &[&str]) -> Result<(), Fault> {
        let Overrides { method, step, duration, alpha } = *overrides;
        self.method = method.map_or_else(|| std::mem::take(&mut self.method), str::to_owned);
        self.step = step.unwrap_or(self.step);
        self.duration = duration.unwrap_or(self.duration);
        self.alpha = alpha.or(self.alpha);
        // A step that no longer goes with the duration is the fault of what has changed.
        self.check(if duration.is_some() && step.is_none() { "duration" } else { "step" }, methods)
    }

    /// Checks all of it; a step that does not go with the duration is said to be the fault of `culprit`.
    pub(crate) fn check(&self, culprit: &'static str, methods: &[&str]) -> Result<(), Fault> {
        if !methods.contains(&self.method.as_str()) {
            return Err(unknown_method(&self.method, methods));
        }
        STEP.check(self.step)?;
        DURATION.check(self.duration)?;
        self.alpha.map_or(Ok(()), |alpha| ALPHA.check(alpha))?;
        self.tolerance.map_or(Ok(()), |tolerance| TOLERANCE.check(tolerance))?;
        let Self { step, duration, .. } = *self;
        let blames_step = culprit == STEP.key;
        let too_many = duration / step > MAX_STEPS as f64;
        let (problem, accepted) = match (blames_step, too_many) {
            _ if !too_many && step <= duration => return Ok(()),
            (true, false) => ("is longer than the duration", format!("at most the duration, {duration:?} s")),
            (false, false) => ("is shorter than the step", format!("at least the step, {step:?} s")),
            (true, true) => {
                let least = duration / MAX_STEPS as f64;
                ("makes more than 1e12 steps", format!("at least {least:?} s, for the duration of {duration:?} s"))
            }
            (false, true) => {
                let most = step * MAX_STEPS as f64;
                ("makes more than 1e12 steps", format!("at most {most:?} s, for the step of {step:?} s"))
            }
        };
        Err(Fault::new(SceneError::OutOfRange, culprit, problem, accepted)
            .found(format!("{:?}", if blames_step { step } else { duration })))
    }
}

/// The error of a setting from the command line, or else from the scene.
fn flag_error(fault: Fault, given: bool, name: &str) -> SceneError {
    let (origin, field) =
        if given { ("command line", format!("--{}", fault.key)) } else { (name, keys::path("run", fault.key)) };
    fault.at(origin, None, Some(field), Excerpt::default())
}

fn unknown_method(method: &str, methods: &[&str]) -> Fault {
    let accepted = format!("one of {}", suggest::list(methods));
    Fault::new(SceneError::UnknownName, "method", "names no known method", accepted)
        .found(format!("{:?}", keys::abridged(method)))
        .help(suggest::nearest(method, methods.iter().copied()).map(suggest::did_you_mean))
}
