use crate::any::has_shape;
use crate::multipliers::multipliers;
use crate::reduced::EquationsOfBases;
use crate::slices::TextSlices;
use crate::tapes::{TapePoint, Tapes};
use crate::{Entry, TextError, Unit, Words};
use expression::formulas::{Formulas, Parameters, RowElimination};
use expression::{Corners, Expression};
use lagrangian::Pivots;
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// A coordinate of a system.
#[derive(Debug, Clone, PartialEq)]
pub struct Coordinate {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Unit,
}

/// A system that was made of texts: its formulas, checked and derived.
///
/// With `n` coordinates and `m` constraints. The last constraints are the rates of constraints on positions.
#[derive(Debug, Clone)]
pub struct TextModel {
    pub(crate) coordinates: Vec<Coordinate>,
    /// The constraints on velocities that are not rates of positions.
    pub(crate) velocities: usize,
    /// The constraints on positions.
    pub(crate) positions: usize,
    pub(crate) lagrangian: Tapes,
    /// `A` by rows, then `b`.
    pub(crate) constraint: Tapes,
    pub(crate) holonomic: Tapes,
    /// The force; `None` if no force acts.
    pub(crate) force: Option<Tapes>,
    /// A basis of the admissible velocities that holds everywhere, given or found; `None` if a basis holds near a configuration only.
    pub(crate) basis: Option<Tapes>,
    /// `L_v`.
    pub(crate) momentum: Tapes,
    /// `L_q`, then `L_v`.
    pub(crate) slopes: Tapes,
    /// The mass matrix `L_vv` by rows, then `L_v`.
    pub(crate) mass: Tapes,
    /// The names of the multipliers.
    pub(crate) rows: Vec<String>,
    pub(crate) outputs: Vec<String>,
    pub(crate) output_units: Vec<String>,
    pub(crate) told: Tapes,
    /// Which of the outputs contain multipliers.
    pub(crate) with_multipliers: Box<[bool]>,
    /// How many free parameters there are before the multipliers in the variables of the outputs; `None` if these have no multipliers.
    pub(crate) before_multipliers: Option<usize>,
    pub(crate) timed: bool,
    pub(crate) formulas: Arc<Formulas>,
    /// How a basis that holds everywhere is derived; `None` if the text gives one, or none is found.
    pub(crate) eliminations: Option<Vec<RowElimination>>,
    pub(crate) equations: EquationsOfBases,
    /// The model between corners in time; `None` if there are no such corners.
    pub(crate) pieces: Option<TextPieces>,
}

/// A system whose formulas have corners or jumps at certain times.
#[derive(Debug, Clone)]
pub(crate) struct TextPieces {
    pub(crate) corners: Corners,
    /// The system with variables for the sides of its corners.
    pub(crate) model: Arc<TextModel>,
}

/// Maximum number of terms and factors of all formulas with the derivatives in the coordinates.
const LARGEST_SLOPES: usize = 1 << 22;

/// Models with the same formulas are equal.
impl PartialEq for TextModel {
    fn eq(&self, other: &Self) -> bool {
        let parts = |of: &Self| (of.coordinates.clone(), of.velocities, of.positions, of.outputs.clone(), of.timed);
        let one = [&self.lagrangian, &self.constraint, &self.holonomic, &self.mass, &self.told];
        let two = [&other.lagrangian, &other.constraint, &other.holonomic, &other.mass, &other.told];
        parts(self) == parts(other) && one == two && self.force == other.force && self.basis == other.basis
    }
}

impl TextModel {
    /// The system of some texts.
    ///
    /// # Errors
    /// [`TextError`] with the first text that is wrong.
    pub fn new(words: &Words) -> Result<Self, TextError> {
        let (n, m) = (words.coordinates.len(), words.constraints.len() + words.positions.len());
        let has_shape = m <= n && has_shape(n, m);
        let formulas = Formulas::of(words, Parameters::Numbers)?;
        let pieces = formulas.pieces().map_err(|error| TextError { entry: Entry::System, problem: error.into() })?;
        let whole = |mut formulas: Formulas| {
            let derived = has_shape && formulas.basis.is_none();
            let eliminations = if derived { formulas.eliminations() } else { None };
            Self::of(words, formulas, eliminations)
        };
        let pieces = match pieces {
            Some((corners, formulas)) => Some(TextPieces { corners, model: Arc::new(whole(formulas)?) }),
            None => None,
        };
        Ok(Self { pieces, ..whole(formulas)? })
    }

