use crate::Function;
use crate::function::power;
use crate::graph::{Expression, NodeKind};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// All numbers from one to another, in which the values of an expression lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interval {
    pub(crate) least: f64,
    pub(crate) most: f64,
}

impl Interval {
    const ALL: Self = Self { least: f64::NEG_INFINITY, most: f64::INFINITY };

    pub(crate) fn new(least: f64, most: f64) -> Self {
        Self { least, most }
    }

    pub(crate) fn at(x: f64) -> Self {
        Self::new(x, x)
    }

    /// A number that has been rounded.
    pub(crate) fn near(x: f64) -> Self {
        Self::at(x).rounded()
    }

    /// Whether zero is among them, as far as is known.
    pub(crate) fn has_zero(self) -> bool {
        // What is no number may be any.
        !(self.least > 0.0 || self.most < 0.0)
    }

    /// The interval with the rounding of an operation; all numbers where an end is none.
    fn rounded(self) -> Self {
        let wide = |x: f64| 4.0 * f64::EPSILON * x.abs();
        let Self { least, most } = self;
        if least.is_nan() || most.is_nan() {
            return Self::ALL;
        }
        Self::new(
            least - if least.is_finite() { wide(least) } else { 0.0 },
            most + if most.is_finite() { wide(most) } else { 0.0 },
        )
    }

    /// The values of a function that never falls.
    fn rising(self, f: impl Fn(f64) -> f64) -> Self {
        Self::new(f(self.least), f(self.most)).rounded()
    }

    fn negated(self) -> Self {
        Self::new(-self.most, -self.least)
    }

    pub(crate) fn plus(self, o: Self) -> Self {
        Self::new(self.least + o.least, self.most + o.most).rounded()
    }

    pub(crate) fn scaled(self, c: f64) -> Self {
        if c < 0.0 { Self::new(self.most * c, self.least * c) } else { Self::new(self.least * c, self.most * c) }
            .rounded()
    }

    fn times(self, o: Self) -> Self {
        // Of ends that are not finite nothing is known.
        let all = [self.least * o.least, self.least * o.most, self.most * o.least, self.most * o.most];
        if all.iter().any(|x| x.is_nan()) {
            return Self::ALL;
        }
        Self::new(all.into_iter().fold(f64::INFINITY, f64::min), all.into_iter().fold(f64::NEG_INFINITY, f64::max))
            .rounded()
    }

    fn abs(self) -> Self {
        match self {
            Self { least, .. } if least >= 0.0 => self,
            Self { most, .. } if most <= 0.0 => self.negated(),
            Self { least, most } => Self::new(0.0, most.max(-least)),
        }
    }

    /// `x^p`.
    fn power(self, p: f64) -> Self {
        if p < 0.0 {
            let below = self.power(-p);
            return if below.has_zero() { Self::ALL } else { Self::new(1.0 / below.most, 1.0 / below.least).rounded() };
        }
        let whole = p.fract() == 0.0;
        if whole && p % 2.0 == 0.0 {
            return self.abs().rising(|x| power(x, p));
        }
        if whole {
            return self.rising(|x| power(x, p));
        }
        // Where the base is negative there is no value.
        if self.most < 0.0 { Self::ALL } else { Self::new(self.least.max(0.0), self.most).rising(|x| power(x, p)) }
    }

    /// The cosine.
    fn cos(self) -> Self {
        let Self { least, most } = self;
        let narrow = most - least < TAU;
        if !narrow || least.abs().max(most.abs()) > 1e9 {
            return Self::new(-1.0, 1.0);
        }
        // Whether a multiple of a turn, after a shift, lies between.
        let has = |shift: f64| ((most - shift) / TAU + 1e-12).floor() >= ((least - shift) / TAU - 1e-12).ceil();
        let (a, b) = (least.cos(), most.cos());
        let ends = Self::new(a.min(b), a.max(b)).rounded();
        Self::new(if has(PI) { -1.0 } else { ends.least }, if has(0.0) { 1.0 } else { ends.most })
    }

