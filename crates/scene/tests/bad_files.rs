//! What is wrong with a file is said with its line, its field and what is accepted.

use approx::assert_abs_diff_eq;
use scene::{Scene, SceneError};

const METHODS: &[&str] = &["dla", "dla-alpha", "rk4"];

/// Every line is addressed by the tests below: keep the numbers.
const GOOD: &str = r#"title = "Good"
[sleigh]
mass = 1.0
inertia = 1.0
offset = 0.5
[start]
x = 0.0
speed = -1.0
turn_rate = 0.1
[run]
method = "dla"
step = 0.05
duration = 40.0
"#;

/// Of a full velocity the part along the blade counts; on a plane that turns, the sideways part is the plane's.
#[test]
fn a_velocity_in_full() {
    let parse = |text: &str| Scene::parse(text, "good.toml", METHODS).unwrap();
    let heading = |text: &str| text.replace("x = 0.0", "x = 0.5\ny = -2\nheading = 2.1");
    let (sin, cos) = 2.1_f64.sin_cos();
    let full = |x: f64, y: f64| heading(GOOD).replace("speed = -1.0", &format!("x_dot = {x:?}\ny_dot = {y:?}"));
    let mut given = parse(&full(-cos, -sin));
    assert_abs_diff_eq!(given.start.speed, -1.0, epsilon = 2.0 * f64::EPSILON);
    given.start.speed = -1.0;
    assert_eq!(given, parse(&heading(GOOD)));
    // The plane moves with 3 (2, 0.5) m/s at the contact point.
    let table = "[[effects]]\nkind = \"turntable\"\nrate = 3.0\n";
    let turning = parse(&(full(6.0 - cos, 1.5 - sin) + table));
    assert_abs_diff_eq!(turning.start.speed, 6.0 * cos + 1.5 * sin - 1.0, epsilon = 16.0 * f64::EPSILON);
    assert!(Scene::parse(&(full(-cos, -sin) + table), "good.toml", METHODS).is_err());
}

/// The error of the good file with one part replaced.
fn error(replaced: &str, by: &str) -> SceneError {
    assert_eq!(GOOD.matches(replaced).count(), 1, "{replaced:?} must occur once");
    let text = GOOD.replace(replaced, by);
    match Scene::parse(&text, "dir/bad.toml", METHODS) {
        Ok(scene) => panic!("{by:?} was accepted: {scene:?}"),
        Err(error) => error,
    }
}

/// Replaced part, replacement, line and column, and what the message holds besides: the field first.
type Case = (&'static str, &'static str, (usize, usize), &'static [&'static str]);

const POSITIVE: &str = "greater than 0";

