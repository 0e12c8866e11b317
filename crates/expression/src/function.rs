use lagrangian::Scalar;

/// The functions that a text may use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "each has the name of its function")]
pub enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Log,
    Sqrt,
    Abs,
    Sign,
    Atan2,
    Min,
    Max,
}

impl Function {
    /// All of them.
    pub const ALL: [Self; 17] = [
        Self::Sin,
        Self::Cos,
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan,
        Self::Sinh,
        Self::Cosh,
        Self::Tanh,
        Self::Exp,
        Self::Log,
        Self::Sqrt,
        Self::Abs,
        Self::Sign,
        Self::Atan2,
        Self::Min,
        Self::Max,
    ];

    /// The name in a text.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sin => "sin",
            Self::Cos => "cos",
            Self::Tan => "tan",
            Self::Asin => "asin",
            Self::Acos => "acos",
            Self::Atan => "atan",
            Self::Sinh => "sinh",
            Self::Cosh => "cosh",
            Self::Tanh => "tanh",
            Self::Exp => "exp",
            Self::Log => "log",
            Self::Sqrt => "sqrt",
            Self::Abs => "abs",
            Self::Sign => "sign",
            Self::Atan2 => "atan2",
            Self::Min => "min",
            Self::Max => "max",
        }
    }

    /// The function of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name() == name)
    }

    /// How many arguments it takes.
    #[must_use]
    pub fn arguments(self) -> usize {
        match self {
            Self::Atan2 | Self::Min | Self::Max => 2,
            _ => 1,
        }
    }

    /// Its value; a function of one argument does not look at the second.
    #[must_use]
    #[inline(always)]
    pub fn of<S: Scalar>(self, a: S, b: S) -> S {
        match self {
            Self::Sin => a.sin(),
            Self::Cos => a.cos(),
            Self::Tan => a.tan(),
            Self::Asin => a.asin(),
            Self::Acos => a.acos(),
            Self::Atan => a.atan(),
            Self::Sinh => a.sinh(),
            Self::Cosh => a.cosh(),
            Self::Tanh => a.tanh(),
            Self::Exp => a.exp(),
            Self::Log => a.ln(),
            Self::Sqrt => a.sqrt(),
            Self::Abs => a.abs(),
            Self::Sign => a.sign(),
            Self::Atan2 => a.atan2(b),
            Self::Min => a.min(b),
            Self::Max => a.max(b),
        }
    }
}

/// `a^b` of a number with a constant exponent: a product where the exponent is whole, a root where it is a half.
#[must_use]
#[inline(always)]
pub(crate) fn power<S: Scalar>(a: S, b: f64) -> S {
    match whole(b) {
        Some(n) => a.powi(n),
        None if b.to_bits() == 0.5_f64.to_bits() => a.sqrt(),
        None => a.powf(b),
    }
}

/// The whole number that this is, where it is small enough for an exponent.
pub(crate) fn whole(x: f64) -> Option<i32> {
    let n = x as i32;
    (f64::from(n).to_bits() == (x + 0.0).to_bits() && n.unsigned_abs() <= 1 << 24).then_some(n)
}
