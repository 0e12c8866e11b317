//! `noslip equations`: the reduced equations of a system of text, as a text for other programs.

use crate::args::EquationsArguments;
use crate::error::CliError;
use crate::inspect::method_names;
use crate::{notes, table, terminal};
use scene::{AnyScene, Overrides};
use serde_json::json;

/// The rates of coordinates and quasi-velocities, as formulas of these and of the time `t`.
pub(crate) fn equations(arguments: &EquationsArguments) -> Result<(), CliError> {
    let scene = AnyScene::load_with(&arguments.scene, &arguments.set.set, &Overrides::default(), &method_names())?;
    let AnyScene::Text(text) = &scene else {
        let name = scene.name();
        return Err(CliError::Request(format!(
            "{name} is a sleigh, whose equations are on the page `scenes` of the documentation; accepted is a system of text"
        )));
    };
    notes::moves(&scene);
    let Some(written) = text.model.written_equations(&text.start) else {
        return Err(CliError::Computation(vec![format!(
            "{}: the reduced equations are too large to be written",
            scene.name()
        )]));
    };
    if arguments.json {
        return terminal::print_json(&json!({
            "scene": scene.name(), "title": scene.title(), "duration": text.run.duration, "unknowns": written.unknowns,
            "coordinates": text.model.coordinates().len(), "statements": written.statements, "rates": written.rates,
            "start": written.start,
        }));
    }
    let mut lines = String::new();
    for (name, meaning) in &written.statements {
        lines.push_str(&format!("{name} = {meaning}\n"));
    }
    for (name, rate) in written.unknowns.iter().zip(&written.rates) {
        lines.push_str(&format!("{name}' = {rate}\n"));
    }
    let start =
        written.unknowns.iter().zip(&written.start).map(|(name, value)| format!("{name} = {}", table::number(*value)));
    lines.push_str(&format!("start: {}\n", start.collect::<Vec<_>>().join(", ")));
    terminal::print(&lines)
}
