use crate::table::as_f64;
use std::f64::consts::TAU;
use toml::de::DeValue;

/// What a value of `[random]` may be.
pub(crate) const ACCEPTED: &str = "{ uniform = [a, b] } with a at most b, { log_uniform = [a, b] } with 0 < a at most b, or \
                                   { normal = [mean, deviation] } with a deviation of 0 or more";

/// How a number is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Draw {
    /// Evenly between two numbers.
    Uniform(f64, f64),
    /// Evenly in its logarithm, between two positive numbers.
    LogUniform(f64, f64),
    /// Normally, with this mean and this standard deviation.
    Normal(f64, f64),
}

impl Draw {
    /// Reads `{ uniform = [a, b] }` and the like. An error names the problem, as "is not a distribution".
    pub(crate) fn read(value: &DeValue<'_>) -> Result<Self, &'static str> {
        const NONE: &str = "is not a distribution";
        let table = value.as_table().filter(|table| table.len() == 1).ok_or(NONE)?;
        let (kind, pair) = table.iter().next().ok_or(NONE)?;
        let pair = pair.get_ref().as_array().filter(|pair| pair.len() == 2).ok_or(NONE)?;
        let number = |i: usize| as_f64(pair[i].get_ref()).filter(|number| number.is_finite());
        let (a, b) = number(0).zip(number(1)).ok_or("has an end that is not a finite number")?;
        match kind.get_ref().as_ref() {
            "uniform" | "log_uniform" if a > b => Err("has its larger end first"),
            "uniform" => Ok(Self::Uniform(a, b)),
            "log_uniform" if a > 0.0 => Ok(Self::LogUniform(a, b)),
            "log_uniform" => Err("has an end that is not positive"),
            "normal" if b >= 0.0 => Ok(Self::Normal(a, b)),
            "normal" => Err("has a negative deviation"),
            _ => Err(NONE),
        }
    }

    /// The number that is drawn from a stream.
    pub(crate) fn sample(self, stream: Stream) -> f64 {
        // From 53 bits, the middle of their interval: neither 0 nor 1.
        let unit = |i: u64| ((stream.and(i).0 >> 11) as f64 + 0.5) * (1.0 / 9_007_199_254_740_992.0);
        match self {
            Self::Uniform(a, b) => a + (b - a) * unit(0),
            Self::LogUniform(a, b) => (a.ln() + (b.ln() - a.ln()) * unit(0)).exp(),
            // Box and Muller 1958.
            Self::Normal(mean, deviation) => mean + deviation * (-2.0 * unit(0).ln()).sqrt() * (TAU * unit(1)).cos(),
        }
    }
}

/// Random bits that belong to a list of numbers and names, and to nothing that was drawn before.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stream(u64);

impl Stream {
    /// The stream of a seed alone.
    pub(crate) fn of(seed: u64) -> Self {
        Self(mixed(seed))
    }

    /// With one more number.
    pub(crate) fn and(self, number: u64) -> Self {
        Self(mixed(self.0 ^ number))
    }

    /// With one more name.
    pub(crate) fn named(self, name: &str) -> Self {
        name.bytes().fold(self, |stream, byte| stream.and(u64::from(byte)))
    }
}

/// The output of SplitMix64 at a state (Steele, Lea and Flood 2014, OOPSLA, 453-472).
fn mixed(state: u64) -> u64 {
    let z = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
