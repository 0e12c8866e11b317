use crate::error::SceneError;
use crate::quantity::KeyQuantity;
use crate::table::TomlTable;
use serde::Serialize;

/// The trailers of a scene; each list has one number for every trailer, or one for all.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrailersSpec {
    /// How many there are.
    pub count: usize,
    /// Masses (kg).
    pub mass: Vec<f64>,
    /// Moments of inertia about the centres of mass (kg m^2).
    pub inertia: Vec<f64>,
    /// Distances of the centres of mass ahead of the blades (m).
    pub offset: Vec<f64>,
    /// Distances of the hinges behind the blades before them (m).
    pub hitch: Vec<f64>,
    /// Distances of the hinges ahead of the trailers' own blades (m).
    pub bar: Vec<f64>,
    /// Headings at the start (rad). A trailer without a heading has the heading of the blade before it.
    pub headings: Vec<f64>,
}

/// The most trailers that a scene may have.
const MOST_TRAILERS: f64 = 100_000.0;

/// Reads the trailers of a scene.
pub(super) fn read(table: &TomlTable<'_>) -> Result<TrailersSpec, SceneError> {
    let count = table.required(&KeyQuantity::finite("count", "blades"))?;
    if count.fract() != 0.0 || !(1.0..=MOST_TRAILERS).contains(&count) {
        let accepted = format!("a whole number from 1 to {MOST_TRAILERS}");
        return Err(table.wrong("count", "is not a number of trailers", accepted));
    }
    let count = count as usize;
    let each = |quantity: &KeyQuantity| {
        let Some(list) = table.number_or_numbers(quantity)? else { return Ok(None) };
        match list.len() {
            1 => Ok(Some(list)),
            length if length == count => Ok(Some(list)),
            _ => {
                let accepted = format!("a number, or a list of {count}, in {}", quantity.unit);
                Err(table.wrong(quantity.key, "has the wrong length", accepted))
            }
        }
    };
    let needed = |quantity: KeyQuantity| {
        each(&quantity)?.ok_or_else(|| table.missing(quantity.key, format!("{}, or a list", quantity.accepted())))
    };
    let headings = table.number_or_numbers(&KeyQuantity::finite("headings", "rad"))?.unwrap_or_default();
    if headings.len() > count {
        let accepted = format!("a list of at most {count} numbers, in rad");
        return Err(table.wrong("headings", "are more than the trailers", accepted));
    }
    Ok(TrailersSpec {
        count,
        mass: needed(KeyQuantity::positive("mass", "kg"))?,
        inertia: needed(KeyQuantity::positive("inertia", "kg m^2"))?,
        offset: each(&KeyQuantity::finite("offset", "m"))?.unwrap_or_else(|| vec![0.0]),
        hitch: each(&KeyQuantity::finite("hitch", "m"))?.unwrap_or_else(|| vec![0.0]),
        bar: needed(KeyQuantity::positive("bar", "m"))?,
        headings,
    })
}
