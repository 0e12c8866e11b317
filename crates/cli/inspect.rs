use crate::args::{SceneArguments, Settings};
use crate::error::CliError;
use crate::table::number;
use crate::terminal;
use harness::{METHODS, Method, Record};
use scene::{AnyScene, Overrides, RunSettings};

/// The names that a scene's `method` may have.
pub(crate) fn method_names() -> Vec<&'static str> {
    METHODS.iter().map(|info| info.name).collect()
}

/// The scene of a command line, with the run settings of its flags.
pub(crate) fn load(arguments: &SceneArguments, method: Option<&str>) -> Result<AnyScene, CliError> {
    load_over((&arguments.scene, &arguments.set), arguments.run(method, arguments.duration))
}

/// The scene `scene` with the settings of the command line, and `run` settings after them.
pub(crate) fn load_over((scene, set): (&str, &Settings), run: Overrides<'_>) -> Result<AnyScene, CliError> {
    Ok(AnyScene::load_with(scene, &set.set, &run, &method_names())?)
}

/// The method of a run, with its settings.
pub(crate) fn method(run: &RunSettings) -> Result<Method, CliError> {
    Ok(Method::of(&run.method, run.alpha, run.tolerance)?)
}

/// The names that a list of `--methods` has; all names by default.
pub(crate) fn listed(names: Option<&[String]>) -> Vec<&str> {
    match names {
        Some(names) => names.iter().map(|name| name.trim()).collect(),
        None => method_names(),
    }
}

/// The methods of these names.
pub(crate) fn methods(names: &[&str], alpha: Option<f64>, tolerance: Option<f64>) -> Result<Vec<Method>, CliError> {
    Ok(names.iter().map(|name| Method::of(name, alpha, tolerance)).collect::<Result<_, _>>()?)
}

/// Prints the warnings of a run, each with the name of the method.
pub(crate) fn warn(record: &Record) {
    for warning in record.warnings() {
        terminal::say("warning", &format!("{}: {warning}", record.method.name));
    }
}

/// Says which numbers of the start the constraints of a scene do not admit.
pub(crate) fn moves(scene: &AnyScene) {
    let AnyScene::Text(scene) = scene else { return };
    let degrees = |unit: &str| ["deg", "degree", "degrees", "°"].contains(&unit);
    for coordinate in scene.model.coordinates().iter().filter(|coordinate| degrees(coordinate.unit.name())) {
        let (name, unit) = (&coordinate.name, coordinate.unit.name());
        let note = format!(
            "formulas have the number of `{name}` in {unit}, and sin({name}) takes it as rad: write sin(pi/180*{name})"
        );
        terminal::say("note", &note);
    }
    for (first, moved) in scene.start.moved.iter().enumerate().map(|(k, moved)| (k == 0, moved)) {
        let (from, to) = (number(moved.from), number(moved.to));
        let note = format!(
            "the constraints do not admit {} = {from} at the start; the run starts with {to}{}",
            moved.name,
            // Numbers that `start` omits are moved before numbers that it gives.
            if first { ": leave out of `start` what is to follow from the rest" } else { "" }
        );
        terminal::say("note", &note);
    }
}
