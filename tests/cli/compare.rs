//! `noslip compare`, and `noslip --all`.

use crate::program::{FAILING, Folder, SCENE, SCENES, TEXTS, keys, methods, names};
use approx::assert_relative_eq;
use serde_json::Value;
use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn row_methods(comparison: &Value) -> Vec<&str> {
    comparison["rows"].as_array().unwrap().iter().map(|row| row["method"].as_str().unwrap()).collect()
}

#[test]
fn json_has_a_row_for_each_method() {
    let folder = Folder::new();
    let comparison = folder.json("compare turnaround --duration 0.2 --json");
    assert_eq!(keys(&comparison), ["scene", "rows"]);
    assert_eq!(comparison["scene"].as_str(), Some("turnaround"));
    assert_eq!(row_methods(&comparison), methods());
    let run = folder.json("run turnaround --duration 0.2 --json");
    let mut expected = keys(&run);
    expected.extend(["error", "seconds_per_simulated_second", "better_than"]);
    for row in comparison["rows"].as_array().unwrap() {
        assert_eq!(keys(row), expected);
        let energy = ["initial", "final", "work", "max_error", "drift_per_time"];
        let drift = ["amplitude", "slope", "slope_ci", "exponent", "verdict"];
        assert_eq!(keys(&row["energy"]), [&energy[..], &drift[..]].concat());
        assert_eq!(keys(&row["constraint"]), ["max", "step_max", "leaf_max"]);
        let cost = row["wall_seconds"].as_f64().unwrap() / row["duration"].as_f64().unwrap();
        assert_relative_eq!(row["seconds_per_simulated_second"].as_f64().unwrap(), cost, max_relative = 1e-12);
        assert!(row["error"].is_f64() && row["energy"]["drift_per_time"].is_f64(), "{row}");
        assert!((0.0..1.0).contains(&row["error"].as_f64().unwrap()), "{row}");
        assert_eq!(row["scene"], comparison["scene"]);
    }
    assert!(folder.names().is_empty());
}

#[test]
fn methods_are_those_asked_for() {
    let folder = Folder::new();
    let asked = |list: &str| {
        let line = ["compare", "circle", "--duration", "1", "--json", "--methods", list];
        serde_json::from_str::<Value>(&folder.noslip(line).stdout).unwrap()
    };
    assert_eq!(row_methods(&asked("rk4,dla")), ["rk4", "dla"]);
    assert_eq!(row_methods(&asked("rk4, dla")), ["rk4", "dla"]);
    let all = methods().join(", ");
    for list in ["nope", "dla,,rk4", "", ",", "DLA", "dla;rk4", "dla,rk4,"] {
        let outcome = folder.noslip(["compare", "circle", "--methods", list, "--report", "report"]);
        outcome.assert_refused(list, &[&all]);
    }
    folder.refused("compare circle --methods dla,rk4,dla", &["--methods", "`dla`", "twice"]);
    assert!(folder.names().is_empty());
}

#[test]
fn the_table_says_what_the_json_says() {
    let text = Folder::new().done("compare turnaround --methods dla,rk4 --duration 2 --wide");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 4, "{text}");
    for column in ["constraint [m/s]", "amplitude [J]", "energy drift [W]", "verdict", "cost [s/s]"] {
        assert!(lines[1].contains(column), "{text}");
    }
    assert!(lines[2].starts_with(" dla ") && lines[3].starts_with(" rk4 "), "{text}");
}

