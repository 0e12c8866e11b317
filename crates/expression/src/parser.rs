use crate::named::{Callee, KNOWN};
use crate::names::{PI, shortened};
use crate::syntax::{Action, SyntaxStep};
use crate::tokens::{Token, Tokens};
use crate::{Error, Function, Names, Syntax, nearest};

/// How large a text may be, so that none, however it was made, takes long or fills the memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Characters of a text; of an expression that is written out, too.
    pub length: usize,
    /// Operations, signs and parentheses that are open within each other.
    pub depth: usize,
    /// Numbers, names and operations of a text.
    pub nodes: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { length: 1 << 20, depth: 256, nodes: 1 << 18 }
    }
}

/// Reads a text.
///
/// `hypot`, `min` and `max` take any number of arguments, `step(x)` is 0 below zero, 1 above and 1/2 at zero, and `if(x < y, a, b)` is `a`
/// where the comparison holds, else `b`, with `<`, `<=`, `>` or `>=`. Operators are `+ - * /`, `^` or `**`, which binds tighter than a sign before it and groups to the right, as in writing: `-x^2` is
/// `-(x^2)`, `2^-x^2` is `2^(-(x^2))`. Names are the names of the table, the [functions](Function) (`ln` is `log`), and `pi`.
///
/// # Errors
/// The first fault with its place and the accepted text, or the [limit](Limits) that the text exceeds.
pub fn parse(text: &str, names: &Names) -> Result<Syntax, Error> {
    parse_within(text, names, &Limits::default())
}

/// Reads an equation as the formula that vanishes, its left side less its right one. A text without `=` is such a formula itself.
///
/// # Errors
/// As [`parse`].
pub fn parse_equation(text: &str, names: &Names) -> Result<Syntax, Error> {
    read(text, names, &Limits::default(), true)
}

/// Reads a text within other limits.
///
/// # Errors
/// As [`parse`].
pub fn parse_within(text: &str, names: &Names, limits: &Limits) -> Result<Syntax, Error> {
    read(text, names, limits, false)
}

fn read(text: &str, names: &Names, limits: &Limits, equation: bool) -> Result<Syntax, Error> {
    // A character has at least one byte: most texts need not be counted.
    if text.len() > limits.length {
        let length = text.chars().count();
        if length > limits.length {
            return Err(Error::TooLong { length, limit: limits.length });
        }
    }
    let mut parser = Parser { tokens: Tokens::new(text), names, limits, equation, open: Vec::new(), steps: Vec::new() };
    parser.read()?;
    Ok(Syntax { steps: parser.steps })
}

/// An operation that waits for its right operand, or a parenthesis for its end.
#[derive(Debug, Clone, Copy)]
enum Open {
    Operation { column: usize, action: Action, binds: u8 },
    Group { column: usize },
    Call { column: usize, at: usize, callee: Callee, commas: usize, comparison: Option<Comparison> },
}

/// The condition of an `if`, as a difference that is positive.
#[derive(Debug, Clone, Copy)]
struct Comparison {
    /// Whether the difference is the right side less the left one.
    negated: bool,
    /// Whether the condition holds where the difference is not positive.
    turned: bool,
}

const EQUATION: u8 = 0;
const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const SIGN: u8 = 3;
const POWER: u8 = 4;

/// Dijkstra's shunting yard: open operators stand in a list, not on the program's stack.
struct Parser<'a> {
    tokens: Tokens<'a>,
    names: &'a Names,
    limits: &'a Limits,
    /// Whether a `=` may follow.
    equation: bool,
    open: Vec<Open>,
    steps: Vec<SyntaxStep>,
}

