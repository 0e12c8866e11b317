//! Scenes with trailers: assemblies.

use scene::Scene;
use sleigh::SleighError;

const METHODS: &[&str] = &["dla"];
const TRAIN: &str = include_str!("../../../../docs/guide/train.toml");

#[test]
fn a_scene_with_trailers_is_a_train() {
    let scene = Scene::parse(TRAIN, "train.toml", METHODS).unwrap();
    let (train, start) = scene.train().unwrap().unwrap();
    assert_eq!(train.trailers().len(), 12);
    assert_eq!((train.assembly.coordinates(), train.assembly.rows()), (39, 13 + 24));
    let misses = train.assembly.misses(0.0, &start);
    // Half a unit in the last place of coordinates of up to eight metres.
    assert!(misses[0] < 1e-15 && misses[1] < 2e-15, "{misses:?}");
    assert_eq!(train.blade(&start, 0), scene.start);
    // The hills are under every blade.
    let level = Scene::parse(&TRAIN.replace("height = 0.6", "height = 0.0"), "train.toml", METHODS).unwrap();
    let (level, _) = level.train().unwrap().unwrap();
    assert!(train.assembly.energy(0.0, &start) > level.assembly.energy(0.0, &start));
    // It is no static system, and another scene is no train.
    assert_eq!(scene.built().err(), Some(SleighError::Train));
    assert!(Scene::load("turnaround", METHODS).unwrap().train().unwrap().is_none());
}

/// Whatever acts on a sleigh acts on the first blade of a train; a velocity that is imposed is that of the start.
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
        let (train, start) = scene.train().unwrap().unwrap();
        assert_eq!(train.assembly.coordinates(), coordinates, "{entry}");
        let (first, misses) = (train.blade(&start, 0), train.assembly.misses(0.0, &start));
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
    let (train, _) = scene.train().unwrap().unwrap();
    assert_eq!(train.assembly.jump_times(0.0, 5.0), [1.0]);
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
