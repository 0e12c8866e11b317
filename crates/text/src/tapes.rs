use expression::{Error, Expression, Graph, Tape};
use lagrangian::Scalar;

/// Some formulas of time, coordinates and rates, the constants among them told apart from those that are computed.
///
/// Of `n` coordinates the variable 0 is time, `1 + i` the coordinate `i`, `1 + n + i` its rate, and `1 + 2 n + k` the parameter `k` of
/// those that are left free.
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
    /// None for formulas in which no rates stand.
    pub(crate) v: &'a [S],
    /// The parameters that are left free: none of a system that has a value for each.
    pub(crate) p: &'a [S],
}

impl<'a, S> TapePoint<'a, S> {
    /// Where no parameter is left free.
    pub(crate) fn new(t: S, q: &'a [S], v: &'a [S]) -> Self {
        Self { t, q, v, p: &[] }
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
        for &(k, x) in &self.constants {
            result(k, S::constant(x));
        }
        let (scratch, all) = (self.tape.scratch(), self.tape.scratch() + self.places.len());
        // Most formulas need few places, and small numbers room for more of them.
        const FEW: usize = 24;
        const MANY: usize = 128;
        if size_of::<S>() <= 2048 && all <= FEW {
            let mut room = [S::zero(); FEW];
            self.computed(n, at, room.split_at_mut(scratch), &mut result);
        } else if size_of::<S>() <= 192 && all <= MANY {
            let mut room = [S::zero(); MANY];
            self.computed(n, at, room.split_at_mut(scratch), &mut result);
        } else {
            let mut room = vec![S::zero(); all];
            self.computed(n, at, room.split_at_mut(scratch), &mut result);
        }
    }

    #[inline]
    fn computed<S: Scalar>(
        &self,
        n: usize,
        at: TapePoint<'_, S>,
        (scratch, computed): (&mut [S], &mut [S]),
        result: &mut impl FnMut(usize, S),
    ) {
        interpret(&self.tape, n, at, scratch, computed);
        for (&k, &x) in self.places.iter().zip(&*computed) {
            result(k, x);
        }
    }
}

/// The tape on one kind of numbers: compiled once for all that have such numbers.
#[inline(never)]
fn interpret<S: Scalar>(tape: &Tape, n: usize, at: TapePoint<'_, S>, scratch: &mut [S], computed: &mut [S]) {
    let input = |k: usize| match k.checked_sub(1) {
        None => at.t,
        Some(i) if i < n => at.q[i],
        Some(i) if i < 2 * n => at.v.get(i - n).copied().unwrap_or(at.t),
        Some(i) => at.p.get(i - 2 * n).copied().unwrap_or(at.t),
    };
    let output = |k: usize, x: S| {
        if let Some(place) = computed.get_mut(k) {
            *place = x;
        }
    };
    // There is room: it was made for this tape.
    let _ = tape.evaluate_with(input, scratch, output);
}
