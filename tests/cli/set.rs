//! `--set`, `-` for the standard input, `check` of several scenes, `diff`, `completions`, `man`, colours.

use crate::program::{Folder, Outcome, SCENE, keys};
use serde_json::Value;
use std::io::Write;
use std::process::Stdio;

#[test]
fn a_setting_counts_as_the_line_of_a_file_does() {
    let folder = Folder::new();
    folder.write("slow.toml", SCENE.replace("speed = -1.0", "speed = -0.5").replace("offset = 0.5", "offset = 0.25"));
    folder.write("fast.toml", SCENE);
    let timeless = |line: &str| {
        let mut object = folder.json(line);
        object["wall_seconds"] = Value::Null;
        object["scene"] = Value::Null;
        object
    };
    let written = timeless("run slow.toml --json");
    assert_eq!(timeless("run fast.toml --set start.speed=-0.5 --set sleigh.offset=0.25 --json"), written);
    assert_ne!(timeless("run fast.toml --json"), written);
    // A flag comes after settings.
    assert_eq!(folder.json("run fast.toml --set run.step=0.5 --step 0.1 --json")["steps"], 20);
    assert_eq!(folder.json("run fast.toml --set run.step=0.5 --json")["steps"], 4);
    let outcome = folder.line("run fast.toml --set sleigh.mass=-1");
    outcome.assert_refused("set", &["fast.toml --set sleigh.mass=-1: `sleigh.mass` must be positive"]);
    folder.refused("run fast.toml --set mass", &["--set", "KEY=VALUE"]);
}

/// A file that is no TOML is refused at its own line, whatever is set.
#[test]
fn settings_do_not_hide_a_broken_file() {
    let folder = Folder::new();
    folder.write("broken.toml", SCENE.replace("offset = 0.5", "offset = = 0.5"));
    let plain = folder.line("run broken.toml");
    plain.assert_refused("broken", &["--> broken.toml:", "offset = = 0.5"]);
    assert_eq!(folder.line("run broken.toml --set run.step=0.1").stderr, plain.stderr);
}

#[test]
fn every_command_that_reads_a_scene_takes_settings() {
    let folder = Folder::new();
    let wrong = "--set sleigh.mass=-1";
    for line in [
        "run bowl",
        "compare bowl",
        "precision bowl",
        "cost bowl",
        "equilibria bowl",
        "phase planimeter",
        "lyapunov bowl",
        "section bowl --plane y=0",
        "check bowl",
    ] {
        folder.refused(&format!("{line} {wrong}"), &["--set sleigh.mass=-1: `sleigh.mass` must be positive"]);
    }
}

#[test]
fn a_scene_comes_from_the_standard_input() {
    let folder = Folder::new();
    let piped = |line: &str, text: &str| {
        let mut command = folder.command(line.split_whitespace());
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
        Outcome::of(child.wait_with_output().unwrap())
    };
    let outcome = piped("run - --json", SCENE);
    let object: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!((outcome.code, &object["scene"], &object["steps"]), (0, &"stdin".into(), &40.into()));
    piped("check -", &SCENE.replace("mass = 1.0", "mass = 0")).assert_refused("-", &["stdin:3:8", "must be positive"]);
}

#[test]
fn check_looks_at_all_scenes() {
    let folder = Folder::new();
    folder.write("bad.toml", SCENE.replace("mass = 1.0", "mass = -1.0"));
    let text = folder.done("check turnaround bowl");
    assert!(text.starts_with("turnaround: valid") && text.contains("\n\nbowl: valid"), "{text}");
    let outcome = folder.line("check bad.toml bowl none.toml");
    assert_eq!(outcome.code, 2);
    assert!(outcome.stdout.starts_with("bowl: valid"), "{outcome:?}");
    outcome.assert_told("check", &["bad.toml:3:8", "none.toml"]);

    let outcome = folder.line("check bowl bad.toml --json");
    assert_eq!(outcome.code, 2);
    let all: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let number = |key: &str| all[1][key].as_u64().unwrap();
    assert_eq!((&all[0]["scene"], &all[0]["valid"], &all[1]["valid"]), (&"bowl".into(), &true.into(), &false.into()));
    assert_eq!((&all[0]["effects"], &all[0]["steps"]), (&serde_json::json!(["bowl"]), &1200.into()));
    assert_eq!((number("line"), number("column"), all[1]["field"].as_str()), (3, 8, Some("sleigh.mass")));
    assert_eq!(folder.json("check bowl --set run.step=0.1 --json")[0]["steps"], 600);
}

