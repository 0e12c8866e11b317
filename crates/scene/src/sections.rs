use crate::error::SceneError;
use crate::fault::Fault;
use crate::keys::{HEADING, INERTIA, MASS, OFFSET, SPEED, TURN_RATE, X, X_DOT, Y, Y_DOT};
use crate::table::TomlTable;
use sleigh::{Sleigh, SleighState};

/// Reads `[sleigh]`: `mass`, `inertia` and `offset` are all required.
pub(crate) fn sleigh(table: &TomlTable<'_>) -> Result<Sleigh, SceneError> {
    let mass = table.required(&MASS)?;
    let inertia = table.required(&INERTIA)?;
    let offset = table.required(&OFFSET)?;
    // With each number in its range, only the inertia about the blade can still overflow.
    Sleigh::new(mass, inertia, offset).map_err(|error| {
        table.fail(Fault::new(
            SceneError::OutOfRange,
            OFFSET.key,
            format!("does not give a sleigh: {error}"),
            "an offset such that inertia + mass * offset^2 is finite",
        ))
    })
}

/// Largest sideways slip of a start, relative to its velocity: the rounding of written decimals.
const ROUNDED: f64 = 1e-9;

/// Reads `[start]`: `turn_rate` is required, and `speed` or both of `x_dot` and `y_dot`; `x`, `y` and `heading` are 0 when left out.
pub(crate) fn start(table: &TomlTable<'_>) -> Result<SleighState, SceneError> {
    let heading = table.number(&HEADING)?.unwrap_or(0.0);
    let in_full = [X_DOT.key, Y_DOT.key].into_iter().find(|key| table.get(key).is_some());
    let speed = match (table.get(SPEED.key), in_full) {
        (Some(_), Some(key)) => {
            return Err(table.fail(Fault::new(
                SceneError::OutOfRange,
                key,
                "gives the velocity a second time, beside `speed`",
                "`speed`, or both of `x_dot` and `y_dot`",
            )));
        }
        (None, Some(_)) => along([table.required(&X_DOT)?, table.required(&Y_DOT)?], heading),
        (_, None) => table.required(&SPEED)?,
    };
    Ok(SleighState {
        x: table.number(&X)?.unwrap_or(0.0),
        y: table.number(&Y)?.unwrap_or(0.0),
        heading,
        speed,
        turn_rate: table.required(&TURN_RATE)?,
    })
}

/// The part of a velocity along the blade.
fn along([x, y]: [f64; 2], heading: f64) -> f64 {
    let (sin, cos) = heading.sin_cos();
    x * cos + y * sin
}

/// Refuses a velocity, given in full, at which the blade slips sideways over the plane, which turns at that rate (rad/s).
pub(crate) fn check_slip(table: &TomlTable<'_>, start: &SleighState, plane: f64) -> Result<(), SceneError> {
    let (Some(x), Some(y)) = (table.number(&X_DOT)?, table.number(&Y_DOT)?) else { return Ok(()) };
    let (sin, cos) = start.heading.sin_cos();
    let over_plane = [x + plane * start.y, y - plane * start.x];
    let slip = over_plane[1] * cos - over_plane[0] * sin;
    if slip.abs() <= ROUNDED * f64::hypot(x, y).max(f64::hypot(over_plane[0], over_plane[1])) {
        return Ok(());
    }
    Err(table.fail(
        Fault::new(
            SceneError::OutOfRange,
            Y_DOT.key,
            format!("and `x_dot` slip sideways at {slip:?} m/s, which the blade does not admit"),
            format!("a velocity along the blade, which points at heading {:?} rad", start.heading),
        )
        .help(format!("the part along the blade is `speed = {:?}`", start.speed)),
    ))
}
