//! Extrapolated differences of the step, along curves on the distribution.

use dla::{Differentiable, OneStep, Sensitivity, State, Tangent, Variation, onto_constraint};
use lagrangian::System;
use std::array::from_fn;

/// A number on which everything here depends: where a step begins and what it is made with.
#[derive(Debug, Clone, Copy)]
pub struct Input<const N: usize, const P: usize> {
    pub q: [f64; N],
    pub v: [f64; N],
    pub t: f64,
    pub h: f64,
    pub p: [f64; P],
}

impl<const N: usize, const P: usize> Input<N, P> {
    /// `self + epsilon direction`.
    pub fn moved(&self, epsilon: f64, direction: &Self) -> Self {
        Self {
            q: from_fn(|i| self.q[i] + epsilon * direction.q[i]),
            v: from_fn(|i| self.v[i] + epsilon * direction.v[i]),
            t: self.t + epsilon * direction.t,
            h: self.h + epsilon * direction.h,
            p: from_fn(|i| self.p[i] + epsilon * direction.p[i]),
        }
    }

    /// All unit directions, and one across all of them.
    pub fn directions() -> Vec<Self> {
        let none = Self { q: [0.0; N], v: [0.0; N], t: 0.0, h: 0.0, p: [0.0; P] };
        let mut all = Vec::new();
        for i in 0..N {
            all.push(Self { q: from_fn(|k| f64::from(u8::from(k == i))), ..none });
            all.push(Self { v: from_fn(|k| f64::from(u8::from(k == i))), ..none });
        }
        for i in 0..P {
            all.push(Self { p: from_fn(|k| f64::from(u8::from(k == i))), ..none });
        }
        all.push(Self { t: 1.0, ..none });
        all.push(Self { h: 1.0, ..none });
        let mixed = |i: usize, phase: f64| (2.3 * i as f64 + phase).sin();
        all.push(Self { q: from_fn(|i| mixed(i, 0.3)), v: from_fn(|i| mixed(i, 1.7)), ..none });
        all
    }
}

/// Which velocities a step is varied with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// Those on the constraint, to which every variation is projected.
    Admissible,
    /// Any.
    Any,
}

/// The state with the admissible velocity nearest to `v` in the kinetic energy.
pub fn admissible<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: [f64; N],
    v: [f64; N],
) -> State<N> {
    let mut state = State::new(q, v, system.angles());
    onto_constraint(system, t, &mut state).unwrap();
    state
}

/// The derivative at zero of a curve, by central differences extrapolated three times (Richardson 1911).
///
/// The steps are `w, w/2, w/4, w/8`: the rest is of order `(w^4/64)^2` times the ninth derivative over `9!`, below `1e-17` for
/// `w = 0.02`; rounding enters as a few ulp over `w/8`, some `1e-13`.
pub fn extrapolated<const K: usize>(curve: &dyn Fn(f64) -> [f64; K]) -> [f64; K] {
    let mut row: Vec<[f64; K]> = (0..4)
        .map(|level| {
            let w = 0.02 / f64::from(1 << level);
            let (ahead, behind) = (curve(w), curve(-w));
            from_fn(|i| (ahead[i] - behind[i]) / (2.0 * w))
        })
        .collect();
    for order in 1..=3 {
        let factor = f64::from(1u32 << (2 * order));
        row = row.windows(2).map(|pair| from_fn(|i| (factor * pair[1][i] - pair[0][i]) / (factor - 1.0))).collect();
    }
    row[0]
}

/// The bar: relative to the largest component of the variation.
pub const BAR: f64 = 1e-9;

/// The largest disagreement of derivative and differences over all directions, relative.
pub fn disagreement<Sys, Method, const N: usize, const M: usize, const P: usize>(
    sensitivity: &Sensitivity<'_, N, M, P>,
    system: impl Fn(&[f64; P]) -> Sys,
    method: &Method,
    (start, at): (Start, &Input<N, P>),
) -> f64
where
    Sys: System<N, M>,
    Method: OneStep<N, M> + Differentiable<N, M> + Clone,
{
    let start = |x: &Input<N, P>| {
        let system = system(&x.p);
        let state = match start {
            Start::Admissible => admissible(&system, x.t, x.q, x.v),
            Start::Any => State::new(x.q, x.v, system.angles()),
        };
        (system, state)
    };
    let (_, mut state) = start(at);
    let derivative = sensitivity.step(&mut method.clone(), at.t, at.h, &mut state).unwrap();
    // The method's step solves the equations as stated a second time, in other unknowns: some tens of roundings.
    assert!(derivative.defect < 1e-14, "defect {:e}", derivative.defect);

    let mut worst = 0.0f64;
    for direction in Input::directions() {
        let end = |epsilon: f64| {
            let x = at.moved(epsilon, &direction);
            let (system, mut state) = start(&x);
            method.clone().step(&system, x.t, x.h, &mut state).unwrap();
            (state.unwrapped(), *state.v())
        };
        // The velocity at the start moves along with the constraint.
        let v = extrapolated(&|epsilon| *start(&at.moved(epsilon, &direction)).1.v());
        let tangent = Tangent { state: Variation { q: direction.q, v }, parameters: direction.p };
        let ends = derivative
            .apply(&tangent)
            .state
            .plus(direction.t, &derivative.from_time)
            .plus(direction.h, &derivative.from_step);
        let (q, v) = (extrapolated(&|epsilon| end(epsilon).0), extrapolated(&|epsilon| end(epsilon).1));
        let size = q.iter().chain(&v).fold(0.0f64, |m, x| m.max(x.abs()));
        for i in 0..N {
            worst = worst.max((ends.q[i] - q[i]).abs() / size).max((ends.v[i] - v[i]).abs() / size);
        }
    }
    worst
}

/// Differences find what they should, and an error of `1e-8`.
#[test]
fn differences_are_extrapolated_to_rounding() {
    let [slope, quotient] = extrapolated(&|x| [(1.0 + x).exp(), (2.0 + x).recip()]);
    approx::assert_relative_eq!(slope, 1f64.exp(), max_relative = 1e-12);
    approx::assert_relative_eq!(quotient, -0.25, max_relative = 1e-12);
    approx::assert_relative_ne!(quotient, -0.25 * (1.0 + 1e-8), max_relative = BAR);
}
