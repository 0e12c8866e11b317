use super::Case;
use super::systems::{BOWL, built, schedule};
use harness::{METHODS, Method, Run};
use scene::BuiltScene;
use std::hint::black_box;
use std::rc::Rc;

/// A step of every method, free and in a bowl.
///
/// `dla` solves the free sleigh by its closed map. The adaptive `dop853` takes as many steps as it needs, and stops at every
/// node.
pub(super) fn cases() -> Vec<Case> {
    let of = |group, effects| {
        let scene = Rc::new(built(effects));
        METHODS.iter().map(move |info| {
            let (scene, method) = (Rc::clone(&scene), method(info.name));
            Case::new(group, info.name, move |steps| go(&scene, &method, steps))
        })
    };
    of("methods, free", "").chain(of("methods, bowl", BOWL)).collect()
}

fn method(name: &str) -> Method {
    let alpha = (name == "dla-alpha").then_some(0.25);
    Method::named(name, alpha).expect("a name of the table")
}

fn go(scene: &BuiltScene, method: &Method, steps: u64) {
    let system = scene.system().mechanism();
    let mut state = system.state(black_box(&scene.q), black_box(&scene.v));
    Run::of(&*system, method).moves(&schedule(steps), &mut state).expect("the steps succeed");
    black_box(state);
}
