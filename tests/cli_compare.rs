//! `noslip compare`, and plain `noslip`.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

#[path = "common/program.rs"]
mod program;

use program::{FAILING, Folder, SCENE, SCENES, keys, methods, names};
use serde_json::Value;

fn row_methods(comparison: &Value) -> Vec<&str> {
    comparison["rows"].as_array().unwrap().iter().map(|row| row["method"].as_str().unwrap()).collect()
}

#[test]
fn json_has_a_row_for_each_method() {
    let folder = Folder::new();
    let comparison = folder.json("compare turnaround --duration 5 --json");
    assert_eq!(keys(&comparison), ["scene", "rows"]);
    assert_eq!(comparison["scene"].as_str(), Some("turnaround"));
    assert_eq!(row_methods(&comparison), methods());
    for row in comparison["rows"].as_array().unwrap() {
        let run = folder.json("run turnaround --duration 5 --json");
        let mut expected = keys(&run);
        expected.push("error");
        assert_eq!(keys(row), expected);
        assert_eq!(keys(&row["energy"]), ["initial", "final", "work", "max_error", "drift_per_time"]);
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
    // Twice the same: measured twice.
    assert_eq!(row_methods(&asked("dla,dla")), ["dla", "dla"]);
    let all = methods().join(", ");
    for list in ["nope", "dla,,rk4", "", ",", "DLA", "dla;rk4", "dla,rk4,"] {
        let outcome = folder.noslip(["compare", "circle", "--methods", list, "--report", "report"]);
        outcome.assert_refused(list, &[&all]);
    }
    assert!(folder.names().is_empty());
}

#[test]
fn the_table_says_what_the_json_says() {
    let text = Folder::new().done("compare turnaround --methods dla,rk4 --duration 2");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 4, "{text}");
    assert!(lines[1].contains("constraint [m/s]") && lines[1].contains("energy drift [W]"), "{text}");
    assert!(lines[2].starts_with(" dla ") && lines[3].starts_with(" rk4 "), "{text}");
}

#[test]
fn the_report_is_whole_and_overwritten_on_demand_only() {
    let folder = Folder::new();
    let line = "compare circle --methods dla,rk4 --duration 2 --report pages";
    let text = folder.done(line);
    assert!(text.contains("report: pages"), "{text}");
    let files = ["circle-constraint.svg", "circle-energy.svg", "circle-path.svg", "index.html"];
    assert_eq!(names(&folder.join("pages")), files);
    let page = folder.read("pages/index.html");
    assert!(page.trim_end().ends_with("</html>") && page.contains("rk4"));

    folder.write("pages/index.html", "mine");
    folder.refused(line, &["pages", "exists already", "--force"]);
    assert_eq!(folder.read("pages/index.html"), "mine");
    folder.done(&format!("{line} --force"));
    assert!(folder.read("pages/index.html").len() > 1000);
    assert_eq!(folder.names(), ["pages"]);
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
    let outcome = folder.line("compare large.toml --methods dla,rk4-reduced,dla --json --report pages");
    let comparison: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(outcome.code, 1);
    assert_eq!(row_methods(&comparison), ["dla", "rk4-reduced", "dla"]);
    let rows = comparison["rows"].as_array().unwrap();
    assert!(rows[0]["failure"]["step"].is_u64() && rows[1].get("failure").is_none(), "{comparison}");
    assert_eq!(rows[1]["steps"].as_u64(), Some(10));
    outcome.assert_told("compare", &["dla failed at step", "valid up to t ="]);
    // A line for each failure.
    assert_eq!(outcome.stderr.lines().filter(|line| line.starts_with("error: dla failed")).count(), 2);
    assert!(folder.join("pages/index.html").is_file());
    let text = folder.line("compare large.toml --methods dla,rk4-reduced");
    assert!(text.code == 1 && text.stdout.contains(" rk4-reduced "), "{text:?}");
}

