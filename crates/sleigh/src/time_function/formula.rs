use crate::SleighError;
use expression::{Corners, Expression, Graph, Names, Series, Tape, parse};
use lagrangian::{Piecewise, Scalar, ScalarFunction};
use serde::{Serialize, Serializer};
use std::fmt;
use std::sync::Arc;

/// A function of time as a formula in `t` (s), as `0.2*t*exp(-t/5)`, with what [`expression`] knows.
///
/// Its derivatives are exact on every number that carries derivatives. Where `abs`, `sign`, `min` or `max` turns, it has a corner or jumps:
/// like a [`Table`](crate::Table) it is then evaluated as one of its pieces, as soon as [`Piecewise::piece`] has chosen one.
#[derive(Clone)]
pub struct Formula {
    text: Arc<str>,
    whole: Arc<FormulaTapes>,
    pieces: Option<Arc<FormulaPieces>>,
    /// The sides of the corners in the piece that is evaluated.
    sides: Option<Arc<[f64]>>,
    constant: bool,
}

/// A formula with variables for the sides of its corners.
#[derive(Debug)]
struct FormulaPieces {
    corners: Corners,
    tapes: FormulaTapes,
}

/// The function and its first derivatives in time, by their order.
#[derive(Debug)]
struct FormulaTapes(Vec<Tape>);

/// Number of derivatives that get formulas: the equations of motion need no more. Derivatives of higher order come from [`Series`].
const FORMULAS: usize = 2;

/// Maximum number of intermediate results that a formula may need at a time: they lie on the stack.
const ROOM: usize = 128;

/// Maximum number of terms and factors of a formula, and the further number that its derivatives may have.
const LARGEST: usize = 1 << 17;
const DERIVED: usize = 1 << 13;

impl Formula {
    /// The function with this text.
    ///
    /// # Errors
    /// [`SleighError::Formula`] if the text is no formula in `t`, needs too many numbers at a time, or has no finite value at
    /// `t = 0`.
    pub fn new(text: &str) -> Result<Self, SleighError> {
        let fail = |problem: String| SleighError::Formula { problem };
        let wrong = |error: expression::Error| fail(error.to_string());
        let names = Names::of(["t"]).map_err(wrong)?;
        let mut graph = Graph::with_limit(LARGEST);
        let t = graph.variable(0);
        let whole = graph.build(&parse(text, &names).map_err(wrong)?, &[t]).map_err(wrong)?;
        let pieces = match Corners::of(&mut graph, &[whole], 0, 1).map_err(wrong)? {
            Some((corners, pieces)) => {
                let tapes = FormulaTapes::of(graph.clone(), pieces[0]).map_err(fail)?;
                Some(Arc::new(FormulaPieces { corners, tapes }))
            }
            None => None,
        };
        let whole = Arc::new(FormulaTapes::of(graph, whole).map_err(fail)?);
        let formula = Self { text: text.into(), constant: whole.0[0].inputs() == 0, whole, pieces, sides: None };
        let start = formula.at(0, 0.0);
        if start.is_finite() { Ok(formula) } else { Err(fail(format!("its value at t = 0 is {start}"))) }
    }

    /// The text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the formula does not contain `t`.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.constant
    }

    /// The times in an interval (s) at which the formula has a corner or jumps; `None` if there are too many to find.
    #[must_use]
    pub fn corners(&self, from: f64, to: f64) -> Option<Vec<f64>> {
        self.pieces.as_ref().map_or(Some(Vec::new()), |pieces| pieces.corners.between(from, to))
    }

    /// Whether the formula has a corner or jumps within 1e4 s of `t = 0`; also true if there are too many to find.
    #[must_use]
    pub fn has_corners(&self) -> bool {
        const FAR: f64 = 1e4;
        self.corners(-FAR, FAR).is_none_or(|corners| !corners.is_empty())
    }

    /// The tapes that hold, and the sides of their corners.
    fn in_use(&self) -> (&FormulaTapes, &[f64]) {
        match (&self.pieces, &self.sides) {
            (Some(pieces), Some(sides)) => (&pieces.tapes, sides),
            _ => (&self.whole, &[]),
        }
    }

    /// A derivative, by its order, at `t`.
    fn at(&self, order: usize, t: f64) -> f64 {
        let (tapes, sides) = self.in_use();
        tapes.at(order, t, sides)
    }

    /// A derivative, by its order, on any number.
    #[inline(always)]
    pub(super) fn derivative<S: Scalar>(&self, order: usize, t: S) -> S {
        t.apply(FormulaDerivative { formula: self, order })
    }
}