#[test]
fn effects_are_listed_with_keys_types_and_units() {
    let folder = Folder::new();
    let (listed, text) = (folder.json("list effects --json"), folder.done("list effects"));
    for effect in listed.as_array().unwrap() {
        assert_eq!(keys(effect), ["name", "keys", "summary", "properties"]);
        let names: Vec<&Value> = effect["properties"].as_array().unwrap().iter().map(|key| &key["name"]).collect();
        assert_eq!(names, effect["keys"].as_array().unwrap().iter().collect::<Vec<_>>());
        assert!(text.contains(&format!(
            "{}: {}",
            effect["name"].as_str().unwrap(),
            effect["summary"].as_str().unwrap()
        )));
        for key in effect["properties"].as_array().unwrap() {
            assert!(key["type"].as_str().is_some_and(|kind| !kind.is_empty()), "{key}");
            assert!(key["required"].is_boolean(), "{key}");
        }
    }
    let bowl = &listed[1]["properties"];
    assert_eq!((&bowl[0]["type"], &bowl[0]["unit"]), (&"[number, number]".into(), &"N/m".into()));
    assert_eq!((&bowl[0]["required"], &bowl[1]["default"]), (&true.into(), &serde_json::json!([0.0, 0.0])));
    assert!(text.contains("stiffness   [number, number]  N/m, required"), "{text}");
}

#[test]
fn a_difference_is_found_in_its_column_and_row() {
    let folder = Folder::new();
    for (name, more) in [("a.csv", "2"), ("a.npz", "2"), ("b.csv", "2 --set start.speed=-1.001"), ("c.csv", "1")] {
        folder.done(&format!("run turnaround --out {name} --duration {more}"));
    }
    let columns = |line: &str| folder.json(line)["columns"].as_array().unwrap().clone();
    // The two formats have the same numbers.
    let same = columns("diff a.csv a.npz --json");
    assert!(same.len() > 5 && same.iter().all(|column| column["same"] == true), "{same:?}");
    folder.done("diff a.csv a.npz --within 0");
    let differing = columns("diff a.csv b.csv --json");
    let speed = differing.iter().find(|column| column["name"] == "speed").unwrap();
    let (a, b, size) =
        (speed["a"].as_f64().unwrap(), speed["b"].as_f64().unwrap(), speed["difference"].as_f64().unwrap());
    assert_eq!(size.to_bits(), (a - b).abs().to_bits());
    assert!((size - 1e-3).abs() < 1e-4, "{speed}");
    let told = folder.line("diff a.csv b.csv --within 1e-9");
    assert_eq!(told.code, 1);
    told.assert_told("diff", &["speed differs by", "more than 1e-9"]);
    assert!(told.stdout.lines().next().unwrap().contains("largest difference"), "{told:?}");
    assert!(folder.done("diff a.csv c.csv").contains("41 and 21 rows: only the first 21 are compared"));
    assert_eq!(folder.line("diff a.csv c.csv --within 1").code, 1);
    folder.refused("diff a.csv none.csv", &["none.csv"]);
    folder.refused("diff a.csv a.txt", &["a.txt", ".csv or .npz"]);
    folder.write("other.csv", "z\n1\n");
    folder.refused("diff a.csv other.csv", &["no column in common"]);
    folder.write("bad.npz", "no archive");
    folder.refused("diff a.csv bad.npz", &["cannot read bad.npz"]);
}

