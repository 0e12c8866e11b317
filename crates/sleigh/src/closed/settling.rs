use super::spin_equation::SpinEquation;
use dla::ClosedStepError;

const MAX_ITERATIONS: u32 = 30;

/// What a search has found.
pub(crate) struct FoundTurn {
    /// The spin, with sine and cosine of the half turn.
    pub(crate) w: f64,
    pub(crate) half_turn: (f64, f64),
    /// What is left to correct of it.
    pub(crate) correction: f64,
    /// The spin at the beginning.
    pub(crate) omega0: f64,
    pub(crate) iterations: u32,
}

/// The spin that Newton's method settles at from a first one, and after how many corrections.
pub(crate) fn settled(
    equation: &SpinEquation,
    first: f64,
    (u0, omega0): (f64, f64),
) -> Result<FoundTurn, ClosedStepError> {
    let mut point = equation.at(first)?;
    let (mut settled, mut iterations) = (false, 0);
    loop {
        let correction = equation.correction(&point, u0, omega0);
        // With one more: near a right angle what the last one leaves of the tangent is more than rounding.
        if settled {
            return Ok(FoundTurn { w: point.w, half_turn: (point.sin, point.cos), correction, omega0, iterations });
        }
        (settled, iterations) = (equation.settles(correction), iterations + 1);
        if !settled && (correction.is_nan() || iterations == MAX_ITERATIONS) {
            return Err(failure(equation.k * u0, iterations, correction / point.w));
        }
        point = equation.at(point.w + correction)?;
    }
}

#[cold]
fn failure(gain: f64, iterations: u32, correction: f64) -> ClosedStepError {
    if !gain.is_finite() {
        ClosedStepError::NotFinite { quantity: "h m a u / (2 J)" }
    } else if gain <= -1.0 {
        out_of_branch(gain)
    } else {
        ClosedStepError::IterationLimit { iterations, correction }
    }
}

#[cold]
pub(crate) fn out_of_branch(gain: f64) -> ClosedStepError {
    ClosedStepError::NoSolution {
        quantity: "the growth of the spin in half a step, -h m a u / (2 J),",
        value: -gain,
        bound: 1.0,
    }
}
