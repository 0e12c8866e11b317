//! Scenes and texts at random.
#![allow(clippy::unwrap_used, reason = "what clippy.toml allows in tests, their helpers need too")]

use proptest::prelude::*;
use scene::{RunSettings, Scene};
use sleigh::{Sleigh, SleighState};

const METHODS: &[&str] = &["dla", "dla-alpha", "rk4"];

fn positive() -> impl Strategy<Value = f64> {
    (-8.0_f64..8.0).prop_map(|exponent| 10.0_f64.powf(exponent))
}

fn finite() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(-0.0), Just(3.0), proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL]
}

prop_compose! {
    fn scenes()(
        title in "[^\\p{Cc}\"\\\\]{0,12}",
        (mass, inertia, offset) in (positive(), positive(), -1e8..1e8),
        start in prop::array::uniform5(finite()),
        method in prop::sample::select(METHODS),
        alpha in prop::option::of(0.0..=1.0),
        (step, ratio) in (positive(), 1.0_f64..1e11),
    ) -> Scene {
        let [x, y, heading, speed, turn_rate] = start;
        Scene {
            name: "random".to_owned(),
            title,
            sleigh: Sleigh::new(mass, inertia, offset).unwrap(),
            start: SleighState { x, y, heading, speed, turn_rate },
            run: RunSettings { method: method.to_owned(), alpha, step, duration: f64::max(step * ratio, step) },
            effects: vec![],
        }
    }
}

/// The scene as a file; `{:?}` writes a number with the digits that lead back to it.
fn written(scene: &Scene) -> String {
    let Scene { title, sleigh, start, run, .. } = scene;
    let alpha = run.alpha.map(|alpha| format!("alpha = {alpha:?}\n")).unwrap_or_default();
    format!(
        "title = \"{title}\"\n[sleigh]\nmass = {:?}\ninertia = {:?}\noffset = {:?}\n[start]\nx = {:?}\ny = {:?}\n\
         heading = {:?}\nspeed = {:?}\nturn_rate = {:?}\n[run]\nmethod = {:?}\nstep = {:?}\nduration = {:?}\n{alpha}",
        sleigh.mass(),
        sleigh.inertia(),
        sleigh.offset(),
        start.x,
        start.y,
        start.heading,
        start.speed,
        start.turn_rate,
        run.method,
        run.step,
        run.duration,
    )
}

/// A text either is a scene or has an error that names where it comes from.
fn parses_or_explains(text: &str) -> Result<(), TestCaseError> {
    if let Err(error) = Scene::parse(text, "mutant.toml", METHODS) {
        let message = error.to_string();
        prop_assert!(message.contains("mutant.toml"), "{text:?}:\n{message}");
        prop_assert!(message.contains("= accepted: "), "{text:?}:\n{message}");
        prop_assert_eq!(error.origin(), "mutant.toml");
        if let Some(place) = error.finding().and_then(|finding| finding.place) {
            let at = format!("mutant.toml:{}:{}\n", place.line, place.column);
            prop_assert!(message.contains(&at), "no {at:?} for {text:?}:\n{message}");
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn scenes_come_back_from_their_text(scene in scenes()) {
        let text = written(&scene);
        let back = Scene::parse(&text, "random.toml", METHODS);
        prop_assert_eq!(back, Ok(scene), "{}", text);
    }

    #[test]
    fn runs_have_their_duration(scene in scenes()) {
        let run = &scene.run;
        let (steps, step) = (run.steps(), run.actual_step());
        prop_assert!(step <= run.step);
        let excess = (steps as f64 * step - run.duration).abs();
        prop_assert!(excess <= 1e-9 * step + 4.0 * f64::EPSILON * run.duration, "{steps} steps of {step} s: {run:?}");
    }

    #[test]
    fn truncated_templates_parse_or_explain(length in 0..Scene::template().len()) {
        // The template is ASCII, so that it may be cut anywhere.
        parses_or_explains(&Scene::template()[..length])?;
    }

    #[test]
    fn mutated_templates_parse_or_explain(
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..30, "\\PC{0,3}|[\r\n\t\"'\\[\\]={},.#0-9a-z-]{0,4}|[\\x00-\\x1f\u{feff}\u{200d}]"), 1..6),
    ) {
        let mut text = Scene::template().to_owned();
        for (index, removed, inserted) in edits {
            let boundaries: Vec<_> = text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
            let start = index.index(boundaries.len());
            let end = (start + removed).min(boundaries.len() - 1);
            text.replace_range(boundaries[start]..boundaries[end], &inserted);
        }
        parses_or_explains(&text)?;
    }

    #[test]
    fn any_text_parses_or_explains(text in any::<String>(), lines in prop::collection::vec("[\\[\\]=\"'a-e.\r \n\t{}0-9é漢]{0,20}", 0..5)) {
        parses_or_explains(&text)?;
        parses_or_explains(&lines.join("\n"))?;
    }

    #[test]
    fn long_lines_and_deep_nests_parse_or_explain(length in 0_usize..20_000, before in "[a-z.]{1,10}") {
        for part in ["a.", "[", "{a=", "x", "é", "\"", "1", "-"] {
            let long = part.repeat(length);
            parses_or_explains(&format!("{before}{long} = 1"))?;
            parses_or_explains(&format!("{before} = {long}"))?;
            parses_or_explains(&Scene::template().replace("mass = 1.0", &format!("mass = {long}")))?;
        }
    }
}
