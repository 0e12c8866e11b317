use crate::Error;
use crate::names::{in_name, shortened, starts_name};
use std::iter::Peekable;
use std::str::CharIndices;

/// A word of a text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Token<'a> {
    Number(f64),
    Name(&'a str),
    Plus,
    Minus,
    Times,
    Over,
    Power,
    Open,
    Close,
    Comma,
    Equals,
    Less { or_equal: bool },
    Greater { or_equal: bool },
    End,
}

impl Token<'_> {
    /// How an error shows it.
    pub(crate) fn shown(&self) -> String {
        match self {
            Self::Number(x) => format!("the number `{x}`"),
            Self::Name(name) => format!("the name `{}`", shortened(name)),
            Self::Plus => "`+`".to_owned(),
            Self::Minus => "`-`".to_owned(),
            Self::Times => "`*`".to_owned(),
            Self::Over => "`/`".to_owned(),
            Self::Power => "`^`".to_owned(),
            Self::Open => "`(`".to_owned(),
            Self::Close => "`)`".to_owned(),
            Self::Comma => "`,`".to_owned(),
            Self::Equals => "`=`".to_owned(),
            Self::Less { or_equal } => if *or_equal { "`<=`" } else { "`<`" }.to_owned(),
            Self::Greater { or_equal } => if *or_equal { "`>=`" } else { "`>`" }.to_owned(),
            Self::End => "the end of the text".to_owned(),
        }
    }
}

/// The words of a text one after another, each with its column.
#[derive(Debug)]
pub(crate) struct Tokens<'a> {
    text: &'a str,
    letters: Peekable<CharIndices<'a>>,
    column: usize,
}

impl<'a> Tokens<'a> {
    pub(crate) fn new(text: &'a str) -> Self {
        Self { text, letters: text.char_indices().peekable(), column: 1 }
    }

    /// The next word; at the end the end, again and again.
    pub(crate) fn next(&mut self) -> Result<(usize, Token<'a>), Error> {
        while self.step_if(char::is_whitespace) {}
        let column = self.column;
        let Some(&(start, first)) = self.letters.peek() else { return Ok((column, Token::End)) };
        if first.is_ascii_digit() || first == '.' {
            return self.number(start).map(|x| (column, Token::Number(x)));
        }
        if starts_name(first) {
            while self.step_if(in_name) {}
            while self.step_if(|c| c == '\'') {}
            return Ok((column, Token::Name(self.since(start))));
        }
        self.step();
        let token = match first {
            '+' => Token::Plus,
            '-' => Token::Minus,
            '*' if self.step_if(|c| c == '*') => Token::Power,
            '*' => Token::Times,
            '/' => Token::Over,
            '^' => Token::Power,
            '(' => Token::Open,
            ')' => Token::Close,
            ',' => Token::Comma,
            '=' => Token::Equals,
            '<' => Token::Less { or_equal: self.step_if(|c| c == '=') },
            '>' => Token::Greater { or_equal: self.step_if(|c| c == '=') },
            found => return Err(Error::Character { column, found }),
        };
        Ok((column, token))
    }

    /// Whether the next word is an opening parenthesis.
    pub(crate) fn opens(&mut self) -> bool {
        while self.step_if(char::is_whitespace) {}
        self.letters.peek().is_some_and(|&(_, c)| c == '(')
    }

    /// Digits with a point and an exponent. An `e` that is followed by no exponent belongs to the number all the same, and is an error.
    fn number(&mut self, start: usize) -> Result<f64, Error> {
        let column = self.column;
        let digit = |c: char| c.is_ascii_digit();
        while self.step_if(digit) {}
        if self.step_if(|c| c == '.') {
            while self.step_if(digit) {}
        }
        if self.step_if(|c| c == 'e' || c == 'E') {
            let _ = self.step_if(|c| c == '-' || c == '+');
            while self.step_if(digit) {}
        }
        let written = self.since(start);
        match written.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(Error::Number { column, found: shortened(written) }),
        }
    }

    fn since(&mut self, start: usize) -> &'a str {
        let end = self.letters.peek().map_or(self.text.len(), |&(at, _)| at);
        self.text.get(start..end).unwrap_or_default()
    }

    fn step(&mut self) {
        self.letters.next();
        self.column += 1;
    }

    fn step_if(&mut self, wanted: impl Fn(char) -> bool) -> bool {
        let found = self.letters.peek().is_some_and(|&(_, c)| wanted(c));
        if found {
            self.step();
        }
        found
    }
}
