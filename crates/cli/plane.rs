use crate::coordinate::{Coordinate, name_and_value};
use clap::ValueEnum;
use scene::Built;
use std::f64::consts::PI;
use std::str::FromStr;

/// The surface of a Poincare section, as it was asked for.
#[derive(Debug, Clone)]
pub(crate) struct Plane {
    /// As it was written.
    pub(crate) text: String,
    surface: Surface<String>,
}

/// A surface, with the name of its quantity, or with the quantity in a system.
#[derive(Debug, Clone)]
pub(crate) enum Surface<Q> {
    /// A quantity that has a value.
    Of(Q, f64),
    /// Every multiple of a period (s).
    Period(f64),
}

/// Which crossings count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Crossed {
    /// Where the quantity rises through the value
    Rising,
    /// Where the quantity falls through the value
    Falling,
    /// In both directions
    Both,
}

impl Crossed {
    pub(crate) fn name(self) -> &'static str {
        ["rising", "falling", "both"][self as usize]
    }
}

impl From<Crossed> for dla::Direction {
    fn from(crossed: Crossed) -> Self {
        match crossed {
            Crossed::Rising => Self::Rising,
            Crossed::Falling => Self::Falling,
            Crossed::Both => Self::Both,
        }
    }
}

const ACCEPTED: &str = "accepted is NAME=VALUE, for example center_y=0, or t=PERIOD";

impl FromStr for Plane {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let surface = match name_and_value(text, ACCEPTED)? {
            (name, period) if name == "t" && period <= 0.0 => {
                return Err(format!("the period must be greater than 0; {ACCEPTED}"));
            }
            (name, period) if name == "t" => Surface::Period(period),
            (name, value) => Surface::Of(name, value),
        };
        Ok(Self { text: text.to_owned(), surface })
    }
}

impl Plane {
    /// The period of a section in time (s).
    pub(crate) fn period(&self) -> Option<f64> {
        if let Surface::Period(period) = self.surface { Some(period) } else { None }
    }

    /// The surface in a system.
    ///
    /// # Errors
    /// The message if the system has no such quantity.
    pub(crate) fn on(&self, system: &Built<'_>) -> Result<Surface<Coordinate>, String> {
        Ok(match &self.surface {
            Surface::Of(name, value) => {
                let quantity = Coordinate::of(system, name).map_err(|error| format!("{error}, or t; {ACCEPTED}"))?;
                Surface::Of(quantity, *value)
            }
            Surface::Period(period) => Surface::Period(*period),
        })
    }

    /// The default axes of a section: for a sleigh by the quantity of the plane; otherwise the first coordinate that is not the plane's, and its
    /// rate.
    pub(crate) fn axes(&self, system: &Built<'_>) -> [String; 2] {
        let name = if let Surface::Of(name, _) = &self.surface { name.as_str() } else { "t" };
        let axes = match name {
            "heading" => ["speed", "turn_rate"],
            "turn_rate" => ["heading", "speed"],
            "along" => ["across", "turn_rate"],
            "across" => ["along", "turn_rate"],
            _ => ["heading", "turn_rate"],
        };
        if system.sleigh().is_some() {
            return axes.map(str::to_owned);
        }
        let names: Vec<String> = system.quantities().into_iter().map(|quantity| quantity.name).collect();
        let plane = system.named(name);
        let rate = |k: usize| k + system.own().0;
        let shown = (0..system.own().0).find(|&k| plane.is_none_or(|plane| plane != k && plane != rate(k)));
        let k = shown.unwrap_or(0);
        [k, rate(k)].map(|k| names[k].clone())
    }
}

impl Surface<Coordinate> {
    /// The function whose zeros are on the surface; of an angle, also the opposite ones.
    pub(crate) fn value(&self, system: &Built<'_>, t: f64, q: &[f64], v: &[f64]) -> f64 {
        match self {
            Self::Of(coordinate, value) => {
                let off = coordinate.value(system, t, q, v) - value;
                if coordinate.quantity.angle { off.sin() } else { off }
            }
            Self::Period(period) => (PI * t / period).sin(),
        }
    }

    /// Whether a zero of the function is on the surface.
    pub(crate) fn holds(&self, system: &Built<'_>, t: f64, q: &[f64], v: &[f64]) -> bool {
        match self {
            Self::Of(coordinate, value) if coordinate.quantity.angle => {
                (coordinate.value(system, t, q, v) - value).cos() > 0.0
            }
            _ => true,
        }
    }
}
