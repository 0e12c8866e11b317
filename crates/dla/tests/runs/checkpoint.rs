use crate::runs::{backward, sleigh, state_of, system};
use dla::{
    Checkpoint, CheckpointError, Composition, Dla, Gauss, Gni, OneStep, Schedule, State, Trajectory, Work, drive_part,
};
use sleigh::ClosedMap;

const SCHEDULE: Schedule = Schedule { t0: 0.5, step: 0.05, steps: 1000 };

/// A run in one piece, and the same one stopped after `stop` steps, written, read and resumed.
fn whole_and_resumed<Method>(make: impl Fn() -> Method, (stop, steps): (u64, u64)) -> [(State<3>, Trajectory); 2]
where
    Method: OneStep<3, 1>,
{
    let sleigh = system();
    let (schedule, every) = (Schedule { steps, ..SCHEDULE }, steps / 10);
    let part = |method: &mut Method, steps, state: &mut State<3>, trajectory: &mut Trajectory| {
        drive_part(&sleigh, method, &schedule, steps, state, trajectory).unwrap();
    };
    let (mut whole, mut nodes) = (state_of(&backward()), Trajectory::every(every));
    part(&mut make(), 0..steps, &mut whole, &mut nodes);

    let (mut state, mut method, mut before) = (state_of(&backward()), make(), Trajectory::every(every));
    part(&mut method, 0..stop, &mut state, &mut before);
    let mut checkpoint = Checkpoint::of([("method", "any".to_owned())]);
    state.save(&mut checkpoint);
    Work::default().save(&mut checkpoint);
    checkpoint.put("memory", &method.memory());
    let text = checkpoint.to_text();

    let read = Checkpoint::from_text(&text).unwrap();
    assert_eq!(read, checkpoint);
    let mut resumed = State::load(&read, [false, false, true]).unwrap();
    assert_eq!(resumed, state);
    let t = schedule.time(stop);
    let mut after = Trajectory::resumed(every, t, Work::load(&read, t, &resumed.into()).unwrap());
    let mut method = make();
    method.recall(&read.list("memory").unwrap(), &resumed);
    part(&mut method, stop..steps, &mut resumed, &mut after);
    [(whole, nodes), (resumed, after)]
}

test_systems::short_and_full! {
    a_resumed_run_has_the_same_bits => resumed_runs(&[1, 40, 55, 99], 100);
    a_resumed_run_has_the_same_bits_in_full => resumed_runs(&[1, 400, 555, 999], 1000);
}

fn resumed_runs(stops: &[u64], steps: u64) {
    for &stop in stops {
        let at = (stop, steps);
        for [(whole, all), (resumed, after)] in [
            whole_and_resumed(|| ClosedMap::of(sleigh()), at),
            whole_and_resumed(|| Composition::suzuki4(ClosedMap::of(sleigh())), at),
            // Which remember derivatives.
            whole_and_resumed(Dla::midpoint, at),
            whole_and_resumed(|| Composition::suzuki4(Dla::trapezoid()), at),
            whole_and_resumed(Gauss::new::<8>, at),
            // It remembers a momentum.
            whole_and_resumed(Gni::<3>::default, at),
        ] {
            assert_eq!(whole, resumed, "after {stop} steps");
            let rest: Vec<_> = all.nodes().iter().filter(|node| node.k > stop).collect();
            assert_eq!(rest, after.nodes().iter().collect::<Vec<_>>());
        }
    }
}

/// The control: a run goes another way if a saved part is left out.
#[test]
fn every_part_of_a_state_counts() {
    let sleigh = system();
    let run = |method: &mut Gni<3>, steps, state: &mut State<3>| {
        drive_part(&sleigh, method, &SCHEDULE, steps, state, ()).unwrap();
    };
    let (mut whole, mut forgetful) = (state_of(&backward()), state_of(&backward()));
    run(&mut Gni::default(), 0..1000, &mut whole);
    run(&mut Gni::default(), 0..400, &mut forgetful);
    run(&mut Gni::default(), 400..1000, &mut forgetful);
    assert_ne!(whole, forgetful, "without the method's memory");

    let (mut exact, mut rounded) = (state_of(&backward()), state_of(&backward()));
    drive_part(&sleigh, &mut Dla::midpoint(), &SCHEDULE, 0..1000, &mut exact, ()).unwrap();
    drive_part(&sleigh, &mut Dla::midpoint(), &SCHEDULE, 0..400, &mut rounded, ()).unwrap();
    let mut rounded = State::new(rounded.unwrapped(), *rounded.v(), [false, false, true]);
    drive_part(&sleigh, &mut Dla::midpoint(), &SCHEDULE, 400..1000, &mut rounded, ()).unwrap();
    assert_ne!(exact, rounded, "without the compensation of the sums");
}

#[test]
fn what_is_no_checkpoint_of_the_run_is_refused() {
    let of =
        |method: &str, version: &str| Checkpoint::of([("method", method.to_owned()), ("version", version.to_owned())]);
    let mut checkpoint = of("dla", "1.2\n3 = ä");
    checkpoint.put("q", &[1.0, -0.0, f64::MIN_POSITIVE / 3.0]);
    checkpoint.put("none", &[]);
    checkpoint.put_counts("k", &[u64::MAX]);
    let text = checkpoint.to_text();
    let read = Checkpoint::from_text(&text).unwrap();
    assert_eq!(read.get::<3>("q").unwrap().map(f64::to_bits), [1.0, -0.0, f64::MIN_POSITIVE / 3.0].map(f64::to_bits));
    assert_eq!((read.list("none").unwrap().len(), read.counts("k").unwrap()), (0, [u64::MAX]));
    assert_eq!(read.belongs_to(&of("dla", "1.2\n3 = ä")), Ok(()));

    let other = read.belongs_to(&of("dla4", "1.2\n3 = ä")).unwrap_err();
    assert_eq!(
        other.to_string(),
        "the checkpoint belongs to another run: in the checkpoint, `method` is `dla`; in this run, `method` is `dla4`"
    );
    assert!(read.belongs_to(&Checkpoint::of([("method", "dla".to_owned())])).is_err(), "one thing more");
    assert_eq!(read.get::<2>("q"), Err(CheckpointError::Missing { name: "q".to_owned(), count: 2 }));
    assert!(read.get::<1>("p").is_err() && State::<3>::load(&read, [false; 3]).is_err());

    // Cut anywhere, or with any byte changed, it is refused.
    for cut in 0..text.len() {
        if let Some(part) = text.get(..cut) {
            assert!(Checkpoint::from_text(part).is_err(), "{part}");
        }
    }
    for i in (0..text.len()).filter(|i| text.is_char_boundary(*i) && text.is_char_boundary(i + 1)) {
        let changed = format!("{}?{}", &text[..i], &text[i + 1..]);
        assert!(Checkpoint::from_text(&changed).is_err(), "{changed}");
    }
    assert_eq!(Checkpoint::from_text("title = 1\n"), Err(CheckpointError::NotOne));
    let newer = text.replacen("checkpoint 5", "checkpoint 6", 1);
    assert_eq!(Checkpoint::from_text(&newer), Err(CheckpointError::Version { found: "6".to_owned() }));
}

/// The published values of the FNV-1a hash of 64 bits (Fowler, Noll, Vo and Eastlake).
#[test]
fn fingerprints_are_fnv() {
    for (text, hash) in [("", "cbf29ce484222325"), ("a", "af63dc4c8601ec8c"), ("foobar", "85944171f73967e8")] {
        assert_eq!(Checkpoint::fingerprint(text), hash);
    }
}
