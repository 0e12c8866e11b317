//! Bundled scenes, the template, their schema, and files that are not scenes.

use scene::{RunSettings, Scene, SceneError, bundled, nearest};
use std::fs;

const METHODS: &[&str] = &["dla", "dla-alpha"];

#[test]
fn bundled_scenes_load_by_name() {
    let names: Vec<_> = bundled().iter().map(|scene| scene.name).collect();
    assert_eq!(names[..3], ["turnaround", "straight", "circle"], "the free motions come first");
    for bundled in bundled() {
        let scene = Scene::load(bundled.name, METHODS).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.name, bundled.name);
        assert_ne!(scene.title, bundled.name, "a bundled scene has a title");
        assert_eq!(scene.run.actual_step().to_bits(), scene.run.step.to_bits(), "{}", bundled.name);
    }
}

#[test]
fn bundled_scenes_are_what_their_names_say() {
    let [turnaround, straight, circle] =
        ["turnaround", "straight", "circle"].map(|name| Scene::load(name, METHODS).unwrap());
    assert!(turnaround.start.speed < 0.0 && turnaround.sleigh.offset() > 0.0);
    assert!(straight.start.speed > 0.0 && straight.sleigh.offset() > 0.0);
    assert!(circle.sleigh.offset().abs() < f64::MIN_POSITIVE);
    let rounds = circle.start.turn_rate * circle.run.duration / std::f64::consts::TAU;
    assert!((4.0..5.0).contains(&rounds), "{rounds}");
}

#[test]
fn the_template_is_a_scene_with_every_key() {
    let scene = Scene::parse(Scene::template(), "mine.toml", METHODS).unwrap();
    assert_eq!((scene.name.as_str(), scene.title.as_str()), ("mine", "My scene"));
    let text = Scene::template()
        .replace("# alpha", "alpha")
        .replace("# tolerance", "tolerance")
        .replace("\"dla\"      #", "\"dla-alpha\" #");
    let scene = Scene::parse(&text, "mine.toml", METHODS).unwrap();
    assert_eq!((scene.run.method.as_str(), scene.run.alpha), ("dla-alpha", Some(0.5)));
    assert_eq!(scene.run.tolerance, Some(1e-12));
}

#[test]
fn what_may_be_left_out_may_be_left_out() {
    let text = "effects = []\nsleigh = { mass = 2, inertia = 0x10, offset = 0 }\n\
        start = { speed = 1, turn_rate = -1_0 }\nrun.step = 1\nrun.duration = 7";
    let scene = Scene::parse(text, "some/dir/short.scene.toml", METHODS).unwrap();
    assert_eq!((scene.name.as_str(), scene.title.as_str()), ("short.scene", "short.scene"));
    let sleigh = sleigh::Sleigh::new(2.0, 16.0, 0.0).unwrap();
    let start = sleigh::SleighState { speed: 1.0, turn_rate: -10.0, ..Default::default() };
    let run = RunSettings { method: "dla".to_owned(), alpha: None, tolerance: None, step: 1.0, duration: 7.0 };
    assert_eq!((scene.sleigh, scene.start, scene.run), (sleigh, start, run));
}

#[test]
fn files_load_by_path() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    fs::write(&path, Scene::template()).unwrap();
    let scene = Scene::load(path.to_str().unwrap(), METHODS).unwrap();
    assert_eq!(scene, Scene::parse(Scene::template(), "mine.toml", METHODS).unwrap());
}

#[test]
fn a_name_that_is_nothing_lists_the_bundled_scenes() {
    for (name, near) in
        [("turnarond", Some("turnaround")), ("no/Circle.toml", Some("circle")), ("xyz", None), ("", None)]
    {
        let error = Scene::load(name, METHODS).unwrap_err();
        let text = error.to_string();
        let SceneError::NotFound { suggestion, .. } = error else { panic!("{text}") };
        assert_eq!(suggestion, near);
        assert!(text.contains(&format!("`{name}`")) && text.contains("turnaround, straight, circle, bowl"), "{text}");
        assert_eq!(text.contains("did you mean"), near.is_some(), "{text}");
    }
}

#[test]
fn files_that_hold_no_text_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let error = Scene::load(folder.path().to_str().unwrap(), METHODS).unwrap_err();
    assert!(matches!(error, SceneError::Directory { .. }), "{error}");
    assert!(error.to_string().contains("is a directory") && error.to_string().contains("path of a scene file"));

    let path = folder.path().join("latin1.toml");
    fs::write(&path, b"# fine\ntitle = \"B\xe9zier\"\n").unwrap();
    let error = Scene::load(path.to_str().unwrap(), METHODS).unwrap_err();
    let text = error.to_string();
    assert!(matches!(error, SceneError::Encoding(_)), "{text}");
    for fragment in ["latin1.toml:2:11\n", "not UTF-8", "the byte 0xe9", "in UTF-8"] {
        assert!(text.contains(fragment), "no {fragment:?} in:\n{text}");
    }

    let path = folder.path().join("huge.toml");
    fs::File::create(&path).unwrap().set_len((16 << 20) + 1).unwrap();
    let error = Scene::load(path.to_str().unwrap(), METHODS).unwrap_err();
    assert!(matches!(error, SceneError::TooLarge { limit: 16_777_216, .. }), "{error}");

    // A file where a directory should be: the words are those of the operating system.
    let below = path.join("scene.toml");
    let error = Scene::load(below.to_str().unwrap(), METHODS).unwrap_err();
    assert!(error.to_string().contains("huge.toml"), "{error}");
    let error = Scene::load("nul\0byte", METHODS).unwrap_err();
    assert!(matches!(&error, SceneError::Unreadable { message, .. } if !message.is_empty()), "{error}");
}

#[test]
fn finds_misspellings_only() {
    let keys = ["mass", "inertia", "offset", "x", "y", "turn_rate"];
    for (word, expected) in [
        ("masss", Some("mass")),
        ("Mass", Some("mass")),
        ("amss", Some("mass")),
        ("inertai", Some("inertia")),
        ("turnrate", Some("turn_rate")),
        ("turn-rate", Some("turn_rate")),
        ("z", None),
        ("weight", None),
        ("", None),
    ] {
        assert_eq!(nearest(word, keys), expected, "{word}");
    }
    assert_eq!(nearest(&"m".repeat(1_000_000), keys), None);
}
