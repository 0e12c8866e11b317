use super::reduced::{Moment, ReducedSleigh};

/// A point of the motion as the path needs it.
#[derive(Debug, Clone, Copy)]
pub(super) struct ExactPoint {
    /// `s - s0`.
    pub(super) tau: f64,
    pub(super) psi: f64,
    pub(super) tanh: f64,
    pub(super) sech: f64,
    /// `e^-|s|`.
    pub(super) g: f64,
}

impl ExactPoint {
    /// `mirror` is the sign of `a omega0`.
    pub(super) fn new(reduced: &ReducedSleigh, moment: &Moment, mirror: f64) -> Self {
        let spin = reduced.gyration * moment.turn_rate.abs();
        Self {
            tau: moment.tau,
            psi: mirror * moment.turn,
            tanh: moment.speed / reduced.speed,
            sech: spin / reduced.speed,
            g: spin / (reduced.speed + moment.speed.abs()),
        }
    }
}
