//! The small linear solvers against those of faer and nalgebra.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]
mod common;

use common::component;
use faer::linalg::solvers::Solve;
use lagrangian::linear::{Lu, normal_solve};
use lagrangian::{AdmissibleBasis, Saddle};
use proptest::prelude::*;
use std::array::from_fn;

type Matrix<const U: usize> = [[f64; U]; U];

fn matrix<const U: usize>() -> impl Strategy<Value = Matrix<U>> {
    // Rows and columns of very different sizes: units must not matter.
    let scale = || proptest::array::uniform::<_, U>((-8..8i32).prop_map(|k| 2f64.powi(3 * k)));
    (proptest::array::uniform::<_, U>(proptest::array::uniform::<_, U>(component())), scale(), scale()).prop_map(
        |(mut a, row, column)| {
            for i in 0..U {
                for j in 0..U {
                    a[i][j] *= row[i] * column[j];
                }
            }
            a
        },
    )
}

/// The largest residual when rows and columns have been scaled to one, relative to the solution and right side so scaled:
/// what elimination with scaled pivoting keeps at rounding.
fn residual<const U: usize>(a: &Matrix<U>, x: &[f64; U], b: &[f64; U]) -> f64 {
    let largest = |values: [f64; U]| values.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let row = a.map(largest);
    let column: [f64; U] = from_fn(|j| largest(from_fn(|i| a[i][j] / row[i])));
    let size = largest(from_fn(|j| column[j] * x[j])) + largest(from_fn(|i| b[i] / row[i]));
    let rest = largest(from_fn(|i| ((0..U).map(|j| a[i][j] * x[j]).sum::<f64>() - b[i]) / row[i]));
    if size > 0.0 { rest / size } else { 0.0 }
}

fn check<const U: usize>(a: Matrix<U>, b: [f64; U]) -> Result<(), TestCaseError> {
    // A refused matrix is another test's matter.
    let Ok(lu) = Lu::new(a) else { return Ok(()) };
    let x = lu.solve(b);
    // U^3 operations, each with half an ulp, and a growth of the entries by 2^U at most.
    prop_assert!(residual(&a, &x, &b) <= 1e-13, "residual {:e}", residual(&a, &x, &b));

    let dense = faer::Mat::from_fn(U, U, |i, j| a[i][j]);
    let right = faer::Mat::from_fn(U, 1, |i, _| b[i]);
    let other = dense.full_piv_lu().solve(&right);
    let theirs: [f64; U] = from_fn(|i| other[(i, 0)]);
    let ours = residual(&a, &x, &b);
    prop_assert!(ours <= 1e-15f64.max(10.0 * residual(&a, &theirs, &b)), "worse than faer's: {ours:e}");
    Ok(())
}

proptest! {
    #[test]
    fn solves_like_faer(a in matrix::<4>(), b in proptest::array::uniform::<_, 4>(component())) {
        check(a, b)?;
    }

    #[test]
    fn solves_like_nalgebra_where_well_conditioned(
        a in proptest::array::uniform3(proptest::array::uniform3(-1.0..1.0f64)),
        b in proptest::array::uniform3(component()),
    ) {
        let mut a = a;
        for i in 0..3 {
            a[i][i] += 4.0;
        }
        let theirs = nalgebra::Matrix3::from_fn(|i, j| a[i][j]).lu().solve(&nalgebra::Vector3::from(b)).unwrap();
        let ours = Lu::new(a).unwrap().solve(b);
        for i in 0..3 {
            approx::assert_relative_eq!(ours[i], theirs[i], epsilon = 1e-14, max_relative = 1e-13);
        }
    }

    #[test]
    fn a_dependent_row_is_refused(
        a in proptest::array::uniform3(proptest::array::uniform3(-1.0..1.0f64)), k in -3.0..3.0f64,
    ) {
        let mut a = a;
        for j in 0..3 {
            a[2][j] = k * a[0][j] - a[1][j];
        }
        // Rounding may make the rows independent, but then the solution is as large as the inverse of rounding.
        if let Ok(lu) = Lu::new(a) {
            let x = lu.solve([0.0, 0.0, 1.0]);
            let size = x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            prop_assert!(size > 1e13, "a dependent row gave a solution of ordinary size: {size:e}");
        }
    }

    /// In the basis and with multipliers: the same solution.
    #[test]
    fn both_forms_of_the_saddle_agree(
        mass in proptest::array::uniform3(0.5..2.0f64), skew in -0.2..0.2f64, angle in -3.0..3.0f64,
        right in proptest::array::uniform3(component()), level in component(),
    ) {
        let (sin, cos) = angle.sin_cos();
        let mut block = [[skew; 3]; 3];
        for i in 0..3 {
            block[i][i] = mass[i];
        }
        let row = [-sin, cos, 0.3];
        let saddle = Saddle { block, transposed: [row], rows: [[-sin, cos, 0.25]], right, level: [level] };
        let basis = AdmissibleBasis::new([[cos, sin, 0.0], [0.3 * sin, -0.3 * cos, 1.0]]);
        let (x, lambda) = saddle.solve(Some(&basis)).unwrap();
        let (y, mu) = saddle.solve(None).unwrap();
        for i in 0..3 {
            approx::assert_relative_eq!(x[i], y[i], epsilon = 1e-13);
        }
        approx::assert_relative_eq!(lambda[0], mu[0], epsilon = 1e-13);
    }
}

#[test]
fn refusals_carry_their_column() {
    assert_eq!(Lu::new([[1.0, 2.0], [2.0, 4.0]]).unwrap_err().column, 1);
    assert_eq!(Lu::new([[0.0, 0.0], [0.0, 1.0]]).unwrap_err().column, 0);
    assert!(Lu::new([[f64::NAN, 0.0], [0.0, 1.0]]).is_err());
    assert!(Lu::new([[f64::INFINITY, 0.0], [0.0, 1.0]]).is_err());
    // Badly scaled is not singular.
    assert!(Lu::new([[1e-200, 0.0], [1.0, 1e150]]).is_ok());
    assert!(Lu::<0>::new([]).is_ok());
}

#[test]
fn multipliers_of_dependent_rows_are_refused() {
    let rows = [[1.0, 0.0, 1.0], [2.0, 0.0, 2.0]];
    assert!(normal_solve(&rows, &[1.0, 2.0, 3.0]).is_err());
    let one = normal_solve(&[[0.0, 2.0, 0.0]], &[1.0, 2.0, 3.0]).unwrap();
    assert!((one[0] - 1.0).abs() < 1e-15);
}
