//! The number of steps, and settings from the command line.

use scene::{AnyScene, MAX_STEPS, Overrides, RunSettings, SceneError};

const METHODS: &[&str] = &["dla", "dla-alpha", "rk4"];

fn run(step: f64, duration: f64) -> RunSettings {
    RunSettings { method: "dla".to_owned(), alpha: None, tolerance: None, step, duration }
}

#[test]
fn multiples_keep_the_step_to_the_last_bit() {
    for (step, duration, steps) in [
        (0.05, 100.0, 2000),
        (0.1, 0.3, 3),
        (0.1, 0.7, 7),
        (0.1, 1e5, 1_000_000),
        (1e-9, 1.1, 1_100_000_000),
        (0.3e-6, 2.7, 9_000_000),
        (1.0, 1.0, 1),
        (0.333_333_333_333, 1.0, 3),
        (1e-4, 1e8, MAX_STEPS),
    ] {
        let run = run(step, duration);
        assert_eq!(run.steps(), steps, "{duration} / {step}");
        assert_eq!(run.actual_step().to_bits(), step.to_bits(), "{duration} / {step}");
    }
}

#[test]
fn other_steps_shrink_to_fit() {
    for (step, duration, steps) in [(0.3, 1.0, 4), (0.7, 1.0, 2), (1.0, 1.000_001, 2), (0.05, 100.01, 2001)] {
        let run = run(step, duration);
        assert_eq!(run.steps(), steps, "{duration} / {step}");
        assert!(run.actual_step() <= step);
        assert!((run.actual_step() * steps as f64 - duration).abs() <= 1e-15 * duration, "{duration} / {step}");
    }
}

#[test]
fn unchecked_settings_do_not_panic() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY, 5e-324, f64::MAX] {
        for other in [0.0, -1.0, f64::NAN, f64::INFINITY, 5e-324, f64::MAX] {
            let run = run(value, other);
            assert!(run.steps() >= 1);
            let _ = run.actual_step();
        }
    }
}

type Given = (Option<&'static str>, Option<f64>, Option<f64>, Option<f64>);

fn overridden((method, step, duration, alpha): Given) -> Result<AnyScene, SceneError> {
    let overrides = Overrides { method, step, duration, alpha };
    AnyScene::load("circle", METHODS).unwrap().with_overrides(&overrides, METHODS)
}

#[test]
fn overrides_replace_what_they_name() {
    let mut scene = AnyScene::load("circle", METHODS).unwrap();
    assert_eq!(overridden((None, None, None, None)).unwrap(), scene);
    let changed = overridden((Some("dla-alpha"), Some(0.5), Some(2.0), Some(0.25))).unwrap();
    *scene.run_mut() =
        RunSettings { method: "dla-alpha".to_owned(), alpha: Some(0.25), tolerance: None, step: 0.5, duration: 2.0 };
    assert_eq!(changed, scene);
}

#[test]
fn bad_overrides_name_their_flag() {
    let cases: &[(Given, &[&str])] = &[
        (
            (Some("rk5"), None, None, None),
            &["`--method`", "found \"rk5\"", "`dla-alpha`, `rk4`", "did you mean `rk4`?"],
        ),
        ((None, Some(-1.0), None, None), &["`--step`", "must be positive", "found -1.0", "greater than 0, in s"]),
        ((None, Some(0.0), None, None), &["`--step`", "must be positive"]),
        ((None, Some(f64::NAN), None, None), &["`--step`", "must be finite"]),
        ((None, Some(61.0), None, None), &["`--step`", "longer than the duration", "at most the duration, 60.0 s"]),
        ((None, Some(1e-12), None, None), &["`--step`", "more than 1e12 steps", "at least 6e-11 s"]),
        ((None, None, Some(0.0), None), &["`--duration`", "must be positive"]),
        ((None, None, Some(0.01), None), &["`--duration`", "shorter than the step", "at least the step, 0.05 s"]),
        ((None, None, Some(1e12), None), &["`--duration`", "more than 1e12 steps", "at most 50000000000.0 s"]),
        ((None, Some(2.0), Some(1.0), None), &["`--step`", "longer than the duration", "1.0 s"]),
        ((None, None, None, Some(1.5)), &["`--alpha`", "between 0 and 1", "a number from 0 to 1"]),
        ((None, None, None, Some(f64::INFINITY)), &["`--alpha`", "must be finite"]),
    ];
    for (overrides, fragments) in cases {
        let error = overridden(*overrides).unwrap_err();
        let text = error.to_string();
        assert_eq!(error.origin(), "command line");
        assert_eq!(error.finding().and_then(|finding| finding.place), None);
        for fragment in fragments.iter().chain(&["command line", "= accepted: "]) {
            assert!(text.contains(fragment), "no {fragment:?} in:\n{text}");
        }
    }
}

#[test]
fn settings_of_the_scene_are_not_blamed_on_a_flag() {
    let mut scene = AnyScene::load("circle", METHODS).unwrap();
    scene.run_mut().step = -1.0;
    let overrides = Overrides { method: Some("rk4"), ..Overrides::default() };
    let error = scene.with_overrides(&overrides, METHODS).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("`run.step`") && text.contains("circle") && !text.contains("--"), "{text}");
}
