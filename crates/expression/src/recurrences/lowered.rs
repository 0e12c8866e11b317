use super::{Corner, Kind, SeriesOperation, Start};
use crate::Function;
use crate::tape::{Instruction, Operation, Program};

/// Whole powers up to this one are products.
const MOST_PRODUCTS: u32 = 64;

/// The operations of a program as those of series, in any order.
#[derive(Debug, Default)]
pub(super) struct Lowered {
    pub(super) operations: Vec<SeriesOperation>,
    pub(super) corners: Vec<Corner>,
    pub(super) constants: Vec<(u32, f64)>,
    pub(super) outputs: Vec<u32>,
    pub(super) inputs: u32,
    pub(super) places: u32,
}

impl Lowered {
    /// The operations of a program whose first `inputs` places are inputs, at least.
    pub(super) fn of(program: Program, inputs: u32) -> Self {
        // The program has places for the inputs up to the last one that it reads.
        let more = inputs.saturating_sub(program.inputs);
        let moved = |place: u32| if place >= program.inputs { place + more } else { place };
        let mut own = Self { places: program.places + more, inputs: program.inputs + more, ..Self::default() };
        for Instruction { to, operation } in program.instructions {
            let operation = match operation.map(moved) {
                Operation::SinCos { a, cos } => Operation::SinCos { a, cos: moved(cos) },
                other => other,
            };
            if let Operation::Output { a } = operation {
                let to = to as usize;
                own.outputs.resize(own.outputs.len().max(to + 1), 0);
                own.outputs[to] = a;
            } else {
                own.lower(moved(to), operation, &program.constants);
            }
        }
        own
    }

    fn place(&mut self) -> u32 {
        self.places += 1;
        self.places - 1
    }

    fn constant(&mut self, to: u32, x: f64) {
        self.constants.push((to, x));
    }

    fn push(&mut self, to: u32, kind: Kind) {
        self.operations.push(SeriesOperation { to, terms: kind.terms(), kind });
    }

    /// The operation in a place of its own.
    fn made(&mut self, kind: Kind) -> u32 {
        let to = self.place();
        self.push(to, kind);
        to
    }

    fn scaled(&mut self, to: u32, alpha: f64, a: u32, gamma: f64) {
        self.push(to, Kind::Scaled { a, alpha, gamma });
    }

    fn inverse(&mut self, b: u32, flat: bool) -> u32 {
        self.made(Kind::Inverse { b, flat })
    }

    /// The function that begins with `start`, with the slope `beta b` in `a`.
    fn integral(&mut self, to: u32, start: Start, a: u32, (beta, b): (f64, u32)) {
        self.push(to, Kind::Integral { a, b, beta, start });
    }

    fn circle(&mut self, a: u32, [sin, cos]: [u32; 2]) {
        self.integral(sin, Start::Call(Function::Sin, a), a, (1.0, cos));
        self.integral(cos, Start::Call(Function::Cos, a), a, (-1.0, sin));
    }

    fn corner(&mut self, function: Function, argument: u32) -> u32 {
        self.corners.push(Corner { argument, function });
        self.corners.len() as u32 - 1
    }

    fn choice(&mut self, to: u32, function: Function, [a, b]: [u32; 2], argument: u32) {
        let corner = self.corner(function, argument);
        self.push(to, Kind::Choice { a, b, corner });
    }

    /// `a^p` for an exponent that is no small whole number: its slope is `p y / a`.
    fn power(&mut self, to: u32, start: Start, a: u32, p: f64) {
        let ratio = self.made(Kind::Quotient { a: to, b: a, flat: true });
        self.integral(to, start, a, (p, ratio));
    }

    /// A product of squares.
    fn whole(&mut self, to: u32, a: u32, n: i32) {
        let mut left = n.unsigned_abs();
        if left > MOST_PRODUCTS {
            return self.power(to, Start::Whole(n), a, f64::from(n));
        }
        let (mut square, mut product) = (a, None);
        while left > 0 {
            if left & 1 == 1 {
                product = Some(match product {
                    None => square,
                    Some(product) => self.made(Kind::Product { a: product, b: square }),
                });
            }
            left >>= 1;
            if left > 0 {
                square = self.made(Kind::Square { a: square });
            }
        }
        match product {
            None => self.constant(to, 1.0),
            Some(product) if n < 0 => self.push(to, Kind::Inverse { b: product, flat: false }),
            Some(product) => self.scaled(to, 1.0, product, 0.0),
        }
    }

