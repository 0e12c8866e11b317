use super::sum::exact;
use super::{Expression, Graph, LONG, NodeKind, Number};
use crate::Function;
use crate::function::power;

/// Exponents beyond this, in halves, are left to [`NodeKind::Power`].
pub(crate) const MOST: i32 = 1 << 20;

/// A product that is being made.
#[derive(Debug, Clone)]
pub(crate) struct Product {
    coefficient: f64,
    factors: Vec<(Expression, i32)>,
}

impl Default for Product {
    fn default() -> Self {
        Self { coefficient: 1.0, factors: Vec::new() }
    }
}

impl Graph {
    /// `e^p` with a constant exponent.
    pub fn power(&mut self, e: Expression, p: f64) -> Expression {
        if let Some(x) = self.value(e) {
            return self.constant(power(x, p));
        }
        let halves = (2.0 * p) as i32;
        if f64::from(halves).to_bits() == (2.0 * p + 0.0).to_bits() && halves.abs() <= MOST {
            let mut product = Product::default();
            self.multiply(&mut product, e, halves);
            return self.finish_product(product);
        }
        if !p.is_finite() {
            return self.constant(f64::NAN);
        }
        self.intern(NodeKind::Power(e, Number::new(p)))
    }

    /// `a^b`: a product, a root or a power where `b` is constant, else `exp(b log(a))`, which is no number where `a` is negative.
    pub fn raised(&mut self, a: Expression, b: Expression) -> Expression {
        if let Some(p) = self.value(b) {
            return self.power(a, p);
        }
        let log = self.call(Function::Log, &[a]);
        let exponent = self.product(&[b, log]);
        self.call(Function::Exp, &[exponent])
    }

    /// The product of these.
    pub fn product(&mut self, factors: &[Expression]) -> Expression {
        let mut product = Product::default();
        for &factor in factors {
            self.multiply(&mut product, factor, 2);
        }
        self.finish_product(product)
    }

    /// `a / b`.
    pub fn quotient(&mut self, a: Expression, b: Expression) -> Expression {
        let mut product = Product::default();
        self.multiply(&mut product, a, 2);
        self.multiply(&mut product, b, -2);
        self.finish_product(product)
    }

    /// `c` times the factors with their exponents.
    pub(crate) fn product_of(&mut self, c: f64, factors: &[(Expression, i32)]) -> Expression {
        let mut product = Product { coefficient: c, factors: Vec::new() };
        for &(base, halves) in factors {
            self.multiply(&mut product, base, halves);
        }
        self.finish_product(product)
    }

    /// Multiplies by `e^(halves/2)`; constants, products and powers are opened where that is right for all of their values.
    pub(crate) fn multiply(&mut self, product: &mut Product, e: Expression, halves: i32) {
        let (content, primitive) = if halves % 2 == 0 { self.content(e) } else { (1.0, e) };
        let outside = power(content, f64::from(halves / 2));
        if !(outside.is_normal() && product.scale(outside)) {
            product.factors.push((e, halves));
            return;
        }
        let e = primitive;
        match self.kind(e) {
            NodeKind::Constant(x) => {
                if !product.scale(power(x.value(), 0.5 * f64::from(halves))) {
                    product.factors.push((e, halves));
                }
            }
            NodeKind::Product(inner) if inner.len() < LONG || halves != 2 => {
                let opened: Option<Vec<_>> =
                    inner.iter().map(|&(b, h)| Some((b, opened(h, halves, inner.len() == 1)?))).collect();
                match opened {
                    Some(opened) if halves == 2 => product.factors.extend(opened),
                    // With another exponent a factor may be opened in its turn; exponents are limited, and so is how often.
                    Some(opened) => opened.into_iter().for_each(|(base, halves)| self.multiply(product, base, halves)),
                    None => product.factors.push((e, halves)),
                }
            }
            &NodeKind::Call(Function::Abs, [u, _]) if halves % 4 == 0 => self.multiply(product, u, halves),
            _ => product.factors.push((e, halves)),
        }
    }

    /// The expression of a product: factors in order, equal ones gathered, long products in parts.
    pub(crate) fn finish_product(&mut self, mut product: Product) -> Expression {
        // What is gathered may be opened then: the square of a root, or of a multiple.
        for _ in 0..LONG {
            let gathered = self.gather(&mut product);
            if !gathered {
                break;
            }
        }
        let Product { mut coefficient, mut factors } = product;
        // Constants that were kept apart, and nothing else.
        let values: Option<Vec<_>> = factors.iter().map(|&(base, halves)| Some((self.value(base)?, halves))).collect();
        if let Some(values) = values {
            coefficient *= values.iter().map(|&(x, halves)| power(x, 0.5 * f64::from(halves))).product::<f64>();
            factors.clear();
        }
        if coefficient == 0.0 || !coefficient.is_finite() {
            return self.constant(coefficient);
        }
        while factors.len() > LONG {
            let parts = factors.chunks(LONG).map(|part| match *part {
                [one] => one,
                _ => (self.intern(NodeKind::Product(part.into())), 2),
            });
            factors = parts.collect();
            factors.sort_by_key(|&(base, _)| base);
        }
        let single = match factors[..] {
            [] => return self.constant(coefficient),
            [(base, 2)] => base,
            _ => self.intern(NodeKind::Product(factors.into())),
        };
        self.scaled(single, coefficient)
    }

    /// Orders factors and gathers equal ones; whether one of them is to be opened, which it then is.
    fn gather(&mut self, product: &mut Product) -> bool {
        let mut factors = std::mem::take(&mut product.factors);
        factors.sort_by_key(|&(base, _)| base);
        let mut again = false;
        let mut i = 0;
        while i < factors.len() {
            let (base, first) = factors[i];
            let (mut halves, mut next) = (i64::from(first), i + 1);
            while next < factors.len() && factors[next].0 == base {
                halves += i64::from(factors[next].1);
                next += 1;
            }
            let alone = next == i + 1;
            i = next;
            match i32::try_from(halves).ok().filter(|h| h.abs() <= MOST) {
                Some(0) => {}
                Some(halves) if alone => product.factors.push((base, halves)),
                Some(halves) => {
                    let before = product.factors.len();
                    self.multiply(product, base, halves);
                    again |= product.factors[before..] != [(base, halves)];
                }
                None => {
                    let large = self.intern(NodeKind::Power(base, Number::new(0.5 * halves as f64)));
                    product.factors.push((large, 2));
                    again = true;
                }
            }
        }
        again
    }
}

impl Product {
    /// Multiplies the coefficient, if the result is in range.
    fn scale(&mut self, c: f64) -> bool {
        let scaled = exact(self.coefficient, c);
        self.coefficient = scaled.unwrap_or(self.coefficient);
        scaled.is_some()
    }
}

/// The exponent of `b` in `(b^(h/2))^(halves/2)`, one of several factors or alone, where `b` may be negative.
fn opened(h: i32, halves: i32, alone: bool) -> Option<i32> {
    // A whole power of anything; a root of a single power that has the sign of its base, or of one that is no number where the base is
    // negative.
    let may = halves % 2 == 0 || (alone && h % 4 != 0);
    let product = i64::from(h) * i64::from(halves);
    let exponent = i32::try_from(product / 2).ok().filter(|h| h.abs() <= MOST);
    exponent.filter(|_| may && product % 2 == 0)
}
