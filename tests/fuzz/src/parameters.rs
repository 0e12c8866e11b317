//! Any sleigh, start, step and effects, over many decades, by every method: a run ends, or an error says why not; what it
//! leaves is finite, and on the constraint.

#![no_main]

use arbitrary::Arbitrary;
use dla::{AnyState, Mechanism, Observer, Report, Schedule, Subject, View, make_steps};
use harness::{METHODS, Method, MethodKind};
use lagrangian::With;
use libfuzzer_sys::fuzz_target;
use scene::AnyEffect;
use sleigh::effects::{Bowl, Drag, EggCrate, Hill, Hills, MovingMass, Slope, Thrust, Torque};
use sleigh::{Guided, Sleigh, SleighError, SleighState, TimeFunction};
use std::f64::consts::PI;
use std::ops::ControlFlow;

/// A number: any bits, or a tame one of some size.
#[derive(Arbitrary, Debug, Clone, Copy)]
enum Number {
    Bits(f64),
    Small(i8),
    Decade { exponent: i8, mantissa: i16 },
}

impl Number {
    fn value(self) -> f64 {
        match self {
            Self::Bits(value) => value,
            Self::Small(value) => f64::from(value) / 16.0,
            Self::Decade { exponent, mantissa } => f64::from(mantissa) * 10.0_f64.powi(i32::from(exponent) / 4),
        }
    }
}

#[derive(Arbitrary, Debug, Clone, Copy)]
enum Function {
    Constant(Number),
    Sine(Number, Number, Number),
}

impl Function {
    fn build(self) -> TimeFunction {
        match self {
            Self::Constant(value) => TimeFunction::Constant(value.value()),
            Self::Sine(amplitude, frequency, phase) => {
                TimeFunction::Sine { amplitude: amplitude.value(), frequency: frequency.value(), phase: phase.value() }
            }
        }
    }
}

#[derive(Arbitrary, Debug)]
enum Effect {
    Slope([Number; 2]),
    Bowl([Number; 2], [Number; 2]),
    EggCrate(Number, [Number; 2]),
    Hill([Number; 4]),
    Drag(Number, Number),
    Thrust(Function),
    Torque(Function),
    MovingMass(Number, Function, Function),
}

/// Where effects and masses of a case go.
type Acting = (Vec<AnyEffect>, Vec<MovingMass>);

impl Effect {
    fn add_to(&self, (effects, masses): &mut Acting) -> Result<(), SleighError> {
        let pair = |numbers: &[Number; 2]| numbers.map(Number::value);
        effects.push(match self {
            Self::Slope(gravity) => AnyEffect::Slope(Slope::new(pair(gravity))?),
            Self::Bowl(stiffness, center) => AnyEffect::Bowl(Bowl::new(pair(stiffness), pair(center))?),
            Self::EggCrate(height, waves) => AnyEffect::EggCrate(EggCrate::new(height.value(), pair(waves))?),
            Self::Hill(hill) => {
                let [height, x, y, width] = hill.map(Number::value);
                AnyEffect::Hills(Hills::new(vec![Hill { height, x, y, width }])?)
            }
            Self::Drag(along, turning) => AnyEffect::Drag(Drag::new(along.value().abs(), turning.value().abs())?),
            Self::Thrust(force) => AnyEffect::Thrust(Thrust::new(force.build())?),
            Self::Torque(torque) => AnyEffect::Torque(Torque::new(torque.build())?),
            Self::MovingMass(mass, x, y) => {
                masses.push(MovingMass::new(mass.value().abs(), x.build(), y.build())?);
                return Ok(());
            }
        });
        Ok(())
    }
}

#[derive(Arbitrary, Debug)]
struct Case {
    method: u8,
    alpha: u8,
    body: [Number; 3],
    start: [Number; 5],
    step: Number,
    steps: u8,
    effects: Vec<Effect>,
}

/// Every node is finite and on the constraint.
struct OnConstraint {
    keeps: bool,
    before: AnyState,
}

impl Observer for OnConstraint {
    fn start(&mut self, node: &View<'_>) {
        self.before.clone_from(node.state);
    }

    /// A node has `v = u (cos th, sin th)` but for the rounding of the sine, the cosine, the two products and the
    /// residual: four units of each component at most. Equations in coordinates leave the rounding of the largest component in
    /// all of them. The angle of `v` is that before the turns are taken off, and has the
    /// rounding of a number of its size: at most half a turn more than the step turns. Where the turns are too many to be
    /// counted there is no telling.
    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        let (q, v) = (node.state.q(), node.state.v());
        assert!(q.iter().chain(v).all(|x| x.is_finite()), "node {}: {q:?}, {v:?}", node.k);
        let turned = node.state.moved_since(&self.before)[2].abs();
        let counted = node.state.turns()[2].abs().max(self.before.turns()[2].abs()) < 1.0 / f64::EPSILON;
        self.before.clone_from(node.state);
        let size: f64 = v.iter().map(|x| x.abs()).sum();
        let bound = f64::EPSILON * (4.0 + PI + turned) * size + 4.0 * f64::MIN_POSITIVE;
        let residual = node.constraint();
        assert!(
            !self.keeps || !counted || residual <= bound,
            "node {}: {residual:e} > {bound:e} at {q:?}, {v:?}",
            node.k
        );
        ControlFlow::Continue(())
    }
}

fn run(case: &Case) -> Result<(), Box<dyn std::error::Error>> {
    let [mass, inertia, offset] = case.body.map(Number::value);
    let mut acting = Acting::default();
    case.effects.iter().take(4).try_for_each(|effect| effect.add_to(&mut acting))?;
    let (effects, masses) = acting;
    let body = Guided::from(Sleigh::new(mass.abs(), inertia.abs(), offset)?).carrying(masses);
    let system = With { body, effects };
    let [x, y, heading, speed, turn_rate] = case.start.map(Number::value);
    let step = case.step.value();
    if ![x, y, heading, speed, turn_rate, step].iter().all(|x| x.is_finite()) || step == 0.0 {
        return Ok(());
    }
    let info = METHODS[usize::from(case.method) % METHODS.len()];
    let method = Method::named(info.name, Some(f64::from(case.alpha) / 255.0))?;
    let (q, v) = SleighState { x, y, heading, speed, turn_rate }.to_coordinates();
    let system = Subject::<3, 1>::from(&system);
    let mut state = system.state(&q, &v);
    // An adaptive one may make a hundred thousand steps within each.
    let most = if info.kind.is_adaptive() { 2 } else { 40 };
    let schedule = Schedule { t0: 0.0, step, steps: u64::from(case.steps % most) };
    // A projection leaves the rounding of the velocity before it: any number of times that of the velocity after it.
    let keeps = info.keeps.contains("constraint") && info.kind != MethodKind::Rk4Projected;
    let mut watch = OnConstraint { keeps, before: state.clone() };
    let mut integrator = system.integrator(&method);
    if let Err(failure) = make_steps(&system, &mut *integrator, &schedule, 0..schedule.steps, &mut state, &mut watch) {
        assert!(!failure.to_string().is_empty());
    }
    assert!(state.q().iter().chain(state.v()).all(|x| x.is_finite()));
    Ok(())
}

fuzz_target!(|case: Case| {
    // Numbers that make no sleigh or no effect are refused where they are given.
    let _ = run(&case);
});
