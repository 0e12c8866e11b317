use super::Taylor;
use super::center::Center;
use super::polynomial::Polynomial;
use crate::sensitivity::SensitivityError;
use crate::{Mechanics, ReducedSeries, State, StepError};
use expression::Expansion;
use lagrangian::linear::larger;
use lagrangian::{Scalar, Seeded};
use nalgebra::{DMatrix, DVector};

/// Tangent vectors of the unknowns, carried along the polynomials of a motion: the same recurrences on numbers with derivatives, eight
/// directions at once, so that they are the derivatives of the polynomials themselves.
pub(crate) struct TaylorFlow {
    of: ReducedSeries,
    series: Expansion<Seeded>,
}

/// Directions that a number carries.
const AT_ONCE: usize = 8;

impl TaylorFlow {
    /// For the recurrences of a system, or of a family, whose parameters are their constants.
    pub(crate) fn new(of: ReducedSeries) -> Self {
        let series = Expansion::new(&of.recurrences);
        Self { of, series }
    }

    /// The tangents after the polynomials of a motion, whose series is `motion`; each has a row for every unknown, and behind them one for every constant.
    ///
    /// # Errors
    /// [`SensitivityError::Step`] if the motion fails, [`SensitivityError::Unsupported`] if a force jumps on the way.
    pub(crate) fn carried<const N: usize, const M: usize>(
        &mut self,
        (system, motion): (&dyn Mechanics<N, M>, ReducedSeries),
        tolerance: f64,
        (t, h): (f64, f64),
        start: &State<N>,
        mut tangents: DMatrix<f64>,
    ) -> Result<(State<N>, DMatrix<f64>), SensitivityError> {
        const JUMPS: SensitivityError = SensitivityError::Unsupported {
            reason: "a force that jumps where the motion turns it round has no derivative",
        };
        let mut polynomial = Polynomial::new(system, motion, tolerance);
        polynomial.within(h);
        let mut center = polynomial.begin(system, (t, h), start)?;
        let end = t + h;
        for tries in 1..=Taylor::<N>::MAX_STEPS {
            let (to, inside) = center.toward(end, h, tries)?;
            let next = self.along(&polynomial, &center, to, &tangents);
            if inside {
                return Ok((polynomial.at(system, &center, end)?, next));
            }
            let turns =
                |corner: usize| center.after.as_ref().is_some_and(|after| after[corner] * center.sides[corner] < 0.0);
            if (0..center.sides.len()).any(|corner| turns(corner) && self.of.recurrences.jumps(corner)) {
                return Err(JUMPS);
            }
            if polynomial.go_on(system, &mut center)? {
                tangents = next;
            }
        }
        Err(StepError::Tolerance { tries: Taylor::<N>::MAX_STEPS, step: center.full }.into())
    }

    /// The tangents at a time (s) of one polynomial.
    fn along<const N: usize>(
        &mut self,
        polynomial: &Polynomial,
        center: &Center<N>,
        to: f64,
        tangents: &DMatrix<f64>,
    ) -> DMatrix<f64> {
        let (unknowns, s) = (self.of.recurrences.unknowns(), (to - center.t) / center.unit);
        let mut next = tangents.clone();
        for from in (0..tangents.ncols()).step_by(AT_ONCE) {
            self.expand(
                (center.t, &center.unknowns(self.of.coordinates, unknowns), &center.sides),
                center.unit,
                polynomial.pace.order,
                tangents,
                from,
            );
            for j in 0..unknowns {
                let sum = (0..=self.series.order())
                    .rev()
                    .fold(Seeded::zero(), |sum, k| sum * s + self.series.coefficients(k)[j]);
                for (column, slope) in (from..tangents.ncols()).zip(sum.eps) {
                    next[(j, column)] = slope;
                }
            }
        }
        next
    }

