//! The files of a command: none is lost, none is overwritten that is not its own, and what names say is one field.

use crate::processes::started;
use crate::program::{Folder, SCENE};
use serde_json::Value;
use std::fs;

/// Every 7th node, so that the last one is not due.
const RUN: &str = "run scene.toml --every 7";
const DRAG: &str = "[[effects]]\nkind = \"drag\"\nalong = 0.1\n[[effects]]\nkind = \"thrust\"\nforce = 0.2\n";

/// Names of outputs and a unit that are more than a word, as far as a table is concerned.
const NAMES: &str = "\
[system]
coordinates = { x = \"m, to the east\", theta = \"angle\" }
lagrangian = \"(theta'^2+x'^2)/2\"
outputs = { twice = \"2*x\" }
[start]
\"x'\" = 1.0
[run]
step = 0.1
duration = 1.0
";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("scene.toml", format!("{SCENE}{DRAG}"));
    folder
}

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).unwrap()
}

/// The header of a file, as a reader of CSV has it.
fn header(folder: &Folder, name: &str) -> Vec<String> {
    let text = folder.read(name);
    let (mut fields, mut quoted) = (vec![String::new()], false);
    for letter in text.lines().next().unwrap().replace("\"\"", "\u{1}").chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            '\u{1}' => fields.last_mut().unwrap().push('"'),
            letter => fields.last_mut().unwrap().push(letter),
        }
    }
    fields
}

#[test]
fn a_run_that_is_over_keeps_its_last_row() {
    let folder = folder();
    let trailer = "[[effects]]\nkind = \"trailers\"\ncount = 1\nmass = 0.5\ninertia = 0.1\nbar = 1.0\n";
    folder.write("train.toml", format!("{SCENE}{trailer}"));
    for (scene, file) in
        [("scene.toml", "k.csv"), ("train.toml", "k.csv"), ("scene.toml", "k.npz"), ("scene.toml", "k.jsonl")]
    {
        let run = format!("{} --out {file}", RUN.replace("scene.toml", scene));
        folder.done(&format!("{run} --checkpoint k.save"));
        let whole = bytes(&folder, file);
        folder.done(&format!("{run} --resume k.save"));
        assert!(bytes(&folder, file) == whole, "{file} of {scene}");
        // Ended between the two renames, of the rows and of what made them.
        let told = folder.join(&format!("{file}-metadata.json"));
        if told.exists() {
            fs::remove_file(&told).unwrap();
            folder.done(&format!("{run} --resume k.save"));
            assert!(bytes(&folder, file) == whole && told.exists(), "{file} of {scene}");
        }
        // A run that is longer goes on from there.
        folder.done(&format!("{run} --resume k.save --duration 3"));
        let longer = bytes(&folder, file);
        folder.done(&format!("{run} --duration 3 --force"));
        assert!(bytes(&folder, file) == longer && longer != whole, "{file} of {scene}");
        for name in folder.names().iter().filter(|name| name.starts_with("k.")) {
            fs::remove_file(folder.join(name)).unwrap();
        }
    }
}

#[test]
fn a_run_that_an_event_ends_early_is_saved() {
    let folder = folder();
    let run = format!("{RUN} --until x=-0.5 --out k.csv");
    let told = folder.done(&format!("{run} --checkpoint k.save"));
    assert!(told.contains("x=-0.5"), "{told}");
    let whole = bytes(&folder, "k.csv");
    folder.done(&format!("{run} --resume k.save"));
    assert!(bytes(&folder, "k.csv") == whole);
    // Of rows of anybody else that is not so.
    folder.write("k.csv", "mine");
    folder.refused(&format!("{run} --resume k.save"), &["k.csv exists already", "--force"]);
    assert_eq!(folder.read("k.csv"), "mine");
}

#[test]
fn a_run_that_is_resumed_goes_on_saving_where_it_is_said_how_often() {
    let folder = folder();
    folder.done("run scene.toml --duration 1 --checkpoint k.save");
    let half = bytes(&folder, "k.save");
    folder.done("run scene.toml --resume k.save");
    assert!(bytes(&folder, "k.save") == half);
    folder.done("run scene.toml --resume k.save --checkpoint-every 10");
    let whole = bytes(&folder, "k.save");
    assert!(whole != half);
    folder.refused("run scene.toml --duration 1 --resume k.save", &["number of steps", "40", "at most 20"]);
    folder.refused("run scene.toml --checkpoint-every 10", &["--checkpoint", "--resume"]);
}

