//! Dormand and Prince's method of order 8(5,3) from two libraries.

use crate::Outcome;
use differential_equations::methods::ExplicitRungeKutta;
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use ode_solvers::{Dop853, OutputType, SVector, System};

struct Slope<F>(F);

impl<F: Fn(&[f64; D]) -> [f64; D], const D: usize> System<f64, SVector<f64, D>> for Slope<F> {
    #[inline(always)]
    fn system(&self, _: f64, y: &SVector<f64, D>, dy: &mut SVector<f64, D>) {
        *dy = SVector::from((self.0)(&y.data.0[0]));
    }
}

/// Crate `ode_solvers`. Its dense output with the whole interval as step is wrong, so that every step is recorded.
pub fn ode_solvers<const D: usize>(
    slope: impl Fn(&[f64; D]) -> [f64; D],
    y: [f64; D],
    duration: f64,
    tolerance: f64,
) -> Result<Outcome<D>, String> {
    let (safety, beta, least, most, steps) = (0.9, 0.0, 0.333, 6.0, 10_000_000);
    let mut solver = Dop853::from_param(
        Slope(slope),
        0.0,
        duration,
        duration,
        SVector::from(y),
        tolerance,
        tolerance,
        safety,
        beta,
        least,
        most,
        duration,
        0.0,
        steps,
        u32::MAX,
        OutputType::Sparse,
    );
    let stats = solver.integrate().map_err(|e| e.to_string())?;
    let end = solver.y_out().last().ok_or("no output")?;
    Ok(Outcome { end: end.data.0[0], steps: (stats.accepted_steps + stats.rejected_steps).into() })
}

impl<F: Fn(&[f64; D]) -> [f64; D], const D: usize> ODE<f64, [f64; D]> for Slope<F> {
    #[inline(always)]
    fn diff(&self, _: f64, y: &[f64; D], dy: &mut [f64; D]) {
        *dy = (self.0)(y);
    }
}

/// Crate `differential-equations`, its method stepped without the recorder of `IVP`.
pub fn differential_equations<const D: usize>(
    slope: impl Fn(&[f64; D]) -> [f64; D],
    y: [f64; D],
    duration: f64,
    tolerance: f64,
) -> Result<Outcome<D>, String> {
    let slope = Slope(slope);
    let mut solver = ExplicitRungeKutta::dop853().rtol(tolerance).atol(tolerance).max_steps(usize::MAX);
    solver.init(&slope, 0.0, duration, &y).map_err(|e| format!("{e:?}"))?;
    for steps in 1..10_000_000 {
        let rest = duration - solver.t();
        let last = 1.01 * solver.h() >= rest;
        if last {
            solver.set_h(rest);
        }
        let begin = solver.t();
        solver.step(&slope).map_err(|e| format!("{e:?}"))?;
        if last && solver.t() > begin {
            return Ok(Outcome { end: *solver.y(), steps });
        }
        if solver.h() <= f64::EPSILON * duration {
            return Err(format!("step {} at t = {}", solver.h(), solver.t()));
        }
    }
    Err("too many steps".into())
}
