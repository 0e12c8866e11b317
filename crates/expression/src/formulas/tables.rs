use super::{Entry, Problem, TextError};
use crate::{Expression, Function, Graph, Names, Syntax, parse};

/// Names that texts of one kind may use, with their meanings.
#[derive(Debug, Default)]
pub(crate) struct TextTable {
    names: Names,
    meanings: Vec<Expression>,
}

impl TextTable {
    fn add(&mut self, name: &str, meaning: Expression) -> Result<(), crate::Error> {
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

    /// The formula of a text.
    pub(crate) fn build(&mut self, text: &str, may: May, entry: Entry) -> Result<Expression, TextError> {
        let fail = |problem: Problem| TextError { entry, problem };
        let table = match may {
            May::Place => &self.place,
            May::Move => &self.moving,
            May::Jump => &self.jumping,
        };
        let syntax = parse(text, &table.names).map_err(|error| fail(error.into()))?;
        if let Some(column) = syntax.first_use(Function::Sign).filter(|_| may != May::Jump) {
            return Err(fail(Problem::Sign { column }));
        }
        self.graph.build(&syntax, &table.meanings).map_err(|error| fail(error.into()))
    }

    /// The formula of an abbreviation, and the permission that a text needs to use it.
    pub(crate) fn abbreviation(&mut self, text: &str, entry: Entry) -> Result<(Expression, May), TextError> {
        let formula = self.build(text, May::Jump, entry)?;
        // The same text is parsed again where less may be said: names that stand for jumps are not known there.
        let smooth = parse(text, &self.moving.names)
            .ok()
            .is_some_and(|syntax: Syntax| syntax.first_use(Function::Sign).is_none());
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
