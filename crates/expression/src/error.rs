use thiserror::Error;

/// What is wrong with a text, or with what was made of it. Columns count characters, from one.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Error {
    /// A character that no expression has.
    #[error("`{found}` has no meaning here (column {column})")]
    Character {
        /// Where.
        column: usize,
        /// The character.
        found: char,
    },
    /// A `=` in a text that is no equation, or a second one in an equation.
    #[error(
        "`=` has no place here (column {column}): a constraint is one equation, `left = right`, or a formula that vanishes, \
        `left - (right)`; all other texts are formulas"
    )]
    Equation {
        /// Where.
        column: usize,
    },
    /// A comparison that is not the condition of an `if`.
    #[error("a comparison is the condition of `if`, as in `if(x < 1, a, b)` (column {column})")]
    Comparison {
        /// Where.
        column: usize,
    },
    /// An `if` whose condition is no comparison.
    #[error("the condition of `if` is a comparison, as in `if(x < 1, a, b)`, and ends here (column {column})")]
    Condition {
        /// Where the condition ends.
        column: usize,
    },
    /// A number that is not written as one.
    #[error("`{found}` is not a number (column {column})")]
    Number {
        /// Where it begins.
        column: usize,
        /// What stands there.
        found: String,
    },
    /// A name that is not in the table.
    #[error("no name `{name}` is known here (column {column}){}", hint(.nearest, .known))]
    UnknownName {
        /// Where it begins.
        column: usize,
        /// The name.
        name: String,
        /// The name that was probably meant.
        nearest: Option<String>,
        /// The names of the table.
        known: Vec<String>,
    },
    /// A parenthesis after a name that is no function.
    #[error("`{name}` is not a function (column {column}){}", hint(.nearest, .known))]
    NotAFunction {
        /// Where the name begins.
        column: usize,
        /// The name.
        name: String,
        /// The function that was probably meant.
        nearest: Option<String>,
        /// The functions that there are.
        known: Vec<String>,
    },
    /// A function without its parentheses.
    #[error("`{name}` is a function, and its argument follows in parentheses: `{name}(..)` (column {column})")]
    NoArguments {
        /// Where the name begins.
        column: usize,
        /// The function.
        name: &'static str,
    },
    /// A function with more or fewer arguments than it takes.
    #[error("`{name}` takes {expected} argument{}, not {found} (column {column})", if *.expected == 1 { "" } else { "s" })]
    ArgumentCount {
        /// Where the name begins.
        column: usize,
        /// The function.
        name: &'static str,
        /// How many arguments it takes.
        expected: usize,
        /// How many it has.
        found: usize,
    },
    /// Something else where an operand belongs.
    #[error("{found} stands where a number, a name, a function or `(` is expected (column {column})")]
    ExpectedOperand {
        /// Where.
        column: usize,
        /// What stands there.
        found: String,
    },
    /// Something else where an operator belongs.
    #[error("{found} stands where an operator or {expected} is expected (column {column})")]
    ExpectedOperator {
        /// Where.
        column: usize,
        /// What stands there.
        found: String,
        /// What else the text might go on with.
        expected: &'static str,
    },
    /// A parenthesis that is never closed.
    #[error("the `(` in column {column} is never closed")]
    Unclosed {
        /// Where it was opened.
        column: usize,
    },
    /// A parenthesis that closes none.
    #[error("this `)` closes nothing (column {column})")]
    Unopened {
        /// Where.
        column: usize,
    },
    /// A text of too many characters.
    #[error("the text has {length} characters; the limit is {limit}")]
    TooLong {
        /// Its length.
        length: usize,
        /// The most that is read.
        limit: usize,
    },
    /// Parentheses, powers or signs within each other too many times.
    #[error("more than {limit} operations are nested here (column {column})")]
    TooDeep {
        /// Where the limit is passed.
        column: usize,
        /// The most.
        limit: usize,
    },
    /// A text of too many numbers, names and operations.
    #[error("the text has more than {limit} numbers, names and operations (column {column})")]
    TooManyNodes {
        /// Where the limit is passed.
        column: usize,
        /// The most.
        limit: usize,
    },
    /// A part of a text that is a constant, and not a finite number.
    #[error("this expression is {value} for all values of the variables (column {column})")]
    NotFinite {
        /// Where the operation stands.
        column: usize,
        /// Its value: infinite, or `NaN`.
        value: String,
    },
    /// A graph of too many nodes: an expression was too large, or its derivatives were.
    #[error("the expressions and their derivatives have more than {limit} terms and factors")]
    GraphFull {
        /// The most.
        limit: usize,
    },
    /// An expression that is too long where every shared part is written out.
    #[error("the expression has more than {limit} characters where it is written out")]
    TextTooLong {
        /// The most.
        limit: usize,
    },
    /// A name that no text could contain.
    #[error("`{name}` cannot be a name: a letter or `_`, then letters, digits and `_`, then any number of `'`")]
    InvalidName {
        /// The name.
        name: String,
    },
    /// A name that means something in every text.
    #[error("`{name}` is reserved: it has a meaning in every expression")]
    ReservedName {
        /// The name.
        name: String,
    },
    /// A name that is in the table already, perhaps in its other spelling.
    #[error("the name `{name}` is defined already")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// Fewer numbers than are needed.
    #[error("too few {what}: {expected} are needed, and {found} are given")]
    TooFew {
        /// The kind of numbers.
        what: &'static str,
        /// How many are needed.
        expected: usize,
        /// How many there are.
        found: usize,
    },
}

impl Error {
    /// The column of the text that it is about, counted in characters from one.
    #[must_use]
    pub fn column(&self) -> Option<usize> {
        match *self {
            Self::Character { column, .. }
            | Self::Equation { column }
            | Self::Comparison { column }
            | Self::Condition { column }
            | Self::Number { column, .. }
            | Self::UnknownName { column, .. }
            | Self::NotAFunction { column, .. }
            | Self::NoArguments { column, .. }
            | Self::ArgumentCount { column, .. }
            | Self::ExpectedOperand { column, .. }
            | Self::ExpectedOperator { column, .. }
            | Self::Unclosed { column }
            | Self::Unopened { column }
            | Self::TooDeep { column, .. }
            | Self::TooManyNodes { column, .. }
            | Self::NotFinite { column, .. } => Some(column),
            Self::TooLong { .. }
            | Self::GraphFull { .. }
            | Self::TextTooLong { .. }
            | Self::InvalidName { .. }
            | Self::ReservedName { .. }
            | Self::DuplicateName { .. }
            | Self::TooFew { .. } => None,
        }
    }
}

/// The nearest name, or those that there are, where they are few enough to be read.
fn hint(nearest: &Option<String>, known: &[String]) -> String {
    match nearest {
        Some(name) => format!("; did you mean `{name}`?"),
        None if known.is_empty() => String::new(),
        None if known.len() > 24 => format!("; {} other names are known", known.len()),
        None => format!(
            "; the known names are \
            {}",
            known.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
        ),
    }
}