impl FormulaTapes {
    /// The formula with as many of its derivatives as have room.
    fn of(graph: Graph, formula: Expression) -> Result<Self, String> {
        let mut graph = graph.with_room(DERIVED);
        let first = Tape::new(&graph, &[formula]).map_err(|error| error.to_string())?;
        if first.scratch() > ROOM {
            return Err(format!("the formula needs more than {ROOM} numbers at a time"));
        }
        let (mut tapes, mut derivative) = (vec![first], formula);
        for _ in 0..FORMULAS {
            derivative = graph.derivative(derivative, 0);
            match Tape::new(&graph, &[derivative]) {
                Ok(tape) if tape.scratch() <= ROOM => tapes.push(tape),
                _ => break,
            }
        }
        Ok(Self(tapes))
    }

    /// A derivative, by its order, at `t` and on these sides.
    fn at(&self, order: usize, t: f64, sides: &[f64]) -> f64 {
        let side = |k: usize| sides.get(k - 1).copied().unwrap_or(0.0);
        let mut value = f64::NAN;
        // There is as much scratch as the tapes were asked for.
        match self.0.get(order) {
            Some(tape) => {
                let input = |k: usize| if k == 0 { t } else { side(k) };
                let _ = tape.evaluate_with(input, &mut [0.0; ROOM], |_, x| value = x);
            }
            None => {
                let input = |k: usize| if k == 0 { Series::variable(t) } else { Series::constant(side(k)) };
                let told = |_, x: Series| value = x.derivative(order);
                let _ = self.0[0].evaluate_with(input, &mut [Series::constant(0.0); ROOM], told);
            }
        }
        value
    }
}

impl Piecewise for Formula {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        // More than can be told are refused where the scene is read.
        self.corners(from, to).unwrap_or_default()
    }

    fn piece(&self, t: f64) -> Self {
        let sides = self.pieces.as_ref().map(|pieces| pieces.corners.sides(t).into());
        Self { sides, ..self.clone() }
    }
}

/// A formula is its text, in files and for debugging.
impl Serialize for Formula {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&self.text)
    }
}

impl fmt::Debug for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Formula").field("text", &self.text).field("sides", &self.sides).finish_non_exhaustive()
    }
}

/// Formulas with the same text have the same derivatives.
impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text && self.sides == other.sides
    }
}

/// A derivative of a formula.
#[derive(Clone, Copy)]
struct FormulaDerivative<'f> {
    formula: &'f Formula,
    order: usize,
}

impl FormulaDerivative<'_> {
    fn next(self) -> Self {
        Self { order: self.order + 1, ..self }
    }
}

impl ScalarFunction for FormulaDerivative<'_> {
    /// It may be of any kind.
    const SMOOTH: bool = false;

    fn expressed<S: Scalar>(self, t: S) -> Option<S> {
        let (tapes, sides) = self.formula.in_use();
        let (tape, mut value) = (tapes.0.get(self.order)?, None);
        let side = |k: usize| S::constant(sides.get(k - 1).copied().unwrap_or(0.0));
        let input = |k: usize| if k == 0 { t } else { side(k) };
        tape.evaluate_with(input, &mut vec![S::zero(); tape.scratch()], |_, x| value = Some(x)).ok()?;
        value
    }

    fn value(self, t: f64) -> f64 {
        self.formula.at(self.order, t)
    }
    fn slope<S: Scalar>(self, t: S, _f: S) -> S {
        t.apply(self.next())
    }
    fn curvature<S: Scalar>(self, t: S, _f: S, _slope: S) -> S {
        t.apply(self.next().next())
    }
}
