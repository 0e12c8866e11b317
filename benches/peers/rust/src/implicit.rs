//! The implicit methods of `diffsol`, with the exact Jacobian.

use crate::Outcome;
use crate::number::Dual;
use crate::problem::{Loads, Sleigh};
use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};

/// Names of [`integrate`]'s methods.
pub const METHODS: [&str; 3] = ["bdf", "tr-bdf2", "esdirk34"];

/// The run by one of [`METHODS`], set up and crossed; a run includes `diffsol`'s own set-up, which a caller cannot reuse.
pub fn integrate<L: Loads>(
    method: &str,
    sleigh: &Sleigh<L>,
    start: [f64; 5],
    duration: f64,
    tolerance: f64,
) -> Result<Outcome<5>, String> {
    let point = |y: &[f64]| -> [f64; 5] { std::array::from_fn(|i| y[i]) };
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(tolerance)
        .atol([tolerance])
        .rhs_implicit(
            |y: &[f64], _: &[f64], _, dy: &mut [f64]| dy.copy_from_slice(&sleigh.reduced(&point(y))),
            |y: &[f64], _: &[f64], _, v: &[f64], jv: &mut [f64]| {
                let along: [Dual; 5] = std::array::from_fn(|i| Dual { value: y[i], slope: v[i] });
                for (out, d) in jv.iter_mut().zip(sleigh.reduced(&along)) {
                    *out = d.slope;
                }
            },
        )
        .init(|_: &[f64], _, y: &mut [f64]| y.copy_from_slice(&start), 5)
        .build()
        .map_err(|e| e.to_string())?;
    macro_rules! cross {
        ($solver:expr) => {{
            let mut solver = $solver.map_err(|e| e.to_string())?;
            solver.set_stop_time(duration).map_err(|e| e.to_string())?;
            let mut steps = 1;
            while solver.step().map_err(|e| e.to_string())? != OdeSolverStopReason::TstopReached {
                steps += 1;
            }
            let state = solver.state();
            Ok(Outcome { end: std::array::from_fn(|i| state.y[i]), steps })
        }};
    }
    type Lu = NalgebraLU<f64>;
    match method {
        "bdf" => cross!(problem.bdf::<Lu>()),
        "tr-bdf2" => cross!(problem.tr_bdf2::<Lu>()),
        "esdirk34" => cross!(problem.esdirk34::<Lu>()),
        _ => Err(format!("no method `{method}`")),
    }
}
