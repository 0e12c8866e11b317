use crate::SleighError;
use expression::{Graph, Names, Tape, parse};
use lagrangian::{Scalar, ScalarFunction};
use std::sync::Arc;

/// A function of time as a formula in `t` (s), as `0.2*t*exp(-t/5)`, with what [`expression`] knows.
///
/// Its derivatives are formulas too: exact on every number that carries derivatives.
#[derive(Debug, Clone)]
pub struct Formula {
    text: Arc<str>,
    /// The function and its derivatives in time, by their order.
    derivatives: Arc<[Tape]>,
    constant: bool,
}

/// The highest derivative of a formula. Equations of motion take two, their linearisation one more.
const HIGHEST: usize = 6;

/// The most numbers that a formula may need at a time: they lie on the stack.
const ROOM: usize = 128;

impl Formula {
    /// The function with this text.
    ///
    /// # Errors
    /// [`SleighError::Formula`] where the text is no formula in `t`, needs too many numbers at a time, or has no finite value at
    /// `t = 0`.
    pub fn new(text: &str) -> Result<Self, SleighError> {
        let fail = |problem: String| SleighError::Formula { problem };
        let wrong = |error: expression::Error| fail(error.to_string());
        let names = Names::of(["t"]).map_err(wrong)?;
        let mut graph = Graph::new();
        let t = graph.variable(0);
        let mut derivative = graph.build(&parse(text, &names).map_err(wrong)?, &[t]).map_err(wrong)?;
        let mut tapes = Vec::with_capacity(HIGHEST + 1);
        for _ in 0..=HIGHEST {
            tapes.push(Tape::new(&graph, &[derivative]).map_err(wrong)?);
            derivative = graph.derivative(derivative, 0);
        }
        if tapes.iter().any(|tape| tape.scratch() > ROOM) {
            return Err(fail(format!("the formula or a derivative of it needs more than {ROOM} numbers at a time")));
        }
        let formula = Self { text: text.into(), constant: tapes[0].inputs() == 0, derivatives: tapes.into() };
        let start = formula.at(0, 0.0);
        if start.is_finite() { Ok(formula) } else { Err(fail(format!("its value at t = 0 is {start}"))) }
    }

    /// The text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether `t` does not stand in it.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.constant
    }

    /// A derivative, by its order, at `t`; not a number above the highest.
    fn at(&self, order: usize, t: f64) -> f64 {
        let (mut scratch, mut value) = ([0.0; ROOM], [f64::NAN]);
        if let Some(tape) = self.derivatives.get(order) {
            // Inputs and scratch are as many as the tape was asked for.
            let _ = tape.evaluate(&[t], &mut scratch, &mut value);
        }
        value[0]
    }

    /// The value at `t`.
    #[inline(always)]
    pub(super) fn value<S: Scalar>(&self, t: S) -> S {
        t.apply(FormulaDerivative { formula: self, order: 0 })
    }

    /// The derivative in time at `t`.
    #[inline(always)]
    pub(super) fn slope<S: Scalar>(&self, t: S) -> S {
        t.apply(FormulaDerivative { formula: self, order: 1 })
    }

    /// The second derivative in time at `t`.
    #[inline(always)]
    pub(super) fn curvature<S: Scalar>(&self, t: S) -> S {
        t.apply(FormulaDerivative { formula: self, order: 2 })
    }
}

/// Of the same text are the same derivatives.
impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
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
