//! The small linear solvers against those of faer and nalgebra.

use crate::common::component;
use faer::linalg::solvers::Solve;
use lagrangian::linear::{Inverse, Lu, has_positive_determinant, normal_solve};
use lagrangian::{AdmissibleBasis, FactoredSaddle, RowSpace, Rows, Saddle};
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

        // Factorised once, for this right-hand side as for any other.
        for basis in [Some(&basis), None] {
            let factors = FactoredSaddle::new(&block, &[row], &saddle.rows, basis).unwrap();
            let z = factors.solve(&right, &[level], basis);
            for i in 0..3 {
                approx::assert_relative_eq!(z[i], x[i], epsilon = 1e-13);
            }
            let mut whole = [[0.0; 4]; 4];
            match basis {
                Some(basis) => {
                    for (row, w) in basis.vectors().iter().enumerate() {
                        for j in 0..3 {
                            whole[row][j] = (0..3).map(|i| w[i] * block[i][j]).sum();
                        }
                    }
                    (whole[2], whole[3][3]) = ([-sin, cos, 0.25, 0.0], 1.0);
                }
                None => {
                    for i in 0..3 {
                        whole[i] = [block[i][0], block[i][1], block[i][2], row[i]];
                    }
                    whole[3] = [-sin, cos, 0.25, 0.0];
                }
            }
            assert_eq!(factors.is_positive(), Lu::new(whole).unwrap().is_positive());
        }
    }

    /// Near the unit matrix the inverse is as good as the factorisation; so it is whatever the scales of rows and columns.
    #[test]
    fn inverses_solve(
        numbers in proptest::collection::vec(-0.2..0.2f64, 16), scales in proptest::collection::vec(-60..60i32, 8),
        b in proptest::array::uniform4(component()),
    ) {
        fn check<const U: usize>(numbers: &[f64], scales: &[i32], b: &[f64; 4]) {
            let scale = |i: usize| 2f64.powi(scales[i]);
            let unit = |i: usize, j: usize| f64::from(u8::from(i == j));
            let a: Matrix<U> = from_fn(|i| from_fn(|j| (unit(i, j) + numbers[4 * i + j]) * scale(i) * scale(4 + j)));
            let b = from_fn(|i| b[i] * scale(i));
            let (inverse, lu) = (Inverse::new(&a).unwrap(), Lu::new(a).unwrap());
            assert_eq!(matches!(inverse, Inverse::Cofactors(..)), U <= 3);
            assert_eq!(inverse.is_positive(), lu.is_positive());
            let (x, y) = (inverse.solve(&b), lu.solve(b));
            // Of the size of the right-hand sides, up to ten, times the condition, a few.
            for i in 0..U {
                approx::assert_relative_eq!(x[i] * scale(4 + i), y[i] * scale(4 + i), epsilon = 1e-12);
            }
        }
        check::<1>(&numbers, &scales, &b);
        check::<2>(&numbers, &scales, &b);
        check::<3>(&numbers, &scales, &b);
        check::<4>(&numbers, &scales, &b);
    }
}

