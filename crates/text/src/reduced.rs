//! The reduced equations of a system of text, derived when they are first asked for.

use crate::tapes::{TapePoint, Tapes};
use crate::{TextFunctions, TextModel};
use dla::ReducedSeries;
use expression::formulas::{Formulas, ReducedFormulas};
use expression::{Expression, Recurrences};
use lagrangian::{Pivots, Reduced, ReducedError, Scalar, StageEvaluation};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Instant;

/// The accelerations of the quasi-velocities in one basis, as formulas.
#[derive(Debug)]
struct ReducedTapes {
    acceleration: Tapes,
    reconstruction: Option<u32>,
    stands_alone: bool,
}

/// The equations in one basis: derived when they are first needed, and `None` if they are too large.
#[derive(Debug, Default)]
pub(crate) struct EquationsOfBasis {
    velocity: OnceLock<Option<Tapes>>,
    turning: OnceLock<Option<Tapes>>,
    reduced: OnceLock<Option<ReducedTapes>>,
    recurrences: OnceLock<Option<Arc<Recurrences>>>,
}

/// The equations in one basis, shared by all systems of a model with the same basis.
pub(crate) type SharedEquations = Arc<EquationsOfBasis>;

/// The equations in each basis used so far, by the number of the basis; zero is the number of a basis that holds everywhere.
#[derive(Debug, Clone, Default)]
pub(crate) struct EquationsOfBases {
    all: Arc<Mutex<BTreeMap<u64, SharedEquations>>>,
    /// Time of their derivation so far (ns).
    taken: Arc<AtomicU64>,
}

impl EquationsOfBases {
    pub(crate) fn of(&self, basis: u64) -> SharedEquations {
        // What a thread that panicked has put there is whole.
        let mut all = self.all.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(all.entry(basis).or_default())
    }
}

impl TextModel {
    /// Time taken so far to derive the equations in the bases used (s). Equations are derived when they are first needed, which is
    /// within the first step.
    #[must_use]
    pub fn derivation_seconds(&self) -> f64 {
        self.equations.taken.load(Ordering::Relaxed) as f64 * 1e-9
    }

    /// Runs `derive` and adds its time to the total.
    fn clocked<T>(&self, derive: impl FnOnce() -> T) -> T {
        let begin = Instant::now();
        let derived = derive();
        self.equations.taken.fetch_add(begin.elapsed().as_nanos() as u64, Ordering::Relaxed);
        derived
    }

    /// The number of the basis in use; zero if the model has a basis that holds everywhere.
    pub(crate) fn basis_number(&self, pivots: &Pivots) -> u64 {
        if self.basis.is_some() { 0 } else { pivots.number() }
    }

    /// The velocity `W xi + v_b` in the basis in use; `None` if its formulas are too large.
    fn velocity(&self, pivots: &Pivots) -> Option<Tapes> {
        let (mut formulas, basis) = self.formulas_in_basis(pivots);
        let velocity = formulas.velocity_in(&basis)?;
        Tapes::new(&formulas.graph, &velocity).ok()
    }

    /// The derivatives of the basis in use in the coordinates, `dW_ai/dq_j` at the place `(a n + i) n + j`.
    fn turning(&self, pivots: &Pivots) -> Option<Tapes> {
        let (mut formulas, basis) = self.formulas_in_basis(pivots);
        let places: Vec<u32> = (0..formulas.n).map(|i| formulas.coordinate(i)).collect();
        let turning = formulas.graph.jacobian(&basis.concat(), &places).concat();
        formulas.graph.check().ok()?;
        Tapes::new(&formulas.graph, &turning).ok()
    }

    fn derived(&self, pivots: &Pivots) -> Option<ReducedTapes> {
        let (formulas, reduced) = self.reduced_formulas(pivots)?;
        let ReducedFormulas { acceleration, reconstruction, stands_alone, .. } = reduced;
        let acceleration = Tapes::new(&formulas.graph, &acceleration).ok()?;
        Some(ReducedTapes { acceleration, reconstruction, stands_alone })
    }

    /// The recurrences of the coordinates and the quasi-velocities.
    fn recurrences(&self, pivots: &Pivots) -> Option<Arc<Recurrences>> {
        let (formulas, reduced) = self.reduced_formulas(pivots)?;
        let rates = [&reduced.velocity[..], &reduced.acceleration].concat();
        let variables: Vec<u32> = (1..=rates.len() as u32).collect();
        Recurrences::new(&formulas.graph, &rates, &variables).ok().map(Arc::new)
    }

