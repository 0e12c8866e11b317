use lagrangian::linear::{larger, largest};
use nalgebra::{DMatrix, DVector};

/// Number of last iterations that are remembered.
const MOST: usize = 16;

/// The derivatives of `x <- g(x)` as far as its last iterations show them: Anderson's acceleration, by which even an iteration converges
/// that is pushed away from its solution in a few directions.
///
/// (Walker and Ni 2011, SIAM J. Numer. Anal. 49, 1715-1735.)
#[derive(Debug, Default)]
pub(super) struct Secants {
    /// The differences from each iteration to the next of the changes `g(x) - x`, and of `g(x)`.
    changes: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
    last: Option<[Vec<f64>; 2]>,
}

impl Secants {
    /// From `x` and `g(x)` the next `x`, in the place of `g(x)`. Every `period`-th number is of one component, and these have a unit each.
    pub(super) fn next(&mut self, x: &[f64], image: &mut [f64], period: usize) {
        let change: Vec<f64> = image.iter().zip(x).map(|(g, x)| g - x).collect();
        if let Some([before, from]) = self.last.take() {
            let less = |a: &[f64], b: Vec<f64>| a.iter().zip(b).map(|(a, b)| a - b).collect();
            if self.changes.len() == MOST {
                self.changes.remove(0);
                self.images.remove(0);
            }
            self.changes.push(less(&change, before));
            self.images.push(less(image, from));
        }
        self.last = Some([change.clone(), image.to_vec()]);
        // Small numbers are not resolved at the expense of large ones.
        const SMALL: f64 = 1e-6;
        let all = largest(image);
        let size = |k: usize| image.iter().skip(k).step_by(period).fold(SMALL * all, |most, x| larger(most, *x));
        let sizes: Vec<f64> = (0..period).map(size).collect();
        let columns = self.changes.len();
        if columns == 0 || all == 0.0 {
            return;
        }
        let matrix = DMatrix::from_fn(image.len(), columns, |i, j| self.changes[j][i] / sizes[i % period]);
        let right = DVector::from_fn(image.len(), |i, _| change[i] / sizes[i % period]);
        let svd = matrix.svd(true, true);
        let Ok(shares) = svd.solve(&right, f64::EPSILON * svd.singular_values.max()) else { return };
        for (share, difference) in shares.iter().zip(&self.images) {
            image.iter_mut().zip(difference).for_each(|(g, d)| *g -= share * d);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear iteration that by itself grows in two directions ends, after as many iterations as there are directions, at its solution.
    #[test]
    fn a_few_directions_may_grow() {
        let g = |x: &[f64]| -> Vec<f64> { vec![1.0 - 3.0 * x[1], 2.0 * x[0], 0.1 * x[2] + 0.9, 1e6 + 0.5 * x[1]] };
        let (mut x, mut secants) = (vec![0.0; 4], Secants::default());
        for _ in 0..8 {
            let mut image = g(&x);
            secants.next(&x, &mut image, 4);
            x = image;
        }
        let missed: Vec<f64> = g(&x).iter().zip(&x).map(|(g, x)| (g - x).abs() / x.abs()).collect();
        assert!(largest(&missed) < 1e-9, "{x:?} misses {missed:?}");
        // The positive control: without memory they grow.
        let plain = (0..8).fold(vec![0.0; 4], |x, _| g(&x));
        assert!(largest(&plain[..2]) > 100.0, "{plain:?}");
    }
}
