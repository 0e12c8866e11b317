use super::Case;
use super::systems::{bowl, sleigh, start, with};
use dla::{Equations, Newton};
use lagrangian::linear::{Lu, Singular};
use lagrangian::{Bracket, Lanes, Motion, Saddle, Scalar, System, With, mass_matrix, reduced_slope};
use sleigh::Sleigh;
use sleigh::effects::Bowl;
use std::hint::black_box;

const SOLVER: &str = "Newton and linear algebra";
const MECHANICS: &str = "mechanics of a point";

/// What a step is made of.
pub(super) fn cases() -> Vec<Case> {
    vec![
        Case::new(SOLVER, "LU 3 x 3", |times| repeat(times, || lu(MATRIX_3))),
        Case::new(SOLVER, "LU 4 x 4", |times| repeat(times, || lu(MATRIX_4))),
        Case::new(SOLVER, "saddle in a basis", |times| {
            let (q, _) = start();
            let basis = sleigh().admissible_basis(0.0, &q);
            repeat(times, || saddle().solve(black_box(basis.as_ref())));
        }),
        Case::new(SOLVER, "saddle with multipliers", |times| repeat(times, || saddle().solve(None))),
        Case::new(SOLVER, "Newton, Kepler's equation", |times| repeat(times, || kepler(1.0))),
        Case::new(MECHANICS, "mass matrix", |times| {
            let (q, v) = start();
            repeat(times, || mass_matrix(&black_box(well()), 0.0, &q, &v));
        }),
        Case::new(MECHANICS, "motion, by hand", |times| {
            let (q, v) = start();
            repeat(times, || Motion::of(&black_box(well()), 0.0, &q, &v));
        }),
        Case::new(MECHANICS, "motion, automatic", |times| {
            let (q, v) = start();
            repeat(times, || Motion::automatic(&black_box(well()), 0.0, &q, &v));
        }),
        Case::new(MECHANICS, "reduced slope", |times| {
            let (q, _) = start();
            repeat(times, || reduced_slope(&black_box(well()), 0.0, &q, &[-1.0, 0.1, 0.0]));
        }),
        Case::new(MECHANICS, "bracket of eight points", |times| {
            let (q, xi) = (start().0.map(Lanes::constant), [-1.0, 0.1, 0.0].map(Lanes::constant));
            repeat(times, || {
                Bracket::at(&black_box(well()), Lanes::constant(0.0), &q, &xi).map(|bracket| bracket.energy())
            });
        }),
    ]
}

fn repeat<T>(times: u64, mut work: impl FnMut() -> T) {
    for _ in 0..times {
        black_box(work());
    }
}

fn well() -> With<Sleigh, (Bowl,)> {
    with((bowl(),))
}

const MATRIX_3: [[f64; 3]; 3] = [[4.0, 1.0, 0.5], [1.0, 3.0, 0.2], [0.3, 0.1, 2.0]];
const MATRIX_4: [[f64; 4]; 4] =
    [[4.0, 1.0, 0.5, 0.1], [1.0, 3.0, 0.2, 0.4], [0.3, 0.1, 2.0, 0.6], [0.2, 0.7, 0.1, 5.0]];

fn lu<const U: usize>(matrix: [[f64; U]; U]) -> Result<[f64; U], Singular> {
    Ok(Lu::new(black_box(matrix))?.solve(black_box([1.0; U])))
}

/// The equations of a sleigh that heads along `x`.
fn saddle() -> Saddle<3, 1> {
    black_box(Saddle {
        block: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.5], [0.0, 0.5, 1.25]],
        transposed: [[0.0, 1.0, 0.0]],
        rows: [[0.0, 1.0, 0.05]],
        right: [1.0, 0.2, 0.3],
        level: [0.0],
    })
}

/// `E - e sin E = M`, the usual test of a solver of one unknown.
struct Kepler {
    mean: f64,
    eccentricity: f64,
}

impl Equations<1> for Kepler {
    fn correction(&mut self, [anomaly]: &[f64; 1]) -> Result<[f64; 1], Singular> {
        let (sin, cos) = anomaly.sin_cos();
        Ok([(self.mean + self.eccentricity * sin - anomaly) / (1.0 - self.eccentricity * cos)])
    }
}

fn kepler(mean: f64) -> bool {
    let mut equations = black_box(Kepler { mean, eccentricity: 0.3 });
    Newton::default().solve(&mut equations, &mut [mean]).is_ok()
}
