use super::{Entry, Problem, TextError};
use crate::names::of_rate;
use crate::{Error, Expression, Graph, Names, Syntax, parse, parse_equation};
use std::collections::HashMap;

/// Names that texts of one kind may use, with their meanings.
#[derive(Debug, Default)]
pub(crate) struct TextTable {
    names: Names,
    meanings: Vec<Expression>,
}

impl TextTable {
    fn add(&mut self, name: &str, meaning: Expression) -> Result<(), Error> {
        self.names.add(name)?;
        self.meanings.push(meaning);
        Ok(())
    }
}

/// The functions that a text may contain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum May {
    /// Functions of time and coordinates.
    Place,
    /// Functions of rates too.
    Move,
    /// Functions that jump too.
    Jump,
}

/// The names of a system, listed by the kind of text that may use them.
#[derive(Debug)]
pub(crate) struct Tables {
    pub(crate) graph: Graph,
    /// The number of coordinates.
    pub(crate) n: usize,
    place: TextTable,
    moving: TextTable,
    jumping: TextTable,
    /// Abbreviations that are made of rates, or jump: these have no rate.
    pub(crate) without_rate: HashMap<String, May>,
}

/// Maximum number of terms and factors in all formulas of a system and their derivatives.
const LARGEST: usize = 1 << 19;

impl Tables {
    pub(crate) fn new(n: usize) -> Self {
        Self {
            graph: Graph::with_limit(LARGEST),
            n,
            place: TextTable::default(),
            moving: TextTable::default(),
            jumping: TextTable::default(),
            without_rate: HashMap::new(),
        }
    }

    /// The variable of the rate of a coordinate.
    pub(crate) fn rate(&self, coordinate: usize) -> u32 {
        (1 + self.n + coordinate) as u32
    }

    /// The variables of all rates.
    pub(crate) fn rates(&self) -> Vec<u32> {
        (0..self.n).map(|i| self.rate(i)).collect()
    }

    /// Adds a name, to the tables of all texts that may use it.
    pub(crate) fn add(&mut self, name: &str, meaning: Expression, from: May, entry: Entry) -> Result<(), TextError> {
        let tables = [(May::Place, &mut self.place), (May::Move, &mut self.moving), (May::Jump, &mut self.jumping)];
        for (_, table) in tables.into_iter().filter(|(may, _)| *may as u8 >= from as u8) {
            table.add(name, meaning).map_err(|error| TextError { entry, problem: error.into() })?;
        }
        Ok(())
    }

    /// Adds a name that outputs alone may use, once all other texts are read.
    pub(crate) fn add_told(&mut self, name: &str, meaning: Expression, entry: Entry) -> Result<(), TextError> {
        self.jumping.add(name, meaning).map_err(|error| TextError { entry, problem: error.into() })
    }

    /// Whether a name has a meaning.
    pub(crate) fn is_known(&self, name: &str) -> bool {
        self.jumping.names.position(name).is_some()
    }

    /// The rate of a function of time and coordinates along the motion.
    pub(crate) fn rate_along(&mut self, formula: Expression) -> Expression {
        let mut rate = self.graph.derivative(formula, 0);
        for i in 0..self.n {
            let (slope, v) = (self.graph.derivative(formula, 1 + i as u32), self.graph.variable(self.rate(i)));
            let along = self.graph.product(&[slope, v]);
            rate = self.graph.sum(&[rate, along]);
        }
        rate
    }

    /// The formula of a text.
    pub(crate) fn build(&mut self, text: &str, may: May, entry: Entry) -> Result<Expression, TextError> {
        self.built(parse, text, may, entry)
    }

    /// The formula of a text that vanishes, or of the left side of an equation less the right one.
    pub(crate) fn equation(&mut self, text: &str, may: May, entry: Entry) -> Result<Expression, TextError> {
        self.built(parse_equation, text, may, entry)
    }

    fn built(
        &mut self,
        read: fn(&str, &Names) -> Result<Syntax, Error>,
        text: &str,
        may: May,
        entry: Entry,
    ) -> Result<Expression, TextError> {
        let fail = |problem: Problem| TextError { entry, problem };
        let table = match may {
            May::Place => &self.place,
            May::Move => &self.moving,
            May::Jump => &self.jumping,
        };
        let syntax = read(text, &table.names).map_err(|error| fail(self.named(error)))?;
        if let Some(column) = syntax.first_jump().filter(|_| may != May::Jump) {
            return Err(fail(Problem::Jump { column }));
        }
        self.graph.build(&syntax, &table.meanings).map_err(|error| fail(error.into()))
    }

    /// The problem of a text with this error.
    fn named(&self, error: Error) -> Problem {
        if let Error::UnknownName { column, name, .. } = &error
            && let Some(of) = of_rate(name)
            && let Some(from) = self.without_rate.get(of)
        {
            let (column, name) = (*column, of.to_owned());
            return Problem::RateOf { column, name, jumps: *from == May::Jump };
        }
        error.into()
    }

    /// The formula of an abbreviation, and the permission that a text needs to use it.
    pub(crate) fn abbreviation(&mut self, text: &str, entry: Entry) -> Result<(Expression, May), TextError> {
        let formula = self.build(text, May::Jump, entry)?;
        // The same text is parsed again where less may be said: names that stand for jumps are not known there.
        let smooth = parse(text, &self.moving.names).ok().is_some_and(|syntax: Syntax| syntax.first_jump().is_none());
        let moves = self.graph.variables(formula).into_iter().any(|k| k > self.n as u32 && k <= 2 * self.n as u32);
        Ok((
            formula,
            if !smooth {
                May::Jump
            } else if moves {
                May::Move
            } else {
                May::Place
            },
        ))
    }
}
