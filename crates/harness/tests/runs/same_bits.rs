//! Every method gives the same bits each time: again, on several threads at once, and from any checkpoint.

use super::{Particle, families, general, request, run};
use crate::common::{bits, goes_on_to_the_same_bits};
use dla::Subject;
use harness::{Method, MethodInfo, Record};

/// The steps of a run, and after how many a checkpoint is made. The end of the run is no checkpoint of its own, nor the end of a piece.
type Length = (u64, u64);
const SHORT: Length = (22, 6);
const LONG: Length = (1100, 300);

/// A system that every method can do.
fn system() -> Particle {
    Particle { basis: true, ..Particle::of(1.0) }
}

/// All that a run measures but its time, each number with every digit and its sign.
fn told(record: &Record) -> String {
    assert!(record.failure.is_none(), "{record:?}");
    bits(record)
}

fn once(info: &MethodInfo, (steps, _): Length) -> String {
    let method = Method::named(info.name, Some(0.3)).unwrap();
    told(&run(&Subject::from(&system()), &method, &request(steps, 0.05)))
}

test_systems::short_and_full! {
    threads_give_the_same_bits => check_threads(&families(), 2, SHORT);
    threads_give_the_same_bits_at_length => check_threads(&general(), 4, LONG);
}

fn check_threads<Infos>(methods: &Infos, threads: usize, length: Length)
where
    Infos: Iterator<Item = &'static MethodInfo> + Clone + Send,
{
    let alone: Vec<String> = methods.clone().map(|info| once(info, length)).collect();
    std::thread::scope(|scope| {
        // Each begins with another method, so that different ones run side by side.
        let from = |first: usize| {
            let (methods, count) = (methods.clone(), alone.len());
            move || methods.cycle().skip(first).take(count).map(|info| once(info, length)).collect::<Vec<String>>()
        };
        let threads: Vec<_> = (0..threads).map(|first| scope.spawn(from(first))).collect();
        for (first, thread) in threads.into_iter().enumerate() {
            let mut expected = alone.clone();
            expected.rotate_left(first);
            assert_eq!(thread.join().unwrap(), expected);
        }
    });
}

test_systems::short_and_full! {
    every_checkpoint_leads_to_the_same_bits => check_checkpoints(families(), SHORT);
    every_checkpoint_leads_to_the_same_bits_at_length => check_checkpoints(general(), LONG);
}

fn check_checkpoints(methods: impl Iterator<Item = &'static MethodInfo>, length: Length) {
    for info in methods {
        let method = Method::named(info.name, Some(0.3)).unwrap();
        let whole = goes_on_to_the_same_bits(&Subject::from(&system()), &method, &request(length.0, 0.05), length.1);
        assert_eq!(told(&whole), once(info, length), "{}", info.name);
    }
}

test_systems::short_and_full! {
    a_bit_of_the_start_shows => check_bit(families(), SHORT);
    a_bit_of_the_start_shows_at_length => check_bit(general(), LONG);
}

/// The control: the comparison tells the smallest change of a start.
fn check_bit(methods: impl Iterator<Item = &'static MethodInfo>, length: Length) {
    for info in methods {
        let method = Method::named(info.name, Some(0.3)).unwrap();
        let mut request = request(length.0, 0.05);
        request.q[0] = request.q[0].next_up();
        let other = told(&run(&Subject::from(&system()), &method, &request));
        assert_ne!(other, once(info, length), "{}", info.name);
    }
}