#[test]
fn a_spool_of_anybody_else_is_not_touched() {
    let folder = folder();
    folder.write("k.csv.part", "mine");
    folder.refused("run scene.toml --out k.csv", &["k.csv.part", "--resume", "--force"]);
    assert_eq!((folder.read("k.csv.part"), folder.names().len()), ("mine".to_owned(), 2));
    folder.done("run scene.toml --out k.csv --force");
    assert!(!folder.join("k.csv.part").exists());
    // One that should have rows and has none.
    folder.done("run scene.toml --duration 1 --out k.csv --checkpoint k.save --force");
    fs::remove_file(folder.join("k.csv")).unwrap();
    folder.write("k.csv.part", "");
    folder.refused("run scene.toml --out k.csv --resume k.save", &["k.csv.part", "begins with the rows", "--force"]);
    assert!(!folder.join("k.csv").exists());
}

#[cfg(unix)]
#[test]
fn links_beside_an_output_are_not_followed_and_rights_are_kept() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = folder();
    folder.write("other", "mine");
    symlink("other", folder.join("k.csv.part")).unwrap();
    let outcome = folder.line("run scene.toml --out k.csv --force");
    outcome.assert_told("a link", &["k.csv.part", "symbolic link"]);
    assert_eq!((outcome.code, folder.read("other")), (1, "mine".to_owned()));
    fs::remove_file(folder.join("k.csv.part")).unwrap();
    symlink("other", folder.join("k.csv.noslip-new")).unwrap();
    symlink("none", folder.join("k.csv-metadata.json.noslip-new")).unwrap();
    folder.done("run scene.toml --out k.csv");
    assert_eq!(folder.read("other"), "mine");
    assert_eq!(folder.names(), ["k.csv", "k.csv-metadata.json", "other", "scene.toml"]);
    // An output that is a link is overwritten where the link leads to, with the rights that are there.
    for name in ["k.csv", "k.csv-metadata.json"] {
        fs::set_permissions(folder.join(name), fs::Permissions::from_mode(0o600)).unwrap();
    }
    symlink("k.csv", folder.join("l.csv")).unwrap();
    folder.done("run scene.toml --every 2 --out l.csv --force");
    folder.done("run scene.toml --every 3 --out k.csv --force");
    folder.done("plot k.csv --out k.svg");
    let mode = |name: &str| fs::symlink_metadata(folder.join(name)).unwrap().permissions().mode() & 0o777;
    assert_eq!(
        [mode("k.csv"), mode("k.csv-metadata.json"), mode("k.svg")],
        [0o600, 0o600, mode("l.csv-metadata.json")]
    );
    assert!(fs::symlink_metadata(folder.join("l.csv")).unwrap().is_symlink());
}

