//! The entries of `[[effects]]`.

mod company;
mod effect;
mod readers;
mod specs;
mod table;

pub use effect::SceneEffect;
pub use specs::{HillSpec, Interpolation, PathShape, PathSpec, TimeSpec, TrailersSpec};
pub use table::{EFFECTS, EffectInfo};

use crate::error::SceneError;
use crate::fault::Fault;
use crate::keys::abridged;
use crate::suggest;
use crate::table::TomlTable;
use sleigh::Sleigh;
use toml::de::DeValue;

/// Reads the entries of `[[effects]]`.
pub(crate) fn read(root: &TomlTable<'_>, sleigh: &Sleigh) -> Result<Vec<SceneEffect>, SceneError> {
    let mut effects: Vec<SceneEffect> = Vec::new();
    for entry in root.entries_of("effects", "a list of tables, each headed `[[effects]]`")? {
        let info = info_of(&entry)?;
        let known: Vec<&str> = ["kind"].into_iter().chain(info.keys.iter().copied()).collect();
        let path = entry.path_of(info.name);
        let table = entry.named(path).with_known_keys(&known)?;
        let effect = (info.read)(&table)?;
        company::check_company(&table, (info, &effect), &effects, sleigh.offset())?;
        company::check_energy(&table, &effect, sleigh)?;
        effects.push(effect);
    }
    Ok(effects)
}

/// The row of [`EFFECTS`] that the entry's `kind` names.
fn info_of(entry: &TomlTable<'_>) -> Result<&'static EffectInfo, SceneError> {
    let names: Vec<&str> = EFFECTS.iter().map(|info| info.name).collect();
    let accepted = || format!("one of {}", suggest::list(&names));
    let kind = entry.get("kind").ok_or_else(|| entry.missing("kind", accepted()))?;
    let DeValue::String(name) = kind.get_ref() else {
        return Err(entry.wrong_type("kind", kind, accepted()));
    };
    EFFECTS.iter().find(|info| info.name == name).ok_or_else(|| {
        let fault = Fault {
            variant: SceneError::UnknownName,
            key: "kind",
            problem: "names no known effect".to_owned(),
            found: Some(format!("{:?}", abridged(name))),
            accepted: accepted(),
            help: suggest::nearest(name, names.iter().copied()).map(suggest::did_you_mean),
        };
        entry.fail(fault)
    })
}