#[test]
fn a_refusal_is_shown_and_fails_only_who_asked_for_it() {
    let folder = Folder::new();
    let shaken = "[[effects]]\nkind = \"moving_mass\"\nmass = 0.5\ny = { amplitude = 0.4, frequency = 2.0 }\n";
    folder.write("shaken.toml", format!("{SCENE}{shaken}"));
    let comparison = folder.json("compare shaken.toml --json --report pages");
    assert_eq!(row_methods(&comparison), methods());
    let rows = comparison["rows"].as_array().unwrap();
    let (refused, made): (Vec<&Value>, Vec<&Value>) = rows.iter().partition(|row| row.get("refused").is_some());
    let names: Vec<&str> = refused.iter().map(|row| row["method"].as_str().unwrap()).collect();
    assert_eq!(names, ["energy2", "energy4", "energy6", "energy8"]);
    for row in refused {
        assert_eq!(row["refused"].as_bool(), Some(true));
        assert!(row["failure"]["reason"].as_str().unwrap().contains("explicit time"), "{row}");
        let extra: Vec<&str> = keys(row).into_iter().filter(|key| made[0].get(key).is_none()).collect();
        assert_eq!((extra, keys(row).len()), (vec!["failure", "refused"], keys(made[0]).len() + 2));
    }
    // One row says why; the pictures leave out what has no path, and the others keep their looks.
    let reason = "refused: the energy-preserving methods are for systems without explicit time";
    let text = folder.done("compare shaken.toml");
    let row = text.lines().find(|line| line.starts_with(" energy2 ")).unwrap();
    assert!(row.contains(reason) && row.split_whitespace().nth(1) == Some("2"), "{row}");
    let page = folder.read("pages/index.html");
    assert!(page.contains(&format!("<td colspan=\"8\">{reason}")), "{page}");
    for picture in ["path", "constraint", "energy"] {
        let drawn = folder.read(&format!("pages/shaken-{picture}.svg"));
        assert!(drawn.contains("lobatto5") && !drawn.contains("energy2"), "{picture}");
    }
    // A picture can show it.
    folder.write("free.toml", SCENE);
    folder.done("compare free.toml --methods dla,energy2 --report free");
    assert!(folder.read("free/free-path.svg").contains("energy2"));

    for line in ["compare shaken.toml --methods dla,energy2", "run shaken.toml --method energy2"] {
        let outcome = folder.line(line);
        assert_eq!(outcome.code, 1, "{outcome:?}");
        outcome.assert_told(line, &["energy2", reason]);
    }
}

#[test]
#[ignore = "minutes unless optimised: `cargo test --release --test cli_compare -- --ignored`"]
fn plain_noslip_does_the_main_job() {
    let folder = Folder::new();
    // Somebody's folder, which stays as it is.
    std::fs::create_dir(folder.join("noslip-report")).unwrap();
    folder.write("noslip-report/index.html", "mine");
    let text = folder.done("");
    let tables: Vec<&str> = text.split("\n\n").collect();
    assert_eq!(tables.len(), 1 + SCENES.len(), "{text}");
    for (scene, table) in SCENES.iter().zip(&tables) {
        assert!(table.lines().next().unwrap().contains(&format!("({scene})")), "{table}");
        let first = |line: &str| line.split_whitespace().next().unwrap().to_owned();
        assert_eq!(table.lines().skip(2).map(first).collect::<Vec<_>>(), methods());
    }
    assert!(tables[SCENES.len()].starts_with("report: noslip-report-2"), "{text}");
    let files = names(&folder.join("noslip-report-2"));
    let pictures = 3 * SCENES.len();
    assert_eq!(files.iter().filter(|name| name.ends_with(".svg")).count(), pictures, "{files:?}");
    assert!(files.len() == 1 + pictures && files.contains(&"index.html".to_owned()), "{files:?}");

    assert_eq!(folder.names(), ["noslip-report", "noslip-report-2"]);
    assert_eq!(folder.read("noslip-report/index.html"), "mine");
    folder.refused("--report noslip-report", &["noslip-report", "exists already", "--force"]);
}