/// Commands on files that have another role, which is named; nothing is computed, and nothing changes, whatever may be overwritten.
#[test]
fn no_file_has_two_roles() {
    let folder = folder();
    folder.write("sweep.toml", "scene = \"scene.toml\"\nduration = 1.0\n[grid]\n\"start.speed\" = [0.1, 0.2]\n");
    folder.write("points.csv", "t,force\n0,0.1\n1,0.2\n");
    let driven = "[[effects]]\nkind = \"thrust\"\nforce = { file = \"points.csv\", columns = [\"t\", \"force\"] }\n";
    folder.write("driven.toml", format!("{SCENE}{driven}"));
    folder.write("system.csv", NAMES);
    folder.write("points.json", "{\"points\": []}");
    folder.done("run scene.toml --out run.csv --checkpoint run.save");
    fs::create_dir(folder.join("below")).unwrap();
    let before: Vec<(String, Option<Vec<u8>>)> =
        folder.names().into_iter().map(|name| (name.clone(), fs::read(folder.join(&name)).ok())).collect();
    for (line, told) in [
        ("run scene.toml --out a.csv --checkpoint a.csv.part --checkpoint-every 10", "--out a.csv writes"),
        ("run scene.toml --out a.csv --checkpoint a.csv-metadata.json", "--out a.csv writes"),
        ("run scene.toml --out a.csv --checkpoint a.csv", "--out a.csv writes"),
        ("run scene.toml --out a.csv --checkpoint below/../a.csv", "--out a.csv writes"),
        ("run scene.toml --out a.csv --checkpoint a.csv.noslip-new", "--out a.csv writes"),
        ("run scene.toml --out a.npz --checkpoint a.npz.part", "--out a.npz writes"),
        ("run scene.toml --out run.save --format csv --resume run.save", "reads"),
        ("run scene.toml --out scene.toml --format csv", "scene.toml: the command reads"),
        ("run ./scene.toml --out below/../scene.toml --format csv", "reads"),
        ("run scene.toml --checkpoint scene.toml", "--checkpoint scene.toml: the command reads"),
        ("run driven.toml --out points.csv", "--out points.csv: the command reads"),
        ("run system.csv --out system.csv", "reads"),
        ("ensemble sweep.toml --out sweep.toml", ".csv"),
        ("precision scene.toml --csv scene.toml", "--csv scene.toml: the command reads"),
        ("precision scene.toml --with points.json --csv points.json", "--csv points.json: the command reads"),
        ("plot run.csv --out run.csv", ".svg"),
        ("section scene.toml --plane x=0 --out scene.toml", "the command reads"),
        ("equilibria scene.toml --picture scene.toml", "--picture scene.toml: the command reads"),
    ] {
        folder.refused(&format!("{line} --force"), &[told]);
        let after: Vec<_> = folder.names();
        assert_eq!(after, before.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>(), "{line}");
        assert!(before.iter().all(|(name, content)| fs::read(folder.join(name)).ok() == *content), "{line}");
    }
    // A sweep and a picture whose names have such an ending.
    folder.write("sweep.csv", folder.read("sweep.toml"));
    folder.write("driven.svg", folder.read("driven.toml"));
    folder.refused("ensemble sweep.csv --out sweep.csv --force", &["reads"]);
    folder.refused("ensemble sweep.csv --out scene.toml.csv --force --resume --part 1/0", &["--part"]);
    folder.refused("plot driven.svg --out driven.svg --force", &["reads"]);
    folder.refused("lyapunov driven.svg --out driven.svg --force", &["reads"]);
    // The control: other names are taken, and a checkpoint is saved over the one that is resumed.
    folder.done("run driven.toml --out a.csv --checkpoint a.save");
    folder.done("run scene.toml --duration 3 --out run.csv --resume run.save --checkpoint run.save");
}

#[test]
fn names_and_units_are_one_field_each_and_are_read_back() {
    let folder = Folder::new();
    folder.write("names.toml", NAMES);
    folder.done("run names.toml --out n.csv");
    folder.done("run names.toml --out n.npz");
    let labels = header(&folder, "n.csv");
    assert!(labels.iter().any(|found| found == "x [m, to the east]"), "{labels:?}");
    let text = folder.read("n.csv");
    assert!(text.lines().next().unwrap().contains(",\"x [m, to the east]\","), "{text}");
    for line in text.lines().skip(1) {
        assert_eq!(line.split(',').count(), labels.len(), "{line}");
    }
    // Every column is that of the archive, whose names need no quotes.
    let told = folder.json("diff n.csv n.npz --json");
    let columns = told["columns"].as_array().unwrap();
    assert_eq!(columns.len(), labels.len());
    assert!(columns.iter().all(|column| column["same"] == Value::Bool(true)), "{told}");
    assert_eq!(told["only"], serde_json::json!([[], []]));
    folder.done("plot n.csv --columns x,twice --out n.svg");
    assert!(folder.read("n.svg").contains("m, to the east"));
    // Another system is driven by that column.
    let driven = "[[effects]]\nkind = \"thrust\"\nforce = { file = \"n.csv\", columns = [\"t\", \"twice\"] }\n";
    folder.write("driven.toml", format!("{SCENE}{driven}").replace("duration = 2.0", "duration = 1.0"));
    folder.done("run driven.toml");
    folder.write("sweep.toml", "scene = \"names.toml\"\n[grid]\n\"start.x'\" = [0.1, 0.2]\n");
    folder.done("ensemble sweep.toml --out e.csv");
    folder.done("ensemble sweep.toml --out e.npz");
    let told = folder.json("diff e.csv e.npz --json");
    assert_eq!(
        (&told["rows"], &told["only"]),
        (&serde_json::json!([2, 2]), &serde_json::json!([["error"], ["failed"]]))
    );
}

