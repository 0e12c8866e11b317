//! Settings of the command line in the text of a scene.

use proptest::prelude::*;
use scene::{Overrides, Scene, SceneError, Setting};
use std::fs;

const METHODS: &[&str] = &["dla", "rk4"];

fn set(scene: &str, settings: &[&str]) -> Result<Scene, SceneError> {
    let settings: Vec<Setting> = settings.iter().map(|text| text.parse().unwrap()).collect();
    Scene::load_with(scene, &settings, &Overrides::default(), METHODS)
}

/// The text of the key, and the value read from it.
#[test]
fn a_setting_is_what_the_text_would_say() {
    let text = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scenes/bowl.toml")).unwrap();
    for (key, value, from, to) in [
        ("sleigh.offset", "0.3", "offset = 0.5", "offset = 0.3"),
        ("start.speed", "-2", "speed = -1.0", "speed = -2"),
        ("effects.0.stiffness", "[0.2, 0.3]", "stiffness = [0.1, 0.1]", "stiffness = [0.2, 0.3]"),
        ("effects.0.stiffness.1", "0.3", "stiffness = [0.1, 0.1]", "stiffness = [0.1, 0.3]"),
        ("run.method", "rk4", "method = \"dla\"", "method = \"rk4\""),
        ("run.method", "\"rk4\"", "method = \"dla\"", "method = \"rk4\""),
        ("title", "A deep bowl", "title = \"The sleigh in a bowl\"", "title = \"A deep bowl\""),
    ] {
        assert!(text.contains(from), "{from}");
        let written = Scene::parse(&text.replace(from, to), "bowl", METHODS).unwrap();
        assert_eq!(set("bowl", &[&format!("{key}={value}")]).unwrap(), written, "{key}");
    }
}

#[test]
fn keys_that_the_text_does_not_have_are_added() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("short.toml");
    let short = "[sleigh]\nmass = 1.0\ninertia = 1.0\noffset = 0.5\n[start]\nspeed = 1.0\nturn_rate = 0.0\n[run]\nstep = 0.1\nduration = 1.0\n\
                 [[effects]]\nkind = \"hills\"\nhills = [{height = 1.0, x = 0.0, y = 0.0, width = 1.0}]";
    fs::write(&path, short).unwrap();
    let scene = |settings: &[&str]| set(path.to_str().unwrap(), settings);
    assert_eq!(scene(&["start.heading=0.25"]).unwrap().start.heading.to_bits(), 0.25_f64.to_bits());
    assert_eq!(scene(&["title=Short"]).unwrap().title, "Short");
    // The rest of the scene, and the order of settings.
    let last = scene(&["start.x=1", "start.x=2", "run.method=rk4"]).unwrap();
    assert_eq!((last.start.x.to_bits(), last.run.method.as_str()), (2.0_f64.to_bits(), "rk4"));
    // A table that is not there: the setting completes the scene.
    fs::write(&path, short.replace("[start]\nspeed = 1.0\nturn_rate = 0.0\n", "")).unwrap();
    assert!(scene(&[]).is_err());
    assert!(scene(&["start.speed=3", "start.turn_rate=0"]).is_ok());
}

#[test]
fn what_has_no_place_or_is_not_valid_is_told_by_its_setting() {
    for (setting, told) in [
        ("sleigh.mass=-1", ["bowl --set sleigh.mass=-1: `sleigh.mass` must be positive", "greater than 0, in kg"]),
        ("sleigh.weight=1", ["`sleigh.weight` is not a key of a scene", "`mass`"]),
        ("effects.3.stiffness=1", ["--set: `effects.3.stiffness` leads to item 3", "items 0 to 0"]),
        ("effects.0.stiffness.x=1", ["`effects.0.stiffness.x` leads to item x", "items 0 to 1"]),
        // The effect has the number that a setting has to give.
        ("effects.0.stiffness=true", ["bowl --set effects.0.stiffness=true: `effects[0].bowl.stiffness`", "accepted"]),
        ("sleigh.mass.value=1", ["`sleigh.mass.value` leads into a value that has no parts", "start.speed"]),
        ("start=1", ["`start` is a table", "start.speed"]),
        ("effects=1", ["`effects` is a table", "start.speed"]),
        ("run.method=euler", ["`run.method`", "`rk4`"]),
    ] {
        let error = set("bowl", &[setting]).unwrap_err().to_string();
        assert!(told.iter().all(|told| error.contains(told)), "{setting}: {error}");
        assert!(!error.contains("-->"), "{error}");
    }
    for text in ["sleigh.mass", "=1", "sleigh..mass=1", ""] {
        assert!(text.parse::<Setting>().is_err(), "{text}");
    }
}

#[test]
fn an_error_of_the_text_itself_shows_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.toml");
    let bad = "[sleigh]\nmass = 1.0\ninertia = -1.0\noffset = 0.5\n[start]\nspeed = 1.0\nturn_rate = 0.0\n[run]\nstep = 0.1\nduration = 1.0\n";
    fs::write(&path, bad).unwrap();
    let error = set(path.to_str().unwrap(), &["sleigh.mass=2"]).unwrap_err().to_string();
    assert!(error.contains("bad.toml:3:11"), "{error}");
    assert!(set(path.to_str().unwrap(), &["sleigh.inertia=1"]).is_ok());
}

proptest! {
    /// Whatever is set: a scene or an error, and no panic.
    #[test]
    fn any_setting_is_read_or_refused(key in "[a-z0-9._' \"\\[]{0,20}", value in "\\PC{0,20}") {
        if let Ok(setting) = format!("{key}={value}").parse::<Setting>() {
            let _ = Scene::load_with("bowl", &[setting], &Overrides::default(), METHODS);
        }
    }

    /// Numbers arrive with all their digits.
    #[test]
    fn numbers_are_those_that_were_written(x in -1e150..1e150_f64) {
        let setting: Setting = format!("start.x={x:?}").parse().unwrap();
        let scene = Scene::load_with("bowl", &[setting], &Overrides::default(), METHODS).unwrap();
        prop_assert_eq!(scene.start.x.to_bits(), x.to_bits());
    }
}