#[test]
fn the_report_is_whole_and_overwritten_on_demand_only() {
    let folder = Folder::new();
    let line = "compare circle --methods dla,rk4 --duration 2 --report pages";
    let text = folder.done(line);
    assert!(text.contains("report: pages"), "{text}");
    let mut files: Vec<String> =
        ["circle.csv", "circle.csv-metadata.json", "circle.json", "index.html"].map(str::to_owned).to_vec();
    let pictures = ["path", "constraint", "energy"];
    files.extend(pictures.iter().flat_map(|what| ["svg", "png"].map(|ending| format!("circle-{what}.{ending}"))));
    files.sort();
    assert_eq!(names(&folder.join("pages")), files);
    let page = folder.read("pages/index.html");
    assert!(page.trim_end().ends_with("</html>") && page.contains("rk4"));
    // Of runs that reach the end no picture speaks of failures.
    assert!(!page.contains("A cross marks"));

    folder.write("pages/index.html", "mine");
    folder.refused(line, &["pages", "exists already", "--force"]);
    assert_eq!(folder.read("pages/index.html"), "mine");
    folder.done(&format!("{line} --force"));
    assert!(folder.read("pages/index.html").len() > 1000);
    assert_eq!(folder.names(), ["pages"]);
}

#[test]
fn the_numbers_beside_the_page_are_those_that_are_printed() {
    let folder = Folder::new();
    let printed = folder.json("compare bowl --methods dla,rk4,energy2,dop853 --duration 2 --json --report pages");
    assert_eq!(serde_json::from_str::<Value>(&folder.read("pages/bowl.json")).unwrap(), printed);
    // A picture shows whoever has a path.
    assert!(folder.read("pages/bowl-path.svg").contains("energy2"));
    let csv = folder.read("pages/bowl.csv");
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let rows = printed["rows"].as_array().unwrap();
    for (line, row) in lines.by_ref().zip(rows) {
        assert_eq!(line.len(), header.len(), "{line:?}");
        let cell = |name: &str| line[header.iter().position(|other| *other == name).unwrap()];
        assert_eq!(cell("method"), row["method"].as_str().unwrap());
        for (name, place) in [
            ("constraint [m/s]", "/constraint/max"),
            ("energy error [J]", "/energy/max_error"),
            ("energy drift [W]", "/energy/slope"),
            ("end error [m or rad]", "/error"),
            ("x [m]", "/final/x"),
            ("wall [s]", "/wall_seconds"),
        ] {
            let bits = |number: f64| number.to_bits();
            let said = row.pointer(place).unwrap().as_f64().map(bits);
            assert_eq!(cell(name).parse().ok().map(bits), said, "{name} of {line:?}");
        }
    }
    assert!(lines.next().is_none());
}

#[test]
fn a_table_fits_eighty_columns_and_has_all_by_wide() {
    let folder = Folder::new();
    let line = "compare flywheel --duration 0.5";
    let (narrow, wide) = (folder.done(line), folder.done(&format!("{line} --wide")));
    assert!(narrow.lines().all(|line| line.chars().count() <= 80), "{narrow}");
    // The control: the table of all columns would not fit.
    assert!(wide.lines().any(|line| line.chars().count() > 120), "{wide}");
    for text in [&narrow, &wide] {
        assert!(["dla", "rk4", "taylor"].iter().all(|method| text.contains(&format!("\n {method} "))), "{text}");
        for heading in ["constraint", "energy error", "verdict", "end error", "ns/step"] {
            assert!(text.lines().nth(1).unwrap().contains(heading), "{heading} in {text}");
        }
    }
    // Methods that refuse stand behind, once for a reason.
    let folder = shaken("0.1");
    let refused = folder.done("compare shaken.toml");
    assert!(refused.lines().any(|line| line.starts_with("energy2, energy4, energy6, energy8: refused: ")), "{refused}");
    assert!(refused.lines().all(|line| line.chars().count() <= 80), "{refused}");
}

#[test]
fn a_report_that_cannot_be_written_is_said_before_the_runs() {
    let folder = Folder::new();
    folder.write("file", "mine");
    for report in ["none/pages", "file/pages", "file --force"] {
        let outcome = folder.line(&format!("compare circle --duration 1e9 --report {report}"));
        assert_eq!((outcome.code, outcome.stdout.as_str()), (1, ""), "{report}: {outcome:?}");
        outcome.assert_told(report, &["cannot write"]);
    }
    assert_eq!(folder.names(), ["file"]);
}

