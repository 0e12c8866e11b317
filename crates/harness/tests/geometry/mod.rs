//! The geometry of the sleigh and of other systems: brackets, phases, steady motions, parking.

mod attitude;
mod brackets;
mod equilibria;
mod exchange;
mod gaits;
mod parking;
mod phase;

use dla::{Dla, Gauss, Observer, OneStep, Piece, Schedule, State, drive_part, piece_by_piece};
use lagrangian::{Piecewise, System};

/// Runs a method on a system that may jump.
fn run<Sys, Method, Obs, const N: usize, const M: usize>(
    system: &Sys,
    method: impl Fn() -> Method,
    (step, steps): (f64, u64),
    state: &mut State<N>,
    mut observer: Obs,
) where
    Sys: System<N, M> + Piecewise,
    Method: OneStep<N, M>,
    Obs: Observer<N, M>,
{
    let schedule = Schedule { t0: 0.0, step, steps };
    piece_by_piece(system, &schedule, state, |piece, Piece { steps, schedule }, state| {
        drive_part(piece, &mut method(), &schedule, steps, state, &mut observer)
    })
    .unwrap();
}

fn dla() -> Dla {
    Dla::midpoint()
}

fn gauss() -> Gauss {
    Gauss::new::<4>()
}
