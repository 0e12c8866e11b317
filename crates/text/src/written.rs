//! The reduced equations of a system of text, as a text again.

use crate::tapes::{TapePoint, Tapes};
use crate::{TextModel, TextStart};
use expression::Names;
use lagrangian::Pivots;
use nalgebra::{DMatrix, DVector};

/// The equations of motion in a basis of the admissible velocities, `q' = W xi + v_b`, `xi' = f(t, q, xi)`, in the words of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenEquations {
    /// The names of the unknowns: first the coordinates, then the quasi-velocities.
    pub unknowns: Vec<String>,
    /// Names of shared expressions with their formulas, each before its first use.
    pub statements: Vec<(String, String)>,
    /// The rate of each unknown.
    pub rates: Vec<String>,
    /// The unknowns at the start.
    pub start: Vec<f64>,
}

impl TextModel {
    /// The reduced equations in the basis in use at a start. If the text gives no basis and none is found that holds everywhere, they
    /// hold only near the start. Returns `None` if they are too large to be written.
    #[must_use]
    pub fn written_equations(&self, start: &TextStart) -> Option<WrittenEquations> {
        let (n, m) = (self.coordinates.len(), self.constraints());
        let (rows, _) = self.rows_at(0.0, &start.q);
        let (formulas, reduced) = self.reduced_formulas(&Pivots::best(&rows, &self.sizes(0.0, &start.q)))?;

        let taken = |word: &str| self.coordinates.iter().any(|coordinate| coordinate.name.starts_with(word));
        let free = |word: &str| {
            let mut word = word.to_owned();
            while taken(&word) {
                word.push('_');
            }
            word
        };
        let (quasi, shared) = (free("xi"), free("s"));
        let places: Vec<String> = self.coordinates.iter().map(|coordinate| coordinate.name.clone()).collect();
        let velocities = (1..=n).map(|k| format!("{quasi}{k}"));
        let names =
            Names::of(["t".to_owned()].into_iter().chain(places.iter().cloned()).chain(velocities.clone())).ok()?;
        let all = [&reduced.velocity[..], &reduced.acceleration].concat();
        let (statements, rates) = formulas.graph.statements(&all, &names, &shared).ok()?;

        // `v = W xi + v_b`.
        let at = |xi: &[f64]| -> Option<DVector<f64>> {
            let mut v = DVector::zeros(n);
            let tapes = Tapes::new(&formulas.graph, &reduced.velocity).ok()?;
            tapes.evaluate(n, TapePoint::new(0.0, &start.q, xi), |i, x| v[i] = x);
            Some(v)
        };
        let shift = at(&vec![0.0; n])?;
        let mut basis = DMatrix::zeros(n, n - m);
        for k in 0..n - m {
            let unit: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i == k))).collect();
            basis.set_column(k, &(at(&unit)? - &shift));
        }
        let xi = basis.svd(true, true).solve(&(DVector::from_column_slice(&start.v) - shift), 0.0).ok()?;
        let start = start.q.iter().copied().chain(xi.iter().copied()).collect();
        Some(WrittenEquations {
            unknowns: places.into_iter().chain(velocities.take(n - m)).collect(),
            statements,
            rates,
            start,
        })
    }
}