#[test]
fn a_method_that_fails_does_not_hide_the_others() {
    let folder = Folder::new();
    folder.write("large.toml", FAILING);
    let outcome = folder.line("compare large.toml --methods dla,rk4-reduced,dla-alpha --json --report pages");
    let comparison: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(outcome.code, 1);
    assert_eq!(row_methods(&comparison), ["dla", "rk4-reduced", "dla-alpha"]);
    let rows = comparison["rows"].as_array().unwrap();
    assert!(rows[0]["failure"]["step"].is_u64() && rows[1].get("failure").is_none(), "{comparison}");
    assert_eq!(rows[1]["steps"].as_u64(), Some(10));
    outcome.assert_told("compare", &["dla failed at step", "valid up to t ="]);
    // A line for each failure.
    assert_eq!(outcome.stderr.lines().filter(|line| line.starts_with("error: dla")).count(), 2);
    assert!(folder.join("pages/index.html").is_file());
    let text = folder.line("compare large.toml --methods dla,rk4-reduced");
    assert!(text.code == 1 && text.stdout.contains(" rk4-reduced "), "{text:?}");
}

/// A scene that depends on time, over so long (s).
fn shaken(duration: &str) -> Folder {
    let folder = Folder::new();
    let effect = "[[effects]]\nkind = \"moving_mass\"\nmass = 0.5\ny = { amplitude = 0.4, frequency = 2.0 }\n";
    let scene = SCENE.replace("duration = 2.0", &format!("duration = {duration}"));
    folder.write("shaken.toml", scene + effect);
    folder
}

const REFUSED: &str = "refused: the energy-preserving methods need systems that do not depend on time explicitly";

/// The rows of all methods, with more that this command does, and what it is told who asks for one that refuses.
fn refusals(folder: &Folder, more: &str) {
    let comparison = folder.json(&format!("compare shaken.toml --json {more}"));
    assert_eq!(row_methods(&comparison), methods());
    let rows = comparison["rows"].as_array().unwrap();
    let (refused, made): (Vec<&Value>, Vec<&Value>) = rows.iter().partition(|row| row.get("refused").is_some());
    let names: Vec<&str> = refused.iter().map(|row| row["method"].as_str().unwrap()).collect();
    assert_eq!(names, ["energy2", "energy4", "energy6", "energy8"]);
    for row in refused {
        assert_eq!(row["refused"].as_bool(), Some(true));
        assert!(row["failure"]["reason"].as_str().unwrap().contains("depend on time explicitly"), "{row}");
        let extra: Vec<&str> = keys(row).into_iter().filter(|key| made[0].get(key).is_none()).collect();
        // It has no error at the end.
        assert_eq!((extra, keys(row).len()), (vec!["failure", "refused"], keys(made[0]).len() + 1));
    }
    for line in ["compare shaken.toml --methods dla,energy2", "run shaken.toml --method energy2"] {
        let outcome = folder.line(line);
        assert_eq!(outcome.code, 1, "{outcome:?}");
        outcome.assert_told(line, &["energy2", REFUSED]);
    }
}

/// A sentence behind the table says why.
fn row_of_a_refusal(text: &str) {
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let said = words.split("energy2").nth(1).unwrap();
    assert!(said.contains(&format!(": {REFUSED}")), "{text}");
}

/// One row of the page says why; the pictures leave out what has no path, and the others keep their looks.
fn page_of_a_refusal(folder: &Folder, other: &str) {
    let page = folder.read("pages/index.html");
    assert!(page.contains(&format!("<td colspan=\"12\">{REFUSED}")), "{page}");
    for picture in ["path", "constraint", "energy"] {
        let drawn = folder.read(&format!("pages/shaken-{picture}.svg"));
        assert!(drawn.contains(other) && !drawn.contains("energy2"), "{picture}");
    }
}

#[test]
fn a_refusal_is_shown_and_fails_only_who_asked_for_it() {
    refusals(&shaken("0.1"), "");
}

#[test]
fn a_refusal_is_a_row_and_no_picture() {
    let folder = shaken("0.1");
    let outcome = folder.line("compare shaken.toml --methods dla,energy2 --report pages");
    assert_eq!(outcome.code, 1, "{outcome:?}");
    row_of_a_refusal(&outcome.stdout);
    page_of_a_refusal(&folder, "dla");
}

