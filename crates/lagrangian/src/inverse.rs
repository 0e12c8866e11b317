use crate::linear::{Lu, Singular, THRESHOLD};
use crate::mapped;

/// The inverse of a matrix of up to three rows that is far from singular, or the factorisation of any other: to solve with
/// it several times, and quickly.
#[derive(Debug, Clone, Copy)]
pub enum Inverse<const U: usize> {
    /// The rows of the inverse, by cofactors, and its determinant.
    Cofactors([[f64; U]; U], f64),
    /// The factorisation.
    Factors(Lu<U>),
}

impl<const U: usize> Inverse<U> {
    /// The determinant against the sum of the sizes of its terms: above it three digits of sixteen are lost to
    /// cancellation, whatever the scale of rows and columns.
    const CLEAR: f64 = 1e-3;

    /// The inverse of a matrix given by rows.
    ///
    /// # Errors
    /// As [`Lu::new`].
    #[inline(always)]
    pub fn new(a: &[[f64; U]; U]) -> Result<Self, Singular> {
        Self::above(a, THRESHOLD)
    }

    /// The inverse of a matrix whose entries carry more round-off: pivots up to `threshold` count as zero.
    ///
    /// # Errors
    /// As [`Lu::new`].
    #[inline(always)]
    pub fn above(a: &[[f64; U]; U], threshold: f64) -> Result<Self, Singular> {
        match Self::by_cofactors(a) {
            Some(inverse) => Ok(inverse),
            None => Self::factorised(a, threshold),
        }
    }

    /// As `above`, but `None` if the elimination of up to three rows loses more than three digits. For more rows the loss is not checked.
    #[inline(always)]
    pub(crate) fn clear_above(a: &[[f64; U]; U], threshold: f64) -> Option<Self> {
        // Decided by the number of rows alone, at compile time: a result that may be of either kind would be stored and loaded again,
        // with the latency of store forwarding.
        match U {
            0..=3 => Self::by_cofactors(a),
            _ => Self::factorised(a, threshold).ok(),
        }
    }

    #[inline(never)]
    fn factorised(a: &[[f64; U]; U], threshold: f64) -> Result<Self, Singular> {
        Lu::above(*a, threshold).map(Self::Factors)
    }

    #[inline(always)]
    fn by_cofactors(a: &[[f64; U]; U]) -> Option<Self> {
        let mut inverse = [[0.0; U]; U];
        let (determinant, terms) = match U {
            1 => {
                inverse[0][0] = 1.0;
                (a[0][0], a[0][0].abs())
            }
            2 => {
                (inverse[0][0], inverse[0][1]) = (a[1][1], -a[0][1]);
                (inverse[1][0], inverse[1][1]) = (-a[1][0], a[0][0]);
                let [p, q] = [a[0][0] * a[1][1], a[0][1] * a[1][0]];
                (p - q, p.abs() + q.abs())
            }
            3 => {
                let (mut determinant, mut terms) = (0.0, 0.0);
                for j in 0..3 {
                    let (k, l) = ((j + 1) % 3, (j + 2) % 3);
                    for i in 0..3 {
                        let (m, n) = ((i + 1) % 3, (i + 2) % 3);
                        let [p, q] = [a[m][k] * a[n][l], a[m][l] * a[n][k]];
                        inverse[j][i] = p - q;
                        if i == 0 {
                            determinant += a[0][j] * (p - q);
                            terms += a[0][j].abs() * (p.abs() + q.abs());
                        }
                    }
                }
                (determinant, terms)
            }
            _ => return None,
        };
        let clear = determinant.abs() > Self::CLEAR * terms && terms.is_finite();
        let scale = determinant.recip();
        if !(clear && scale.is_finite()) {
            return None;
        }
        for row in &mut inverse {
            for x in row {
                *x *= scale;
            }
        }
        Some(Self::Cofactors(inverse, scale))
    }

    /// Whether the determinant is positive.
    #[must_use]
    #[inline(always)]
    pub fn is_positive(&self) -> bool {
        match self {
            Self::Cofactors(_, determinant) => *determinant > 0.0,
            Self::Factors(lu) => lu.is_positive(),
        }
    }

    /// The solution `x` of `A x = b`.
    #[must_use]
    #[inline(always)]
    pub fn solve(&self, b: &[f64; U]) -> [f64; U] {
        match self {
            Self::Cofactors(inverse, _) => mapped(inverse, |row| (0..U).map(|i| row[i] * b[i]).sum()),
            Self::Factors(lu) => lu.solve(*b),
        }
    }
}
