//! Every method gives the same bits each time: again, on several threads at once, and from any checkpoint.

use super::{Particle, general, request};
use dla::Checkpoint;
use harness::{Method, MethodInfo, Record, Request, Saving, run, run_saved};

/// The end of the run is no checkpoint of its own, nor the end of a piece.
const STEPS: u64 = 1100;
const EVERY: u64 = 300;

/// A system that every method can do.
fn system() -> Particle {
    Particle { basis: true, ..Particle::of(1.0) }
}

/// All that a run measures but its time, each number with every digit and its sign.
fn told(record: Record<3>) -> String {
    assert!(record.failure.is_none(), "{record:?}");
    format!("{:?}", Record { wall_seconds: 0.0, ..record })
}

fn once(info: &MethodInfo) -> String {
    told(run(&system(), &Method::named(info.name, Some(0.3)).unwrap(), &request(STEPS, 0.05), &mut ()))
}

/// A run with all of its checkpoints, as their text gives them back.
fn saved(info: &MethodInfo, from: Option<&Checkpoint>) -> (String, Vec<Checkpoint>) {
    let mut all = Vec::new();
    let mut save = |made: &Checkpoint| all.push(Checkpoint::from_text(&made.to_text()).unwrap());
    let mut saving = Saving { identity: &Checkpoint::default(), from, every: Some(EVERY), save: &mut save };
    let method = Method::named(info.name, Some(0.3)).unwrap();
    let made = run_saved::<3, 1>(&system(), &method, &request(STEPS, 0.05), &mut saving, None, &mut ());
    (told(made.unwrap()), all)
}

#[test]
fn threads_give_the_same_bits() {
    let alone: Vec<String> = general().map(once).collect();
    std::thread::scope(|scope| {
        // Each begins with another method, so that different ones run side by side.
        let threads: Vec<_> = (0..4).map(|first| scope.spawn(move || from(first))).collect();
        for (first, thread) in threads.into_iter().enumerate() {
            let mut expected = alone.clone();
            expected.rotate_left(first);
            assert_eq!(thread.join().unwrap(), expected);
        }
    });
}

fn from(first: usize) -> Vec<String> {
    general().cycle().skip(first).take(general().count()).map(once).collect()
}

#[test]
fn every_checkpoint_leads_to_the_same_bits() {
    for info in general() {
        let (whole, checkpoints) = saved(info, None);
        assert_eq!(whole, once(info), "{}: watched in parts, and at once", info.name);
        assert_eq!(checkpoints.len() as u64, STEPS.div_ceil(EVERY), "{}", info.name);
        for checkpoint in &checkpoints {
            assert_eq!(saved(info, Some(checkpoint)).0, whole, "{}", info.name);
        }
    }
}

/// The control: what is compared tells the smallest change of a start.
#[test]
fn a_bit_of_the_start_shows() {
    for info in general() {
        let method = Method::named(info.name, Some(0.3)).unwrap();
        let Request { q, .. } = request(STEPS, 0.05);
        let request = Request { q: [q[0].next_up(), q[1], q[2]], ..request(STEPS, 0.05) };
        assert_ne!(told(run(&system(), &method, &request, &mut ())), once(info), "{}", info.name);
    }
}