const CASES: &[Case] = &[
    // Numbers out of their range.
    ("mass = 1.0", "mass = -1.0", (3, 8), &["`sleigh.mass`", "must be positive", "found -1.0", POSITIVE, "in kg"]),
    ("mass = 1.0", "mass = 0", (3, 8), &["`sleigh.mass`", "must be positive", "found 0", POSITIVE]),
    ("mass = 1.0", "mass = -0.0", (3, 8), &["`sleigh.mass`", "must be positive"]),
    ("mass = 1.0", "mass = 1e-999", (3, 8), &["`sleigh.mass`", "must be positive", "found 1e-999"]),
    ("mass = 1.0", "mass = nan", (3, 8), &["`sleigh.mass`", "must be finite", "found nan", POSITIVE]),
    ("inertia = 1.0", "inertia = +inf", (4, 11), &["`sleigh.inertia`", "must be finite", "in kg m^2"]),
    ("inertia = 1.0", "inertia = -2", (4, 11), &["`sleigh.inertia`", "must be positive"]),
    ("offset = 0.5", "offset = -inf", (5, 10), &["`sleigh.offset`", "must be finite", "a finite number, in m"]),
    ("offset = 0.5", "offset = 1e999", (5, 10), &["`sleigh.offset`", "must be finite", "found 1e999"]),
    ("offset = 0.5", "offset = 1e200", (5, 10), &["`sleigh.offset`", "inertia + mass * offset^2"]),
    ("speed = -1.0", "speed = nan", (8, 9), &["`start.speed`", "must be finite", "in m/s"]),
    ("speed = -1.0", "x_dot = inf\ny_dot = 0", (8, 9), &["`start.x_dot`", "must be finite", "in m/s"]),
    ("speed = -1.0", "x_dot = -1.0", (6, 1), &["`start.y_dot`", "is missing", "in m/s"]),
    ("speed = -1.0", "speed = -1.0\ny_dot = 0", (9, 9), &["`start.y_dot`", "a second time, beside `speed`"]),
    ("speed = -1.0", "y_dot = 0.5\nx_dot = 2", (8, 9), &["`start.y_dot`", "slip sideways at 0.5 m/s", "`speed = 2.0`"]),
    ("turn_rate = 0.1", "turn_rate = inf", (9, 13), &["`start.turn_rate`", "must be finite", "in rad/s"]),
    ("x = 0.0", "y = nan", (7, 5), &["`start.y`", "must be finite"]),
    ("step = 0.05", "step = 0.0", (12, 8), &["`run.step`", "must be positive", POSITIVE, "in s"]),
    ("step = 0.05", "step = -1", (12, 8), &["`run.step`", "must be positive"]),
    ("step = 0.05", "step = nan", (12, 8), &["`run.step`", "must be finite"]),
    ("step = 0.05", "step = 41", (12, 8), &["`run.step`", "longer than the duration", "at most the duration, 40.0 s"]),
    ("step = 0.05", "step = 3e-11", (12, 8), &["`run.step`", "more than 1e12 steps", "at least 4e-11 s"]),
    ("step = 0.05", "step = 5e-324", (12, 8), &["`run.step`", "more than 1e12 steps"]),
    ("duration = 40.0", "duration = -40.0", (13, 12), &["`run.duration`", "must be positive"]),
    ("duration = 40.0", "duration = 0", (13, 12), &["`run.duration`", "must be positive", "found 0"]),
    ("duration = 40.0", "duration = inf", (13, 12), &["`run.duration`", "must be finite"]),
    ("method = \"dla\"", "alpha = 1.5", (11, 9), &["`run.alpha`", "between 0 and 1", "a number from 0 to 1"]),
    ("method = \"dla\"", "alpha = -0.1", (11, 9), &["`run.alpha`", "between 0 and 1"]),
    // Wrong types.
    ("mass = 1.0", "mass = \"1.0\"", (3, 8), &["`sleigh.mass`", "wrong type", "found a string", POSITIVE]),
    ("mass = 1.0", "mass = [1.0]", (3, 8), &["`sleigh.mass`", "found a list"]),
    ("mass = 1.0", "mass = true", (3, 8), &["`sleigh.mass`", "found a truth value"]),
    ("mass = 1.0", "mass = 1979-05-27", (3, 8), &["`sleigh.mass`", "found a date or time"]),
    ("mass = 1.0", "mass = { kg = 1.0 }", (3, 8), &["`sleigh.mass`", "found a table"]),
    ("method = \"dla\"", "method = 4", (11, 10), &["`run.method`", "found an integer", "`dla`, `dla-alpha`, `rk4`"]),
    ("\"Good\"", "1.5", (1, 9), &["`title`", "found a number", "a string"]),
    ("title = \"Good\"", "effects = 3", (1, 11), &["`effects`", "found an integer", "`[[effects]]`"]),
    ("title = \"Good\"", "effects = [1]", (1, 12), &["`effects`", "found an integer", "`[[effects]]`"]),
    ("[run]", "[[run]]", (10, 1), &["`run`", "found a list", "the table `[run]`"]),
    // Names.
    ("\"dla\"", "\"dal\"", (11, 10), &["`run.method`", "found \"dal\"", "`dla-alpha`, `rk4`", "did you mean `dla`?"]),
    ("\"dla\"", "\"\"", (11, 10), &["`run.method`", "one of `dla`"]),
    (
        "duration = 40.0\n",
        "duration = 40.0\n[[effects]]\nkind = \"bow\"\nstiffness = 1",
        (15, 8),
        &["`effects.kind`", "\"bow\"", "`slope`, `bowl`", "did you mean `bowl`?"],
    ),
    (
        "duration = 40.0\n",
        "duration = 40.0\n\n[[effects]]\nstiffness = 1",
        (15, 1),
        &["`effects.kind`", "is missing", "one of `slope`"],
    ),
    (
        "title = \"Good\"",
        "effects = [{ kind = 1 }]",
        (1, 21),
        &["`effects.kind`", "found an integer", "one of `slope`"],
    ),
    // Keys that no scene has.
    ("mass = 1.0", "masss = 1.0", (3, 1), &["`sleigh.masss`", "`mass`, `inertia`, `offset`", "did you mean `mass`?"]),
    ("x = 0.0", "turn-rate = 0.0", (7, 1), &["`start.turn-rate`", "did you mean `turn_rate`?"]),
    ("x = 0.0", "\"a b\" = 0.0", (7, 1), &["`start.\"a b\"`", "`heading`"]),
    ("x = 0.0", "mass = 0.0", (7, 1), &["`start.mass`", "belongs in the table `[sleigh]`"]),
    ("step = 0.05", "title = 1", (12, 1), &["`run.title`", "belongs at the top"]),
    ("title = \"Good\"", "titel = \"Good\"", (1, 1), &["`titel`", "did you mean `title`?"]),
    ("[start]", "[strat]", (6, 2), &["`strat`", "did you mean `start`?"]),
    ("[start]", "[sleigh.start]", (6, 9), &["`sleigh.start`", "`mass`, `inertia`, `offset`", "headed `[start]`"]),
    // Functions of time.
    (
        "duration = 40.0\n",
        "duration = 40.0\n[[effects]]\nkind = \"thrust\"\nforce = true",
        (16, 9),
        &[
            "`effects.thrust.force`",
            "a function of time in N",
            "a formula in `t` in quotes",
            "`{times, values, interpolation}`",
        ],
    ),
    (
        "duration = 40.0\n",
        "duration = 40.0\n[[effects]]\nkind = \"servo\"\nspeed = {amplitude = 1e200, frequency = 1.0}",
        (16, 9),
        &["`effects.servo.speed`", "makes the kinetic energy too large", "in m/s"],
    ),
    // Keys and tables that are not there.
    ("mass = 1.0\n", "", (2, 1), &["`sleigh.mass`", "is missing", POSITIVE, "[sleigh]"]),
    ("inertia = 1.0\n", "", (2, 1), &["`sleigh.inertia`", "is missing"]),
    ("offset = 0.5\n", "", (2, 1), &["`sleigh.offset`", "is missing", "a finite number, in m"]),
    ("speed = -1.0\n", "", (6, 1), &["`start.speed`", "is missing", "[start]"]),
    ("turn_rate = 0.1\n", "", (6, 1), &["`start.turn_rate`", "is missing"]),
    ("step = 0.05\n", "", (10, 1), &["`run.step`", "is missing", "[run]"]),
    ("duration = 40.0\n", "", (10, 1), &["`run.duration`", "is missing"]),
    (
        "[start]\nx = 0.0\nspeed = -1.0\nturn_rate = 0.1\n",
        "",
        (1, 1),
        &["`start`", "is missing", "the table `[start]`"],
    ),
    // Not TOML.
    ("mass = 1.0", "mass = ", (3, 8), &["`sleigh.mass` is not TOML", POSITIVE, "in kg"]),
    ("mass = 1.0", "mass 1.0", (3, 6), &["mass 1.0", "accepted: `=`"]),
    ("mass = 1.0", "mass = 1.0 kg", (3, 8), &["`sleigh.mass` is not TOML", POSITIVE, "in kg"]),
    ("mass = 1.0", "mass = 1,0", (3, 9), &["`sleigh.mass` is not TOML", POSITIVE]),
    ("mass = 1.0", "mass = 1e", (3, 10), &["`sleigh.mass`", POSITIVE]),
    ("\"dla\"", "dla", (11, 10), &["`run.method` is not TOML: string values must be quoted", "a string in quotes"]),
    ("inertia = 1.0", "mass = 1.0", (4, 1), &["duplicate key", "once"]),
    ("[start]", "[start", (6, 7), &["[start"]),
    ("\"Good\"", "\"Good", (1, 14), &["`title` is not TOML", "a string in quotes"]),
];

