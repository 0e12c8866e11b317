use crate::{sleigh, state_of};
use dla::{Dla, Form, Gauss, Hint, OneStep, Schedule, Stage, StepError, Trajectory, drive};
use lagrangian::ClosedStepError;
use proptest::prelude::*;
use sleigh::SleighState;

fn start(speed: f64, turn_rate: f64) -> SleighState {
    SleighState { speed, turn_rate, ..SleighState::default() }
}

fn general() -> Dla<lagrangian::Midpoint, lagrangian::Midpoint> {
    Dla::midpoint().solved(Form::General)
}

#[test]
fn experiment_wrong_roots() {
    let sleigh = sleigh();
    let mut counts = [0; 6];
    let mut shown = 0;
    for i in 0..40 {
        for j in 0..40 {
            for h in [0.3, 1.0, 2.0, 3.0] {
                let (u, w) = (-3.0 + 0.151 * f64::from(i), 0.01 + 0.11 * f64::from(j));
                for form in [Form::General, Form::Multipliers] {
                    let (mut a, mut b) = (state_of(&start(u, w)), state_of(&start(u, w)));
                    let closed = Dla::midpoint().step(&sleigh, 0.0, h, &mut a);
                    let open = Dla::midpoint().solved(form).step(&sleigh, 0.0, h, &mut b);
                    let index = match (closed.is_ok(), open.is_ok()) {
                        (true, true) => {
                            let d = (0..3).fold(0.0f64, |d, i| d.max((a.v()[i] - b.v()[i]).abs()));
                            if d < 1e-8 { 0 } else { 1 }
                        }
                        (true, false) => 2,
                        (false, true) => 3,
                        (false, false) => 4,
                    };
                    counts[index] += 1;
                    if (index == 1 || index == 3) && shown < 30 {
                        shown += 1;
                        println!("{index}: h {h} u {u:.2} w {w:.2}: {:?} {:?}", b.v(), closed.map(|_| *a.v()));
                    }
                }
            }
        }
    }
    println!("same {}, other root {}, general only fails {}, closed only fails {}, both fail {}", counts[0], counts[1], counts[2], counts[3], counts[4]);
}
