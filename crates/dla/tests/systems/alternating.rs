//! Compositions of the one-sided rule and its adjoint, measured against those of the midpoint rule at equal work.
//!
//! They were made for methods of order 1 (Blanes and Moan 2002, J. Comput. Appl. Math. 142, 313-330). Where they do not
//! pay is recorded here, with the numbers of docs/methods/compositions.md.

use crate::support::ByHand;
use dla::{Composition, Dla, Gauss, Mechanics, OneStep, Schedule, State, StepError, StepReport, drive};
use lagrangian::{Effect, Scalar, System, With};
use sleigh::{CentreOfMass, Sleigh, SleighState};
use test_systems::ContactOscillator;

/// The rules `alpha = 1` and `alpha = 0` in turn, over the given parts of a step: each is the adjoint of the other.
#[derive(Clone)]
struct Alternating {
    rules: [Dla; 2],
    parts: Vec<f64>,
}

impl Alternating {
    /// From the weights `a` and `b` of a symmetric splitting into two flows, of each the first half and the centre.
    fn of_splitting(a: &[f64], b: &[f64]) -> Self {
        let (mut parts, mut left) = (Vec::new(), 0.0);
        for (a, b) in a.iter().zip(b) {
            parts.push(a - left);
            left = b - (a - left);
            parts.push(left);
        }
        let mirrored: Vec<f64> = parts.iter().rev().copied().collect();
        parts.extend(mirrored);
        assert!((parts.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        Self { rules: [1.0, 0.0].map(|alpha| Dla::alpha(alpha).unwrap()), parts }
    }

    /// `S6`: twelve parts, order 4.
    fn s6() -> Self {
        let (b1, b2) = (0.209515106613362, -0.143851773179818);
        Self::of_splitting(&[0.0792036964311957, 0.353172906049774, -0.0420650803577195], &[b1, b2, 0.5 - b1 - b2])
    }

    /// `S10`: twenty parts, order 6.
    fn s10() -> Self {
        let a = [0.0502627644003922, 0.413514300428344, 0.0450798897943977, -0.188054853819569, 0.541960678450780];
        let b = [0.148816447901042, -0.132385865767784, 0.067307604692185, 0.432666402578175];
        Self::of_splitting(&a, &[b[0], b[1], b[2], b[3], 0.5 - b.iter().sum::<f64>()])
    }
}

impl<const N: usize, const M: usize> OneStep<N, M> for Alternating {
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        let (mut done, mut report) = (0.0, StepReport::of(0));
        for (k, part) in self.parts.iter().enumerate() {
            report = self.rules[k % 2].step(system, t + done * h, part * h, state)?;
            done += part;
        }
        Ok(report)
    }
}

/// The potential `(X^2 + Y^2) / 20` (J) at the centre of mass.
#[derive(Clone)]
pub(crate) struct Bowl;

impl Effect<CentreOfMass, 3> for Bowl {
    fn lagrangian<S: Scalar>(&self, _: &CentreOfMass, _t: S, q: &[S; 3], _v: &[S; 3]) -> Option<S> {
        Some(-(q[0] * q[0] + q[1] * q[1]) * 0.05)
    }
}

/// A run, and its last state.
struct Case<'a, Sys> {
    name: &'static str,
    system: &'a Sys,
    start: State<3>,
    duration: f64,
    end: State<3>,
}

impl<'a, Sys: System<3, 1>> Case<'a, Sys> {
    fn new(name: &'static str, system: &'a Sys, (q, v): ([f64; 3], [f64; 3]), duration: f64) -> Self {
        let start = State::new(q, v, system.angles());
        let mut end = start;
        let schedule = Schedule { t0: 0.0, step: duration / 400.0, steps: 400 };
        drive(system, &mut Gauss::new::<8>(), &schedule, &mut end, ()).unwrap();
        Self { name, system, start, duration, end }
    }

    /// The largest error of a coordinate or velocity at the end, if the run may solve `solves` times.
    fn error(&self, mut method: impl OneStep<3, 1>, stages: u64, solves: u64) -> f64 {
        let steps = solves / stages;
        let mut state = self.start;
        let schedule = Schedule { t0: 0.0, step: self.duration / steps as f64, steps };
        drive(self.system, &mut method, &schedule, &mut state, ()).unwrap();
        let (q, exact) = (state.unwrapped(), self.end.unwrapped());
        let error = |i: usize| (q[i] - exact[i]).abs().max((state.v()[i] - self.end.v()[i]).abs());
        error(0).max(error(1)).max(error(2))
    }