impl Parser<'_> {
    /// Reads operands and operators in turn until the text ends.
    fn read(&mut self) -> Result<(), Error> {
        let mut wants_operand = true;
        loop {
            let (column, token) = self.tokens.next()?;
            if wants_operand {
                wants_operand = self.operand(column, token)?;
            } else if token == Token::End {
                return self.end();
            } else {
                wants_operand = self.operator(column, token)?;
            }
        }
    }

    /// What may begin an operand; whether the operand is still to come.
    fn operand(&mut self, column: usize, token: Token<'_>) -> Result<bool, Error> {
        match token {
            Token::Number(x) => self.push(column, Action::Number(x))?,
            Token::Name(name) => return self.name(column, name),
            Token::Plus => return Ok(true),
            Token::Minus => {
                self.open(column, Open::Operation { column, action: Action::Negate, binds: SIGN })?;
                return Ok(true);
            }
            Token::Open => {
                self.open(column, Open::Group { column })?;
                return Ok(true);
            }
            found => return Err(Error::ExpectedOperand { column, found: found.shown() }),
        }
        Ok(false)
    }

    fn name(&mut self, column: usize, name: &str) -> Result<bool, Error> {
        let callee = Callee::named(name);
        let position = self.names.position(name);
        if !matches!(callee, Some(Callee::Function(_))) && position.is_none() && name != PI && !self.tokens.opens() {
            return Err(self.names.unknown(name, column));
        }
        match (callee, self.tokens.opens()) {
            (Some(callee), true) => {
                let (at, _) = self.tokens.next()?;
                self.open(column, Open::Call { column, at, callee, commas: 0, comparison: None })?;
                Ok(true)
            }
            (Some(callee), false) if position.is_none() => Err(Error::NoArguments { column, name: callee.name() }),
            (None, true) => {
                let nearest = nearest(name, KNOWN).map(str::to_owned);
                let known = KNOWN.map(str::to_owned).to_vec();
                Err(Error::NotAFunction { column, name: shortened(name), nearest, known })
            }
            (_, false) => {
                self.push(column, position.map_or(Action::Number(std::f64::consts::PI), Action::Name))?;
                Ok(false)
            }
        }
    }

    /// What may follow an operand; whether another operand is to come.
    fn operator(&mut self, column: usize, token: Token<'_>) -> Result<bool, Error> {
        let (action, binds) = match token {
            Token::Plus => (Action::Add, SUM),
            Token::Minus => (Action::Subtract, SUM),
            Token::Times => (Action::Multiply, PRODUCT),
            Token::Over => (Action::Divide, PRODUCT),
            Token::Power => (Action::Power, POWER),
            Token::Close => return self.close(column),
            Token::Comma => return self.comma(column),
            Token::Less { or_equal } => return self.compare(column, !or_equal, or_equal),
            Token::Greater { or_equal } => return self.compare(column, or_equal, or_equal),
            Token::Equals => {
                self.finish(EQUATION)?;
                if !std::mem::take(&mut self.equation) || !self.open.is_empty() {
                    return Err(Error::Equation { column });
                }
                (Action::Subtract, EQUATION)
            }
            found => return Err(self.expected_operator(column, &found)),
        };
        // A power waits for the one to its right.
        self.finish(if binds == POWER { POWER + 1 } else { binds })?;
        self.open(column, Open::Operation { column, action, binds })?;
        Ok(true)
    }

    fn close(&mut self, column: usize) -> Result<bool, Error> {
        self.finish(0)?;
        match self.open.pop() {
            Some(Open::Group { .. }) => Ok(false),
            Some(Open::Call { column, callee, commas, comparison, .. }) => {
                self.called(column, callee, commas + 1, comparison)?;
                Ok(false)
            }
            _ => Err(Error::Unopened { column }),
        }
    }

    fn comma(&mut self, column: usize) -> Result<bool, Error> {
        self.finish(0)?;
        let Some(Open::Call { callee, commas, comparison, .. }) = self.open.last_mut() else {
            return Err(self.expected_operator(column, &Token::Comma));
        };
        *commas += 1;
        let (callee, commas, comparison) = (*callee, *commas, *comparison);
        match callee {
            Callee::Hypot => self.square(column)?,
            Callee::If if commas == 1 => match comparison {
                None => return Err(Error::Condition { column }),
                Some(Comparison { negated: true, .. }) => self.push(column, Action::Negate)?,
                Some(_) => {}
            },
            _ => {}
        }
        Ok(true)
    }

    /// A comparison, in the condition of an `if`: the left side less the right one, to be `negated`, and to be positive or not (`turned`).
    fn compare(&mut self, column: usize, negated: bool, turned: bool) -> Result<bool, Error> {
        self.finish(0)?;
        match self.open.last_mut() {
            Some(Open::Call { callee: Callee::If, commas: 0, comparison: comparison @ None, .. }) => {
                *comparison = Some(Comparison { negated, turned });
            }
            _ => return Err(Error::Comparison { column }),
        }
        self.open(column, Open::Operation { column, action: Action::Subtract, binds: EQUATION })?;
        Ok(true)
    }

    fn square(&mut self, column: usize) -> Result<(), Error> {
        self.push(column, Action::Number(2.0))?;
        self.push(column, Action::Power)
    }

    /// The call of a function whose arguments are complete.
    fn called(
        &mut self,
        column: usize,
        callee: Callee,
        found: usize,
        comparison: Option<Comparison>,
    ) -> Result<(), Error> {
        let (least, most) = callee.arguments();
        if found < least || found > most {
            return Err(Error::ArgumentCount { column, name: callee.name(), expected: least, found });
        }
        match callee {
            Callee::Function(function) => {
                for _ in 0..(found - 1).max(1) {
                    self.push(column, Action::Call(function))?;
                }
            }
            Callee::Hypot => {
                self.square(column)?;
                for _ in 1..found {
                    self.push(column, Action::Add)?;
                }
                self.push(column, Action::Call(Function::Sqrt))?;
            }
            Callee::Step => {
                self.push(column, Action::Call(Function::Sign))?;
                for (number, action) in [(1.0, Action::Add), (2.0, Action::Divide)] {
                    self.push(column, Action::Number(number))?;
                    self.push(column, action)?;
                }
            }
            Callee::If => {
                let turned = comparison.is_some_and(|comparison| comparison.turned);
                self.push(column, Action::Choose { turned })?;
            }
            Callee::Mod => self.push(column, Action::Modulo)?,
        }
        Ok(())
    }

    fn end(&mut self) -> Result<(), Error> {
        self.finish(0)?;
        match self.open.last() {
            None => Ok(()),
            Some(&(Open::Group { column } | Open::Call { at: column, .. } | Open::Operation { column, .. })) => {
                Err(Error::Unclosed { column })
            }
        }
    }

    fn expected_operator(&self, column: usize, found: &Token<'_>) -> Error {
        let inner = self.open.iter().rev().find(|open| !matches!(open, Open::Operation { .. }));
        let expected = match inner {
            None => "the end of the text",
            Some(Open::Call { callee, .. }) if callee.arguments().1 > 1 => "`,` or `)`",
            Some(_) => "`)`",
        };
        Error::ExpectedOperator { column, found: found.shown(), expected }
    }

    /// Ends the operations whose right operand is complete: those that bind at least so.
    fn finish(&mut self, least: u8) -> Result<(), Error> {
        while let Some(&Open::Operation { column, action, binds }) = self.open.last() {
            if binds < least {
                break;
            }
            self.open.pop();
            self.push(column, action)?;
        }
        Ok(())
    }

    fn open(&mut self, column: usize, open: Open) -> Result<(), Error> {
        if self.open.len() >= self.limits.depth {
            return Err(Error::TooDeep { column, limit: self.limits.depth });
        }
        self.open.push(open);
        Ok(())
    }

    fn push(&mut self, column: usize, action: Action) -> Result<(), Error> {
        if self.steps.len() >= self.limits.nodes {
            return Err(Error::TooManyNodes { column, limit: self.limits.nodes });
        }
        self.steps.push(SyntaxStep { column, action });
        Ok(())
    }
}
