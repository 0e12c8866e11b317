use super::tables::{May, Tables};
use super::{Entry, Formulas, Parameters, Problem, TextError, Words};
use crate::Expression;
use crate::names::{in_name, of_rate};
use std::collections::HashSet;

/// The names of columns that every trajectory has.
const COLUMNS: [&str; 4] = ["t", "energy", "constraint", "work"];

impl Formulas {
    /// What the texts of a system mean.
    ///
    /// # Errors
    /// [`TextError`] with the first text that is wrong.
    pub fn of(words: &Words, parameters: Parameters) -> Result<Self, TextError> {
        let (n, m) = (words.coordinates.len(), words.constraints.len() + words.positions.len());
        let whole = |problem| Err(TextError { entry: Entry::System, problem });
        if n == 0 {
            return whole(Problem::NoCoordinates);
        }
        if m > n {
            return whole(Problem::TooManyConstraints { coordinates: n, constraints: m });
        }
        let mut tables = names(words, parameters)?;
        let (lagrangian, massless) = lagrangian(&mut tables, words)?;
        let (velocities, rest) = constraints(&mut tables, words)?;
        let (positions, rates) = positions(&mut tables, words)?;
        let force = forces(&mut tables, words)?;
        let basis = basis(&mut tables, words, n - m)?;
        let free = if parameters == Parameters::Variables { words.parameters.len() } else { 0 };
        let first = (1 + 2 * n + free) as u32;
        multipliers(&mut tables, words, m, first)?;
        let outputs = outputs(&mut tables, words)?;
        let has_multiplier = outputs.iter().any(|&e| tables.graph.variables(e).last().is_some_and(|k| *k >= first));
        let multipliers = has_multiplier.then_some(first);
        let rows: Vec<Expression> = velocities.into_iter().chain(rates.iter().flat_map(|(a, _)| a.clone())).collect();
        if let Some(i) = undetermined(&tables, &rows, &massless) {
            let rate = format!("{}'", words.coordinates[i].0);
            return Err(of(Entry::Lagrangian, Problem::NoInertia { rate }));
        }
        let level = rest.into_iter().chain(rates.iter().map(|(_, b)| *b)).collect();
        Ok(Self { n, m, graph: tables.graph, lagrangian, rows, level, positions, force, basis, outputs, multipliers })
    }
}

fn of(entry: Entry, problem: Problem) -> TextError {
    TextError { entry, problem }
}

/// Whether a text is one line that is written as it is read: without control characters, and without those that turn the direction of
/// writing.
fn fits_a_line(text: &str) -> bool {
    let turns = |c: char| matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    !text.chars().any(|c| c.is_control() || turns(c))
}

/// Time, coordinates, rates, parameters and abbreviations.
fn names(words: &Words, parameters: Parameters) -> Result<Tables, TextError> {
    let n = words.coordinates.len();
    let mut tables = Tables::new(n);
    let time = tables.graph.variable(0);
    tables.add("t", time, May::Place, Entry::System)?;
    for (i, (name, unit)) in words.coordinates.iter().enumerate() {
        let entry = Entry::Coordinate(i);
        if !fits_a_line(unit.name()) {
            return Err(of(entry, Problem::NotAColumn { name: unit.name().to_owned() }));
        }
        if name == "t" || name.ends_with('\'') || name.ends_with("_dot") {
            return Err(of(entry, Problem::NotACoordinate { name: name.clone() }));
        }
        if COLUMNS.contains(&name.as_str()) {
            return Err(of(entry, Problem::Column { name: name.clone() }));
        }
        let (place, rate) = (tables.graph.variable(1 + i as u32), tables.graph.variable(tables.rate(i)));
        tables.add(name, place, May::Place, entry)?;
        tables.add(&format!("{name}'"), rate, May::Move, entry)?;
    }
    for (k, (name, value)) in words.parameters.iter().enumerate() {
        let entry = Entry::Parameter(k);
        if !value.is_finite() {
            return Err(of(entry, Problem::NotFinite { value: *value }));
        }
        let meaning = match parameters {
            Parameters::Numbers => tables.graph.constant(*value),
            Parameters::Variables => tables.graph.variable((1 + 2 * n + k) as u32),
        };
        tables.add(name, meaning, May::Place, entry)?;
    }
    let asked: HashSet<&str> = words.formulas().flat_map(words_of).filter_map(of_rate).collect();
    let given: HashSet<&str> = words.abbreviations.iter().filter_map(|(name, _)| of_rate(name)).collect();
    for (k, (name, text)) in words.abbreviations.iter().enumerate() {
        let entry = Entry::Abbreviation(k);
        let (formula, from) = tables.abbreviation(text, entry)?;
        tables.add(name, formula, from, entry)?;
        if from != May::Place {
            tables.without_rate.insert(name.clone(), from);
        } else if asked.contains(name.as_str()) && !given.contains(name.as_str()) {
            let rate = tables.rate_along(formula);
            tables.add(&format!("{name}'"), rate, May::Move, entry)?;
        }
    }
    Ok(tables)
}

