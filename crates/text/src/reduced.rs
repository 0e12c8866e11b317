//! The reduced equations of a system of text, derived when they are first asked for.

use crate::tapes::{TapePoint, Tapes};
use crate::{TextModel, TextSystem};
use ::formulas::{Formulas, ReducedFormulas};
use lagrangian::{Pivots, Reduced, Scalar};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The accelerations of the quasi-velocities in one basis, as formulas.
#[derive(Debug)]
pub(crate) struct ReducedTapes {
    acceleration: Tapes,
    reconstruction: Option<u32>,
    stands_alone: bool,
}

/// The equations in one basis: nothing before they are asked for, and none where they are too large.
pub(crate) type Equations = Arc<OnceLock<Option<ReducedTapes>>>;

/// The equations in each basis that has been in use, by its number; zero is that of a basis that holds everywhere.
#[derive(Debug, Clone, Default)]
pub(crate) struct EquationsOfBases(Arc<Mutex<BTreeMap<u64, Equations>>>);

impl EquationsOfBases {
    pub(crate) fn of(&self, basis: u64) -> Equations {
        // What a thread that panicked has put there is whole.
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(all.entry(basis).or_default())
    }
}

impl TextModel {
    /// The number of the basis in use: zero where one holds everywhere.
    pub(crate) fn basis_number(&self, pivots: &Pivots) -> u64 {
        if self.basis.is_some() { 0 } else { pivots.number() }
    }

    fn derived(&self, pivots: &Pivots) -> Option<ReducedTapes> {
        let (formulas, reduced) = self.reduced_formulas(pivots)?;
        let ReducedFormulas { acceleration, reconstruction, stands_alone, .. } = reduced;
        let acceleration = Tapes::new(&formulas.graph, &acceleration).ok()?;
        Some(ReducedTapes { acceleration, reconstruction, stands_alone })
    }

    /// The reduced equations in the basis in use; none where they are too large.
    pub(crate) fn reduced_formulas(&self, pivots: &Pivots) -> Option<(Formulas, ReducedFormulas)> {
        let mut formulas = Formulas::clone(&self.formulas);
        let basis = match (&formulas.basis, &self.eliminations) {
            (Some(given), _) => given.chunks(formulas.n).map(<[_]>::to_vec).collect(),
            (None, Some(eliminations)) => formulas.basis_by(eliminations),
            (None, None) => formulas.eliminated_basis(&pivots.order().collect::<Vec<_>>()),
        };
        let reduced = formulas.reduced_in(basis)?;
        Some((formulas, reduced))
    }
}

impl<const N: usize, const M: usize> TextSystem<N, M> {
    fn equations(&self) -> Option<&ReducedTapes> {
        self.equations.get_or_init(|| self.model.derived(&self.pivots)).as_ref()
    }
}

/// By computer algebra: `xi'` as formulas in the basis in use.
impl<const N: usize, const M: usize> Reduced<N, M> for TextSystem<N, M> {
    fn reduced_motion<S: Scalar>(&self, t: S, q: &[S; N], xi: &[S; N]) -> Option<[S; N]> {
        let n = self.model.coordinates.len();
        let mut acceleration = [S::zero(); N];
        // The variable of the quasi-velocity `k` is that of the rate of the coordinate `k`.
        let at = TapePoint::new(t, &q[..n], &xi[..n]);
        self.equations()?.acceleration.evaluate(n, at, |k, x| acceleration[k] = x);
        Some(acceleration)
    }

    fn reconstruction(&self) -> Option<u32> {
        self.equations()?.reconstruction
    }

    fn stands_alone(&self) -> bool {
        self.equations().is_some_and(|equations| equations.stands_alone)
    }
}
