use super::product::{MOST, Product};
use super::{Expression, Graph, NodeKind, Number};
use crate::Function;
use crate::function::power;

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
}