#[test]
fn fields_in_quotes_may_have_lines_and_quotes() {
    let folder = Folder::new();
    folder.write("a.csv", "t [s],\"two\nlines, \"\"so\"\" [m]\",text,v [m [sic]]\n0,1,\"a\nb\",5\n1,2,c,6\n");
    folder.write("b.csv", "# a comment\n\nt [s],\"two\nlines, \"\"so\"\"\",v\n0,1,5\n1,2.5,6\n");
    let told = folder.json("diff a.csv b.csv --json");
    let columns: Vec<(&str, f64)> = told["columns"]
        .as_array()
        .unwrap()
        .iter()
        .map(|column| (column["name"].as_str().unwrap(), column["difference"].as_f64().unwrap()))
        .collect();
    assert_eq!(columns, [("t", 0.0), ("two\nlines, \"so\"", 0.5), ("v", 0.0)]);
    // A row that is cut is an error, and not a row of numbers that are missing.
    folder.write("cut.csv", "t,x\n0,1\n1\n");
    folder.refused("diff a.csv cut.csv", &["cut.csv", "1 field"]);
}

#[test]
fn negative_numbers_are_numbers_however_they_are_written() {
    let folder = folder();
    for (duration, t) in [("-1e-1", -0.1), ("-.5", -0.5), ("-2.5e-01", -0.25), ("-1", -1.0)] {
        let run = folder.json(&format!("run scene.toml --duration {duration} --json"));
        assert!((run["final"]["t"].as_f64().unwrap() - t).abs() < 1e-12, "{duration}: {run}");
    }
    folder.refused("run scene.toml --duration --json", &["--duration", "not a number"]);
    folder.refused("run scene.toml --step -1e-1", &["step"]);
}

#[test]
fn pictures_and_inputs_that_would_fill_the_memory_are_refused() {
    let folder = folder();
    let line = "plot scene.toml --out p.png --size";
    folder.refused(&format!("{line} 100x100cm --dpi 1200"), &["47244 x 47244 pixels", "1.5e8", "--dpi", ".svg"]);
    folder.done(&format!("{line} 3x3cm --dpi 300"));
    folder.done("plot scene.toml --out p.svg --size 100x100cm --dpi 1200");
    #[cfg(target_os = "linux")]
    {
        folder.refused("run scene.toml --resume /dev/zero", &["/dev/zero", "not a checkpoint"]);
        folder.refused("precision scene.toml --with /dev/zero", &["/dev/zero", "larger than"]);
        std::os::unix::fs::symlink("/dev/zero", folder.join("zero.csv")).unwrap();
        folder.refused("plot zero.csv", &["zero.csv", "not a regular file"]);
    }
}

#[test]
fn nodes_that_do_not_fit_in_memory_are_refused() {
    let text = SCENE.replace("duration = 2.0", "duration = 50000000000.0");
    for text in [
        text.clone(),
        format!("{text}[[effects]]\nkind = \"trailers\"\ncount = 1\nmass = 0.5\ninertia = 0.1\nbar = 1.0\n"),
    ] {
        let scene = scene::AnyScene::parse(&text, "long", &["dla"]).unwrap();
        let refused = cli::run(&scene, &cli::RunRequest::default(), &cli::Caller::default()).unwrap_err();
        assert!(refused.request, "{refused:?}");
        for word in ["every=", "t_eval=", "1000000000002 nodes"] {
            assert!(refused.message.contains(word), "{word}: {refused:?}");
        }
    }
}

/// A train of many blades has more columns than this process may have files open.
#[cfg(target_os = "linux")]
#[test]
fn an_archive_of_many_columns_is_continued_with_few_open_files() {
    let folder = Folder::new();
    let trailers = "[[effects]]\nkind = \"trailers\"\ncount = 30\nmass = 0.5\ninertia = 0.1\nbar = 1.0\n";
    folder.write("train.toml", format!("{SCENE}{trailers}").replace("duration = 2.0", "duration = 0.3"));
    folder.done("run train.toml --out k.npz");
    let whole = bytes(&folder, "k.npz");
    fs::remove_file(folder.join("k.npz")).unwrap();
    let script = "ulimit -n 24; \"$0\" run train.toml --duration 0.15 --out k.npz --checkpoint k.save && \
                  exec \"$0\" run train.toml --out k.npz --resume k.save";
    let mut shell = std::process::Command::new("sh");
    shell.args(["-c", script, env!("CARGO_BIN_EXE_noslip")]).current_dir(folder.path());
    let outcome = crate::program::Outcome::of(shell.output().unwrap());
    assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""));
    assert!(bytes(&folder, "k.npz") == whole);
}