    /// The order of a method from two runs, and its error in the cheaper one.
    fn measured(&self, label: &str, method: &(impl OneStep<3, 1> + Clone), stages: u64, order: f64) -> f64 {
        let [coarse, fine] = [1440, 2880].map(|solves| self.error(method.clone(), stages, solves));
        let slope = (coarse / fine).log2();
        println!("{:<20} {label:<8} {coarse:.1e} {fine:.1e}, order {slope:.2}", self.name);
        assert!((slope - order).abs() < 0.2, "{}, {label}: order {slope}", self.name);
        coarse
    }

    /// How many times larger the error of the alternating composition of order 4 is than that of the midpoint rule, at equal
    /// numbers of solves.
    fn ratio_of_order_four(&self) -> f64 {
        // The closed form of the midpoint rule on the free sleigh costs far less than a solve: not compared here.
        let suzuki = self.measured("Suzuki", &Composition::suzuki4(Dla::midpoint()), 5, 4.0);
        self.measured("S6", &Alternating::s6(), 12, 4.0) / suzuki
    }

    /// Those of orders 4 and 6.
    fn ratios(&self) -> [f64; 2] {
        let midpoint = Dla::midpoint();
        let kahan_li = self.measured("Kahan-Li", &Composition::kahan_li6(midpoint), 9, 6.0);
        let s10 = self.measured("S10", &Alternating::s10(), 20, 6.0);
        [self.ratio_of_order_four(), s10 / kahan_li]
    }
}

const START: SleighState = SleighState { x: 0.3, y: -0.2, heading: 0.5, turn_rate: 0.6, speed: -1.0 };

#[test]
fn alternating_compositions_at_equal_work() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let free = Case::new("free sleigh", &ByHand::from(sleigh), START.to_coordinates(), 10.0).ratio_of_order_four();
    assert!(free > 10.0, "{free}");
}

#[test]
#[ignore = "slow"]
fn alternating_compositions_at_equal_work_in_full() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let start = START.to_coordinates();
    let free = Case::new("free sleigh", &ByHand::from(sleigh), start, 10.0).ratios();
    assert!(free[0] > 10.0 && free[1] > 10.0, "{free:?}");

    let bowl = With { body: CentreOfMass(sleigh), effects: Bowl };
    let start = bowl.body.from_blade(&start.0, &start.1);
    let in_bowl = Case::new("sleigh in a bowl", &ByHand::from(bowl), start, 20.0).ratios();
    assert!(in_bowl[0] > 3.0 && in_bowl[1] > 3.0, "{in_bowl:?}");

    // Here alone the one of order 4 is better, by less than the factor that half as much work again is worth.
    let oscillator = ContactOscillator { eps: 0.3, s: 0.0 };
    let contact = Case::new("contact oscillator", &oscillator, oscillator.start_at(0.7), 20.0).ratios();
    assert!((1.5f64.powi(-4)..1.0).contains(&contact[0]) && contact[1] > 1.5, "{contact:?}");
}

/// What composes to a symmetric map keeps the constraint, and a step back undoes it.
#[test]
fn alternating_compositions_are_symmetric() {
    let sleigh = ByHand::from(Sleigh::new(1.0, 1.0, 0.5).unwrap());
    let (q, v) = SleighState { turn_rate: 0.6, speed: -1.0, ..SleighState::default() }.to_coordinates();
    for mut method in [Alternating::s6(), Alternating::s10()] {
        let start = State::new(q, v, [false; 3]);
        let mut state = start;
        for h in [0.1, -0.1] {
            drive(&sleigh, &mut method, &Schedule { t0: 0.0, step: h, steps: 50 }, &mut state, ()).unwrap();
            assert!(lagrangian::constraint_residual(&sleigh, 0.0, state.q(), state.v())[0].abs() < 1e-15);
        }
        for i in 0..3 {
            // A thousand solves there and back, and the growth of errors by exp(c u t) = e^2.
            assert!((state.q()[i] - start.q()[i]).abs() < 2000.0 * 8.0 * f64::EPSILON);
        }
    }
}