    pub(crate) fn of(
        words: &Words,
        mut formulas: Formulas,
        eliminations: Option<Vec<RowElimination>>,
    ) -> Result<Self, TextError> {
        let all = formulas.rates();
        let derived = eliminations.as_ref().map(|all| formulas.basis_by(all).concat());
        let basis = formulas.basis.clone().or(derived);
        let given = formulas.clone();
        let before_multipliers = formulas.multipliers.map(|first| first as usize - 1 - 2 * words.coordinates.len());
        let Formulas { mut graph, lagrangian, rows, level, positions, force, outputs, multipliers, .. } = formulas;
        let contains = |&e: &Expression| {
            multipliers.is_some_and(|first| graph.variables(e).last().is_some_and(|variable| *variable >= first))
        };
        let with_multipliers = outputs.iter().map(contains).collect();
        let momentum = graph.gradient(lagrangian, &all);
        let mass: Vec<Expression> = [graph.hessian(lagrangian, &all, &all).concat(), momentum.clone()].concat();
        let fail = |error: expression::Error| TextError { entry: Entry::Lagrangian, problem: error.into() };
        graph.check().map_err(fail)?;
        // A long potential has as many long derivatives as it has coordinates.
        graph.set_limit(LARGEST_SLOPES);
        let places: Vec<u32> = (1..=all.len() as u32).collect();
        let slopes = [graph.gradient(lagrangian, &places), momentum.clone()].concat();
        // `A` by rows, then `b`.
        let constraint = [&rows[..], &level].concat();
        let tapes = |formulas: &[Expression], entry| {
            Tapes::new(&graph, formulas).map_err(|error| TextError { entry, problem: error.into() })
        };
        let mut every = [&constraint[..], &positions, &outputs, &[lagrangian]].concat();
        every.extend(force.iter().chain(&basis).flatten());
        let timed = every.into_iter().any(|e| graph.variables(e).first() == Some(&0));
        let named = |(name, unit): &(String, Unit)| Coordinate { name: name.clone(), unit: unit.clone() };
        Ok(Self {
            coordinates: words.coordinates.iter().map(named).collect(),
            velocities: words.constraints.len(),
            positions: words.positions.len(),
            lagrangian: tapes(&[lagrangian], Entry::Lagrangian)?,
            constraint: tapes(&constraint, Entry::System)?,
            holonomic: tapes(&positions, Entry::System)?,
            force: force.map(|force| tapes(&force, Entry::System)).transpose()?,
            basis: basis.as_ref().map(|basis| tapes(basis, Entry::Basis)).transpose()?,
            momentum: tapes(&momentum, Entry::Lagrangian)?,
            slopes: tapes(&slopes, Entry::Lagrangian)?,
            mass: tapes(&mass, Entry::Lagrangian)?,
            rows: (0..words.constraints.len() + words.positions.len()).map(|k| words.multiplier(k)).collect(),
            outputs: words.outputs.iter().map(|(name, _)| name.clone()).collect(),
            output_units: (0..words.outputs.len())
                .map(|k| words.output_units.get(k).cloned().unwrap_or_default())
                .collect(),
            told: tapes(&outputs, Entry::System)?,
            with_multipliers,
            before_multipliers,
            timed,
            formulas: Arc::new(given),
            eliminations,
            equations: EquationsOfBases::default(),
            pieces: None,
        })
    }

    /// The model with steps across its corners in time, for derivatives of steps of one length.
    #[must_use]
    pub fn uncut(&self) -> Self {
        Self { pieces: None, ..self.clone() }
    }

    /// The times in an interval (s) at which a formula has a corner in time, or jumps; `None` if there are too many to find.
    #[must_use]
    pub fn jumps(&self, from: f64, to: f64) -> Option<Vec<f64>> {
        self.pieces.as_ref().map_or(Some(Vec::new()), |pieces| pieces.corners.between(from, to))
    }

