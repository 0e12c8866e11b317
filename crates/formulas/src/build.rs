use crate::tables::{May, Tables};
use crate::{Entry, Formulas, Parameters, Problem, TextError, Words};
use expression::Expression;

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
        let lagrangian = lagrangian(&mut tables, words)?;
        let (velocities, rest) = constraints(&mut tables, words)?;
        let (positions, rates) = positions(&mut tables, words)?;
        let force = forces(&mut tables, words)?;
        let basis = basis(&mut tables, words, n - m)?;
        let outputs = outputs(&mut tables, words)?;
        let rows = velocities.into_iter().chain(rates.iter().flat_map(|(a, _)| a.clone())).collect();
        let level = rest.into_iter().chain(rates.iter().map(|(_, b)| *b)).collect();
        Ok(Self { n, m, graph: tables.graph, lagrangian, rows, level, positions, force, basis, outputs })
    }
}

fn of(entry: Entry, problem: Problem) -> TextError {
    TextError { entry, problem }
}

/// Time, coordinates, rates, parameters and abbreviations.
fn names(words: &Words, parameters: Parameters) -> Result<Tables, TextError> {
    let n = words.coordinates.len();
    let mut tables = Tables::new(n);
    let time = tables.graph.variable(0);
    tables.add("t", time, May::Place, Entry::System)?;
    for (i, (name, _)) in words.coordinates.iter().enumerate() {
        let entry = Entry::Coordinate(i);
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
    for (k, (name, text)) in words.abbreviations.iter().enumerate() {
        let entry = Entry::Abbreviation(k);
        let (formula, from) = tables.abbreviation(text, entry)?;
        tables.add(name, formula, from, entry)?;
    }
    Ok(tables)
}

fn lagrangian(tables: &mut Tables, words: &Words) -> Result<Expression, TextError> {
    let lagrangian = tables.build(&words.lagrangian, May::Move, Entry::Lagrangian)?;
    let there = tables.graph.variables(lagrangian);
    for (i, (name, _)) in words.coordinates.iter().enumerate() {
        if !there.contains(&tables.rate(i)) {
            return Err(of(Entry::Lagrangian, Problem::NoInertia { rate: format!("{name}'") }));
        }
    }
    Ok(lagrangian)
}

/// The rows of `A`, one after the other, and `b`.
fn constraints(tables: &mut Tables, words: &Words) -> Result<(Vec<Expression>, Vec<Expression>), TextError> {
    let (rates, zero) = (tables.rates(), tables.graph.constant(0.0));
    let rest: Vec<(u32, Expression)> = rates.iter().map(|&rate| (rate, zero)).collect();
    let (mut rows, mut level) = (Vec::new(), Vec::new());
    for (k, text) in words.constraints.iter().enumerate() {
        let entry = Entry::Constraint(k);
        let row = tables.build(text, May::Move, entry)?;
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
        let function = tables.build(text, May::Place, entry)?;
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

/// A force for each coordinate; none where no text gives one.
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
    }
    Ok(Some(forces))
}

/// The components of all vectors; none where no text gives them.
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
            components.push(tables.build(text, May::Place, Entry::Component(k, i))?);
        }
    }
    Ok(Some(components))
}

fn outputs(tables: &mut Tables, words: &Words) -> Result<Vec<Expression>, TextError> {
    let mut taken: Vec<String> = COLUMNS.map(str::to_owned).to_vec();
    taken.extend(words.coordinates.iter().flat_map(|(name, _)| [name.clone(), format!("{name}'")]));
    let mut outputs = Vec::new();
    for (k, (name, text)) in words.outputs.iter().enumerate() {
        let entry = Entry::Output(k);
        if taken.contains(name) {
            return Err(of(entry, Problem::Column { name: name.clone() }));
        }
        taken.push(name.clone());
        outputs.push(tables.build(text, May::Jump, entry)?);
    }
    Ok(outputs)
}