#[test]
#[ignore = "slow"]
fn a_refusal_is_shown_and_fails_only_who_asked_for_it_at_length() {
    let folder = shaken("2.0");
    refusals(&folder, "--report pages");
    row_of_a_refusal(&folder.done("compare shaken.toml"));
    page_of_a_refusal(&folder, "lobatto5");
    // A picture can show it.
    folder.write("free.toml", SCENE);
    folder.done("compare free.toml --methods dla,energy2 --report free");
    assert!(folder.read("free/free-path.svg").contains("energy2"));
}

/// The row of each method of a long comparison.
fn rows_of(folder: &Folder, line: &str) -> Vec<Value> {
    folder.json(line)["rows"].as_array().unwrap().clone()
}

fn energy(row: &Value, key: &str) -> f64 {
    row["energy"][key].as_f64().unwrap()
}

/// The rows of some methods on a scene, over so long (s).
fn compared(scene: &str, step: f64, duration: f64, methods: &str) -> Vec<Value> {
    let line = format!("compare {scene} --step {step} --duration {duration} --methods {methods} --json");
    rows_of(&Folder::new(), &line)
}

/// Nothing but rounding, which grows with the distance: at 2.1 m/s at most (1.2 J above hollows at -1 J), the rounding of x and y,
/// with slopes of 0.5 J/m, changes the energy by at most this. It is no line.
fn energy_is_kept_on_the_attractor(duration: f64) {
    let rows = compared("egg-crate-attractor", 0.1, duration, "energy4");
    assert!(energy(&rows[0], "max_error") < 2.1 * duration * f64::EPSILON, "{rows:?}");
    assert_ne!(rows[0]["energy"]["verdict"], "linear drift", "{rows:?}");
}

/// Above the blade: no contraction, no drift.
fn verdicts_above_the_blade(step: f64, duration: f64) {
    let rows = compared("egg-crate", step, duration, "dla,rk4");
    assert_eq!(rows[0]["energy"]["verdict"], "bounded", "{rows:?}");
    assert_eq!(rows[1]["energy"]["verdict"], "linear drift", "{rows:?}");
    // The larger amplitude, the smaller slope: and from when on that counts.
    assert!(energy(&rows[0], "amplitude") > energy(&rows[1], "amplitude"), "{rows:?}");
    let overtaken = &rows[0]["better_than"][0];
    let (a, b) = ([0, 1].map(|k| energy(&rows[k], "amplitude")), [0, 1].map(|k| energy(&rows[k], "slope").abs()));
    assert_eq!(overtaken["method"], "rk4");
    assert_relative_eq!(overtaken["from"].as_f64().unwrap(), (a[0] - a[1]) / (b[1] - b[0]), max_relative = 1e-12);
    assert_eq!(rows[1]["better_than"].as_array().map(Vec::len), Some(0));
    // The discrete constraint is that of dla, and not of rk4.
    let over_step = |k: usize| rows[k]["constraint"]["step_max"].as_f64().unwrap();
    assert!(over_step(0) < 1e-13 && over_step(1) > 1e-6, "{rows:?}");
}

#[test]
fn verdicts_on_an_attractor_and_off_it() {
    energy_is_kept_on_the_attractor(5.0);
    verdicts_above_the_blade(0.4, 200.0);
}

#[test]
#[ignore = "slow"]
fn verdicts_on_an_attractor_and_off_it_at_length() {
    // The centre of mass ahead of the blade: a linear drift of the order of the method.
    let slopes = [0.05, 0.025].map(|step| {
        let rows = compared("egg-crate-attractor", step, 5000.0, "dla");
        assert_eq!(rows[0]["energy"]["verdict"], "linear drift", "{rows:?}");
        assert!(energy(&rows[0], "slope_ci") < 0.25 * -energy(&rows[0], "slope"), "{rows:?}");
        (energy(&rows[0], "slope"), energy(&rows[0], "slope_ci"))
    });
    let ratio = slopes[0].0 / slopes[1].0;
    let spread = ratio * (slopes[0].1 / slopes[0].0).hypot(slopes[1].1 / slopes[1].0);
    // The intervals of 95 % are two standard errors; of three and a half one such run in a thousand is out.
    assert!((ratio - 4.0).abs() < 1.75 * spread, "{ratio} +- {spread}");

    let rows = compared("egg-crate-attractor", 0.1, 2000.0, "rk4");
    assert_eq!(rows[0]["energy"]["verdict"], "linear drift", "{rows:?}");
    energy_is_kept_on_the_attractor(500.0);
    verdicts_above_the_blade(0.1, 1000.0);
}

