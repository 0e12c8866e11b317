use crate::contributions::{Contributions, at};
use crate::dla::PARALLEL;
use crate::equations::AssemblyEquations;
use crate::projection::project;
use crate::{Assembly, AssemblyState, Solver, terms};
use dla::StepError;

impl Assembly {
    /// Brings the velocity of a state onto the constraints by an impulse of the constraints, if it misses them by more than rounding, as
    /// after a jump of an imposed velocity: `sum_e L_v(q, v) = p + A' mu`, `A v + b = 0`, as [`dla::onto_constraint`]. Rounding is
    /// judged for a step of length `h` (s).
    ///
    /// # Errors
    /// [`StepError`] if the constraints do not determine the velocity, or if the memory does not suffice.
    pub fn onto_constraint(&self, (t, h): (f64, f64), state: &mut AssemblyState) -> Result<(), StepError> {
        let (q, v) = (state.q().to_vec(), state.v().to_vec());
        let (levels, p) = self.levels(t, &q, &v);
        let mut sizes = vec![0.0; self.coordinates() + self.rows()];
        terms::add(self, (t, h), |i| q[i], |i| v[i], &mut sizes);
        let met = |(level, size): (&f64, &f64)| level.abs() <= 8.0 * f64::EPSILON * size;
        if levels.iter().zip(&sizes[self.coordinates()..]).all(met) {
            return Ok(());
        }
        let mut equations = AssemblyEquations::of(self, Solver::Best, PARALLEL)?;
        let mut v1 = v.clone();
        project(&mut equations, (self, t, h), (&q, &v), &p, &mut v1)?;
        for (i, v) in v1.into_iter().enumerate() {
            state.set_velocity(i, v);
        }
        Ok(())
    }

    /// The misses of the constraints, `-(A v + b)`, and the momenta with their signs turned.
    pub(crate) fn levels(&self, t: f64, q: &[f64], v: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut contributions = Contributions::of(self, PARALLEL);
        let mut levels = vec![0.0; self.rows()];
        let mut p = vec![0.0; self.coordinates()];
        contributions.ask(self, false, &|placed, out| at(placed, q, v, |q, v| placed.element.velocity(t, q, v, out)));
        contributions.add_momenta(self, -1.0, &mut p);
        contributions.write_levels(self, &mut levels);
        (levels, p)
    }
}
