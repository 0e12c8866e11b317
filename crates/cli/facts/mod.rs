//! What scenes are, for a person: names and values.

mod sleigh;
mod text;

use crate::error::CliError;
use crate::notes;
use scene::{AnyScene, SceneSystem};

/// What a scene says.
pub(crate) fn of(scene: &AnyScene) -> Result<Vec<(String, String)>, CliError> {
    let scene = match scene {
        AnyScene::Sleigh(scene) => &**scene,
        AnyScene::Text(scene) => return Ok(text::listed(scene)),
    };
    Ok(match scene.train()? {
        Some((train, (q, v))) => sleigh::listed(scene, &scene.start, train.mechanism().energy(0.0, &q, &v), ""),
        None => sleigh::of(scene)?,
    })
}

/// The same with its method, for `noslip check`.
pub(crate) fn described(scene: &AnyScene) -> Result<Vec<(String, String)>, CliError> {
    notes::moves(scene);
    let mut facts = of(scene)?;
    facts.push(("method".to_owned(), scene.run().method.clone()));
    Ok(facts)
}
