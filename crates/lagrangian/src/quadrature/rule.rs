use thiserror::Error;

/// One node of a quadrature over a step: where, as a fraction of the step, and with what weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RuleNode {
    /// Position, 0 at the beginning of the step and 1 at its end.
    pub alpha: f64,
    /// Weight.
    pub weight: f64,
}

/// A quadrature rule on the straight line from `q0` to `q1`: [`Midpoint`], [`Trapezoid`] or [`Alpha`].
///
/// It gives a discrete Lagrangian `L_d = h sum_i w_i L(t_i, q_i, v)`, the discrete forces that belong to it, and a
/// discrete constraint `w_d = sum_i w_i [A(q_i, t_i) v + b(q_i, t_i)]`, with `q_i = q0 + alpha_i h v`,
/// `t_i = t0 + alpha_i h` and `v = (q1 - q0)/h`. (Marsden and West 2001, Acta Numerica 10, 357-514, section 2.3.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    nodes: [RuleNode; 2],
    count: usize,
}

impl Rule {
    /// The nodes.
    #[must_use]
    #[inline(always)]
    pub fn nodes(&self) -> &[RuleNode] {
        // One or both: a slice of any length would be checked.
        if self.count == 1 { &self.nodes[..1] } else { &self.nodes }
    }
}

/// One node in the middle: order 2, self-adjoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Midpoint;

/// The two end points: order 2, self-adjoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Trapezoid;

/// One node at `q0 + alpha (q1 - q0)`: order 1 unless `alpha = 1/2`; its adjoint has the weight `1 - alpha`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alpha(f64);

/// The weight of a rule was not a number from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("alpha must lie between 0 and 1, and is {alpha}")]
pub struct NotAWeight {
    /// What was given.
    pub alpha: f64,
}

impl Alpha {
    /// The rule with its node at the fraction `alpha` of the step, `0 <= alpha <= 1`.
    ///
    /// # Errors
    /// [`NotAWeight`] for any other number.
    pub fn new(alpha: f64) -> Result<Self, NotAWeight> {
        if (0.0..=1.0).contains(&alpha) { Ok(Self(alpha)) } else { Err(NotAWeight { alpha }) }
    }

    /// Whether this is the midpoint rule, the only self-adjoint one of the family.
    #[must_use]
    #[allow(clippy::float_cmp, reason = "only the number 1/2 itself makes the rule symmetric")]
    pub fn is_symmetric(&self) -> bool {
        self.0 == 0.5
    }
}

impl From<Alpha> for Rule {
    fn from(Alpha(alpha): Alpha) -> Self {
        Self { nodes: [RuleNode { alpha, weight: 1.0 }; 2], count: 1 }
    }
}

impl From<Midpoint> for Rule {
    fn from(_: Midpoint) -> Self {
        Alpha(0.5).into()
    }
}

impl From<Trapezoid> for Rule {
    fn from(_: Trapezoid) -> Self {
        Self { nodes: [0.0, 1.0].map(|alpha| RuleNode { alpha, weight: 0.5 }), count: 2 }
    }
}
