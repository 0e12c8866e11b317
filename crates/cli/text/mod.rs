//! Scenes of systems of text: what the commands make of them.

pub(crate) mod compare;
pub(crate) mod equilibria;
pub(crate) mod facts;
pub(crate) mod precision;
pub(crate) mod run;
pub(crate) mod told;

use crate::error::CliError;
use scene::{AnyText, TextScene};

/// The system of a scene.
pub(crate) fn system(scene: &TextScene) -> Result<AnyText, CliError> {
    // Sizes were checked when the scene was read.
    scene.system().ok_or_else(|| CliError::Request("the system has more coordinates than there is room for".to_owned()))
}
