use super::Case;
use super::systems::{bowl, schedule, start, with};
use dla::State;
use harness::{METHODS, Method, integrate};
use lagrangian::{System, With};
use sleigh::Sleigh;
use sleigh::effects::Bowl;
use std::hint::black_box;

/// A step of every method, free and in a bowl.
///
/// `dla` solves the free sleigh by its closed map. The adaptive `dop853` takes as many steps as it needs, and stops at every
/// node.
pub(super) fn cases() -> Vec<Case> {
    let free = METHODS.iter().map(|info| {
        let method = method(info.name);
        Case::new("methods, free", info.name, move |steps| go(&with(()), &method, steps))
    });
    let bowl = METHODS.iter().map(|info| {
        let method = method(info.name);
        Case::new("methods, bowl", info.name, move |steps| {
            go::<With<Sleigh, (Bowl,)>>(&with((bowl(),)), &method, steps);
        })
    });
    free.chain(bowl).collect()
}

fn method(name: &str) -> Method {
    let alpha = (name == "dla-alpha").then_some(0.25);
    Method::named(name, alpha).expect("a name of the table")
}

fn go<Sys: System<3, 1>>(system: &Sys, method: &Method, steps: u64) {
    let (q, v) = start();
    let mut state = State::new(q, v, system.angles());
    integrate(black_box(system), method, &schedule(steps), &mut state, &mut ()).expect("the steps succeed");
    black_box(state);
}