    fn lower(&mut self, to: u32, operation: Operation, constants: &[f64]) {
        let k = |k: u32| constants.get(k as usize).copied().unwrap_or(f64::NAN);
        match operation {
            Operation::Constant { k: x } => self.constant(to, k(x)),
            Operation::Add { a, b } => self.push(to, Kind::Sum { a, b, beta: 1.0 }),
            Operation::Subtract { a, b } => self.push(to, Kind::Sum { a, b, beta: -1.0 }),
            Operation::PlusTimes { a, b, k: x } => self.push(to, Kind::Sum { a, b, beta: k(x) }),
            Operation::Negate { a } => self.scaled(to, -1.0, a, 0.0),
            Operation::Plus { a, k: x } => self.scaled(to, 1.0, a, k(x)),
            Operation::From { a, k: x } => self.scaled(to, -1.0, a, k(x)),
            Operation::Times { a, k: x } => self.scaled(to, k(x), a, 0.0),
            Operation::Multiply { a, b } => self.push(to, Kind::Product { a, b }),
            Operation::PlusProduct { a, b, c } => self.push(to, Kind::SumOfProduct { a, b, c, beta: 1.0 }),
            Operation::MinusProduct { a, b, c } => self.push(to, Kind::SumOfProduct { a, b, c, beta: -1.0 }),
            Operation::Square { a } => self.push(to, Kind::Square { a }),
            Operation::Divide { a, b } => self.push(to, Kind::Quotient { a, b, flat: false }),
            Operation::Invert { a } => self.push(to, Kind::Inverse { b: a, flat: false }),
            Operation::Length { a } => self.push(to, Kind::Root { a, flat: true }),
            Operation::Whole { a, n } => self.whole(to, a, n),
            Operation::Real { a, k: x } | Operation::Flat { a, k: x } => self.power(to, Start::Real(k(x)), a, k(x)),
            Operation::SinCos { a, cos } => self.circle(a, [to, cos]),
            Operation::Call { function, a, b } => self.call(to, function, a, b),
            Operation::Output { .. } => {}
        }
    }

    fn call(&mut self, to: u32, function: Function, a: u32, b: u32) {
        let start = Start::Call(function, b);
        match function {
            Function::Sin => {
                let cos = self.place();
                self.circle(a, [to, cos]);
            }
            Function::Cos => {
                let sin = self.place();
                self.circle(a, [sin, to]);
            }
            Function::Tan | Function::Tanh => {
                let sign = if function == Function::Tan { 1.0 } else { -1.0 };
                let square = self.made(Kind::Square { a: to });
                let slope = self.made(Kind::Scaled { a: square, alpha: sign, gamma: 1.0 });
                self.integral(to, start, a, (1.0, slope));
            }
            Function::Asin | Function::Acos => {
                let square = self.made(Kind::Square { a });
                let rest = self.made(Kind::Scaled { a: square, alpha: -1.0, gamma: 1.0 });
                let root = self.made(Kind::Root { a: rest, flat: false });
                let slope = self.inverse(root, false);
                self.integral(to, start, a, (if function == Function::Asin { 1.0 } else { -1.0 }, slope));
            }
            Function::Atan => {
                let square = self.made(Kind::Square { a });
                let sum = self.made(Kind::Scaled { a: square, alpha: 1.0, gamma: 1.0 });
                let slope = self.inverse(sum, false);
                self.integral(to, start, a, (1.0, slope));
            }
            Function::Sinh | Function::Cosh => {
                let partner = if function == Function::Sinh { Function::Cosh } else { Function::Sinh };
                let other = self.place();
                self.integral(to, start, a, (1.0, other));
                self.integral(other, Start::Call(partner, a), a, (1.0, to));
            }
            Function::Exp => self.integral(to, start, a, (1.0, to)),
            Function::Log => {
                let slope = self.inverse(a, false);
                self.integral(to, start, a, (1.0, slope));
            }
            Function::Sqrt => self.push(to, Kind::Root { a, flat: false }),
            Function::Inverse => self.push(to, Kind::Inverse { b: a, flat: true }),
            Function::Atan2 => {
                // The slopes in `a` and `b` are `b / r` and `-a / r` with `r = a^2 + b^2`.
                let squares = [a, b].map(|a| self.made(Kind::Square { a }));
                let sum = self.made(Kind::Sum { a: squares[0], b: squares[1], beta: 1.0 });
                let [in_a, in_b] = [b, a].map(|a| self.made(Kind::Quotient { a, b: sum, flat: true }));
                let first = self.made(Kind::Integral { a, b: in_a, beta: 1.0, start });
                let second = self.made(Kind::Integral { a: b, b: in_b, beta: -1.0, start: Start::Zero });
                self.push(to, Kind::Sum { a: first, b: second, beta: 1.0 });
            }
            Function::Abs | Function::Sign => self.choice(to, function, [a, a], a),
            Function::Floor => {
                // As `Graph::floor_beside`.
                let turned = self.made(Kind::Scaled { a, alpha: std::f64::consts::PI, gamma: 0.0 });
                let [sin, cos, side, zero] = [(); 4].map(|()| self.place());
                self.circle(turned, [sin, cos]);
                self.choice(side, Function::Sign, [sin, sin], sin);
                self.constant(zero, 0.0);
                let moved = self.made(Kind::Sum { a, b: side, beta: 0.5 });
                let middle = self.made(Kind::Scaled { a: moved, alpha: 0.5, gamma: 0.0 });
                let whole = self.made(Kind::Integral {
                    a: middle,
                    b: zero,
                    beta: 0.0,
                    start: Start::Call(Function::Floor, middle),
                });
                let rest = self.made(Kind::Scaled { a: side, alpha: -0.5, gamma: 0.5 });
                self.push(to, Kind::Sum { a: rest, b: whole, beta: 2.0 });
            }
            Function::Where | Function::Unless => {
                let corner = self.corner(function, a);
                self.push(to, Kind::Pick { a: b, corner });
            }
            Function::Min | Function::Max => {
                let argument = self.made(Kind::Sum { a, b, beta: -1.0 });
                self.choice(to, function, [a, b], argument);
            }
        }
    }
}
