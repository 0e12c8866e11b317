//! Scenes and texts at random.

use dla::{Piece, Schedule, make_steps, piece_by_piece};
use proptest::prelude::*;
use scene::{Rotor, RunSettings, Scene, SceneEffect, SceneError};
use sleigh::effects::{
    AnyEffect, Bowl, Drag, EggCrate, Friction, Hill, Hills, MovingMass, QuadraticDrag, Slope, Thrust, Torque,
};
use sleigh::{ClosedPath, Formula, Sleigh, SleighState, Table, TimeFunction};

const METHODS: &[&str] = &["dla", "dla-alpha", "rk4"];

fn positive() -> impl Strategy<Value = f64> {
    (-8.0_f64..8.0).prop_map(|exponent| 10.0_f64.powf(exponent))
}

fn finite() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(-0.0), Just(3.0), proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL]
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), -3.0..3.0, finite()]
}

fn pair() -> impl Strategy<Value = [f64; 2]> {
    prop::array::uniform2(number())
}

/// A function of time; its table, if it is one, jumps where every step of `scenes` has a node: never within the run.
///
/// On the heap, as what acts is: trees of values within one another outgrow the stack of a test.
fn function() -> BoxedStrategy<TimeFunction> {
    prop_oneof![
        number().prop_map(TimeFunction::Constant),
        (number(), number(), number()).prop_map(|(amplitude, frequency, phase)| TimeFunction::Sine {
            amplitude,
            frequency,
            phase
        }),
        (number(), number()).prop_map(|(a, b)| TimeFunction::Table(Table::new(vec![-1.0, 0.0], vec![a, b]).unwrap())),
        number().prop_map(|a| TimeFunction::Formula(Formula::new(&format!("{a:?}*cos(t)")).unwrap())),
    ]
    .boxed()
}

fn hill() -> impl Strategy<Value = Hill> {
    (number(), number(), number(), positive()).prop_map(|(height, x, y, width)| Hill { height, x, y, width })
}

/// Any effect that a scene may have several of.
fn acting() -> BoxedStrategy<SceneEffect> {
    let smooth = prop_oneof![
        number().prop_map(TimeFunction::Constant),
        (number(), number(), number()).prop_map(|(amplitude, frequency, phase)| TimeFunction::Sine {
            amplitude,
            frequency,
            phase
        }),
    ];
    let forces = prop_oneof![
        pair().prop_map(|gravity| AnyEffect::from(Slope { gravity })),
        (pair(), pair()).prop_map(|(stiffness, center)| Bowl { stiffness, center }.into()),
        (number(), pair()).prop_map(|(height, wave_number)| EggCrate { height, wave_number }.into()),
        prop::collection::vec(hill(), 0..3).prop_map(|hills| Hills { hills }.into()),
        (positive(), positive()).prop_map(|(along, turning)| Drag { along, turning }.into()),
        (positive(), positive()).prop_map(|(along, turning)| QuadraticDrag { along, turning }.into()),
        prop::array::uniform4(positive()).prop_map(|[along, smoothing, turning, turning_smoothing]| {
            Friction { along, smoothing, turning, turning_smoothing }.into()
        }),
        function().prop_map(|force| Thrust { force }.into()),
        function().prop_map(|torque| Torque { torque }.into()),
    ];
    prop_oneof![
        9 => forces.prop_map(SceneEffect::Acting),
        1 => (positive(), smooth.clone(), smooth)
            .prop_map(|(mass, x, y)| SceneEffect::MovingMass(MovingMass { mass, x, y })),
    ]
    .boxed()
}

/// At most one rotor, one guide and one table, then what acts on them.
fn effects() -> impl Strategy<Value = Vec<SceneEffect>> {
    let flywheel = (positive(), number(), prop::option::of(function()))
        .prop_map(|(inertia, rate, torque)| SceneEffect::Flywheel(Rotor { inertia, rate, torque }));
    let guide = prop_oneof![
        (function(), prop::option::of(function()))
            .prop_map(|(speed, turn_rate)| SceneEffect::Servo { speed: Some(speed), turn_rate }),
        function().prop_map(|turn_rate| SceneEffect::Servo { speed: None, turn_rate: Some(turn_rate) }),
        (positive(), pair(), positive()).prop_map(|(radius, center, period)| SceneEffect::Tracer {
            path: ClosedPath::circle(radius, center, period).unwrap(),
        }),
    ];
    let turntable = number().prop_map(|rate| SceneEffect::Turntable { rate });
    (
        prop::option::of(flywheel),
        prop::option::of(guide),
        prop::option::of(turntable),
        prop::collection::vec(acting(), 0..4),
    )
        .prop_map(|(flywheel, guide, turntable, acting)| {
            flywheel.into_iter().chain(guide).chain(turntable).chain(acting).collect()
        })
}

