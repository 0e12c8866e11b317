//! docs/scene.schema.json and the program say the same of a scene.

mod dictionary;
mod validator;

use scene::{AnyScene, EFFECTS, EffectInfo, Scene, SceneEffect, SceneError, TextScene, bundled, bundled_texts};
use serde_json::Value;
use validator::validate;

const SCHEMA: &str = include_str!("../../../../docs/scene.schema.json");
const METHODS: &[&str] = &["dla", "dla-alpha"];

const HEAD: &str = "title = \"A test\"
[sleigh]
mass = 1.0
inertia = 2
offset = 0.5
[start]
x = 0.0
y = 0.0
heading = 0.5
speed = -1.0
turn_rate = 0.1
[run]
method = \"dla-alpha\"
alpha = 0.5
step = 0.05
duration = 2.0
";

/// What is wrong wherever it stands: a text of the scene, and what it becomes.
const MUTANTS: &[(&str, &str)] = &[
    ("title = \"A test\"", "title = 1"),
    ("title", "tittle"),
    ("[sleigh]\nmass = 1.0\n", "[sleigh]\n"),
    ("mass = 1.0", "mass = 0.0"),
    ("mass = 1.0", "mass = \"1 kg\""),
    ("inertia = 2", "inertia = -2"),
    ("offset = 0.5", "offset = [0.5]"),
    ("offset = 0.5", "offset = 0.5\ncolour = 1"),
    ("x = 0.0", "x = true"),
    ("speed = -1.0\n", ""),
    ("speed = -1.0", "x_dot = -1.0"),
    ("speed = -1.0", "speed = -1.0\nx_dot = 0.0"),
    ("speed = -1.0", "speed = 0.0\nx_dot = 0.0\ny_dot = 0.0"),
    ("[start]", "[begin]"),
    ("method = \"dla-alpha\"", "method = 2"),
    ("alpha = 0.5", "alpha = 1.5"),
    ("step = 0.05", "step = 0"),
    ("duration = 2.0", ""),
];

/// Every kind of effect, in all of its forms, and the errors of each.
const ENTRIES: &[(&str, &[(&str, &str)])] = &[
    ("kind = \"slope\"\ngravity = [1.0, 0]", &[("[1.0, 0]", "1.0"), ("[1.0, 0]", "[1.0]"), ("slope", "slopes")]),
    ("kind = \"bowl\"\nstiffness = [1.0, 0.0]", &[("[1.0, 0.0]", "[1.0, 0.0, 0.0]"), ("kind = \"bowl\"\n", "")]),
    ("kind = \"bowl\"\nstiffness = [1.0, 1.0]\ncenter = [0.0, 1.0]", &[("[0.0, 1.0]", "[0.0, \"1\"]")]),
    (
        "kind = \"egg_crate\"\nheight = 0.5\nwave_number = [1.0, 2.0]",
        &[("height = 0.5\n", ""), ("height", "depth"), ("[1.0, 2.0]", "1.0")],
    ),
    (
        "kind = \"hills\"\nhills = [{ height = -1.0, x = 0.0, y = 0.0, width = 1.0 }]",
        &[
            ("width = 1.0", "width = 0.0"),
            ("x = 0.0, ", ""),
            ("width", "size"),
            ("[{ height = -1.0, x = 0.0, y = 0.0, width = 1.0 }]", "2.0"),
        ],
    ),
    ("kind = \"flywheel\"\ninertia = 0.5", &[("0.5", "0.0"), ("inertia", "mass")]),
    (
        "kind = \"flywheel\"\ninertia = 0.5\nrotor_rate = 1.0\ntorque = { amplitude = 1.0, frequency = 2.0 }",
        &[("amplitude = 1.0, ", ""), ("frequency = 2.0", "frequency = 2.0, times = [0.0], values = [1.0]")],
    ),
    ("kind = \"drag\"\nalong = 0.0", &[("along = 0.0", ""), ("0.0", "-1.0")]),
    ("kind = \"drag\"\nturning = 0.1", &[("turning", "pivoting")]),
    ("kind = \"thrust\"\nforce = -0.5", &[("force", "thrust"), ("-0.5", "true"), ("force = -0.5", "")]),
    ("kind = \"quadratic_drag\"\nalong = 0.2", &[("along = 0.2", ""), ("0.2", "-0.2")]),
    (
        "kind = \"friction\"\nalong = 0.5\nsmoothing = 0.001\nturning = 0.1\nturning_smoothing = 0.002",
        &[("0.001", "0.0"), ("0.002", "-1.0"), ("turning_smoothing", "smooth")],
    ),
    ("kind = \"thrust\"\nforce = \"0.2*t\"", &[("\"0.2*t\"", "[\"0.2*t\"]")]),
    (
        "kind = \"thrust\"\nforce = { times = [0.0, 1.0], values = [1.0, 2.0], interpolation = \"linear\" }",
        &[("linear", "cubic"), ("times", "file"), ("\"linear\"", "1.0")],
    ),
    (
        "kind = \"thrust\"\nforce = { times = [0.0, 1.0], values = [1.0, 2.0] }",
        &[(", values = [1.0, 2.0]", ""), ("[0.0, 1.0]", "[]"), ("values", "forces")],
    ),
    ("kind = \"torque\"\ntorque = { amplitude = 1.0, frequency = 2.0, phase = 0.5 }", &[("phase", "shift")]),
    (
        "kind = \"moving_mass\"\nmass = 0.5\nx = 0.3\ny = { amplitude = 0.4, frequency = 2.0 }",
        &[("mass = 0.5\n", ""), ("mass = 0.5", "mass = 0"), ("0.3", "{ times = [0.0, 1.0], values = [0.0, 1.0] }")],
    ),
    (
        "kind = \"moving_mass\"\nmass = 0.5\ny = { times = [0.0], values = [1.0] }",
        &[("\ny = { times = [0.0], values = [1.0] }", "")],
    ),
    ("kind = \"servo\"\nspeed = 1.0", &[("speed = 1.0", ""), ("speed", "velocity")]),
    ("kind = \"servo\"\nspeed = 1.0\nturn_rate = { amplitude = 1, frequency = 2 }", &[("turn_rate", "rate")]),
    (
        "kind = \"tracer\"\npath = { circle = { radius = 0.3, center = [0.0, 1.0] }, period = 2.0 }",
        &[
            (", period = 2.0", ""),
            ("radius = 0.3", "radius = 0.0"),
            ("period = 2.0", "period = 2.0, polygon = [[0.0, 0.0], [1.0, 0.0]]"),
            ("circle = { radius = 0.3, center = [0.0, 1.0] }, ", ""),
        ],
    ),
    (
        "kind = \"tracer\"\npath = { polygon = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], period = 8.0 }",
        &[("[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]", "[[0.0, 0.0]]"), ("[1.0, 1.0]", "[1.0]")],
    ),
    ("kind = \"turntable\"\nrate = 0.2", &[("rate = 0.2", ""), ("rate = 0.2", "rate = 0.2\nrate_2 = 1")]),
    (
        "kind = \"trailers\"\ncount = 2\nmass = 0.5\ninertia = [0.1, 0.2]\nhitch = -0.1\nbar = 0.8\nheadings = [0.3]",
        &[
            ("count = 2\n", ""),
            ("count = 2", "count = 0"),
            ("mass = 0.5\n", ""),
            ("mass = 0.5", "mass = [0.5, 0.0]"),
            ("[0.1, 0.2]", "[]"),
            ("bar = 0.8", "bar = 0.0"),
            ("hitch", "hinge"),
        ],
    ),
];

