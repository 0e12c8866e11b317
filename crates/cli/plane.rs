use crate::coordinate::{Coordinate, Place};
use clap::ValueEnum;
use std::f64::consts::PI;
use std::str::FromStr;

/// The surface of a Poincare section.
#[derive(Debug, Clone)]
pub(crate) struct Plane {
    /// As it was written.
    pub(crate) text: String,
    what: What,
}

#[derive(Debug, Clone, Copy)]
enum What {
    /// A quantity that has a value.
    Of(Coordinate, f64),
    /// Every multiple of a period (s).
    Period(f64),
}

/// Which crossings count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Crossed {
    /// Where the quantity rises through the value
    Rising,
    /// Where it falls
    Falling,
    /// All
    Both,
}

impl Crossed {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Rising => "rising",
            Self::Falling => "falling",
            Self::Both => "both",
        }
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

impl FromStr for Plane {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let accepted = "accepted is NAME=VALUE, as in center_y=0, or t=PERIOD";
        let (name, value) = text.split_once('=').ok_or(accepted)?;
        let number = value.trim().parse().ok().filter(|value: &f64| value.is_finite());
        let value = number.ok_or_else(|| format!("`{}` is not a number; {accepted}", value.trim()))?;
        let what = if name.trim() == "t" {
            if value <= 0.0 {
                return Err(format!("a period is greater than 0; {accepted}"));
            }
            What::Period(value)
        } else {
            What::Of(name.parse().map_err(|error| format!("{error}, or t; {accepted}"))?, value)
        };
        Ok(Self { text: text.to_owned(), what })
    }
}

impl Plane {
    /// The function whose zeros are on the surface; of an angle, also the opposite ones.
    pub(crate) fn value(&self, t: f64, place: &Place) -> f64 {
        match self.what {
            What::Of(coordinate, value) if coordinate.is_angle() => (coordinate.at(place) - value).sin(),
            What::Of(coordinate, value) => coordinate.at(place) - value,
            What::Period(period) => (PI * t / period).sin(),
        }
    }

    /// Whether a zero of the function is on the surface.
    pub(crate) fn holds(&self, place: &Place) -> bool {
        match self.what {
            What::Of(coordinate, value) if coordinate.is_angle() => (coordinate.at(place) - value).cos() > 0.0,
            _ => true,
        }
    }

    /// The period of a section in time (s).
    pub(crate) fn period(&self) -> Option<f64> {
        if let What::Period(period) = self.what { Some(period) } else { None }
    }

    /// What a section shows where nobody says.
    pub(crate) fn axes(&self) -> [&'static str; 2] {
        match self.what {
            What::Of(Coordinate { name: "heading", .. }, _) => ["speed", "turn_rate"],
            What::Of(Coordinate { name: "turn_rate", .. }, _) => ["heading", "speed"],
            What::Of(Coordinate { name: "along", .. }, _) => ["across", "turn_rate"],
            What::Of(Coordinate { name: "across", .. }, _) => ["along", "turn_rate"],
            _ => ["heading", "turn_rate"],
        }
    }
}