prop_compose! {
    fn scenes()(
        title in "[^\\p{Cc}\"\\\\]{0,12}",
        (mass, inertia, offset) in (positive(), positive(), -1e8..1e8),
        start in prop::array::uniform5(finite()),
        method in prop::sample::select(METHODS),
        alpha in prop::option::of(0.0..=1.0),
        tolerance in prop::option::of(positive()),
        (step, ratio) in (positive(), 1.0_f64..1e11),
        mut effects in effects(),
    ) -> Scene {
        if offset == 0.0 {
            effects.retain(|effect| !matches!(effect, SceneEffect::Tracer { .. }));
        }
        let [x, y, heading, speed, turn_rate] = start;
        Scene {
            name: "random".to_owned(),
            title,
            sleigh: Sleigh::new(mass, inertia, offset).unwrap(),
            start: SleighState { x, y, heading, speed, turn_rate },
            run: RunSettings {
                method: method.to_owned(),
                alpha,
                tolerance,
                step,
                duration: f64::max(step * ratio, step),
            },
            effects,
        }
    }
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

/// Makes at most ten steps; an error is as good as an end, if it shows.
fn a_few_steps(scene: &Scene) -> Result<(), TestCaseError> {
    let (built, all) = (scene.built().unwrap(), scene.schedule());
    let (system, schedule) = (built.system().mechanism(), Schedule { steps: all.steps.min(10), ..all });
    let mut state = system.state(&built.q, &built.v);
    let run = piece_by_piece(0, &*system, &schedule, &mut state, |piece, Piece { steps, schedule }, state| {
        make_steps(piece, &mut *piece.general_map(), &schedule, steps, state, &mut ())
    });
    match run {
        Ok(made) => prop_assert!(made == schedule.steps && state.v().iter().all(|v| v.is_finite())),
        Err(error) => prop_assert!(!error.to_string().is_empty()),
    }
    Ok(())
}

proptest! {
    #[test]
    fn scenes_come_back_from_their_text(scene in scenes()) {
        let text = scene.to_toml().unwrap();
        let back = Scene::parse(&text, "random.toml", METHODS);
        match back {
            // An energy that is too large for a number is refused.
            Err(error @ SceneError::OutOfRange(_)) => {
                let told = error.to_string();
                prop_assert!(told.contains("too large for a number") || told.contains("not a finite number"), "{}", told);
            }
            back => prop_assert_eq!(back, Ok(scene), "{}", text),
        }
    }

    #[test]
    #[ignore = "slow"]
    fn scenes_run_or_say_why_not_in_full(scene in scenes()) {
        a_few_steps(&scene)?;
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
    fn mutated_scenes_parse_or_explain(
        scene in scenes(),
        (at, removed, inserted) in (any::<prop::sample::Index>(), 0_usize..12, "[\\[\\]={},.#0-9a-z\"\n-]{0,4}"),
    ) {
        let mut text = scene.to_toml().unwrap();
        let boundaries: Vec<_> = text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
        let start = at.index(boundaries.len());
        let end = (start + removed).min(boundaries.len() - 1);
        text.replace_range(boundaries[start]..boundaries[end], &inserted);
        parses_or_explains(&text)?;
    }

    #[test]
    fn any_text_parses_or_explains(text in any::<String>(), lines in prop::collection::vec("[\\[\\]=\"'a-e.\r \n\t{}0-9é漢]{0,20}", 0..5)) {
        parses_or_explains(&text)?;
        parses_or_explains(&lines.join("\n"))?;
    }

    #[test]
    #[ignore = "slow"]
    fn long_lines_and_deep_nests_parse_or_explain_at_length(length in 0_usize..20_000, before in "[a-z.]{1,10}") {
        long_and_deep(length, &before)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn scenes_run_or_say_why_not(scene in scenes()) {
        a_few_steps(&scene)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn long_lines_and_deep_nests_parse_or_explain(length in 0_usize..20_000, before in "[a-z.]{1,10}") {
        long_and_deep(length, &before)?;
    }
}

fn long_and_deep(length: usize, before: &str) -> Result<(), TestCaseError> {
    for part in ["a.", "[", "{a=", "x", "é", "\"", "1", "-"] {
        let long = part.repeat(length);
        parses_or_explains(&format!("{before}{long} = 1"))?;
        parses_or_explains(&format!("{before} = {long}"))?;
        parses_or_explains(&Scene::template().replace("mass = 1.0", &format!("mass = {long}")))?;
    }
    Ok(())
}
