//! Where runs and analyses are compiled for the systems of scenes.
//!
//! What is generic in the shape of a system, and never inlined, is compiled in the first crate that names it with a shape, and the crates above
//! call that. The program, its tests and the Python package would each compile all methods for ten shapes otherwise.

use crate::analysis::{DiscreteMap, differentiable, lyapunov_within, relative_equilibria_within, section};
use crate::precision::{Reference, ReferenceMotion};
use crate::run::observed_and_timed;
use crate::{
    Again, Method, integrate_from, recommend, run_observed, run_saved_watched, step_evaluations, step_time, timed,
};
use dla::OneStep;
use std::hint::black_box;

/// What is compiled here, for the shapes of the systems of scenes. It names functions, and nobody needs to call it.
#[inline(never)]
pub fn shapes() {
    motions::<3, 1>();
    motions::<3, 2>();
    motions::<3, 3>();
    motions::<4, 1>();
    motions::<4, 2>();
    motions::<4, 3>();
    motions::<6, 3>();
    motions::<8, 4>();
    motions::<12, 6>();
    motions::<18, 6>();
    // No velocity is imposed on these.
    free_motions::<3, 1>();
    free_motions::<4, 1>();
    free_motions::<4, 2>();
    free_motions::<6, 3>();
    free_motions::<8, 4>();
    free_motions::<12, 6>();
    free_motions::<18, 6>();
}

fn motions<const N: usize, const M: usize>() {
    black_box(Method::stepper::<N, M> as fn(_) -> _);
    black_box(<Again<'_, N, M> as OneStep<N, M>>::step as fn(_, _, _, _, _) -> _);
    black_box(integrate_from::<N, M> as fn(_, _, _, _, _, _) -> _);
    black_box(observed_and_timed::<N, M> as fn(_, _, _, _) -> _);
    black_box(timed::<N, M> as fn(_, _, _, _, _) -> _);
    black_box(run_observed::<N, M> as fn(_, _, _, _, _, _) -> _);
    black_box(run_saved_watched::<N, M> as fn(_, _, _, _, _, _, _) -> _);
    black_box(recommend::<N, M> as fn(_, _, _, _, _) -> _);
    black_box(ReferenceMotion::<N, M>::end as fn(_, _, _) -> _);
    black_box(Reference::<N>::converged::<M> as fn(_, _) -> _);
    black_box(step_time::<N, M> as fn(_, _, _, _) -> _);
    black_box(step_evaluations::<N, M> as fn(_, _, _, _) -> _);
    black_box(relative_equilibria_within::<N, M> as fn(_, _, _, _) -> _);
    black_box(differentiable::<N, M> as fn(_) -> _);
    black_box(DiscreteMap::<N, M>::spectrum as fn(_, _, _) -> _);
    black_box(DiscreteMap::<N, M>::limit as fn(_, _, _) -> _);
}

fn free_motions<const N: usize, const M: usize>() {
    black_box(section::<N, M> as fn(_, _, _, _, _) -> _);
    black_box(lyapunov_within::<N, M> as fn(_, _, _, _, _) -> _);
}
