use expression::{Error, Expression, Graph, Tape};
use lagrangian::Scalar;

/// Some formulas of time, coordinates and rates, the constants among them told apart from those that are computed.
///
/// With `n` coordinates, variable 0 is time, `1 + i` coordinate `i`, `1 + n + i` its rate, and `1 + 2 n + k` free parameter `k`, or the
/// side `k` of a piece.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tapes {
    tape: Tape,
    /// Which formula each output of the tape is.
    places: Box<[usize]>,
    /// Tapes that are constant, without the zeros.
    constants: Box<[(usize, f64)]>,
}

/// Where formulas are evaluated.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TapePoint<'a, S> {
    pub(crate) t: S,
    pub(crate) q: &'a [S],
    /// The rates; empty for formulas without rates.
    pub(crate) v: &'a [S],
    /// The free parameters; empty if the system has a value for each parameter.
    pub(crate) p: &'a [S],
    /// The sides of the corners in time; empty for a system that is no piece.
    pub(crate) sides: &'a [f64],
}

impl<'a, S> TapePoint<'a, S> {
    /// Where no parameter is left free.
    pub(crate) fn new(t: S, q: &'a [S], v: &'a [S]) -> Self {
        Self { t, q, v, p: &[], sides: &[] }
    }
}

impl Tapes {
    pub(crate) fn new(graph: &Graph, formulas: &[Expression]) -> Result<Self, Error> {
        let (mut places, mut constants, mut computed) = (Vec::new(), Vec::new(), Vec::new());
        for (k, &formula) in formulas.iter().enumerate() {
            match graph.value(formula) {
                Some(0.0) => {}
                Some(x) => constants.push((k, x)),
                None => {
                    places.push(k);
                    computed.push(formula);
                }
            }
        }
        let tape = Tape::new(graph, &computed)?;
        Ok(Self { tape, places: places.into(), constants: constants.into() })
    }

    /// How many operations an evaluation takes.
    pub(crate) fn operations(&self) -> usize {
        self.tape.cost().total()
    }

    /// Tells the formulas that do not vanish, by their number; `n` is the number of coordinates of which the formulas are.
    #[inline]
    pub(crate) fn evaluate<S: Scalar>(&self, n: usize, at: TapePoint<'_, S>, mut result: impl FnMut(usize, S)) {
        self.tell(n, at, &mut result);
    }

    /// Evaluates as a call, compiled once for each type of numbers.
    #[inline(never)]
    fn tell<S: Scalar>(&self, n: usize, at: TapePoint<'_, S>, result: &mut dyn FnMut(usize, S)) {
        for &(k, x) in &self.constants {
            result(k, S::constant(x));
        }
        // Most formulas need few places, and small numbers room for more of them.
        const FEW: usize = 24;
        const MANY: usize = 128;
        let scratch = self.tape.scratch();
        if size_of::<S>() <= 2048 && scratch <= FEW {
            self.interpret(n, at, &mut [S::zero(); FEW], result);
        } else if size_of::<S>() <= 192 && scratch <= MANY {
            self.interpret(n, at, &mut [S::zero(); MANY], result);
        } else {
            self.interpret(n, at, &mut vec![S::zero(); scratch], result);
        }
    }

    #[inline(never)]
    fn interpret<S: Scalar>(
        &self,
        n: usize,
        at: TapePoint<'_, S>,
        scratch: &mut [S],
        result: &mut dyn FnMut(usize, S),
    ) {
        let input = |k: usize| match k.checked_sub(1) {
            None => at.t,
            Some(i) if i < n => at.q[i],
            Some(i) if i < 2 * n => at.v.get(i - n).copied().unwrap_or(at.t),
            // No system has both.
            Some(i) => {
                let side = at.sides.get(i - 2 * n).map_or(at.t, |&side| S::constant(side));
                at.p.get(i - 2 * n).copied().unwrap_or(side)
            }
        };
        let output = |k: usize, x: S| {
            if let Some(&place) = self.places.get(k) {
                result(place, x);
            }
        };
        // There is room: it was made for this tape.
        let _ = self.tape.evaluate_with(input, scratch, output);
    }
}
