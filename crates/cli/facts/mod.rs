//! Descriptions of scenes for a person: names and values.

mod sleigh;
mod text;

use crate::error::CliError;
use crate::notes;
use scene::AnyScene;

pub(crate) use sleigh::listed as of_sleigh;

/// The description of a scene.
pub(crate) fn of(scene: &AnyScene) -> Result<Vec<(String, String)>, CliError> {
    let scene = match scene {
        AnyScene::Sleigh(scene) => &**scene,
        AnyScene::Text(scene) => return Ok(text::listed(scene)),
    };
    Ok(match scene.train()? {
        Some((train, start)) => sleigh::listed(scene, &scene.start, train.assembly.energy(0.0, &start), ""),
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