    /// The reduced equations in the basis in use; `None` if they are too large.
    pub(crate) fn reduced_formulas(&self, pivots: &Pivots) -> Option<(Formulas, ReducedFormulas)> {
        let (mut formulas, basis) = self.formulas_in_basis(pivots);
        let reduced = formulas.reduced_in(basis)?;
        Some((formulas, reduced))
    }

    fn formulas_in_basis(&self, pivots: &Pivots) -> (Formulas, Vec<Vec<Expression>>) {
        let mut formulas = Formulas::clone(&self.formulas);
        let basis = match (&formulas.basis, &self.eliminations) {
            (Some(given), _) => given.chunks(formulas.n).map(<[_]>::to_vec).collect(),
            (None, Some(eliminations)) => formulas.basis_by(eliminations),
            (None, None) => formulas.eliminated_basis(&pivots.order().collect::<Vec<_>>()),
        };
        (formulas, basis)
    }
}

impl<const N: usize, const M: usize> TextFunctions<N, M> {
    /// The derivatives of the basis, as formulas; `None` if they are too large.
    pub(crate) fn turning(&self) -> Option<&Tapes> {
        self.equations.turning.get_or_init(|| self.model.clocked(|| self.model.turning(&self.pivots))).as_ref()
    }

    /// The series of the motion.
    pub(crate) fn series(&self) -> Result<ReducedSeries, &'static str> {
        const TOO_LARGE: &str = "the reduced equations, from which series are made, are too large";
        let derived =
            self.equations.recurrences.get_or_init(|| self.model.clocked(|| self.model.recurrences(&self.pivots)));
        let recurrences = Arc::clone(derived.as_ref().ok_or(TOO_LARGE)?);
        let n = self.n();
        Ok(ReducedSeries { recurrences, coordinates: n, constants: (1 + 2 * n, Arc::clone(&self.sides)) })
    }

    fn equations(&self) -> Option<&ReducedTapes> {
        self.equations.reduced.get_or_init(|| self.model.clocked(|| self.model.derived(&self.pivots))).as_ref()
    }
}

/// By computer algebra: `xi'` as formulas in the basis in use.
impl<const N: usize, const M: usize> Reduced<N, M> for TextFunctions<N, M> {
    const STAGES: StageEvaluation = StageEvaluation::InArrays;

    fn reduced_motion<S: Scalar>(&self, t: S, q: &[S; N], xi: &[S; N]) -> Option<[S; N]> {
        let n = self.model.coordinates.len();
        let mut acceleration = [S::zero(); N];
        // The variable of the quasi-velocity `k` is that of the rate of the coordinate `k`.
        let at = TapePoint { sides: &self.sides, ..TapePoint::new(t, &q[..n], &xi[..n]) };
        self.equations()?.acceleration.evaluate(n, at, |k, x| acceleration[k] = x);
        Some(acceleration)
    }

    fn velocity<S: Scalar>(
        &self,
        t: S,
        q: &[S; N],
        xi: &[S; N],
        derived: impl FnOnce() -> Result<[S; N], ReducedError>,
    ) -> Result<[S; N], ReducedError> {
        let Some(formulas) =
            self.equations.velocity.get_or_init(|| self.model.clocked(|| self.model.velocity(&self.pivots)))
        else {
            return derived();
        };
        let (n, m) = (self.model.coordinates.len(), self.model.constraints());
        let mut velocity = [S::zero(); N];
        let at = TapePoint { sides: &self.sides, ..TapePoint::new(t, &q[..n], &xi[..n]) };
        formulas.evaluate(n, at, |i, x| velocity[i] = x);
        // The coordinates that are held by no constraint move by themselves.
        for (rate, xi) in velocity[n + M - m..].iter_mut().zip(&xi[n - m..]) {
            *rate = *xi;
        }
        Ok(velocity)
    }

    fn reconstruction(&self) -> Option<u32> {
        self.equations()?.reconstruction
    }

    fn stands_alone(&self) -> bool {
        self.equations().is_some_and(|equations| equations.stands_alone)
    }
}
