use crate::error::SceneError;
use crate::fault::Fault;
use crate::keys::{HEADING, INERTIA, MASS, OFFSET, SPEED, TURN_RATE, X, Y};
use crate::table::TomlTable;
use sleigh::{Sleigh, SleighState};

/// Reads `[sleigh]`: `mass`, `inertia` and `offset` are all required.
pub(crate) fn sleigh(table: &TomlTable<'_>) -> Result<Sleigh, SceneError> {
    let mass = table.required(&MASS)?;
    let inertia = table.required(&INERTIA)?;
    let offset = table.required(&OFFSET)?;
    // With each number in its range, only the inertia about the blade can still overflow.
    Sleigh::new(mass, inertia, offset).map_err(|error| {
        table.fail(Fault {
            variant: SceneError::OutOfRange,
            key: OFFSET.key,
            problem: format!("does not give a sleigh: {error}"),
            found: None,
            accepted: "an offset such that inertia + mass * offset^2 is finite".to_owned(),
            help: None,
        })
    })
}

/// Reads `[start]`: `speed` and `turn_rate` are required, `x`, `y` and `heading` are 0 when left out.
pub(crate) fn start(table: &TomlTable<'_>) -> Result<SleighState, SceneError> {
    Ok(SleighState {
        x: table.number(&X)?.unwrap_or(0.0),
        y: table.number(&Y)?.unwrap_or(0.0),
        heading: table.number(&HEADING)?.unwrap_or(0.0),
        speed: table.required(&SPEED)?,
        turn_rate: table.required(&TURN_RATE)?,
    })
}
