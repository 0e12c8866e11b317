use crate::reduced::{Moment, Reduced};

/// A point of the motion as the path needs it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Point {
    /// `s - s0`.
    pub(crate) tau: f64,
    pub(crate) psi: f64,
    pub(crate) tanh: f64,
    pub(crate) sech: f64,
    /// `e^-|s|`.
    pub(crate) g: f64,
}

impl Point {
    /// `mirror` is the sign of `a omega0`.
    pub(crate) fn new(reduced: &Reduced, moment: &Moment, mirror: f64) -> Self {
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