#[test]
fn errors_name_line_field_and_what_is_accepted() {
    for &(replaced, by, (line, column), fragments) in CASES {
        let error = error(replaced, by);
        let text = error.to_string();
        let place = error.finding().and_then(|finding| finding.place).map(|place| (place.line, place.column));
        assert_eq!(place, Some((line, column)), "{by:?}:\n{text}");
        assert_eq!(error.origin(), "dir/bad.toml");
        let at = format!("dir/bad.toml:{line}:{column}\n");
        for fragment in fragments.iter().copied().chain([at.as_str(), "= accepted: "]) {
            assert!(text.contains(fragment), "no {fragment:?} for {by:?} in:\n{text}");
        }
    }
}

/// A key of another table is known as such in the tables of a scene, and an effect has keys of its own.
#[test]
fn a_key_of_an_effect_is_not_sent_to_another_table() {
    let sent = |error: SceneError| error.to_string().contains("belongs in the table");
    assert!(sent(error("x = 0.0", "mass = 0.0")));
    assert!(!sent(with_effect(0.05, 40.0, "kind = \"bowl\"\nstiffness = 1.0\nduration = 1.0").unwrap_err()));
}

#[test]
fn an_error_reads_like_this() {
    let expected = "\
`sleigh.mass` must be positive
 --> dir/bad.toml:3:8
  |
3 | mass = -1.0
  |        ^^^^ found -1.0
  |
  = accepted: a finite number greater than 0, in kg";
    assert_eq!(error("mass = 1.0", "mass = -1.0").to_string(), expected);
}

#[test]
fn the_data_of_an_error_say_what_its_text_says() {
    let error = error("method = \"dla\"", "method = \"rk5\"");
    assert!(matches!(error, SceneError::UnknownName(_)));
    let finding = error.finding().unwrap();
    assert_eq!(finding.field.as_deref(), Some("run.method"));
    assert_eq!(finding.found.as_deref(), Some("\"rk5\""));
    assert_eq!(finding.accepted, "one of `dla`, `dla-alpha`, `rk4`");
    assert_eq!(finding.help.as_deref(), Some("did you mean `rk4`?"));
}

