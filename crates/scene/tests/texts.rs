//! Scenes of systems of text: whatever stands in a file, it is a scene or an error at a place in it.

use proptest::prelude::*;
use scene::{AnyScene, SceneError, bundled_texts};

const METHODS: &[&str] = &["dla", "lobatto3"];

#[test]
fn bundled_texts_are_scenes_that_tell_their_source() {
    for bundled in bundled_texts() {
        let AnyScene::Text(scene) = AnyScene::load(bundled.name, METHODS).unwrap() else { panic!("{}", bundled.name) };
        assert_eq!(scene.name, bundled.name);
        assert!(scene.start.moved.is_empty(), "{}: {:?}", bundled.name, scene.start.moved);
        let head: String = bundled.text.lines().take_while(|line| line.starts_with('#')).collect();
        let year = |word: &str| {
            word.trim_matches(|c: char| !c.is_ascii_digit()).parse().is_ok_and(|y: u32| (1800..2100).contains(&y))
        };
        assert!(head.split(' ').any(year), "{}: a source has a year: {head}", bundled.name);
    }
}

/// A command that needs a sleigh says what the scene is.
#[test]
fn a_system_of_text_is_no_sleigh() {
    let error = scene::Scene::load("knife-edge", METHODS).unwrap_err();
    assert!(matches!(&error, SceneError::UnknownKey(_)) && error.to_string().contains("a system of text"), "{error}");
}

/// Pieces of scenes, in any order.
fn piece() -> impl Strategy<Value = String> {
    prop::sample::select(vec![
        "'", "\"", "x'", "(", ")", "^", "**", "1e999", "nan", "[", "]", "{", "}", "=", ",", "\n", "theta", "cos",
        "sign(", "\\u0041", "é", "#", "\"\"\"", "[system]", "[start]", "t", "x_dot", "0", "-", "/0", "sqrt(-1)",
        "log(0)", ".", " ",
    ])
    .prop_map(str::to_owned)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    /// A bundled text with some of it replaced.
    #[test]
    fn no_file_panics(which in 0..bundled_texts().len(), at in 0.0..1.0, length in 0_usize..40, pieces in prop::collection::vec(piece(), 0..6)) {
        let text = bundled_texts()[which].text;
        let place = |at: usize| (0..=at.min(text.len())).rev().find(|&k| text.is_char_boundary(k)).unwrap();
        let from = place((at * text.len() as f64) as usize);
        let to = place(from + length).max(from);
        let changed = format!("{}{}{}", &text[..from], pieces.concat(), &text[to..]);
        if let Err(error) = AnyScene::parse(&changed, "changed.toml", METHODS) {
            if let Some(place) = error.finding().and_then(|finding| finding.place) {
                let lines: Vec<&str> = changed.split('\n').collect();
                prop_assert!(place.line <= lines.len() && place.column <= lines[place.line - 1].chars().count() + 1, "{error}");
            }
            prop_assert!(!error.to_string().is_empty());
        }
    }
}

/// The multipliers of each bundled text, by its formulas and by those of its system in a shape.
#[test]
fn multipliers_are_those_of_the_equations_of_motion() {
    let mut rows = 0;
    for bundled in bundled_texts() {
        let AnyScene::Text(scene) = AnyScene::load(bundled.name, METHODS).unwrap() else { panic!("{}", bundled.name) };
        let built = scene.built().unwrap();
        let [_, expected] = built.system().mechanism().motion(0.0, &built.q, &built.v).unwrap();
        let found = scene.model.multipliers(0.0, &scene.start.q, &scene.start.v);
        let size = found.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() <= 1e-10 * size, "{}: {found} and {expected}", bundled.name);
        }
        rows += found.len();
    }
    assert!(rows > 20, "{rows}");
}

/// A scene that is written as a file is the same scene, with the names of its constraints and the units of its outputs.
#[test]
fn a_written_scene_reads_back() {
    let named = "\
[system]
coordinates = { x = \"m\", y = \"m\" }
lagrangian = \"(x'^2 + y'^2)/2\"
constraints = { row = \"x' = 2*y'\" }
outputs = { pull = { formula = \"lambda_row\", unit = \"N\" }, twice = \"2*x\" }
[run]
step = 0.05
duration = 2.0
";
    let loaded = bundled_texts().iter().map(|bundled| AnyScene::load(bundled.name, METHODS).unwrap());
    for scene in loaded.chain([AnyScene::parse(named, "named.toml", METHODS).unwrap()]) {
        let written = AnyScene::parse(&scene.to_toml().unwrap(), "again.toml", METHODS).unwrap();
        let [AnyScene::Text(scene), AnyScene::Text(written)] = [scene, written] else { panic!("texts") };
        assert_eq!(scene.words, written.words);
    }
}