#[test]
fn names_that_become_too_long_are_refused_before_the_work() {
    let folder = folder();
    folder.write("sweep.toml", "scene = \"scene.toml\"\n[grid]\n\"start.speed\" = [0.1, 0.2]\n");
    for letters in [231, 241, 250] {
        let name = "x".repeat(letters - 4);
        for line in [
            format!("run scene.toml --duration 1e9 --step 1e-3 --out {name}.csv"),
            format!("ensemble sweep.toml --out {name}.csv"),
            format!("precision scene.toml --csv {name}.csv"),
            format!("section scene.toml --plane x=0 --duration 1e9 --out {name}.csv"),
        ] {
            let outcome = folder.line(&line);
            assert_eq!((outcome.code, outcome.stdout.as_str()), (1, ""), "{line}: {outcome:?}");
            outcome.assert_told(&line, &["File name too long"]);
        }
    }
    assert_eq!(folder.names(), ["scene.toml", "sweep.toml"]);
    folder.done(&format!("run scene.toml --out {}.csv", "x".repeat(226)));
}

#[test]
fn a_title_stands_on_one_line_and_turns_no_letters() {
    let folder = folder();
    let title = "title = \"one\\nenergy  0 J\\u202Eright\"";
    folder.write("title.toml", folder.read("scene.toml").replace("title = \"A test\"", title));
    let text = folder.done("run title.toml");
    assert!(text.contains("one energy  0 J\\u{202e}right"), "{text}");
    assert!(
        !text.contains('\u{202e}') && text.lines().filter(|line| line.starts_with("energy ")).count() == 2,
        "{text}"
    );
}

/// Of processes that would write one report, one does, and the others say so before they compute.
#[test]
fn a_report_is_of_one_process() {
    let folder = Folder::new();
    let line = "compare turnaround --methods dla,rk4 --duration 2 --report pages";
    let all: Vec<_> = (0..4).map(|_| started(&folder, line)).collect();
    let all: Vec<_> = all.into_iter().map(crate::processes::output).collect();
    let done = all.iter().filter(|(code, ..)| *code == Some(0)).count();
    assert_eq!(done, 1, "{all:?}");
    for (code, printed, told) in all.iter().filter(|(code, ..)| *code != Some(0)) {
        assert_eq!((*code, printed.as_str()), (Some(2), ""), "{told}");
    }
    assert!(folder.join("pages/index.html").exists());
    assert_eq!(folder.names(), ["pages"]);
}

#[cfg(target_os = "linux")]
#[test]
fn the_path_of_a_scene_may_be_any_bytes() {
    use std::os::unix::ffi::OsStringExt;
    let name = |end: &[u8]| std::ffi::OsString::from_vec([b"sc\xe9ne", end].concat());
    let folder = Folder::new();
    let below = folder.path().join(name(b""));
    fs::create_dir(&below).unwrap();
    fs::write(below.join(name(b".toml")), SCENE).unwrap();
    fs::write(below.join(name(b".sweep")), "scene = \"near.toml\"\n[grid]\n\"start.speed\" = [0.1, 0.2]\n").unwrap();
    fs::write(below.join("near.toml"), SCENE).unwrap();
    let path = |file: &[u8]| below.join(name(file)).into_os_string();
    let out = |command: &str, file: &[u8]| {
        let outcome = folder.noslip([command.into(), path(file), "--out".into(), "r.csv".into(), "--force".into()]);
        assert_eq!(outcome.code, 0, "{outcome:?}");
    };
    out("run", b".toml");
    let rows = folder.read("r.csv");
    folder.write("plain.toml", SCENE);
    folder.done("run plain.toml --out p.csv");
    assert_eq!(folder.read("p.csv"), rows);
    out("ensemble", b".sweep");
    assert_eq!(folder.noslip(["check".into(), path(b".toml")]).code, 0);
    let own = path(b".toml");
    let outcome = folder.noslip([
        "run".into(),
        own.clone(),
        "--format".into(),
        "csv".into(),
        "--force".into(),
        "--out".into(),
        own,
    ]);
    outcome.assert_refused("its own scene", &["reads"]);
}
