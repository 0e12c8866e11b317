use crate::timing::median_seconds;
use dla::{Dla, Form, RunError, Schedule, State, drive_part, piece_by_piece};
use lagrangian::{AdmissibleBasis, Constraint, Piecewise, Scalar, System};
use std::cell::Cell;
use std::hint::black_box;

/// The time of a step of `dla`, solved in general form (ns), as the mean over a run and the median of repeated runs: no closed form of
/// the step is used.
///
/// # Errors
/// [`RunError`] where the run fails.
pub fn step_time<Sys, const N: usize, const M: usize>(
    system: &Sys,
    schedule: &Schedule,
    q: [f64; N],
    v: [f64; N],
) -> Result<f64, RunError>
where
    Sys: System<N, M> + Piecewise,
{
    let start = State::new(q, v, system.angles());
    let steps = made(system, schedule, start)?;
    let seconds = median_seconds(|| {
        // The same run has just succeeded.
        black_box(made(system, schedule, black_box(start)).is_ok());
    });
    Ok(1e9 * seconds / steps.max(1) as f64)
}

/// How often such a step evaluates the Lagrangian, the forces or the constraint, with derivatives or without.
///
/// # Errors
/// [`RunError`] where the run fails.
pub fn step_evaluations<Sys, const N: usize, const M: usize>(
    system: &Sys,
    schedule: &Schedule,
    q: [f64; N],
    v: [f64; N],
) -> Result<f64, RunError>
where
    Sys: System<N, M> + Piecewise,
{
    let evaluations = Cell::new(0);
    let counted = Counted { system: system.piece(schedule.t0), whole: system, evaluations: &evaluations };
    let steps = made(&counted, schedule, State::new(q, v, system.angles()))?;
    Ok(evaluations.get() as f64 / steps.max(1) as f64)
}

fn made<Sys, const N: usize, const M: usize>(
    system: &Sys,
    schedule: &Schedule,
    mut state: State<N>,
) -> Result<u64, RunError>
where
    Sys: System<N, M> + Piecewise,
{
    let mut method = Dla::midpoint().solved(Form::General);
    piece_by_piece(system, schedule, &mut state, |piece, steps, state| {
        drive_part(piece, &mut method, schedule, steps, state, ())
    })
}

/// A system that counts how often it is evaluated.
struct Counted<'a, Sys> {
    system: Sys,
    whole: &'a Sys,
    evaluations: &'a Cell<u64>,
}

impl<Sys> Counted<'_, Sys> {
    fn count(&self) {
        self.evaluations.set(self.evaluations.get() + 1);
    }
}

impl<Sys: System<N, M>, const N: usize, const M: usize> System<N, M> for Counted<'_, Sys> {
    const MOVING: bool = Sys::MOVING;

    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> S {
        self.count();
        self.system.lagrangian(t, q, v)
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; N]) -> Constraint<S, N, M> {
        self.count();
        self.system.constraint(t, q)
    }
    fn force<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        let force = self.system.force(t, q, v);
        if force.is_some() {
            self.count();
        }
        force
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<AdmissibleBasis<S, N, M>> {
        self.system.admissible_basis(t, q)
    }
    fn holonomic<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<[Option<S>; M]> {
        self.system.holonomic(t, q)
    }
    fn nonlinear<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[Option<S>; M]> {
        self.system.nonlinear(t, q, v)
    }
    fn angles(&self) -> [bool; N] {
        self.system.angles()
    }
}

impl<Sys: Piecewise> Piecewise for Counted<'_, Sys> {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        self.whole.jumps(from, to)
    }
    fn piece(&self, t: f64) -> Self {
        Self { system: self.whole.piece(t), ..*self }
    }
}
