use lagrangian::linear::normal_solve;
use lagrangian::{Rounded, from_fn, mapped};

/// A covector without its part along the rows, the reaction, which the multipliers balance: `r - Q Q' r` with an orthonormal
/// basis `Q` of the rows, by modified Gram-Schmidt, twice (Bjorck 1967, BIT 7, 1-21). Rows that depend on those before them
/// are passed over.
pub(crate) fn without_reaction<const N: usize, const M: usize>(
    rows: &[[f64; N]; M],
    mut r: [Rounded; N],
) -> [Rounded; N] {
    let mut basis = [[0.0; N]; M];
    for k in 0..M {
        let before = norm(&rows[k]);
        let mut row = mapped(&rows[k], |x| x / before);
        for _ in 0..2 {
            for q in basis.iter().take(k) {
                let along: f64 = (0..N).map(|i| q[i] * row[i]).sum();
                row = from_fn(|i| row[i] - along * q[i]);
            }
        }
        let left = norm(&row);
        // A row of zeros, or one that the others imply, adds nothing.
        if left > DEPENDENT {
            basis[k] = mapped(&row, |x| x / left);
        }
    }
    for q in &basis {
        let along = (0..N).fold(Rounded::exact(0.0), |sum, i| sum + r[i] * q[i]);
        r = from_fn(|i| r[i] + -(along * q[i]));
    }
    r
}

/// Splits a covector into its part along the rows, `A' lambda`, and the rest; none for dependent rows. Done twice, since the normal
/// equations lose digits.
pub(crate) fn parted<const N: usize, const M: usize>(
    rows: &[[f64; N]; M],
    r: &[f64; N],
) -> Option<([f64; N], [f64; M])> {
    let (mut left, mut lambda) = (*r, [0.0; M]);
    for _ in 0..2 {
        let part = normal_solve(rows, &left).ok()?;
        for k in 0..M {
            lambda[k] += part[k];
            left = from_fn(|i| left[i] - part[k] * rows[k][i]);
        }
    }
    Some((left, lambda))
}

/// A row whose part beside the rows before it is smaller counts as dependent on them.
const DEPENDENT: f64 = 1e-12;

fn norm<const N: usize>(row: &[f64; N]) -> f64 {
    row.iter().fold(0.0_f64, |length, x| length.hypot(*x))
}

/// The largest residual in units of the round-off of its terms.
pub(crate) fn most_roundings(residuals: impl IntoIterator<Item = Rounded>) -> f64 {
    residuals.into_iter().fold(0.0, |most, residual| residual.roundings().max(most))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reaction_leaves_nothing() {
        let rows = [[1.0, 2.0, 0.5, 0.0], [2.0, 4.0, 1.0, 0.0], [0.0; 4], [0.3, -1.0, 2.0, 1e3]];
        // A' (1, 0, 0, 2), and a hundred times its round-off across it.
        let reaction: [f64; 4] = from_fn(|i| rows[0][i] + 2.0 * rows[3][i]);
        let left = without_reaction(&rows, mapped(&reaction, Rounded::once));
        assert!(most_roundings(left) <= 1.0, "{left:?}");
        let across = [2.0, -1.0, 0.0, 1.6e-3].map(|x: f64| 1e-10 * x);
        let left = without_reaction(&rows, from_fn(|i| Rounded::once(reaction[i] + across[i])));
        assert!(most_roundings(left) > 100.0, "{left:?}");
    }
}