/// The names, functions and numbers of a text, with the primes of rates.
fn words_of(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !in_name(c) && c != '\'').filter(|word| !word.is_empty())
}

/// The Lagrangian, and the coordinates whose rates are not in it.
fn lagrangian(tables: &mut Tables, words: &Words) -> Result<(Expression, Vec<usize>), TextError> {
    let lagrangian = tables.build(&words.lagrangian, May::Move, Entry::Lagrangian)?;
    tables.periodic(words, lagrangian, Entry::Lagrangian)?;
    let there = tables.graph.variables(lagrangian);
    let massless = (0..tables.n).filter(|&i| !there.contains(&tables.rate(i))).collect();
    Ok((lagrangian, massless))
}

/// A coordinate without inertia for whose rate no row of the constraints is left, if there is one.
fn undetermined(tables: &Tables, rows: &[Expression], massless: &[usize]) -> Option<usize> {
    let mut of_row: Vec<Option<usize>> = vec![None; rows.len() / tables.n];
    massless.iter().copied().find(|&i| !given_a_row(tables, rows, i, &mut of_row, &mut vec![false; rows.len()]))
}

/// Gives a coordinate a row in which its rate stands, and others another row where that is needed (Kuhn's matching).
fn given_a_row(
    tables: &Tables,
    rows: &[Expression],
    i: usize,
    of_row: &mut [Option<usize>],
    tried: &mut [bool],
) -> bool {
    for k in 0..of_row.len() {
        if tried[k] || tables.graph.value(rows[k * tables.n + i]) == Some(0.0) {
            continue;
        }
        tried[k] = true;
        let free = match of_row[k] {
            None => true,
            Some(other) => given_a_row(tables, rows, other, of_row, tried),
        };
        if free {
            of_row[k] = Some(i);
            return true;
        }
    }
    false
}

/// The rows of `A`, one after the other, and `b`.
fn constraints(tables: &mut Tables, words: &Words) -> Result<(Vec<Expression>, Vec<Expression>), TextError> {
    let (rates, zero) = (tables.rates(), tables.graph.constant(0.0));
    let rest: Vec<(u32, Expression)> = rates.iter().map(|&rate| (rate, zero)).collect();
    let (mut rows, mut level) = (Vec::new(), Vec::new());
    for (k, text) in words.constraints.iter().enumerate() {
        let entry = Entry::Constraint(k);
        let row = tables.equation(text, May::Move, entry)?;
        tables.periodic(words, row, entry)?;
        let graph = &mut tables.graph;
        let slopes = graph.gradient(row, &rates);
        let rate = |i: usize| format!("{}'", words.coordinates[i].0);
        for (i, &slope) in slopes.iter().enumerate() {
            if let Some(other) = graph.variables(slope).into_iter().find_map(|k| rates.iter().position(|r| *r == k)) {
                return Err(of(entry, Problem::NotAffine { rate: rate(i), other: rate(other) }));
            }
        }
        if slopes.iter().all(|&slope| graph.value(slope) == Some(0.0)) {
            return Err(of(entry, Problem::NoRate));
        }
        rows.extend(slopes);
        level.push(graph.substitute(row, &rest));
    }
    Ok((rows, level))
}

/// Functions of positions, and the rows and levels that are their rates.
type Positions = (Vec<Expression>, Vec<(Vec<Expression>, Expression)>);