    /// The coordinates.
    #[must_use]
    pub fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }

    /// How many constraints there are, those on positions with the others.
    #[must_use]
    pub fn constraints(&self) -> usize {
        self.velocities + self.positions
    }

    /// How many of the constraints are on positions.
    #[must_use]
    pub fn positions(&self) -> usize {
        self.positions
    }

    /// Whether no shape has room for the system, so that it has the methods of assemblies only and no reduced equations.
    #[must_use]
    pub fn is_assembly(&self) -> bool {
        !has_shape(self.coordinates.len(), self.constraints())
    }

    /// The names of the multipliers of the constraints, those on velocities first: `lambda1`, .., or `lambda_NAME` of a constraint with a name.
    #[must_use]
    pub fn multiplier_names(&self) -> &[String] {
        &self.rows
    }

    /// The names of the outputs.
    #[must_use]
    pub fn outputs(&self) -> &[String] {
        &self.outputs
    }

    /// The units of the outputs; empty for an output without a unit.
    #[must_use]
    pub fn output_units(&self) -> &[String] {
        &self.output_units
    }

    /// Whether forces act.
    #[must_use]
    pub fn has_forces(&self) -> bool {
        self.force.is_some()
    }

    /// Whether the text gives a basis of the admissible velocities; else it is derived.
    #[must_use]
    pub fn gives_basis(&self) -> bool {
        self.formulas.basis.is_some()
    }

    /// Whether any formula depends on time.
    #[must_use]
    pub fn depends_on_time(&self) -> bool {
        self.timed
    }

    /// How many operations the Lagrangian, the constraints and the forces take, each evaluated once.
    #[must_use]
    pub fn operations(&self) -> [usize; 3] {
        let force = self.force.as_ref().map_or(0, Tapes::operations);
        [self.lagrangian.operations(), self.constraint.operations(), force]
    }

    /// The outputs at a state.
    #[must_use]
    pub fn told(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
        let mut told = vec![0.0; self.outputs.len()];
        self.tell(self.before_multipliers.is_some(), t, q, v, |k, x| told[k] = x);
        told
    }

    /// One of the outputs at a state; none of a number beyond them.
    #[must_use]
    pub fn output(&self, k: usize, t: f64, q: &[f64], v: &[f64]) -> Option<f64> {
        let (with_multipliers, mut told) = (*self.with_multipliers.get(k)?, 0.0);
        self.tell(with_multipliers, t, q, v, |i, x| {
            if i == k {
                told = x;
            }
        });
        Some(told)
    }

    /// Tells all outputs; an output with multipliers is right only if these are to be solved for.
    fn tell(&self, with_multipliers: bool, t: f64, q: &[f64], v: &[f64], see: impl FnMut(usize, f64)) {
        let p = if with_multipliers { self.multipliers(t, q, v) } else { Vec::new() };
        self.told.evaluate(self.coordinates.len(), TapePoint { p: &p, ..TapePoint::new(t, q, v) }, see);
    }

    /// The multipliers `lambda` of the constraints at a state, those on velocities first: `A' lambda` are the generalised forces of the
    /// constraints. Of constraints that depend on one another they are the shortest; NaN where the equations are not finite.
    #[must_use]
    pub fn multipliers(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
        multipliers(TextSlices::of(self, &[]), t, q, v)
    }

    /// The energy `v . L_v - L` (J).
    #[must_use]
    pub fn energy(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let mut energy = -self.lagrangian_at(t, q, v);
        self.momentum.evaluate(self.coordinates.len(), TapePoint::new(t, q, v), |i, p| energy += v[i] * p);
        energy
    }

    pub(crate) fn lagrangian_at(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let mut lagrangian = 0.0;
        self.lagrangian.evaluate(self.coordinates.len(), TapePoint::new(t, q, v), |_, x| lagrangian = x);
        lagrangian
    }

    /// `A` and `b`.
    pub(crate) fn rows_at(&self, t: f64, q: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let (n, m) = (self.coordinates.len(), self.constraints());
        let (mut a, mut b) = (DMatrix::zeros(m, n), DVector::zeros(m));
        self.constraint.evaluate(n, TapePoint::new(t, q, &[]), |k, x| match k.checked_sub(n * m) {
            Some(row) => b[row] = x,
            None => a[(k / n, k % n)] = x,
        });
        (a, b)
    }

    /// The functions of the positions.
    pub(crate) fn positions_at(&self, t: f64, q: &[f64]) -> DVector<f64> {
        let mut g = DVector::zeros(self.positions);
        self.holonomic.evaluate(self.coordinates.len(), TapePoint::new(t, q, &[]), |k, x| g[k] = x);
        g
    }

    /// The sizes of rates with the same kinetic energy.
    pub(crate) fn sizes(&self, t: f64, q: &[f64]) -> Vec<f64> {
        let mass = self.mass_at(t, q, &vec![0.0; q.len()]);
        Pivots::sizes(mass.diagonal().iter().copied()).collect()
    }

    /// The mass matrix `L_vv`.
    pub(crate) fn mass_at(&self, t: f64, q: &[f64], v: &[f64]) -> DMatrix<f64> {
        let n = self.coordinates.len();
        let mut mass = DMatrix::zeros(n, n);
        self.mass.evaluate(n, TapePoint::new(t, q, v), |k, x| {
            if k < n * n {
                mass[(k / n, k % n)] = x;
            }
        });
        mass
    }
}
