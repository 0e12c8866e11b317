//! Whether formulas have the period of the angles in them.

use super::tables::Tables;
use super::{Entry, Problem, TextError, Unit, Words};
use crate::{Expression, Turned};

/// Number of points at which a formula is evaluated if its form does not tell whether it has the period of an angle.
const PLACES: usize = 48;

impl Tables {
    /// Refuses a formula whose value changes after a full turn of an angle.
    pub(crate) fn periodic(&self, words: &Words, formula: Expression, entry: Entry) -> Result<(), TextError> {
        for (i, (name, unit)) in words.coordinates.iter().enumerate() {
            let variable = 1 + i as u32;
            let same = *unit != Unit::Angle
                || match self.graph.turned(formula, variable) {
                    Turned::Same => true,
                    Turned::Changed => false,
                    Turned::Open(parts) => self.graph.may_be_same(&parts, variable, &self.places(words)),
                };
            if !same {
                return Err(TextError { entry, problem: Problem::NoPeriod { angle: name.clone() } });
            }
        }
        Ok(())
    }

    /// Values of all variables, the same in every run. They have several sizes, and some are positive, since the domain of a formula and
    /// the places of its corners are not known.
    fn places(&self, words: &Words) -> Vec<Vec<f64>> {
        let mut random = 0;
        let place = |k: usize| {
            let size = [0.3, 3.0, 30.0, 300.0][k % 4];
            let mut drawn = || {
                let x = size * uniform(&mut random);
                if k % 8 < 4 { x.abs() } else { x }
            };
            let state: Vec<f64> = (0..=2 * self.n).map(|_| drawn()).collect();
            state.into_iter().chain(words.parameters.iter().map(|(_, value)| *value)).collect()
        };
        (0..PLACES).map(place).collect()
    }
}

/// A number between -1 and 1 (splitmix64).
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (((z ^ (z >> 31)) >> 11) as f64).mul_add(2.0_f64.powi(-52), -1.0)
}
