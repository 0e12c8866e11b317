//! What the optional functions of a system buy: nanoseconds a step where a system is two functions only, where it gives a basis of its
//! admissible velocities, and where it knows its reduced equations too.

#![allow(missing_docs, dead_code, clippy::unwrap_used)]

#[path = "text/systems.rs"]
mod systems;
#[path = "text/without.rs"]
mod without;

use noslip::dla::Mechanics;
use noslip::prelude::*;
use std::time::Instant;
use without::Without;

/// Makes a method.
type Make<'a, const N: usize, const M: usize> = &'a dyn Fn() -> Box<dyn OneStep<N, M>>;

/// The least time of a step, of some rounds (ns); none where a step fails.
fn step<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    method: Make<'_, N, M>,
    (q, v): ([f64; N], [f64; N]),
) -> Option<f64> {
    const STEPS: u64 = 1000;
    let round = |_| {
        let (mut state, mut method) = (State::new(q, v, system.angles()), method());
        let begin = Instant::now();
        drive(system, &mut *method, &Schedule { t0: 0.0, step: 0.01, steps: STEPS }, &mut state, ()).ok()?;
        Some(begin.elapsed().as_nanos() as f64 / STEPS as f64)
    };
    (0..9).map(round).reduce(|a, b| Some(a?.min(b?)))?
}

/// The rows of a system, from the admissible velocity nearest to `v`: two functions alone, with a derived basis, with its own, and with
/// its reduced equations.
fn row<Sys, const N: usize, const M: usize>(name: &str, system: &Sys, (q, v): ([f64; N], [f64; N]))
where
    Sys: System<N, M> + Clone,
{
    let start = consistent_start(system, 0.0, &q, &v).unwrap();
    let start = (start.q, start.v);
    let bare = Without::<_, false>(system.clone());
    let derived = WithBasis::new(bare.clone(), 0.0, &start.0);
    let given = Without::<_, true>(system.clone());
    let forms: [&dyn Mechanics<N, M>; 4] = [&bare, &derived, &given, system];
    let methods: [(&str, Make<'_, N, M>); 2] =
        [("dla", &|| Box::new(method!("dla"))), ("gauss16", &|| Box::new(method!("gauss16")))];
    for (method, make) in methods {
        print!("| {name} | `{method}` |");
        for form in forms {
            match step(form, make, start) {
                Some(nanoseconds) => print!(" {nanoseconds:.0} |"),
                None => print!(" - |"),
            }
        }
        println!();
    }
}

fn main() {
    println!("| ns a step | method | two functions | `WithBasis` | `admissible_basis` | `reduced` |");
    println!("|---|---|--:|--:|--:|--:|");
    row("knife edge (3, 1)", &systems::KnifeEdge::default(), ([0.0; 3], [1.0, 0.0, 0.5]));
    row("roller racer (4, 2)", &systems::RollerRacer::default(), ([0.0, 0.0, 0.0, 0.5], [1.0, 0.0, 0.0, 0.3]));
    row("snakeboard (5, 2)", &systems::Snakeboard::default(), ([0.0, 0.0, 0.0, 0.0, -0.5], [0.0; 5]));
}
