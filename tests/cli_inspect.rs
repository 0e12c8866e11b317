//! `noslip check`, `noslip list` and `noslip new`.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

#[path = "common/program.rs"]
mod program;

use program::{Folder, SCENE, SCENES, keys, methods};

#[test]
fn check_says_what_a_scene_is() {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    for scene in SCENES {
        assert!(folder.done(&format!("check {scene}")).starts_with(&format!("{scene}: valid")));
    }
    let text = folder.done("check scene.toml");
    for fact in ["A test", "1 kg", "0.5 m", "0.50625 J", "2 s in 40 steps of 0.05 s", "dla"] {
        assert!(text.contains(fact), "{fact}: {text}");
    }
    // A path is a file even where a bundled scene has that name.
    folder.write("turnaround", SCENE);
    assert!(folder.done("check turnaround").contains("turns around"));
    assert!(folder.done("check ./turnaround").contains("A test"));
}

#[test]
fn lists_are_the_same_as_text_and_as_json() {
    let folder = Folder::new();
    let listed = folder.json("list methods --json");
    let text = folder.done("list methods");
    assert_eq!(text.lines().count(), listed.as_array().unwrap().len());
    for (line, method) in text.lines().zip(listed.as_array().unwrap()) {
        assert_eq!(keys(method), ["name", "order", "keeps", "summary", "reference"]);
        assert!(line.starts_with(method["name"].as_str().unwrap()), "{line}");
        assert!(line.contains(&format!("order {}", method["order"])), "{line}");
        for key in ["keeps", "summary", "reference"] {
            assert!(!method[key].as_str().unwrap().is_empty(), "{method}");
        }
    }
    let baselines = ["rk4", "rk4-projected", "rk4-reduced", "implicit-midpoint", "dop853"];
    for baseline in ["dla", "dla-trapezoid", "dla-alpha"].into_iter().chain(baselines) {
        assert!(methods().iter().any(|name| name == baseline), "{baseline}");
    }

    let scenes = folder.json("list scenes --json");
    let text = folder.done("list scenes");
    for ((scene, line), name) in scenes.as_array().unwrap().iter().zip(text.lines()).zip(SCENES) {
        assert_eq!(scene["name"].as_str(), Some(name));
        assert!(line.starts_with(name) && line.ends_with(scene["title"].as_str().unwrap()), "{line}");
    }
    assert_eq!((scenes.as_array().unwrap().len(), text.lines().count()), (3, 3));

    assert!(folder.json("list effects --json").is_array());
    assert!(!folder.done("list effects").is_empty());
}

#[test]
fn a_new_scene_is_valid_runs_and_is_never_overwritten_unasked() {
    let folder = Folder::new();
    assert!(folder.done("new my.toml").contains("my.toml"));
    assert!(folder.done("check my.toml").starts_with("my: valid"));
    assert_eq!(folder.json("run my.toml --json")["scene"].as_str(), Some("my"));
    let template = folder.read("my.toml");

    folder.write("my.toml", "mine");
    folder.refused("new my.toml", &["my.toml", "exists already", "--force"]);
    assert_eq!(folder.read("my.toml"), "mine");
    folder.done("new my.toml --force");
    assert_eq!(folder.read("my.toml"), template);

    let outcome = folder.line("new none/my.toml");
    assert_eq!((outcome.code, outcome.stdout.as_str()), (1, ""));
    outcome.assert_told("new", &["none/my.toml"]);
    assert_eq!(folder.names(), ["my.toml"]);
}

#[cfg(unix)]
#[test]
fn a_new_scene_has_the_rights_of_a_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    folder.done("new my.toml");
    folder.write("other.toml", "");
    let rights = |name: &str| std::fs::metadata(folder.join(name)).unwrap().permissions().mode();
    assert_eq!(rights("my.toml"), rights("other.toml"));
}

#[test]
fn help_and_version_are_results() {
    let folder = Folder::new();
    assert_eq!(folder.done("--version"), format!("noslip {}\n", env!("CARGO_PKG_VERSION")));
    for command in ["run", "compare", "check", "list", "new"] {
        assert!(folder.done("--help").contains(command));
        assert!(folder.done(&format!("{command} --help")).contains("Usage: noslip"));
    }
}