#[test]
fn empty_texts_are_empty_scenes() {
    for text in ["", "\n\n", "# nothing\r\n", "\u{feff}", "\u{feff}# nothing"] {
        let error = Scene::parse(text, "empty.toml", METHODS).unwrap_err();
        let message = error.to_string();
        assert!(matches!(error, SceneError::Missing(_)));
        for fragment in ["the scene is empty", "empty.toml:1:1", "`[sleigh]` or `[system]`, `[start]` and `[run]`"] {
            assert!(message.contains(fragment), "{text:?}:\n{message}");
        }
    }
}

#[test]
fn places_do_not_depend_on_the_ends_of_lines() {
    let windows = format!("\u{feff}{}", GOOD.replace('\n', "\r\n"));
    let scene = Scene::parse(&windows, "windows.toml", METHODS).unwrap();
    assert_eq!(scene, Scene { name: "windows".to_owned(), ..Scene::parse(GOOD, "good.toml", METHODS).unwrap() });
    let error = Scene::parse(&windows.replace("mass = 1.0", "mass = -1.0"), "windows.toml", METHODS).unwrap_err();
    assert!(error.to_string().contains("windows.toml:3:8\n"), "{error}");
}

#[test]
fn methods_are_those_of_the_caller() {
    let error = Scene::parse(&GOOD.replace("method = \"dla\"\n", ""), "bad.toml", &["rk4"]).unwrap_err();
    let text = error.to_string();
    // The default is not accepted here, and the file has no line to blame but the table's header.
    assert!(
        text.contains("bad.toml:10:1\n") && text.contains("found \"dla\"") && text.contains("one of `rk4`"),
        "{text}"
    );
}

#[test]
fn errors_cross_threads() {
    fn check<E: std::error::Error + Send + Sync + 'static>() {}
    check::<SceneError>();
}

/// The good scene with another step and duration, and one effect.
fn with_effect(step: f64, duration: f64, effect: &str) -> Result<Scene, SceneError> {
    let text = GOOD.replace("step = 0.05", &format!("step = {step:?}"));
    let text = text.replace("duration = 40.0", &format!("duration = {duration:?}"));
    Scene::parse(&format!("{text}[[effects]]\n{effect}\n"), "dir/bad.toml", METHODS)
}

/// Jumps may be at any time: at a node of equal steps the run has them, elsewhere each piece has steps of its own, none longer.
#[test]
fn a_jump_has_a_node_wherever_it_is() {
    let table = |time: f64| format!("kind = \"thrust\"\nforce = {{times = [0.0, {time:?}], values = [1.0, 2.0]}}");
    for (step, time) in [(0.01, 613_296.69), (0.05, 793_484.2), (0.1, 4_341_178.1)] {
        let equal = with_effect(step, 1e7, &table(time)).unwrap();
        assert_eq!((equal.schedule().step.to_bits(), equal.schedule().steps), (step.to_bits(), equal.run.steps()));
        let own = with_effect(step, 1e7, &table(time + 0.3 * step)).unwrap().schedule();
        assert_eq!(own.steps, equal.run.steps() + 1);
        let pieces = dla::smooth_pieces(&own, vec![time + 0.3 * step]).unwrap();
        assert_eq!(pieces.len(), 2);
        assert!(pieces.iter().all(|piece| piece.schedule.step <= step * (1.0 + 1e-9)), "{pieces:?}");
    }
}

/// A path has no more corners in a run than memory holds.
#[test]
fn a_path_of_too_many_corners_is_refused() {
    for period in ["1e-300", "1e-12"] {
        let path = format!("kind = \"tracer\"\npath = {{polygon = [[0, 0], [1, 0], [1, 1]], period = {period}}}");
        let error = with_effect(0.05, 40.0, &path).unwrap_err().to_string();
        assert!(error.contains("`run.duration` has more than 1e6 corners") && error.contains(period), "{error}");
        // A million corners, three in each period.
        let most = 1e6 / 3.0 * period.parse::<f64>().unwrap();
        assert!(error.contains(&format!("at most {most:e} s")), "{error}");
    }
    let quick = "kind = \"tracer\"\npath = {polygon = [[0, 0], [1, 0], [1, 1]], period = 0.04}";
    assert!(with_effect(0.05, 40.0, quick).unwrap().schedule().steps >= 3000);
    let slow = "kind = \"tracer\"\npath = {polygon = [[0, 0], [1, 0]], period = 1.0}";
    assert!(with_effect(0.05, 40.0, slow).is_ok());
}
