use lagrangian::linear::{Singular, larger};

/// A row of the matrix: `2 N` places a stage, which is room for `N` velocities and up to `N` multipliers.
type StagesRow<const N: usize, const S: usize> = [[[f64; N]; 2]; S];

/// Linear equations in the velocities and multipliers of all stages, on the stack.
///
/// Their number `S N + (S - 1) M` cannot yet be written as the length of an array, so there is room for `2 S N`.
#[derive(Debug, Clone)]
pub(super) struct Dense<const N: usize, const M: usize, const S: usize> {
    rows: [[[StagesRow<N, S>; N]; 2]; S],
    right: StagesRow<N, S>,
}

/// A pivot below it, relative to its row and column, is round-off.
const THRESHOLD: f64 = 4.0 * f64::EPSILON;

#[inline]
fn flat<const N: usize, const S: usize>(row: &StagesRow<N, S>) -> &[f64] {
    row.as_flattened().as_flattened()
}

#[inline]
fn flat_mut<const N: usize, const S: usize>(row: &mut StagesRow<N, S>) -> &mut [f64] {
    row.as_flattened_mut().as_flattened_mut()
}

impl<const N: usize, const M: usize, const S: usize> Dense<N, M, S> {
    /// The number of equations.
    pub(super) const SIZE: usize = {
        assert!(M <= N, "more constraints than coordinates");
        S * N + (S - 1) * M
    };

    /// All zero.
    #[inline]
    pub(super) fn zero() -> Self {
        Self { rows: [[[[[[0.0; N]; 2]; S]; N]; 2]; S], right: [[[0.0; N]; 2]; S] }
    }

    /// The index of velocity `i` of a stage, and of its equation.
    #[inline]
    pub(super) fn velocity(stage: usize, i: usize) -> usize {
        stage * N + i
    }

    /// The index of multiplier `k` of a stage; the last stage has none.
    #[inline]
    pub(super) fn multiplier(stage: usize, k: usize) -> usize {
        S * N + stage * M + k
    }

    /// A row of the matrix.
    #[inline]
    pub(super) fn row(&mut self, row: usize) -> &mut [f64] {
        flat_mut(&mut self.rows.as_flattened_mut().as_flattened_mut()[row])
    }

    /// The right-hand sides, and after [`Dense::solve`] the solution.
    #[inline]
    pub(super) fn right(&mut self) -> &mut [f64] {
        flat_mut(&mut self.right)
    }

    /// Solves by elimination with scaled partial pivoting.
    ///
    /// # Errors
    /// [`Singular`] as for [`lagrangian::linear::Lu::new`].
    #[inline]
    pub(super) fn solve(&mut self) -> Result<(), Singular> {
        let rows = &mut self.rows.as_flattened_mut().as_flattened_mut()[..Self::SIZE];
        let right = flat_mut(&mut self.right);
        let mut scales = [[[0.0; N]; 2]; S];
        let mut columns = [[[0.0f64; N]; 2]; S];
        let (scales, columns) = (flat_mut(&mut scales), flat_mut(&mut columns));
        for (scale, row) in scales.iter_mut().zip(rows.iter()) {
            let row = &flat(row)[..Self::SIZE];
            *scale = row.iter().fold(0.0, |m: f64, x| larger(m, *x)).recip();
            for (column, x) in columns.iter_mut().zip(row) {
                *column = larger(*column, x * *scale);
            }
        }
        for k in 0..Self::SIZE {
            let mut best = k;
            let mut size = 0.0;
            for i in k..Self::SIZE {
                let candidate = (flat(&rows[i])[k] * scales[i]).abs();
                if candidate > size {
                    (best, size) = (i, candidate);
                }
            }
            let pivot = size / columns[k];
            if pivot <= THRESHOLD || !pivot.is_finite() {
                return Err(Singular { column: k, pivot });
            }
            rows.swap(k, best);
            scales.swap(k, best);
            right.swap(k, best);
            let (upper, lower) = rows.split_at_mut(k + 1);
            let upper = &flat(&upper[k])[..Self::SIZE];
            let upper_right = right[k];
            for (row, right) in lower.iter_mut().zip(&mut right[k + 1..]) {
                let row = &mut flat_mut(row)[..Self::SIZE];
                let factor = row[k] / upper[k];
                if factor != 0.0 {
                    for (x, u) in row[k + 1..].iter_mut().zip(&upper[k + 1..]) {
                        *x -= factor * u;
                    }
                    *right -= factor * upper_right;
                }
            }
        }
        for k in (0..Self::SIZE).rev() {
            let row = &flat(&rows[k])[..Self::SIZE];
            let known: f64 = row[k + 1..].iter().zip(&right[k + 1..Self::SIZE]).map(|(x, y)| x * y).sum();
            right[k] = (right[k] - known) / row[k];
        }
        Ok(())
    }
}
