use crate::args::{SceneArguments, Settings};
use crate::error::CliError;
use harness::{METHODS, Method};
use scene::{AnyScene, Overrides, RunSettings, Scene};

/// The names that a scene's `method` may have.
pub(crate) fn method_names() -> Vec<&'static str> {
    METHODS.iter().map(|info| info.name).collect()
}

/// The scene of a command line, with what its flags say instead.
pub(crate) fn load(arguments: &SceneArguments, method: Option<&str>) -> Result<Scene, CliError> {
    let SceneArguments { step, duration, alpha, .. } = *arguments;
    let overrides = Overrides { method, step, duration, alpha };
    Ok(Scene::load_with(&arguments.scene, &arguments.set.set, &overrides, &method_names())?)
}

/// The scene of a command line, of either kind.
pub(crate) fn load_any(arguments: &SceneArguments, method: Option<&str>) -> Result<AnyScene, CliError> {
    load_any_with((&arguments.scene, &arguments.set), method, arguments.step, arguments.duration, arguments.alpha)
}

/// The scene of that name, of either kind, with the settings of the command line, of which flags come last.
pub(crate) fn load_any_with(
    (scene, settings): (&str, &Settings),
    method: Option<&str>,
    step: Option<f64>,
    duration: Option<f64>,
    alpha: Option<f64>,
) -> Result<AnyScene, CliError> {
    let names = method_names();
    let overrides = Overrides { method, step, duration, alpha };
    Ok(AnyScene::load_with(scene, &settings.set, &overrides, &names)?)
}

/// The method of a run, with its settings.
pub(crate) fn method(run: &RunSettings) -> Result<Method, CliError> {
    Ok(Method::of(&run.method, run.alpha, run.tolerance)?)
}