fn positions(tables: &mut Tables, words: &Words) -> Result<Positions, TextError> {
    let places: Vec<u32> = (1..=words.coordinates.len() as u32).collect();
    let (mut functions, mut rates) = (Vec::new(), Vec::new());
    for (k, text) in words.positions.iter().enumerate() {
        let entry = Entry::Position(k);
        let function = tables.equation(text, May::Place, entry)?;
        tables.periodic(words, function, entry)?;
        let graph = &mut tables.graph;
        let slopes = graph.gradient(function, &places);
        if slopes.iter().all(|&slope| graph.value(slope) == Some(0.0)) {
            return Err(of(entry, Problem::NoCoordinate));
        }
        rates.push((slopes, graph.derivative(function, 0)));
        functions.push(function);
    }
    Ok((functions, rates))
}

/// A force for each coordinate; `None` if no text gives a force.
fn forces(tables: &mut Tables, words: &Words) -> Result<Option<Vec<Expression>>, TextError> {
    if words.forces.is_empty() {
        return Ok(None);
    }
    let zero = tables.graph.constant(0.0);
    let mut forces = vec![zero; words.coordinates.len()];
    for (k, (name, text)) in words.forces.iter().enumerate() {
        let entry = Entry::Force(k);
        let Some(i) = words.coordinates.iter().position(|(coordinate, _)| coordinate == name) else {
            let known: Vec<String> = words.coordinates.iter().map(|(name, _)| format!("`{name}`")).collect();
            return Err(of(entry, Problem::NoSuchCoordinate { name: name.clone(), known: known.join(", ") }));
        };
        forces[i] = tables.build(text, May::Jump, entry)?;
        tables.periodic(words, forces[i], entry)?;
    }
    Ok(Some(forces))
}

/// The components of all vectors; `None` if no text gives a basis.
fn basis(tables: &mut Tables, words: &Words, dimension: usize) -> Result<Option<Vec<Expression>>, TextError> {
    if words.basis.is_empty() {
        return Ok(None);
    }
    let (expected, found) = (dimension, words.basis.len());
    if found != expected {
        return Err(of(Entry::Basis, Problem::Vectors { expected, found }));
    }
    let mut components = Vec::new();
    for (k, vector) in words.basis.iter().enumerate() {
        let (expected, found) = (words.coordinates.len(), vector.len());
        if found != expected {
            return Err(of(Entry::Vector(k), Problem::Components { expected, found }));
        }
        for (i, text) in vector.iter().enumerate() {
            let component = tables.build(text, May::Place, Entry::Component(k, i))?;
            tables.periodic(words, component, Entry::Component(k, i))?;
            components.push(component);
        }
    }
    Ok(Some(components))
}

/// Names for the multipliers of the rows, in outputs. A name that the system has keeps its meaning.
fn multipliers(tables: &mut Tables, words: &Words, rows: usize, first: u32) -> Result<(), TextError> {
    for k in 0..rows {
        let meaning = tables.graph.variable(first + k as u32);
        let entry = match k.checked_sub(words.constraints.len()) {
            None => Entry::Constraint(k),
            Some(position) => Entry::Position(position),
        };
        // A name that is given must be free.
        let (name, given) = (words.multiplier(k), words.rows.get(k).is_some_and(|name| !name.is_empty()));
        if given || !tables.is_known(&name) {
            tables.add_told(&name, meaning, entry)?;
        }
    }
    Ok(())
}

fn outputs(tables: &mut Tables, words: &Words) -> Result<Vec<Expression>, TextError> {
    let mut taken: HashSet<String> = COLUMNS.map(str::to_owned).into();
    taken.extend(words.coordinates.iter().flat_map(|(name, _)| [name.clone(), format!("{name}'")]));
    let mut outputs = Vec::new();
    for (k, (name, text)) in words.outputs.iter().enumerate() {
        let entry = Entry::Output(k);
        if !taken.insert(name.clone()) {
            return Err(of(entry, Problem::Column { name: name.clone() }));
        }
        if name.is_empty() || name.starts_with(['=', '+', '-', '@']) || name.contains([',', '"']) || !fits_a_line(name)
        {
            return Err(of(entry, Problem::NotAColumn { name: name.clone() }));
        }
        if let Some(unit) = words.output_units.get(k).filter(|unit| !fits_a_line(unit)) {
            return Err(of(entry, Problem::NotAColumn { name: unit.clone() }));
        }
        outputs.push(tables.build(text, May::Jump, entry)?);
    }
    Ok(outputs)
}
