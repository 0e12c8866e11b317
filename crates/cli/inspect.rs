use crate::args::{ListArguments, Listed, NewArguments, SceneArguments, Settings};
use crate::error::CliError;
use crate::files::write_whole;
use crate::{effect_keys, table, terminal};
use dla::Schedule;
use harness::{METHODS, Method};
use scene::{AnyScene, Overrides, RunSettings, Scene};
use serde_json::json;
use std::io::Write;
use std::path::Path;

/// The names that a scene's `method` may have.
pub(crate) fn method_names() -> Vec<&'static str> {
    METHODS.iter().map(|info| info.name).collect()
}

/// The scene of a command line, with what its flags say instead.
pub(crate) fn load(arguments: &SceneArguments, method: Option<&str>) -> Result<Scene, CliError> {
    load_with((&arguments.scene, &arguments.set), method, arguments.step, arguments.duration, arguments.alpha)
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
    Ok(AnyScene::load_over(scene, &settings.set, &overrides, &names)?)
}

/// The scene of that name, with the settings of the command line, of which flags come last.
pub(crate) fn load_with(
    (scene, settings): (&str, &Settings),
    method: Option<&str>,
    step: Option<f64>,
    duration: Option<f64>,
    alpha: Option<f64>,
) -> Result<Scene, CliError> {
    let names = method_names();
    let overrides = Overrides { method, step, duration, alpha };
    Ok(Scene::load_over(scene, &settings.set, &overrides, &names)?)
}

/// The steps of a scene's run.
pub(crate) fn schedule(scene: &Scene) -> Schedule {
    scene.schedule()
}

/// The method of a run, with its settings.
pub(crate) fn method(run: &RunSettings) -> Result<Method, CliError> {
    Ok(Method::of(&run.method, run.alpha, run.tolerance)?)
}

/// `noslip list`: what there is.
pub(crate) fn list(arguments: &ListArguments) -> Result<(), CliError> {
    if arguments.json {
        let all: Vec<_> = match arguments.what {
            Listed::Methods => METHODS
                .iter()
                .map(|m| {
                    json!({"name": m.name, "order": m.order, "keeps": m.keeps, "summary": m.summary,
                           "reference": m.reference, "adaptive": m.kind.is_adaptive(), "assemblies": m.assemblies,
                           "lanes": m.lanes, "tangent": m.tangent.is_ok()})
                })
                .collect(),
            Listed::Effects => scene::EFFECTS
                .iter()
                .map(|effect| {
                    let scene::EffectInfo { name, keys, summary, .. } = effect;
                    json!({"name": name, "keys": keys, "summary": summary, "properties": effect_keys::json(name)})
                })
                .collect(),
            Listed::Cases => crate::stability::cases()
                .map(|case| {
                    json!({"name": case.name, "hard": case.hard, "shows": case.shows, "bar": case.bar,
                           "refusable": case.refusable})
                })
                .collect(),
            Listed::Scenes => scenes()?.iter().map(|(name, title)| json!({"name": name, "title": title})).collect(),
        };
        return terminal::print_json(&json!(all));
    }
    let text = match arguments.what {
        Listed::Methods => {
            let line = |m: &harness::MethodInfo| (m.name, format!("order {}, {}", m.order, m.summary));
            table::aligned(&METHODS.iter().map(line).collect::<Vec<_>>())
        }
        Listed::Effects => effect_keys::text(),
        Listed::Cases => {
            table::aligned(&crate::stability::cases().map(|case| (case.name, case.hard)).collect::<Vec<_>>())
        }
        Listed::Scenes => table::aligned(&scenes()?),
    };
    terminal::print(&text)
}

fn scenes() -> Result<Vec<(&'static str, String)>, CliError> {
    let names = method_names();
    let title = |bundled: &scene::Bundled| Ok((bundled.name, AnyScene::load(bundled.name, &names)?.title().to_owned()));
    scene::bundled().iter().chain(scene::bundled_texts()).map(title).collect()
}

/// `noslip new`: a scene to start from; `-` is standard output.
pub(crate) fn new(arguments: &NewArguments) -> Result<(), CliError> {
    if arguments.file == Path::new("-") {
        return terminal::print(Scene::template());
    }
    write_whole(&arguments.file, arguments.force, |file| file.write_all(Scene::template().as_bytes()))?;
    terminal::print(&format!("written: {}\n", arguments.file.display()))
}
