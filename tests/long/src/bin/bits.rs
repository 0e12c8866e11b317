//! `bits`: a hash of the last bits of every method in the bowl, to compare builds and machines with.

use dla::{AnyState, Mechanism, Schedule, Subject, make_steps};
use harness::{METHODS, Method};
use noslip_long::{STEP, bowl};
use std::error::Error;

/// The FNV-1a hash of the bits.
fn hash(numbers: impl Iterator<Item = f64>) -> u64 {
    let bytes = numbers.flat_map(|number| number.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

fn main() -> Result<(), Box<dyn Error>> {
    let schedule = Schedule { t0: 0.0, step: STEP, steps: 2000 };
    for info in METHODS {
        let (system, state) = bowl(0.1)?;
        let (system, mut state) = (Subject::<3, 1>::from(&system), AnyState::from(state));
        let mut integrator = system.integrator(&Method::named(info.name, Some(0.3))?);
        let outcome = make_steps(&system, &mut *integrator, &schedule, 0..schedule.steps, &mut state, &mut ());
        match outcome {
            Ok(_) => {
                println!("{:18} {:016x}", info.name, hash(state.unwrapped().into_iter().chain(state.v().to_vec())))
            }
            Err(failure) => println!("{:18} {failure}", info.name),
        }
    }
    Ok(())
}