/// Starts a command, sends it Ctrl-C, as a terminal does, once a file of it is there, and returns what came of it.
#[cfg(unix)]
fn interrupted(folder: &Folder, line: &str, sign_of_life: &str) -> crate::program::Outcome {
    let mut command = folder.command(line.split_whitespace());
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let begin = Instant::now();
    while !folder.join(sign_of_life).exists() {
        assert!(begin.elapsed() < Duration::from_secs(60), "no {sign_of_life}");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let outcome = crate::program::Outcome::of(child.wait_with_output().unwrap());
    assert_eq!(outcome.code, 130, "{outcome:?}");
    outcome
}

/// With a checkpoint after every `every` steps.
#[cfg(unix)]
fn interrupted_comparison(every: u64) {
    let folder = Folder::new();
    let line = |more: &str| format!("compare turnaround --step 0.01 --methods dla,gauss4 --json {more}");
    let long = line(&format!("--duration 3e6 --checkpoint saves --checkpoint-every {every}"));
    let outcome = interrupted(&folder, &long, "saves/dla.save");
    outcome
        .assert_told("ctrl-c", &["interrupted: 0 of 2 methods finished, dla up to t = ", "--resume saves continues"]);
    let object: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let rows = object["rows"].as_array().unwrap();
    assert_eq!((&object["interrupted"], rows.len()), (&Value::Bool(true), 1), "{object}");
    let steps = rows[0]["steps"].as_u64().unwrap();
    assert!((every..300_000_000).contains(&steps) && rows[0]["interrupted"] == true, "{object}");
    // What was saved last is where it ended, and belongs to that comparison alone.
    let saved = fs::read_to_string(folder.join("saves/dla.save")).unwrap();
    assert!(saved.contains(&format!("\nk: {steps:016x}\n")), "{steps}");
    folder.refused(&line("--duration 9 --resume saves"), &["belongs to another run"]);
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_is_done_and_the_rest_is_resumed() {
    interrupted_comparison(1000);
}

#[cfg(unix)]
#[test]
#[ignore = "slow"]
fn ctrl_c_keeps_what_is_done_and_the_rest_is_resumed_at_length() {
    interrupted_comparison(1_000_000);
}

/// With a checkpoint after every `every` steps, and a row after each tenth of them.
#[cfg(unix)]
fn interrupted_run(every: u64) {
    let folder = Folder::new();
    let rows = every / 10;
    let line = format!(
        "run turnaround --step 0.01 --duration 3e6 --out path.csv --every {rows} --checkpoint run.save \
         --checkpoint-every {every} --json"
    );
    let outcome = interrupted(&folder, &line, "run.save");
    outcome.assert_told("ctrl-c", &["interrupted: the run reached t = ", "--resume run.save continues"]);
    let object: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let steps = object["steps"].as_u64().unwrap();
    assert!((every..300_000_000).contains(&steps) && object["interrupted"] == true, "{object}");
    let written = fs::read_to_string(folder.join("path.csv")).unwrap();
    assert!(written.lines().count() as u64 >= steps / rows, "{steps} steps, {} lines", written.lines().count());
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_the_run_and_its_nodes() {
    interrupted_run(1000);
}

#[cfg(unix)]
#[test]
#[ignore = "slow"]
fn ctrl_c_keeps_the_run_and_its_nodes_at_length() {
    interrupted_run(1_000_000);
}

#[test]
fn a_comparison_from_its_checkpoints_is_the_same() {
    resumed_comparisons(" --set effects.0.count=3 --duration 0.06");
}

#[test]
#[ignore = "slow"]
fn a_comparison_from_its_checkpoints_is_the_same_in_full() {
    resumed_comparisons(" --duration 0.2");
}

/// Of a sleigh and of a train, the train with `more`.
fn resumed_comparisons(more: &str) {
    let train = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/guide/train.toml");
    for (scene, methods) in [("turnaround --duration 20", ["dla", "rk4"]), (train, ["dla", "dla4"])] {
        let folder = Folder::new();
        let short = if scene == train { more } else { "" };
        let line = format!("compare {scene}{short} --methods {} --json", methods.join(","));
        let whole = folder.json(&line);
        let saved = folder.json(&format!("{line} --checkpoint saves --checkpoint-every 100"));
        assert_eq!(names(&folder.join("saves")), methods.map(|method| format!("{method}.save")));
        let resumed = folder.json(&format!("{line} --resume saves"));
        // All but the times.
        let timeless = |mut object: Value| {
            for row in object["rows"].as_array_mut().unwrap() {
                row["wall_seconds"] = Value::Null;
                row["seconds_per_simulated_second"] = Value::Null;
            }
            object
        };
        let whole = timeless(whole);
        assert_eq!((timeless(saved), timeless(resumed)), (whole.clone(), whole));
        folder.refused(&format!("{line} --checkpoint saves"), &["saves", "exists already", "--force"]);
        folder.refused(&format!("{line} --resume nowhere"), &["cannot read nowhere"]);
    }
}

#[test]
#[ignore = "slow"]
fn every_method_on_every_scene() {
    let folder = Folder::new();
    // Somebody's folder, which stays as it is.
    fs::create_dir(folder.join("noslip-report")).unwrap();
    folder.write("noslip-report/index.html", "mine");
    let (text, methods) = (folder.done("--all"), methods());
    let tables: Vec<&str> = text.split("\n\n").collect();
    let scenes: Vec<&str> = SCENES.iter().chain(&TEXTS).copied().collect();
    assert_eq!(tables.len(), 2 + scenes.len(), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    // All together first: a line for each method, which refuses or fails on some scenes at most.
    let together: Vec<&str> = tables[0].lines().collect();
    assert!(together.len() == 2 + methods.len() && together[0].contains("All 30 scenes"), "{text}");
    for (line, method) in together[2..].iter().zip(&methods) {
        assert!(line.starts_with(&format!(" {method} ")), "{line}");
        let counts = line.split_whitespace().skip(1).take(2).map(|count| count.parse::<usize>().unwrap());
        assert!(counts.sum::<usize>() < scenes.len(), "{line}");
    }
    // Each method has a row, or is named behind the table.
    for (scene, table) in scenes.iter().zip(&tables[1..]) {
        assert!(table.lines().next().unwrap().contains(&format!("({scene})")), "{table}");
        let words: Vec<&str> = table.split_whitespace().map(|word| word.trim_end_matches([',', ':'])).collect();
        for method in &methods {
            assert!(words.contains(&method.as_str()), "{method} in {table}");
        }
    }
    assert!(tables[1 + scenes.len()].starts_with("report: noslip-report-2"), "{text}");
    let files = names(&folder.join("noslip-report-2"));
    let pictures = 3 * scenes.len();
    assert_eq!(files.iter().filter(|name| name.ends_with(".svg")).count(), pictures, "{files:?}");
    // Each picture twice, as SVG and as PNG; the numbers of each scene twice, as CSV and as JSON, with the metadata of the CSV.
    assert_eq!(files.len(), 1 + 2 * pictures + 3 * scenes.len(), "{files:?}");
    assert!(files.contains(&"index.html".to_owned()), "{files:?}");

    assert_eq!(folder.names(), ["noslip-report", "noslip-report-2"]);
    assert_eq!(folder.read("noslip-report/index.html"), "mine");
    folder.refused("--all --report noslip-report", &["noslip-report", "exists already", "--force"]);
}
