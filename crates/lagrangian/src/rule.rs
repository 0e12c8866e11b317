use thiserror::Error;

/// One node of a quadrature over a step: where, as a fraction of the step, and with what weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RuleNode {
    /// Position, 0 at the beginning of the step and 1 at its end.
    pub alpha: f64,
    /// Weight.
    pub weight: f64,
}

/// A quadrature rule on the straight line from `q0` to `q1`.
///
/// It gives a discrete Lagrangian `L_d = h sum_i w_i L(t_i, q_i, v)`, the discrete forces that belong to it, and a
/// discrete constraint `w_d = sum_i w_i [A(q_i, t_i) v + b(q_i, t_i)]`, with `q_i = q0 + alpha_i h v`,
/// `t_i = t0 + alpha_i h` and `v = (q1 - q0)/h`. (Marsden and West 2001, Acta Numerica 10, 357-514, section 2.3.)
pub trait Rule {
    /// Whether derivatives at its nodes are compiled into each step by it: some percent quicker to run than the function that
    /// other rules have in common, and longer to compile.
    const IN_PLACE: bool = false;

    /// The nodes.
    fn nodes(&self) -> &[RuleNode];
}

/// One node in the middle: order 2, self-adjoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Midpoint;

/// The two end points: order 2, self-adjoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Trapezoid;

/// One node at `q0 + alpha (q1 - q0)`: order 1 unless `alpha = 1/2`; its adjoint has the weight `1 - alpha`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alpha([RuleNode; 1]);

/// The mean of the rules with `alpha` and with `1 - alpha`: order 2, self-adjoint. `alpha = 0` is the trapezoid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Symmetrised([RuleNode; 2]);

/// One of the rules above, which a program knows only when it runs: a step by it is compiled once for all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnyRule {
    nodes: [RuleNode; 2],
    count: usize,
}

/// The weight of a rule was not a number from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("alpha must lie between 0 and 1, and is {alpha}")]
pub struct NotAWeight {
    /// What was given.
    pub alpha: f64,
}

fn checked(alpha: f64) -> Result<f64, NotAWeight> {
    if (0.0..=1.0).contains(&alpha) { Ok(alpha) } else { Err(NotAWeight { alpha }) }
}

impl Alpha {
    /// The rule with its node at the fraction `alpha` of the step, `0 <= alpha <= 1`.
    ///
    /// # Errors
    /// [`NotAWeight`] for any other number.
    pub fn new(alpha: f64) -> Result<Self, NotAWeight> {
        Ok(Self([RuleNode { alpha: checked(alpha)?, weight: 1.0 }]))
    }
}

impl Alpha {
    /// Whether this is the midpoint rule, the only self-adjoint one of the family.
    #[must_use]
    #[allow(clippy::float_cmp, reason = "only the number 1/2 itself makes the rule symmetric")]
    pub fn is_symmetric(&self) -> bool {
        self.0[0].alpha == 0.5
    }
}

impl Symmetrised {
    /// The rule with its nodes at the fractions `alpha` and `1 - alpha` of the step, `0 <= alpha <= 1`.
    ///
    /// # Errors
    /// [`NotAWeight`] for any other number.
    pub fn new(alpha: f64) -> Result<Self, NotAWeight> {
        let alpha = checked(alpha)?;
        Ok(Self([alpha, 1.0 - alpha].map(|alpha| RuleNode { alpha, weight: 0.5 })))
    }
}

impl Rule for Midpoint {
    const IN_PLACE: bool = true;

    #[inline(always)]
    fn nodes(&self) -> &[RuleNode] {
        &[RuleNode { alpha: 0.5, weight: 1.0 }]
    }
}
impl Rule for Trapezoid {
    #[inline(always)]
    fn nodes(&self) -> &[RuleNode] {
        &[RuleNode { alpha: 0.0, weight: 0.5 }, RuleNode { alpha: 1.0, weight: 0.5 }]
    }
}
impl Rule for Alpha {
    #[inline(always)]
    fn nodes(&self) -> &[RuleNode] {
        &self.0
    }
}
impl Rule for Symmetrised {
    #[inline(always)]
    fn nodes(&self) -> &[RuleNode] {
        &self.0
    }
}
impl Rule for AnyRule {
    #[inline(always)]
    fn nodes(&self) -> &[RuleNode] {
        // One or both: a slice of any length would be checked.
        if self.count == 1 { &self.nodes[..1] } else { &self.nodes }
    }
}

macro_rules! any_rule {
    ($($rule:ty),*) => {
        $(impl From<$rule> for AnyRule {
            fn from(rule: $rule) -> Self {
                let nodes = rule.nodes();
                Self { nodes: [nodes[0], nodes[nodes.len() - 1]], count: nodes.len() }
            }
        })*
    };
}
any_rule!(Midpoint, Trapezoid, Alpha, Symmetrised);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_rule_has_the_nodes_of_the_one_it_is() {
        fn same<R: Rule + Into<AnyRule> + Copy>(rule: R) {
            let any: AnyRule = rule.into();
            assert_eq!(any.nodes(), rule.nodes());
        }
        same(Midpoint);
        same(Trapezoid);
        same(Alpha::new(0.3).unwrap());
        same(Symmetrised::new(0.3).unwrap());
    }
}
