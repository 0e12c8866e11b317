//! Scenes with trailers: assemblies.

use scene::{AnyScene, BuildError, BuiltScene, Scene};
use sleigh::{SleighError, SleighState};

const METHODS: &[&str] = &["dla"];
const TRAIN: &str = include_str!("../../../../docs/guide/train.toml");

/// What the constraints of a system miss at its start: velocities, and positions.
fn misses(built: &BuiltScene) -> [f64; 2] {
    let (mechanism, BuiltScene { q, v, .. }) = (built.system().mechanism(), built);
    [mechanism.largest_residual(0.0, q, v), mechanism.largest_position(0.0, &mechanism.state(q, v)).unwrap()]
}

fn first_blade(built: &BuiltScene) -> SleighState {
    built.system().sleigh().unwrap().sleigh_state(&built.q, &built.v)
}

#[test]
fn a_scene_with_trailers_is_a_train() {
    let scene = Scene::parse(TRAIN, "train.toml", METHODS).unwrap();
    let built = scene.built().unwrap();
    let mechanism = built.system().mechanism();
    assert_eq!(built.system().train().unwrap().trailers().len(), 12);
    assert_eq!(mechanism.size(), dla::Size { n: 39, m: 13 + 24 });
    let misses = misses(&built);
    // Half a unit in the last place of coordinates of up to eight metres.
    assert!(misses[0] < 1e-15 && misses[1] < 2e-15, "{misses:?}");
    assert_eq!(first_blade(&built), scene.start);
    // The hills are under every blade.
    let level = Scene::parse(&TRAIN.replace("height = 0.6", "height = 0.0"), "train.toml", METHODS).unwrap();
    let level = level.built().unwrap();
    let lower = level.system().mechanism().energy(0.0, &built.q, &built.v);
    assert!(mechanism.energy(0.0, &built.q, &built.v) > lower);
    // It has no analyses, and another scene is no train.
    let refused = AnyScene::Sleigh(Box::new(scene)).built_for_analysis();
    assert_eq!(refused.err(), Some(BuildError::Sleigh(SleighError::Train)));
    assert!(Scene::load("turnaround", METHODS).unwrap().built().unwrap().system().train().is_none());
}

/// Whatever acts on a sleigh acts on the first blade of a train; an imposed velocity sets the start.
#[test]
fn every_effect_goes_with_trailers() {
    for (entry, coordinates, speed) in [
        ("kind = \"flywheel\"\ninertia = 1.0\nrotor_rate = 2.0", 40, None),
        ("kind = \"tracer\"\npath = { circle = { radius = 1.0 }, period = 9.0 }", 39, Some(())),
        (
            "kind = \"servo\"\nspeed = { times = [0.0, 1.0], values = [0.7, 1.0], interpolation = \"linear\" }",
            39,
            Some(()),
        ),
        ("kind = \"servo\"\nspeed = { times = [0.0, 1.0], values = [0.7, 1.0] }\nturn_rate = 0.1", 39, Some(())),
        ("kind = \"thrust\"\nforce = { times = [0.0, 1.0], values = [0.0, 1.0] }", 39, None),
    ] {
        let scene = Scene::parse(&format!("{TRAIN}\n[[effects]]\n{entry}\n"), "train.toml", METHODS).unwrap();
        let built = scene.built().unwrap();
        assert_eq!(built.q.len(), coordinates, "{entry}");
        let (first, misses) = (first_blade(&built), misses(&built));
        assert!(misses[0] < 1e-14 && misses[1] < 2e-15, "{entry}: {misses:?}");
        assert_eq!(speed.is_some(), first != scene.start, "{entry}");
        if entry.contains("values = [0.7") {
            assert!((first.speed - 0.7).abs() < 1e-15, "{first:?}");
        }
    }
    // The jumps of the lead are those of the train.
    let pushed =
        format!("{TRAIN}\n[[effects]]\nkind = \"thrust\"\nforce = {{ times = [0.0, 1.0], values = [0.0, 1.0] }}\n");
    let scene = Scene::parse(&pushed, "train.toml", METHODS).unwrap();
    assert_eq!(scene.built().unwrap().system().mechanism().jump_times(0.0, 5.0), [1.0]);
    assert_eq!(scene.jumps().unwrap(), [1.0]);
}

#[test]
fn what_does_not_go_with_trailers_is_refused() {
    let refused = |text: &str| Scene::parse(text, "train.toml", METHODS).unwrap_err().to_string();
    let with = |entry: &str| refused(&format!("{TRAIN}\n[[effects]]\n{entry}\n"));
    let said = with("kind = \"trailers\"\ncount = 1\nmass = 1.0\ninertia = 1.0\nbar = 1.0");
    assert!(said.contains("is given twice"), "{said}");
    for (from, to, expected) in [
        ("count = 12", "count = 1.5", "a whole number from 1 to 100000"),
        ("mass = 0.3", "mass = [0.3, 0.4]", "wrong length"),
        ("bar = 0.5", "bar = -0.5", "must be positive"),
        ("count = 12", "count = 2", "more than the trailers"),
    ] {
        let said = refused(&TRAIN.replace(from, to));
        assert!(said.contains(expected), "{said}");
    }
}
