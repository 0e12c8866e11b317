use crate::Function;

/// One operation on numbers in places; `k` is the place of a constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Operation {
    /// `k`
    Constant { k: u32 },
    /// `a + b`
    Add { a: u32, b: u32 },
    /// `a - b`
    Subtract { a: u32, b: u32 },
    /// `a * b`
    Multiply { a: u32, b: u32 },
    /// `a / b`
    Divide { a: u32, b: u32 },
    /// `-a`
    Negate { a: u32 },
    /// `1 / a`
    Invert { a: u32 },
    /// `a + k`
    Plus { a: u32, k: u32 },
    /// `k - a`
    From { a: u32, k: u32 },
    /// `k * a`
    Times { a: u32, k: u32 },
    /// `a + k * b`
    PlusTimes { a: u32, b: u32, k: u32 },
    /// `c + a * b`
    PlusProduct { a: u32, b: u32, c: u32 },
    /// `c - a * b`
    MinusProduct { a: u32, b: u32, c: u32 },
    /// `a * a`
    Square { a: u32 },
    /// The root of a sum of squares.
    Length { a: u32 },
    /// `a^n`
    Whole { a: u32, n: i32 },
    /// `a^k`
    Real { a: u32, k: u32 },
    /// `a^k` of a base that may be zero in a whole region.
    Flat { a: u32, k: u32 },
    /// Sine and cosine of `a`, the cosine to the place `cos`.
    SinCos { a: u32, cos: u32 },
    /// A function.
    Call { function: Function, a: u32, b: u32 },
    /// `a` is an output.
    Output { a: u32 },
}

impl Operation {
    /// Changes the places that it reads.
    pub(crate) fn map(self, f: impl Fn(u32) -> u32) -> Self {
        match self {
            Self::Constant { k } => Self::Constant { k },
            Self::Add { a, b } => Self::Add { a: f(a), b: f(b) },
            Self::Subtract { a, b } => Self::Subtract { a: f(a), b: f(b) },
            Self::Multiply { a, b } => Self::Multiply { a: f(a), b: f(b) },
            Self::Divide { a, b } => Self::Divide { a: f(a), b: f(b) },
            Self::Negate { a } => Self::Negate { a: f(a) },
            Self::Invert { a } => Self::Invert { a: f(a) },
            Self::Plus { a, k } => Self::Plus { a: f(a), k },
            Self::From { a, k } => Self::From { a: f(a), k },
            Self::Times { a, k } => Self::Times { a: f(a), k },
            Self::PlusTimes { a, b, k } => Self::PlusTimes { a: f(a), b: f(b), k },
            Self::PlusProduct { a, b, c } => Self::PlusProduct { a: f(a), b: f(b), c: f(c) },
            Self::MinusProduct { a, b, c } => Self::MinusProduct { a: f(a), b: f(b), c: f(c) },
            Self::Square { a } => Self::Square { a: f(a) },
            Self::Length { a } => Self::Length { a: f(a) },
            Self::Whole { a, n } => Self::Whole { a: f(a), n },
            Self::Real { a, k } => Self::Real { a: f(a), k },
            Self::Flat { a, k } => Self::Flat { a: f(a), k },
            Self::SinCos { a, cos } => Self::SinCos { a: f(a), cos },
            Self::Call { function, a, b } => Self::Call { function, a: f(a), b: f(b) },
            Self::Output { a } => Self::Output { a: f(a) },
        }
    }

    /// The places that it reads; those that do not exist stand as the first.
    pub(crate) fn reads(self) -> [u32; 3] {
        match self {
            Self::Constant { .. } => [u32::MAX; 3],
            Self::Add { a, b }
            | Self::Subtract { a, b }
            | Self::Multiply { a, b }
            | Self::Divide { a, b }
            | Self::PlusTimes { a, b, .. }
            | Self::Call { a, b, .. } => [a, b, b],
            Self::PlusProduct { a, b, c } | Self::MinusProduct { a, b, c } => [a, b, c],
            Self::Negate { a }
            | Self::Invert { a }
            | Self::Plus { a, .. }
            | Self::From { a, .. }
            | Self::Times { a, .. }
            | Self::Square { a }
            | Self::Length { a }
            | Self::Whole { a, .. }
            | Self::Real { a, .. }
            | Self::Flat { a, .. }
            | Self::SinCos { a, .. }
            | Self::Output { a } => [a; 3],
        }
    }
}

/// An operation and the place of its result: of an output its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Instruction {
    pub(crate) to: u32,
    pub(crate) operation: Operation,
}