/// Near a singular matrix cofactors cancel, and the elimination with pivots decides.
#[test]
fn inverses_leave_what_is_nearly_singular() {
    let near = |e: f64| [[1.0, 2.0, 3.0], [2.0, 4.0 + e, 6.0], [1.0, 1.0, 1.0]];
    assert!(matches!(Inverse::new(&near(1.0)), Ok(Inverse::Cofactors(..))));
    assert!(matches!(Inverse::new(&near(1e-6)), Ok(Inverse::Factors(_))));
    assert_eq!(Inverse::new(&near(0.0)).unwrap_err(), Lu::new(near(0.0)).unwrap_err());
    assert!(Inverse::new(&[[f64::NAN]]).is_err() && Inverse::new(&[[0.0]]).is_err());
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

/// The sign of the determinant of a product of triangles of whole numbers, rows and columns scaled by powers of two: all of
/// it exact.
fn sign<const U: usize>(numbers: &[i32], scales: &[i32]) -> Result<(), TestCaseError> {
    let number = |i: usize, j: usize| f64::from(numbers[5 * i + j]);
    let lower = |i: usize, k: usize| if i == k { 1.0 } else { number(i, k) };
    let scale = |i: usize| 2f64.powi(scales[i]);
    let a: Matrix<U> = from_fn(|i| {
        from_fn(|j| (0..=i.min(j)).map(|k| lower(i, k) * number(k, j)).sum::<f64>() * scale(i) * scale(U + j))
    });
    let signs: f64 = (0..U).map(|i| number(i, i).signum() * f64::from(u8::from(number(i, i) != 0.0))).product();
    let expected = if signs == 0.0 { None } else { Some(signs > 0.0) };
    prop_assert_eq!(has_positive_determinant(&a), expected, "{:?}", a);
    // Of a singular matrix elimination may leave the rounding of a pivot.
    if let (Ok(lu), Some(positive)) = (Lu::new(a), expected) {
        prop_assert_eq!(lu.is_positive(), positive, "{:?}", a);
    }
    Ok(())
}

proptest! {
    #[test]
    fn signs_of_determinants(
        numbers in proptest::collection::vec(-3..4i32, 25), scales in proptest::collection::vec(-20..20i32, 10),
    ) {
        sign::<1>(&numbers, &scales)?;
        sign::<2>(&numbers, &scales)?;
        sign::<3>(&numbers, &scales)?;
        sign::<4>(&numbers, &scales)?;
        prop_assume!((0..5).all(|i| numbers[6 * i] != 0));
        sign::<5>(&numbers, &scales)?;
    }

    /// The rank of rows in any units, of the coordinates and of their own; what the dependent one is
    /// made of, and the velocities that none of them sees.
    #[test]
    fn rank_of_rows(
        a in proptest::array::uniform2(proptest::array::uniform4(component())), weights in proptest::array::uniform2(0.2..3.0f64),
        row in proptest::array::uniform3(-6..6i32), unit in proptest::array::uniform4(-6..6i32),
    ) {
        let unit = unit.map(|k| 10f64.powi(k));
        let row = row.map(|k| 10f64.powi(k));
        // Two rows of some size and angle, and a third that may depend on them.
        let size = |x: &[f64; 4]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let along = (0..4).map(|i| a[0][i] * a[1][i]).sum::<f64>() / (size(&a[0]) * size(&a[1]));
        prop_assume!(size(&a[0]) > 0.1 && size(&a[1]) > 0.1 && along.abs() < 0.9);
        let third: [f64; 4] = from_fn(|i| weights[0] * a[0][i] / size(&a[0]) - weights[1] * a[1][i] / size(&a[1]));
        let scaled = |rows: [[f64; 4]; 3]| -> [[f64; 4]; 3] { from_fn(|k| from_fn(|i| row[k] * rows[k][i] * unit[i])) };
        let mass = from_fn(|i| from_fn(|j| if i == j { unit[i] * unit[i] } else { 0.0 }));
        let tolerance = RowSpace::<4, 3>::ROUNDING;

        let rows = scaled([a[0], a[1], third]);
        let space = RowSpace::new(&rows, &mass, tolerance);
        prop_assert_eq!(space.rank(), 2);
        let found = space.dependence();
        prop_assert_eq!(found.involved, Rows::from_iter(0..3));
        prop_assert!(found.distance <= tolerance);
        for k in (0..3).filter(|k| !found.independent.contains(*k)) {
            for i in 0..4 {
                let sum: f64 = found.independent.iter().map(|l| found.combination[k][l] * rows[l][i]).sum();
                let terms: f64 = found.independent.iter().map(|l| (found.combination[k][l] * rows[l][i]).abs()).sum();
                // Both rows have weights of a size, and an angle that is not small.
                prop_assert!((sum - rows[k][i]).abs() <= 100.0 * tolerance * (terms + row[k] * unit[i]), "{sum} {rows:?}");
            }
        }
        for w in &space.kernel()[..2] {
            for r in &rows {
                let terms: f64 = (0..4).map(|i| (r[i] * w[i]).abs()).sum();
                let (_, size) = space.outside(r);
                let seen: f64 = (0..4).map(|i| r[i] * w[i]).sum();
                prop_assert!(seen.abs() <= 10.0 * tolerance * (terms + size), "{seen:e}");
            }
            prop_assert!(w.iter().any(|w| *w != 0.0));
        }

        // A part across both shows, however small it is beside the rounding of the rest.
        let kernel = space.kernel();
        let across: [f64; 4] = from_fn(|i| (kernel[0][i] + kernel[1][i]) * unit[i]);
        let length = size(&across);
        let lifted = scaled([a[0], a[1], from_fn(|i| third[i] + 1e-9 * across[i] / length)]);
        prop_assert_eq!(RowSpace::new(&lifted, &mass, tolerance).rank(), 3);
        prop_assert_eq!(RowSpace::new(&lifted, &mass, 1e-6).rank(), 2);
    }
}

#[test]
fn rows_that_vanish_or_are_no_numbers() {
    let identity = from_fn(|i| from_fn(|j| f64::from(u8::from(i == j))));
    let rank = |rows: [[f64; 2]; 2]| RowSpace::new(&rows, &identity, RowSpace::<2, 2>::ROUNDING).rank();
    assert_eq!(rank([[0.0, 0.0], [1.0, 0.0]]), 1);
    assert_eq!(rank([[0.0, 0.0], [0.0, 0.0]]), 0);
    assert_eq!(rank([[1e-300, 0.0], [1e-300, 1e-300]]), 2);
    assert_eq!(rank([[1e200, 0.0], [1e200, 1e200]]), 2);
    assert!(rank([[f64::NAN, 0.0], [0.0, 1.0]]) < 2);
    // A coordinate without mass, in any unit.
    for unit in [1e-9, 1.0, 1e9] {
        let mass = [[2.0, 0.0], [0.0, 0.0]];
        let rank = |rows: [[f64; 2]; 2]| RowSpace::new(&rows, &mass, RowSpace::<2, 2>::ROUNDING).rank();
        assert_eq!(rank([[1.0, unit], [3.0, 3.0 * unit]]), 1);
        assert_eq!(rank([[1.0, unit], [3.0, 2.9 * unit]]), 2);
    }
}
