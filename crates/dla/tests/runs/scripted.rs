//! A method with a script, and memories, which pass through methods built on others.

use dla::{Composition, Dla, Mechanics, OneStep, State, StepError, StepReport};
use lagrangian::{Constraint, Scalar, System};

/// A point on a line that is led at 1 m/s; a method with a script asks it for nothing.
#[derive(Clone, Copy)]
pub(crate) struct Point;

impl System<1, 1> for Point {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 1], v: &[S; 1]) -> S {
        v[0] * v[0] * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 1]) -> Constraint<S, 1, 1> {
        ([[S::constant(1.0)]], [S::constant(-1.0)])
    }
}

/// Moves with its velocity, in steps below one eighth before the time 1/4 and of any length later; it remembers them.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Short {
    made: Vec<f64>,
}

impl OneStep<1, 1> for Short {
    fn step(
        &mut self,
        _: &dyn Mechanics<1, 1>,
        t: f64,
        h: f64,
        state: &mut State<1>,
    ) -> Result<StepReport<1>, StepError> {
        if t < 0.25 && h > 0.125 {
            return Err(StepError::Branch);
        }
        self.made.extend([t, h]);
        let v = *state.v();
        state.advance(&[h * v[0]], v, None);
        Ok(StepReport { impulses: [[h], [2.0 * h]], work: (t > 0.2).then_some(h), ..StepReport::of(1) })
    }
    fn memory(&self) -> Vec<f64> {
        self.made.clone()
    }
    fn recall(&mut self, memory: &[f64], _state: &State<1>) {
        self.made = memory.to_vec();
    }
}

pub(crate) fn start() -> State<1> {
    State::new([0.0], [1.0], [false])
}

#[test]
fn memories_pass_through() {
    let given = [0.5, 0.25];
    let mut composed = Composition::suzuki4(Short::default());
    OneStep::<1, 1>::recall(&mut composed, &given, &start());
    assert_eq!(OneStep::<1, 1>::memory(&composed), given);
    // What is a map has none.
    assert!(OneStep::<3, 1>::memory(&Dla::midpoint()).is_empty());
}
