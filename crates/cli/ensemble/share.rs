use std::ops::Range;
use std::str::FromStr;

/// One of some equal parts of the members of a sweep, such as `3/64`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Share {
    number: u64,
    of: u64,
}

impl Share {
    /// Part `number`, counted from 1, of `of` parts.
    pub(super) fn new(number: u64, of: u64) -> Self {
        Self { number, of }
    }

    /// The members of this part, in a sweep of `count` members.
    pub(super) fn members(self, count: u64) -> Range<u64> {
        let until = |part: u64| (u128::from(count) * u128::from(part) / u128::from(self.of)) as u64;
        until(self.number - 1)..until(self.number)
    }
}

impl std::fmt::Display for Share {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Share {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers =
            text.split_once('/').and_then(|(number, of)| Some((number.trim().parse().ok()?, of.trim().parse().ok()?)));
        match numbers {
            Some((number, of)) if 1 <= number && number <= of => Ok(Self { number, of }),
            _ => Err("accepted is I/N, for example 3/64: part I of N parts, with I from 1 to N".to_owned()),
        }
    }
}
