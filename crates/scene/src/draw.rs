use crate::sweep::number;
use std::f64::consts::TAU;
use toml::Value;

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
    /// Reads `{ uniform = [a, b] }` and the like.
    pub(crate) fn read(value: &Value) -> Result<Self, String> {
        let accepted = "accepted is { uniform = [a, b] }, { log_uniform = [a, b] } with positive numbers, or { normal = [mean, deviation] }";
        let fail = || format!("is no distribution; {accepted}");
        let table = value.as_table().filter(|table| table.len() == 1).ok_or_else(fail)?;
        let (kind, pair) = table.iter().next().ok_or_else(fail)?;
        let pair = pair.as_array().filter(|pair| pair.len() == 2).ok_or_else(fail)?;
        let (a, b) = number(&pair[0]).zip(number(&pair[1])).ok_or_else(fail)?;
        match kind.as_str() {
            "uniform" => Ok(Self::Uniform(a, b)),
            "log_uniform" if a > 0.0 && b > 0.0 => Ok(Self::LogUniform(a, b)),
            "normal" if b >= 0.0 => Ok(Self::Normal(a, b)),
            _ => Err(fail()),
        }
    }

    /// The number that a member draws for its key `k`: a function of these and of the seed, and of nothing that was drawn before.
    pub(crate) fn sample(self, seed: u64, member: u64, k: u64) -> f64 {
        let bits = |i: u64| mixed(mixed(mixed(seed) ^ member) ^ (2 * k + i));
        // From 53 bits, the middle of their interval: neither 0 nor 1.
        let unit = |i: u64| ((bits(i) >> 11) as f64 + 0.5) * (1.0 / 9_007_199_254_740_992.0);
        match self {
            Self::Uniform(a, b) => a + (b - a) * unit(0),
            Self::LogUniform(a, b) => (a.ln() + (b.ln() - a.ln()) * unit(0)).exp(),
            // Box and Muller 1958.
            Self::Normal(mean, deviation) => mean + deviation * (-2.0 * unit(0).ln()).sqrt() * (TAU * unit(1)).cos(),
        }
    }
}

/// The output of SplitMix64 at a state (Steele, Lea and Flood 2014, OOPSLA, 453-472).
fn mixed(state: u64) -> u64 {
    let z = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
