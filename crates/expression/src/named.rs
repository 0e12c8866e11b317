use crate::Function;

/// What a text may call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Callee {
    /// A function of the graph.
    Function(Function),
    /// The length of a vector.
    Hypot,
    /// 0 below zero, 1 above, 1/2 at zero.
    Step,
    /// A choice between two by a comparison.
    If,
    /// The rest of a division.
    Mod,
}

/// Names that are no functions of the graph; a name of a system may be one of these.
const FURTHER: [(&str, Callee); 5] = [
    ("ln", Callee::Function(Function::Log)),
    ("hypot", Callee::Hypot),
    ("step", Callee::Step),
    ("if", Callee::If),
    ("mod", Callee::Mod),
];

/// The names that are told where a name is no function.
pub(crate) const KNOWN: [&str; 23] = [
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "log", "ln", "sqrt", "abs",
    "sign", "min", "max", "hypot", "step", "if", "floor", "mod",
];

impl Callee {
    pub(crate) fn named(name: &str) -> Option<Self> {
        let further = FURTHER.into_iter().find(|(known, _)| *known == name).map(|(_, callee)| callee);
        further.or_else(|| Function::named(name).map(Self::Function))
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Function(function) => function.name(),
            Self::Hypot => "hypot",
            Self::Step => "step",
            Self::If => "if",
            Self::Mod => "mod",
        }
    }

    /// How many arguments it takes, at least and at most.
    pub(crate) fn arguments(self) -> (usize, usize) {
        match self {
            Self::Function(Function::Min | Function::Max) | Self::Hypot => (2, usize::MAX),
            Self::Function(function) => (function.arguments(), function.arguments()),
            Self::Step => (1, 1),
            Self::If => (3, 3),
            Self::Mod => (2, 2),
        }
    }
}
