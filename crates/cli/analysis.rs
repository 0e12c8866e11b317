//! The common part of the analyses of motions, `noslip lyapunov` and `noslip section`: how they open a scene, and how they show a result.

use crate::args::SceneArguments;
use crate::chart_file::ChartFile;
use crate::command_line::CommandLine;
use crate::error::{CliError, unless_interrupted};
use crate::provenance::Provenance;
use crate::starts::with_energy;
use crate::{inspect, table, terminal};
use harness::Method;
use report::Chart;
use scene::{AnyScene, Built, BuiltScene, Column, StartPlace};
use serde_json::{Value, json};
use std::path::Path;

/// An analysis of a scene by a method.
pub(crate) struct Analysis<'a> {
    command: &'static str,
    arguments: &'a SceneArguments,
    pub(crate) scene: AnyScene,
    pub(crate) method: Method,
    file: Option<ChartFile<'a>>,
}

/// A result: the columns and rows of a file of numbers, the chart of a picture, the object of `--json`, and the lines for a person.
pub(crate) struct AnalysisResult<'r> {
    pub(crate) columns: Vec<Column>,
    pub(crate) rows: &'r dyn Fn() -> Vec<Vec<f64>>,
    pub(crate) chart: &'r dyn Fn() -> Chart,
    pub(crate) object: &'r dyn Fn() -> Value,
    pub(crate) lines: Vec<(String, String)>,
    /// The command that makes the result again, and the notes on the file besides method, step and duration.
    pub(crate) again: CommandLine,
    pub(crate) notes: Value,
    pub(crate) warning: Option<String>,
    pub(crate) failures: Vec<String>,
    /// How far the work came, if a signal ended it.
    pub(crate) interrupted: Option<String>,
}

impl<'a> Analysis<'a> {
    /// Opens the scene of `noslip COMMAND`; `duration` (s) is the default.
    pub(crate) fn open(
        command: &'static str,
        arguments: &'a SceneArguments,
        method: &str,
        duration: f64,
    ) -> Result<Self, CliError> {
        let duration = arguments.duration.or(Some(duration));
        let scene = inspect::load_over((&arguments.scene, &arguments.set), arguments.run(Some(method), duration))?;
        let method = inspect::method(scene.run())?;
        Ok(Self { command, arguments, scene, method, file: None })
    }

    /// Checks the file `out` of the result, and builds the system of the scene, which must have a motion of its own.
    pub(crate) fn begin(&mut self, out: Option<&'a Path>) -> Result<BuiltScene, CliError> {
        let SceneArguments { scene, force, .. } = self.arguments;
        self.file = out.map(|path| ChartFile::of(path, scene, *force)).transpose()?;
        inspect::moves(&self.scene);
        let built = self.scene.built_for_analysis()?;
        if built.system().imposes_velocities() {
            let problem =
                "the scene imposes velocities (servo, tracer): accepted are scenes that only the blade constrains";
            return Err(CliError::Request(problem.to_owned()));
        }
        Ok(built)
    }

    /// The command with the run settings that were taken.
    pub(crate) fn again(&self) -> CommandLine {
        let SceneArguments { scene, set, .. } = self.arguments;
        CommandLine::of(self.command, scene, set).run(self.scene.run(), self.scene.schedule().step)
    }

    /// The lines on scene and run, over `duration` (s).
    pub(crate) fn lines(&self, duration: f64, of: &str) -> Vec<(String, String)> {
        let run = self.scene.run();
        let [duration, step] = [duration, run.actual_step()].map(table::number);
        let lines = [
            ("scene", format!("{} ({})", self.scene.title(), self.scene.name())),
            ("run", format!("{duration} s by {} with steps of {step} s{of}", run.method)),
        ];
        lines.map(|(name, value)| (name.to_owned(), value)).to_vec()
    }

    /// The keys of `--json` on scene and run, over `duration` (s), and after them `more`.
    pub(crate) fn object(&self, duration: f64, more: Value) -> Value {
        let mut object = json!({
            "scene": self.scene.name(),
            "method": self.method.info().name,
            "step": self.scene.run().actual_step(),
            "duration": duration,
        });
        extend(&mut object, more);
        object
    }

    /// Writes and prints a result.
    pub(crate) fn tell(&self, result: AnalysisResult<'_>) -> Result<(), CliError> {
        let AnalysisResult { columns, rows, chart, again, interrupted, .. } = result;
        let path = self.file.map(ChartFile::path);
        let written = self.file.map_or(Ok(()), |file| {
            let again = again.maybe("--out", path.map(Path::display));
            let run = self.scene.run();
            let mut notes = json!({"method": run.method, "step": self.scene.schedule().step, "duration": run.duration});
            extend(&mut notes, result.notes);
            let provenance = Provenance::on(&self.scene, Some(&again), notes).interrupted(interrupted.as_deref());
            file.write(self.arguments.force, &provenance, (&columns, rows), chart)
        });
        if self.arguments.json {
            terminal::print_json(&(result.object)())?;
        } else {
            terminal::print(&table::aligned(&result.lines))?;
            if let (Some(path), Ok(())) = (path, &written) {
                terminal::print(&format!("written    {}\n", path.display()))?;
            }
        }
        result.warning.iter().for_each(|warning| terminal::say("warning", warning));
        unless_interrupted(interrupted, None, CliError::of_failures(result.failures).and(written))
    }
}

fn extend(object: &mut Value, more: Value) {
    if let (Value::Object(object), Value::Object(more)) = (object, more) {
        object.extend(more);
    }
}

/// The start with the energy `wanted` (J), if any is.
pub(crate) fn with_wanted_energy(
    system: &Built<'_>,
    start: StartPlace,
    wanted: Option<f64>,
) -> Result<StartPlace, CliError> {
    let Some(wanted) = wanted else { return Ok(start) };
    with_energy(system, &start, wanted).ok_or_else(|| {
        let at_rest = system.mechanism().energy(0.0, &start.0, &vec![0.0; start.1.len()]);
        CliError::Request(format!(
            "--energy {wanted:?}: no multiple of the velocity of the start has this energy; at rest at the start the \
                energy is {at_rest:?} J"
        ))
    })
}
