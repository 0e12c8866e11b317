//! The generic step of every model against a step written by hand for it.
//!
//! The generic step has the Lagrangian and the constraint, and nothing else: `dla` in its general form. By hand are the
//! accelerations, worked out on paper ([`Model::accelerations_by_hand`]), in a classical Runge-Kutta step of plain numbers.

use dla::{Dla, OneStep, State};
use models::{
    ChaplyginBall, CompoundPendulum, ContactOscillator, GaugedOscillator, KnifeEdge, Model, Particle,
    QuarticOscillator, RollerRacer, RollingDisk, SleighOnArm, Snakeboard, Suslov, TurntableBall,
};
use std::array::from_fn;
use std::hint::black_box;

/// Steps of one measurement, few enough that no model leaves its coordinates.
pub(crate) const STEPS: u32 = 200;
const STEP: f64 = 0.005;

/// A model, and its two ways to make [`STEPS`] steps.
pub(crate) struct Row {
    pub(crate) name: &'static str,
    pub(crate) generic: Box<dyn Fn()>,
    pub(crate) by_hand: Box<dyn Fn()>,
}

pub(crate) fn all() -> Vec<Row> {
    let oscillator = ContactOscillator::new(0.3).expect("a positive coupling");
    let pendulum = CompoundPendulum::new(1.0, 0.5, 1.0, 9.81).expect("positive");
    vec![
        row(RollingDisk::new(1.0, 0.5, 0.125, 0.0625).expect("positive")),
        row(Particle::flat(1.0).expect("positive")),
        row(Particle::in_well(1.0, 0.5).expect("positive")),
        row(KnifeEdge::new(1.0, 1.0, 0.5).expect("positive")),
        row(Suslov::new([1.0, 2.0, 1.5], 0.3, 0.5).expect("positive definite")),
        row(ChaplyginBall::new(1.0, 0.5, [0.2, 0.3, 0.4]).expect("positive")),
        row(oscillator),
        row(GaugedOscillator::new(oscillator, 1.0).expect("finite")),
        row(QuarticOscillator::new(0.5).expect("positive")),
        row(Snakeboard::new(1.0, 0.5, 0.2, 0.1, 0.05).expect("positive")),
        row(RollerRacer::new(1.0, 0.5, 0.2, 0.6, 0.4).expect("positive")),
        row(pendulum),
        row(SleighOnArm::new(1.0, 0.5, 0.3, 0.4, 1.0, 0.2).expect("positive")),
        row(TurntableBall::new(1.0, 0.5, 0.1, 0.3).expect("positive")),
    ]
}

fn row<Mo: Model<N, M> + Copy + 'static, const N: usize, const M: usize>(model: Mo) -> Row {
    Row {
        name: model.name(),
        generic: Box::new(move || {
            let (model, (q, v)) = (black_box(model), model.start());
            let (mut method, mut state) = (Dla::midpoint(), State::new(q, v, model.angles()));
            for k in 0..STEPS {
                method.step(&model, f64::from(k) * STEP, STEP, &mut state).expect("the steps succeed");
            }
            black_box(state);
        }),
        by_hand: Box::new(move || {
            let (model, mut y) = (black_box(model), model.start());
            for k in 0..STEPS {
                y = runge_kutta(&model, f64::from(k) * STEP, &y);
            }
            black_box(y);
        }),
    }
}

type Place<const N: usize> = ([f64; N], [f64; N]);

#[inline(always)]
fn runge_kutta<Mo: Model<N, M>, const N: usize, const M: usize>(model: &Mo, t: f64, y: &Place<N>) -> Place<N> {
    let slope = |t: f64, (q, v): &Place<N>| (*v, model.accelerations_by_hand(t, q, v));
    let ahead = |h: f64, k: &Place<N>| (from_fn(|i| y.0[i] + h * k.0[i]), from_fn(|i| y.1[i] + h * k.1[i]));
    let k1 = slope(t, y);
    let k2 = slope(t + 0.5 * STEP, &ahead(0.5 * STEP, &k1));
    let k3 = slope(t + 0.5 * STEP, &ahead(0.5 * STEP, &k2));
    let k4 = slope(t + STEP, &ahead(STEP, &k3));
    let sum = |a: f64, b: f64, c: f64, d: f64| STEP / 6.0 * (a + 2.0 * (b + c) + d);
    (
        from_fn(|i| y.0[i] + sum(k1.0[i], k2.0[i], k3.0[i], k4.0[i])),
        from_fn(|i| y.1[i] + sum(k1.1[i], k2.1[i], k3.1[i], k4.1[i])),
    )
}
