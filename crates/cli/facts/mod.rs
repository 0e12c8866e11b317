//! Descriptions of scenes for a person: names and values.

mod sleigh;
mod text;

use crate::error::CliError;
use crate::notes;
use scene::AnyScene;

/// The description of a scene.
pub(crate) fn of(scene: &AnyScene) -> Result<Vec<(String, String)>, CliError> {
    Ok(match scene {
        AnyScene::Sleigh(scene) => sleigh::of(scene)?,
        AnyScene::Text(scene) => text::listed(scene),
    })
}

/// The same with its method, for `noslip check`.
pub(crate) fn described(scene: &AnyScene) -> Result<Vec<(String, String)>, CliError> {
    notes::moves(scene);
    let mut facts = of(scene)?;
    facts.push(("method".to_owned(), scene.run().method.clone()));
    Ok(facts)
}