    fn expand(
        &mut self,
        (t, x, sides): (f64, &[f64], &[f64]),
        unit: f64,
        order: usize,
        tangents: &DMatrix<f64>,
        from: usize,
    ) {
        let seeded = |re: f64, row: usize| Seeded {
            re,
            eps: std::array::from_fn(|k| {
                if row < tangents.nrows() && from + k < tangents.ncols() { tangents[(row, from + k)] } else { 0.0 }
            }),
        };
        let places: Vec<Seeded> = x.iter().enumerate().map(|(j, x)| seeded(*x, j)).collect();
        let sides: Vec<Seeded> = sides.iter().map(|side| Seeded::constant(*side)).collect();
        let other =
            |variable: usize| self.of.constant(variable).map_or(Seeded::zero(), |(k, re)| seeded(re, x.len() + k));
        self.series.expand_with(&self.of.recurrences, (Seeded::constant(t), &places, &sides), unit, order, other);
    }

    /// The derivative of the velocity in each tangent, at some unknowns: the coordinates' rates.
    pub(crate) fn velocities(&mut self, t: f64, x: &[f64], tangents: &DMatrix<f64>) -> DMatrix<f64> {
        let mut all = DMatrix::zeros(self.of.coordinates, tangents.ncols());
        for from in (0..tangents.ncols()).step_by(AT_ONCE) {
            self.expand((t, x, &[]), 1.0, 1, tangents, from);
            for (i, rate) in self.series.coefficients(1)[..self.of.coordinates].iter().enumerate() {
                for (column, slope) in (from..tangents.ncols()).zip(rate.eps) {
                    all[(i, column)] = slope;
                }
            }
        }
        all
    }

    /// Puts the quasi-velocities' variations into tangents that have those of the coordinates and of the constants, from the variations of
    /// the velocity.
    pub(crate) fn solve_velocities(
        &mut self,
        t: f64,
        x: &[f64],
        tangents: &mut DMatrix<f64>,
        velocities: &DMatrix<f64>,
    ) {
        let (n, unknowns) = (self.of.coordinates, self.of.recurrences.unknowns());
        let mut units = DMatrix::zeros(tangents.nrows(), unknowns - n);
        for k in 0..unknowns - n {
            units[(n + k, k)] = 1.0;
        }
        let basis = self.velocities(t, x, &units).svd(true, true);
        let rest = velocities - self.velocities(t, x, tangents);
        for column in 0..tangents.ncols() {
            let solved =
                basis.solve(&rest.column(column).into_owned(), 0.0).unwrap_or_else(|_| DVector::zeros(unknowns - n));
            tangents.view_mut((n, column), (unknowns - n, 1)).copy_from(&solved);
        }
    }
}

/// The derivative of a step in the coordinates `(q, xi)`.
///
/// # Errors
/// As [`TaylorFlow::carried`].
pub(crate) fn step_derivative<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    tolerance: f64,
    time: (f64, f64),
    [start, end]: [&State<N>; 2],
) -> Result<DMatrix<f64>, SensitivityError> {
    let series = system.series().map_err(|reason| SensitivityError::Unsupported { reason })?;
    let (n, unknowns) = (series.coordinates, series.recurrences.unknowns());
    let mut flow = TaylorFlow::new(series.clone());
    let (there, found) =
        flow.carried((system, series), tolerance, time, start, DMatrix::identity(unknowns, unknowns))?;
    same_end(start, &there, end)?;
    let mut all = DMatrix::identity(2 * N - M, 2 * N - M);
    let place = |j: usize| if j < n { j } else { N + j - n };
    for j in 0..unknowns {
        for k in 0..unknowns {
            all[(place(j), place(k))] = found[(j, k)];
        }
    }
    Ok(all)
}

/// Whether two ends of a step are one but for what two tolerances leave.
pub(crate) fn same_end<const N: usize>(
    start: &State<N>,
    one: &State<N>,
    other: &State<N>,
) -> Result<(), SensitivityError> {
    const AGREEMENT: f64 = 1e-6;
    let (before, one, other) = (start.unwrapped(), one.unwrapped(), other.unwrapped());
    let defect = (0..N).fold(0.0, |most: f64, i| larger(most, (one[i] - other[i]).abs() / (1.0 + before[i].abs())));
    if defect <= AGREEMENT { Ok(()) } else { Err(SensitivityError::OtherSolution { defect }) }
}
