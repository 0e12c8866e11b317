//! Functions of time whose points lie in a file beside the scene.

use scene::{AnyEffect, Scene, SceneEffect, SceneError};
use sleigh::TimeFunction;
use std::fs;

const SCENE: &str = "[sleigh]
mass = 1.0
inertia = 1.0
offset = 0.5
[start]
speed = 1.0
turn_rate = 0.0
[run]
step = 0.1
duration = 2.0
[[effects]]
kind = \"thrust\"
";

/// What a scene in a folder with that file reads.
fn read(points: Option<&str>, force: &str) -> Result<Scene, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    if let Some(points) = points {
        fs::write(folder.path().join("points.csv"), points).unwrap();
    }
    fs::write(&path, format!("{SCENE}force = {force}\n")).unwrap();
    Scene::load(path.to_str().unwrap(), &["dla"])
}

#[test]
fn columns_are_found_by_name_with_or_without_unit() {
    let points = "# measured on a Tuesday\nt [s], left, force [N]\n0.0, 7, 1.5\n0.5, 8, -2\n1e0, 9, 0.25\n";
    for column in ["force", "force [N]"] {
        for (interpolation, linear) in [("", false), (", interpolation = \"linear\"", true)] {
            let force = format!("{{ file = \"points.csv\", columns = [\"t\", \"{column}\"]{interpolation} }}");
            let scene = read(Some(points), &force).unwrap_or_else(|error| panic!("{error}"));
            let [SceneEffect::Acting(AnyEffect::Thrust(thrust))] = &scene.effects[..] else {
                panic!("{:?}", scene.effects)
            };
            let (times, values) = match (&thrust.force, linear) {
                (TimeFunction::Table(table), false) => (table.times(), table.values()),
                (TimeFunction::Ramp(ramp), true) => (ramp.times(), ramp.values()),
                (other, _) => panic!("{other:?}"),
            };
            assert_eq!((times, values), (&[0.0, 0.5, 1.0][..], &[1.5, -2.0, 0.25][..]));
            // The jumps are nodes, and so are the corners of ramps: here at 0.5 and 1.
            assert_eq!(scene.jumps().unwrap().len(), 2);
        }
    }
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    let refused = |points: Option<&str>, force: &str, said: &[&str]| {
        let message = read(points, force).unwrap_err().to_string();
        for words in said {
            assert!(message.contains(words), "{words}: {message}");
        }
    };
    let named = "{ file = \"points.csv\", columns = [\"t\", \"force\"] }";
    refused(None, named, &["`effects.thrust.force.file` cannot be read", "points.csv"]);
    refused(Some("t,other\n0,1\n"), named, &["name `force`, which the file does not have", "two of `t`, `other`"]);
    refused(Some("t,force\n0,1\n1,one\n"), named, &["no number in line 3", "one"]);
    refused(Some("t,force\n0,1\n1\n"), named, &["is not a table", "line: 3"]);
    refused(Some("t,force\n1,1\n0,1\n"), named, &["the times do not increase"]);
    refused(Some("t,force\n"), named, &["the table has no times"]);
    refused(Some("t,force\n0,inf\n"), named, &["is not finite"]);
    refused(Some(""), named, &["name `t`"]);
    refused(Some("t,force\n0,1\n"), "{ file = \"points.csv\" }", &["columns` is missing"]);
    refused(Some("t,force\n0,1\n"), "{ file = \"points.csv\", columns = [\"t\"] }", &["a list of two names"]);
    refused(Some("t,force\n0,1\n"), "{ file = \".\", columns = [\"t\", \"force\"] }", &["not a file"]);
    refused(Some("t,force\n0,1\n"), "{ file = \"points.csv\", times = [0.0] }", &["does not go with"]);
    refused(
        None,
        "{ times = [0.0], values = [1.0], interpolation = \"cubic\" }",
        &["not a known interpolation", "`\"linear\"`"],
    );
    refused(None, "\"0.2*x\"", &["not a function of the time `t`", "no name `x`"]);
}
