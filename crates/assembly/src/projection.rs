use crate::contributions::{MatrixPart, gathered};
use crate::equations::AssemblyEquations;
use crate::{Assembly, terms};
use dla::{Stage, StepError};

/// The velocity `v1` at the configuration `q1` with the momenta `-p` but for a reaction: `sum_e L_v(q1, v1) = -p + A(q1)' mu`,
/// `A(q1) v1 + b = 0`.
///
/// `v1` is the first guess, and `v` one by whose size rounding is judged.
pub(crate) fn project(
    equations: &mut AssemblyEquations,
    (assembly, t, h): (&Assembly, f64, f64),
    (q1, v): (&[f64], &[f64]),
    p: &[f64],
    v1: &mut [f64],
) -> Result<u32, StepError> {
    let evaluate = |equations: &mut AssemblyEquations, v1: &[f64], derivatives: bool| {
        equations.contributions.ask(assembly, derivatives, &|placed, out| {
            gathered(
                placed,
                |i| q1[i],
                |q1| {
                    gathered(placed, |i| v1[i], |v1| placed.element.velocity(t, q1, v1, out));
                },
            );
        });
        equations.write(assembly, derivatives.then_some(MatrixPart::All), p);
    };
    let terms = |sizes: &mut [f64]| terms::add(assembly, (t, h), |i| q1[i], |i| v[i], sizes);
    equations.newton((assembly, Stage::Projection), v1, terms, evaluate)
}