    /// Bounds on the values of an expression, from the bounds on its parts.
    pub(crate) fn of(kind: &NodeKind, variable: impl Fn(u32) -> Self, part: impl Fn(Expression) -> Self) -> Self {
        match kind {
            NodeKind::Constant(x) => Self::at(x.value()),
            NodeKind::Variable(k) => variable(*k),
            NodeKind::Sum { constant, terms } => {
                terms.iter().fold(Self::at(constant.value()), |sum, &(term, c)| sum.plus(part(term).scaled(c.value())))
            }
            NodeKind::Product(factors) => factors
                .iter()
                .map(|&(base, halves)| part(base).power(0.5 * f64::from(halves)))
                .reduce(Self::times)
                .unwrap_or(Self::at(1.0)),
            NodeKind::Power(base, p) => part(*base).power(p.value()),
            NodeKind::Call(function, [a, b]) => Self::called(*function, part(*a), part(*b)),
        }
    }

    fn called(function: Function, a: Self, b: Self) -> Self {
        let within = |least: f64, most: f64| Self::new(a.least.clamp(least, most), a.most.clamp(least, most));
        match function {
            _ if a.least.is_nan() || a.most.is_nan() => Self::ALL,
            Function::Sin => a.plus(Self::at(-FRAC_PI_2)).cos(),
            Function::Cos => a.cos(),
            Function::Tan => {
                let poles = ((a.most - FRAC_PI_2) / PI).floor() - ((a.least - FRAC_PI_2) / PI).floor();
                if a.most - a.least < PI && poles == 0.0 { a.rising(f64::tan) } else { Self::ALL }
            }
            Function::Asin => within(-1.0, 1.0).rising(f64::asin),
            Function::Acos => within(-1.0, 1.0).negated().rising(|x| (-x).acos()),
            Function::Atan => a.rising(f64::atan),
            Function::Sinh => a.rising(f64::sinh),
            Function::Cosh => a.abs().rising(f64::cosh),
            Function::Tanh => a.rising(f64::tanh),
            Function::Exp => a.rising(f64::exp),
            Function::Log => Self::new(a.least.max(0.0), a.most.max(0.0)).rising(f64::ln),
            Function::Sqrt => Self::new(a.least.max(0.0), a.most.max(0.0)).rising(f64::sqrt),
            Function::Abs => a.abs(),
            Function::Sign => Self::new(sign(a.least), sign(a.most)),
            Function::Inverse => a.power(-1.0),
            Function::Floor => Self::new(a.least.floor(), a.most.floor()),
            Function::Where | Function::Unless => {
                let chosen = if function == Function::Where { a.least > 0.0 } else { a.most <= 0.0 };
                let left = if function == Function::Where { a.most <= 0.0 } else { a.least > 0.0 };
                match (chosen, left) {
                    (true, _) => b,
                    (_, true) => Self::at(0.0),
                    _ if b.least.is_nan() || b.most.is_nan() => Self::ALL,
                    _ => Self::new(b.least.min(0.0), b.most.max(0.0)),
                }
            }
            // Where the angle does not jump, it is extreme at a corner.
            Function::Atan2 if !(a.has_zero() && b.least <= 0.0) => {
                let all = [a.least, a.most].map(|y| [b.least, b.most].map(|x| y.atan2(x)));
                let [least, most] = [f64::min, f64::max].map(|of| all.into_iter().flatten().fold(all[0][0], of));
                Self::new(least, most).rounded()
            }
            Function::Atan2 => Self::new(-PI, PI),
            Function::Min => Self::new(a.least.min(b.least), a.most.min(b.most)),
            Function::Max => Self::new(a.least.max(b.least), a.most.max(b.most)),
        }
    }
}

/// -1, 0 or 1.
pub(crate) fn sign(x: f64) -> f64 {
    Function::Sign.of(x, x)
}