#[test]
fn what_is_no_number_differs_from_numbers_alone() {
    let folder = Folder::new();
    folder.write("a.csv", "# made by hand\nx [m],what,x [m]\n1,one,\n2,two,3\n");
    folder.write("b.csv", "x,what,x\n1,one,\n2.5,two,nan\n");
    let found = folder.json("diff a.csv b.csv --json");
    let columns = found["columns"].as_array().unwrap();
    let names: Vec<&str> = columns.iter().map(|column| column["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["x", "x.1"]);
    assert_eq!((columns[0]["difference"].as_f64(), columns[0]["row"].as_u64()), (Some(0.5), Some(1)));
    assert_eq!((&columns[1]["difference"], columns[1]["row"].as_u64()), (&Value::Null, Some(1)));
    assert!(folder.done("diff a.csv b.csv").contains("inf"));
}

#[test]
fn completions_and_pages_name_every_command() {
    let folder = Folder::new();
    let commands = ["run", "compare", "precision", "check", "diff"];
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = folder.done(&format!("completions {shell}"));
        assert!(commands.iter().all(|command| text.contains(command)) && text.contains("duration"), "{shell}");
    }
    folder.refused("completions none", &["bash"]);
    let page = folder.done("man");
    assert!(page.contains(".TH noslip 1") && commands.iter().all(|command| page.contains(command)), "{page}");
    assert!(folder.done("man run").contains("noslip\\-run") || folder.done("man run").contains("noslip-run"));
    folder.refused("man none", &["unknown command `none`", "run"]);
    assert!(!folder.done("--help").contains("man "));
}

#[test]
fn the_help_says_what_exit_codes_mean() {
    let help = Folder::new().done("--help");
    for code in ["0    done", "1    the computation failed", "2    the request was wrong", "130  ended by Ctrl-C"] {
        assert!(help.contains(code), "{code} in {help}");
    }
}

#[test]
fn errors_have_colours_where_they_are_wanted() {
    let folder = Folder::new();
    folder.write("bad.toml", SCENE.replace("mass = 1.0", "mass = -1.0"));
    let told = |variables: &[(&str, &str)]| {
        let mut command = folder.command(["check", "bad.toml"]);
        command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE").envs(variables.iter().copied());
        Outcome::of(command.output().unwrap()).stderr
    };
    let plain = told(&[]);
    assert!(plain.starts_with("error: ") && !plain.contains('\x1b'), "{plain}");
    let coloured = told(&[("CLICOLOR_FORCE", "1")]);
    assert!(coloured.starts_with("\x1b[31m\x1b[1merror:\x1b[0m "), "{coloured:?}");
    assert!(coloured.matches('\x1b').count() > 4, "{coloured:?}");
    assert_eq!(told(&[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")]), plain);
}

/// A sweep takes other values of its scene: the rows are those of a scene that has them, and the command told makes them again.
#[test]
fn a_sweep_takes_settings_of_its_scene() {
    let folder = Folder::new();
    let sweep = |scene: &str| format!("scene = \"{scene}\"\nduration = 2.0\n[grid]\n\"start.speed\" = [-1.0, -2.0]\n");
    folder.write("sweep.toml", sweep("scene.toml"));
    folder.write("scene.toml", SCENE);
    folder.write("heavy.toml", SCENE.replace("mass = 1.0", "mass = 2.5"));
    folder.write("other.toml", sweep("heavy.toml"));
    folder.done("ensemble sweep.toml --set sleigh.mass=2.5 --out set.csv");
    folder.done("ensemble other.toml --out other.csv");
    folder.done("ensemble sweep.toml --out plain.csv");
    assert_eq!(folder.read("set.csv"), folder.read("other.csv"));
    assert_ne!(folder.read("set.csv"), folder.read("plain.csv"));
    assert!(folder.read("set.csv-metadata.json").contains("--set sleigh.mass=2.5"));
    folder.refused("ensemble sweep.toml --set sleigh.weight=2.5", &["--set sleigh.weight=2.5"]);
    folder.done("ensemble sweep.toml --set sleigh.mass=2.5 --part 1/2 --out parts");
    folder.done("ensemble sweep.toml --set sleigh.mass=2.5 --part 2/2 --out parts");
    folder.done("merge parts --out merged.csv");
    assert_eq!(folder.read("merged.csv"), folder.read("set.csv"));
}
