//! How a step is divided, and that its parts are steps of the method: with its order, and the same bits where none is divided.

use crate::parts::{free, made, sleigh};
use dla::{
    Composition, Dla, Gauss, Mechanics, OneStep, Schedule, State, StepError, StepReport, Substepping, Substeps,
    Undivided, drive,
};
use sleigh::{Exact, SleighState};
use std::ops::ControlFlow;

fn start() -> SleighState {
    SleighState { speed: -1.0, turn_rate: 0.6, ..SleighState::default() }
}

/// A method that refuses steps above a length, on every third interval of a tenth above a shorter one.
#[derive(Clone)]
struct Refusing<Method> {
    method: Method,
    longest: f64,
}

impl<Method: OneStep<3, 1>> OneStep<3, 1> for Refusing<Method> {
    fn step(
        &mut self,
        system: &dyn Mechanics<3, 1>,
        t: f64,
        h: f64,
        state: &mut State<3>,
    ) -> Result<StepReport<1>, StepError> {
        let third = ((t + 0.5 * h) / 0.1).floor() % 3.0 == 0.0;
        if h > if third { 0.5 } else { 1.0 } * self.longest {
            return Err(StepError::Branch);
        }
        self.method.step(system, t, h, state)
    }
}

/// Steps of which the most are divided in two and some in four: half the step, and the error is `2^-p` of what it was.
#[test]
fn divided_steps_keep_the_order() {
    fn error<Method: OneStep<3, 1> + Clone>(method: Method, steps: u64) -> f64 {
        let step = 4.0 / steps as f64;
        let (q, v) = start().to_coordinates();
        let mut state = State::new(q, v, [false, false, true]);
        let mut method = Substepping::new(Refusing { method, longest: 0.6 * step }, 8);
        let schedule = Schedule { t0: 0.0, step, steps };
        drive(&free(0.5), &mut method, &schedule, &mut state, ()).unwrap();
        assert_eq!(method.divided(), steps);
        assert!(method.parts() > 2 * steps && method.most() > 2, "{}", method.parts());
        let right = Exact::new(&sleigh(0.5), &start()).unwrap().at(4.0);
        let end = SleighState::from_coordinates(&state.unwrapped(), state.v());
        [end.x - right.x, end.y - right.y, end.heading - right.heading, end.speed - right.speed]
            .iter()
            .fold(0.0, |most, error| f64::max(most, error.abs()))
    }
    fn order<Method: OneStep<3, 1> + Clone>(method: &Method, steps: u64) -> f64 {
        (error(method.clone(), steps) / error(method.clone(), 2 * steps)).log2()
    }
    for (found, order) in [
        (order(&Dla::midpoint(), 160), 2.0),
        (order(&Composition::suzuki4(Dla::midpoint()), 80), 4.0),
        (order(&Gauss::new::<3>(), 20), 6.0),
    ] {
        // Which steps have four parts differs from one length to the next.
        assert!((found - order).abs() < 0.35, "{found} for {order}");
    }
}

/// Where every step resolves the motion, looking at its halves changes no bit.
#[test]
fn what_is_resolved_is_left_alone() {
    let run = made(&free(0.5), Gauss::new::<3>(), &start(), (0.05, 200));
    let (q, v) = start().to_coordinates();
    let mut state = State::new(q, v, [false, false, true]);
    let schedule = Schedule { t0: 0.0, step: 0.05, steps: 200 };
    drive::<_, _, 3, 1>(&free(0.5), &mut Gauss::new::<3>(), &schedule, &mut state, ()).unwrap();
    let last = run.nodes.last().unwrap();
    assert_eq!((run.divided, run.parts, last.q, last.v), (0, 0, state.unwrapped(), *state.v()));
    // The control: eight times the step.
    assert!(made(&free(0.5), Dla::midpoint(), &start(), (0.4, 25)).divided > 0);
}

/// Makes what is long enough, and says how often it was asked.
fn pieces(
    limits: Substeps,
    longest: impl Fn(f64) -> f64,
) -> (Result<ControlFlow<(), u64>, Undivided<&'static str>>, f64) {
    let mut way = 0.0;
    let made = limits.divide(
        (2.0, 8.0),
        "whole",
        |_| true,
        |(t, h), after| {
            assert_eq!((t - 2.0 + h) / 8.0, after);
            if h > longest(t) {
                return Err("too long");
            }
            way += h;
            Ok(ControlFlow::Continue(()))
        },
    );
    (made, way)
}

#[test]
fn parts_fill_the_step_within_their_limits() {
    // A half, a quarter, an eighth: eight parts of one second each.
    assert_eq!(pieces(Substeps::default(), |_| 1.0), (Ok(ControlFlow::Continue(8)), 8.0));
    assert_eq!(pieces(Substeps::new(3, u64::MAX), |_| 1.0), (Ok(ControlFlow::Continue(8)), 8.0));
    // Two of one second, one of two, one of four.
    let growing = |t: f64| if t < 4.0 { 1.0 } else { 8.0 };
    assert_eq!(pieces(Substeps::default(), growing), (Ok(ControlFlow::Continue(4)), 8.0));
    let error = pieces(Substeps::new(2, u64::MAX), |_| 1.0).0.unwrap_err();
    assert_eq!(error, Undivided { tried: 2, time: 2.0, part: 2.0, source: "too long" });
    // Two of two seconds failed, two of one second held after one of two, and there may be no more.
    let error = pieces(Substeps::new(53, 5), |t| if t < 4.0 { 2.0 } else { 1.0 }).0.unwrap_err();
    assert_eq!(error, Undivided { tried: 5, time: 5.0, part: 1.0, source: "too long" });
}

#[test]
fn what_no_part_mends_ends_at_once_and_what_breaks_off_does() {
    let never = |_: (f64, f64), _| -> Result<ControlFlow<()>, &'static str> { panic!("is not asked") };
    let error = Substeps::default().divide((0.0, 1.0), "hopeless", |_| false, never).unwrap_err();
    assert_eq!(error, Undivided { tried: 0, time: 0.0, part: 1.0, source: "hopeless" });
    let mut parts = 0;
    let broken = Substeps::default().divide(
        (0.0, 1.0),
        "whole",
        |_| true,
        |_, _| {
            parts += 1;
            Ok(if parts == 1 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) })
        },
    );
    assert_eq!((broken, parts), (Ok(ControlFlow::Break(())), 2));
}
