//! Whether formulas have the period of the angles in them.

use crate::tables::Tables;
use crate::{Entry, Problem, TextError, Unit, Words};
use expression::{Expression, Tape, Turned};
use std::f64::consts::TAU;

/// So many places are looked at where the form of a formula does not say whether it has the period of an angle.
const PLACES: usize = 48;

/// A formula has the period where what is left after a turn is so small beside its terms: their round-off, magnified by what the formula
/// makes of the places.
const ROUNDING: f64 = 1e-9;

impl Tables {
    /// Refuses a formula that is another after a turn of a coordinate that is an angle.
    pub(crate) fn periodic(&self, words: &Words, formula: Expression, entry: Entry) -> Result<(), TextError> {
        for (i, (name, unit)) in words.coordinates.iter().enumerate() {
            let variable = 1 + i as u32;
            let same = *unit != Unit::Angle
                || match self.graph.turned(formula, variable) {
                    Turned::Same => true,
                    Turned::Changed => false,
                    Turned::Open(parts) => self.same_in_numbers(words, &parts, variable),
                };
            if !same {
                return Err(TextError { entry, problem: Problem::NoPeriod { angle: name.clone() } });
            }
        }
        Ok(())
    }

    /// Whether a sum is the same after a turn of a variable, at all places where it is a number.
    fn same_in_numbers(&self, words: &Words, parts: &[(Expression, f64)], variable: u32) -> bool {
        let formulas: Vec<Expression> = parts.iter().map(|part| part.0).collect();
        // What has no room is refused elsewhere.
        let Ok(tape) = Tape::new(&self.graph, &formulas) else { return true };
        let numbers = 1 + 2 * self.n;
        let (mut scratch, mut before, mut after) =
            (vec![0.0; tape.scratch()], vec![0.0; parts.len()], vec![0.0; parts.len()]);
        let mut place: Vec<f64> = vec![0.0; numbers];
        place.extend(words.parameters.iter().map(|(_, value)| value));
        let mut random = 0;
        (0..PLACES).all(|k| {
            // Of several sizes, and some of them positive: where a formula is a number, and where it has a corner, is not known.
            let size = [0.3, 3.0, 30.0, 300.0][k % 4];
            for x in &mut place[..numbers] {
                let drawn = size * uniform(&mut random);
                *x = if k % 8 < 4 { drawn.abs() } else { drawn };
            }
            let mut there = place.clone();
            there[variable as usize] += TAU;
            let evaluated = tape.evaluate(&place, &mut scratch, &mut before).is_ok()
                && tape.evaluate(&there, &mut scratch, &mut after).is_ok();
            let (mut change, mut terms) = (0.0, 0.0);
            for ((&(_, c), x), y) in parts.iter().zip(&before).zip(&after) {
                change += c * (y - x);
                terms += c.abs() * (x.abs() + y.abs());
            }
            // Where it is not a number before or after the turn, nothing is told.
            !evaluated || !f64::is_finite(terms) || f64::abs(change) <= ROUNDING * terms
        })
    }
}

/// A number between -1 and 1, the same ones in every run (splitmix64).
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (((z ^ (z >> 31)) >> 11) as f64).mul_add(2.0_f64.powi(-52), -1.0)
}
