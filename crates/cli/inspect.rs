use crate::args::{SceneArguments, Settings};
use crate::error::CliError;
use harness::{METHODS, Method};
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
    Ok(AnyScene::load_over(scene, &set.set, &run, &method_names())?)
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