/// A system of text with all of its keys.
const TEXT: &str = "title = \"A skate\"
[system]
coordinates = { x = \"m\", y = \"m\", theta = \"angle\" }
parameters = { m = 1.0, J = 2 }
tables = { push = { times = [0.0, 1.0], values = [1.0, 2.0], interpolation = \"linear\" } }
let = { c = \"cos(theta)\", s = \"sin(theta)\" }
lagrangian = \"m/2*(x'^2 + y'^2) + J/2*theta'^2\"
constraints = [\"y'*c - x'*s\"]
positions = []
forces = { theta = \"-0.1*theta'\" }
basis = [[\"c\", \"s\", \"0\"], [\"0\", \"0\", \"1\"]]
outputs = { speed = \"x'*c + y'*s\" }
[start]
x = 0.5
\"x'\" = 1
[run]
step = 0.05
duration = 2.0
";

/// What is wrong with it, as far as a schema can know.
const OF_TEXT: &[(&str, &str)] = &[
    ("x = \"m\"", "x = 1"),
    ("m = 1.0", "m = \"1\""),
    ("let", "lets"),
    (", values = [1.0, 2.0]", ""),
    ("\"linear\"", "\"cubic\""),
    ("{ times = [0.0, 1.0], values = [1.0, 2.0], interpolation = \"linear\" }", "1.0"),
    ("lagrangian = \"m/2*(x'^2 + y'^2) + J/2*theta'^2\"\n", ""),
    ("[\"y'*c - x'*s\"]", "\"y'*c - x'*s\""),
    ("theta = \"-0.1*theta'\"", "theta = -0.1"),
    ("[\"0\", \"0\", \"1\"]]", "\"1\"]"),
    ("positions = []", "positions = [0.0]"),
    ("x = 0.5", "x = \"0.5\""),
    ("[run]\nstep = 0.05\nduration = 2.0\n", ""),
    ("[start]", "[[effects]]\nkind = \"drag\"\nalong = 1.0\n[start]"),
    ("[start]", "[sleigh]\nmass = 1.0\n[start]"),
];

fn schema() -> Value {
    serde_json::from_str(SCHEMA).unwrap()
}

/// What the schema says of a scene.
fn valid(text: &str) -> Result<(), String> {
    let schema = schema();
    let value: Value = toml::from_str(text).map_err(|error| error.to_string())?;
    validate(&schema, &schema, &value)
}

/// Both accept the scene, and neither accepts any of its mutants.
fn check(text: &str, mutants: &[(&str, &str)]) {
    valid(text).unwrap_or_else(|error| panic!("{error}"));
    AnyScene::parse(text, "scene.toml", METHODS).unwrap_or_else(|error| panic!("{error}"));
    for (from, to) in mutants {
        let mutant = text.replacen(from, to, 1);
        assert_ne!(mutant, text, "{from}");
        assert!(toml::from_str::<Value>(&mutant).is_ok(), "a mutant is TOML still: {mutant}");
        assert!(valid(&mutant).is_err(), "the schema accepts {from:?} as {to:?}");
        assert!(AnyScene::parse(&mutant, "scene.toml", METHODS).is_err(), "the program accepts {from:?} as {to:?}");
    }
}

#[test]
fn bundled_scenes_and_the_template_are_valid() {
    for text in bundled()
        .iter()
        .chain(bundled_texts())
        .map(|scene| scene.text)
        .chain([Scene::template(), TextScene::template()])
    {
        valid(text).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn what_is_wrong_is_wrong_to_both() {
    check(HEAD, MUTANTS);
    for (entry, mutants) in ENTRIES {
        // The effect alone is what changes.
        let text = format!("[[effects]]\n{entry}\n\n{}", HEAD.replacen("title = \"A test\"\n", "", 1));
        check(&text, mutants);
        // Each row of the table reads the effect of its name, and no other.
        let scene = Scene::parse(&text, "scene.toml", METHODS).unwrap();
        let kinds: Vec<&str> = scene.effects.iter().map(SceneEffect::kind).collect();
        assert!(kinds.len() == 1 && entry.starts_with(&format!("kind = \"{}\"", kinds[0])), "{entry}: {kinds:?}");
    }
}

#[test]
fn a_system_of_text_is_right_or_wrong_to_both() {
    check(TEXT, OF_TEXT);
    let named = TEXT.replacen("[\"y'*c - x'*s\"]", "{ edge = \"y'*c = x'*s\" }", 1).replacen(
        "{ speed = \"x'*c + y'*s\" }",
        "{ speed = { formula = \"x'*c + y'*s\", unit = \"m/s\" } }",
        1,
    );
    let mutants = [
        ("edge = \"y'*c = x'*s\"", "edge = 1"),
        ("unit = \"m/s\"", "unit = 1"),
        ("formula = \"x'*c + y'*s\", ", ""),
        ("unit = ", "units = "),
    ];
    check(&named, &mutants);
}

#[test]
fn every_kind_has_its_keys_and_an_entry_here() {
    let schema = schema();
    let kinds: Vec<&str> = EFFECTS.iter().map(|info| info.name).collect();
    let named: Vec<&str> = schema["$defs"]["sleigh_scene"]["properties"]["effects"]["items"]["oneOf"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["$ref"].as_str().unwrap().strip_prefix("#/$defs/").unwrap())
        .collect();
    assert_eq!(named, kinds);
    for EffectInfo { name: kind, keys, .. } in EFFECTS {
        let properties: Vec<&str> =
            schema["$defs"][kind]["properties"].as_object().unwrap().keys().map(String::as_str).collect();
        let mut expected: Vec<&str> = ["kind"].iter().chain(*keys).copied().collect();
        let mut found = properties;
        expected.sort_unstable();
        found.sort_unstable();
        assert_eq!(found, expected, "{kind}");
        assert!(ENTRIES.iter().any(|(entry, _)| entry.starts_with(&format!("kind = \"{kind}\""))), "{kind}");
    }
}

#[test]
fn every_table_has_its_keys() {
    let schema = schema();
    for table in ["", "sleigh", "start", "run"] {
        // What the program accepts, it says when it finds something else.
        let text = if table.is_empty() {
            format!("zzz = 1\n{HEAD}")
        } else {
            HEAD.replacen(&format!("[{table}]\n"), &format!("[{table}]\nzzz = 1\n"), 1)
        };
        let Err(SceneError::UnknownKey(finding)) = Scene::parse(&text, "scene.toml", METHODS) else {
            panic!("{table}")
        };
        let whole = &schema["$defs"]["sleigh_scene"];
        let place = if table.is_empty() { whole } else { &whole["properties"][table] };
        let keys: Vec<&str> = place["properties"].as_object().unwrap().keys().map(String::as_str).collect();
        let said: Vec<&str> = finding
            .accepted
            .split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .filter(|word| !word.is_empty())
            .collect();
        let sorted = |mut words: Vec<&str>| {
            words.sort_unstable();
            words.iter().map(|word| (*word).to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(sorted(keys), sorted(said), "{table}");
    }
}
