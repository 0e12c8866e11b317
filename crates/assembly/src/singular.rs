use crate::Assembly;
use crate::factor::Factor;
use crate::pattern::Pattern;
use dla::DependentRows;
use lagrangian::linear::largest;

/// The constraints that depend on one another in a matrix that is singular: those with a part in its null vector.
///
/// The diagonal block of the constraints is made a little less than zero, `-delta` (a regularisation). Inverse iteration then converges to
/// the vector of the smallest eigenvalue: multipliers whose forces cancel.
#[cold]
pub(crate) fn dependent(
    assembly: &Assembly,
    pattern: &Pattern,
    values: &mut [f64],
    factor: &mut Factor,
) -> DependentRows {
    const PART: f64 = 1e-3;
    let delta = 1e-9 * largest(values);
    for place in &pattern.regular {
        values[*place as usize] = -delta;
    }
    let factorised = factor.factorise(pattern, values);
    for place in &pattern.regular {
        values[*place as usize] = 0.0;
    }
    let n = assembly.coordinates();
    // No row of a model is orthogonal to these numbers by its symmetry.
    let mut x: Vec<f64> = (0..pattern.unknowns()).map(|i| if i < n { 0.0 } else { 1.0 + (i as f64).sin() }).collect();
    let mut named = [None; 4];
    if factorised.is_err() {
        return named;
    }
    for _ in 0..3 {
        factor.solve(&mut x);
        let size = largest(&x);
        if !size.is_finite() || size == 0.0 {
            return named;
        }
        x.iter_mut().for_each(|x| *x /= size);
        x[..n].fill(0.0);
    }
    let mut heaviest: Vec<usize> = (n..x.len()).filter(|k| x[*k].abs() > PART).collect();
    heaviest.sort_by(|a, b| x[*b].abs().total_cmp(&x[*a].abs()));
    named.iter_mut().zip(heaviest).for_each(|(name, k)| *name = assembly.constraint(k - n));
    named
}
