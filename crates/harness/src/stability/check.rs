//! Checks on the numbers of a run: small functions, each of which measures one quantity against its bar.

use lagrangian::linear::larger;

/// A measured quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finding {
    /// Its name.
    pub what: &'static str,
    /// Its value.
    pub measured: f64,
    /// Its largest allowed value.
    pub bar: f64,
}

impl Finding {
    /// Whether it meets its bar; NaN does not.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.measured <= self.bar
    }

    /// The fraction of the bar, to find the worst of several.
    #[must_use]
    pub fn part(&self) -> f64 {
        if self.measured == 0.0 { 0.0 } else { self.measured / self.bar }
    }
}

/// The most that rounding can do in `steps` steps to a number of the size `size`: some operations a step, each wrong by half an ulp and all
/// in the same sense. (Higham 2002, Accuracy and Stability of Numerical Algorithms, section 4.2.)
#[must_use]
pub fn rounding(steps: usize, size: f64) -> f64 {
    /// Operations in a step that one number of its result depends on.
    const OPERATIONS: f64 = 32.0;
    OPERATIONS * 0.5 * f64::EPSILON * (steps + 1) as f64 * size
}

/// The largest relative error of a method of the given order over `length` time constants with steps of `part` of one: the size of the
/// terms that it leaves out, `part^order` for each time constant. For `part` above one it is no bound.
#[must_use]
pub fn truncation(order: u32, part: f64, length: f64) -> f64 {
    length * part.powf(f64::from(order))
}

/// The largest size of some numbers, under a name.
#[must_use]
pub fn largest(what: &'static str, sizes: impl IntoIterator<Item = f64>, bar: f64) -> Finding {
    Finding { what, measured: sizes.into_iter().fold(0.0, larger), bar }
}

/// The number of values whose sign differs from the sign of the first; zero counts as another sign.
#[must_use]
pub fn sign_kept(values: impl IntoIterator<Item = f64>) -> Finding {
    let sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
    let mut signs = values.into_iter().map(|x| sign(x).to_bits());
    let first = signs.next();
    let changed = signs.filter(|sign| Some(*sign) != first).count();
    Finding { what: "nodes with the wrong sign", measured: changed as f64, bar: 0.0 }
}

/// The change of values that should be constant.
#[must_use]
pub fn constant(values: impl IntoIterator<Item = f64>, bar: f64) -> Finding {
    let mut values = values.into_iter();
    let first = values.next().unwrap_or(f64::NAN);
    largest("change of an integral", values.map(|x| x - first), bar)
}

/// A quantity that was measured elsewhere.
#[must_use]
pub fn measured(what: &'static str, measured: f64, bar: f64) -> Finding {
    Finding { what, measured, bar }
}
