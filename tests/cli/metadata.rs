//! What made a file of numbers, and the units of its columns, stand beside every `.csv`.

use crate::program::{Folder, SCENE};
use serde_json::Value;

/// The document beside a file, with the columns of the header.
fn beside(folder: &Folder, file: &str) -> Value {
    let document: Value = serde_json::from_str(&folder.read(&format!("{file}-metadata.json"))).unwrap();
    assert_eq!(document["@context"], "http://www.w3.org/ns/csvw");
    assert_eq!(document["url"], file.rsplit('/').next().unwrap());
    let columns = document["tableSchema"]["columns"].as_array().unwrap();
    let titles: Vec<&str> = columns.iter().map(|column| column["titles"].as_str().unwrap()).collect();
    assert_eq!(Some(titles.join(",").as_str()), folder.read(file).lines().next(), "{file}");
    for (title, column) in titles.iter().zip(columns) {
        let unit = title.split_once(" [").map(|(_, unit)| unit.trim_end_matches(']'));
        assert_eq!(column.get("schema:unitText").and_then(Value::as_str), unit, "{title} of {file}");
    }
    assert!(document["notes"][0]["program"].as_str().unwrap().starts_with("noslip "), "{document}");
    assert!(document["notes"][0]["scene"].as_str().unwrap().contains("[sleigh]"), "{document}");
    document
}

#[test]
fn the_command_that_is_told_makes_the_same_numbers_again() {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    let set = "--set sleigh.offset=0.4";
    for line in [
        format!("run scene.toml {set} --every 5 --out k.csv"),
        format!("run scene.toml {set} --method gauss-adaptive --tolerance 1e-9 --out k.csv"),
        format!("section scene.toml {set} --plane heading=0.1 --duration 15 --starts 2 --out k.csv"),
        format!("lyapunov scene.toml {set} --duration 4 --settle 1 --exponents 2 --energy 1 --out k.csv"),
        format!("lyapunov scene.toml {set} --duration 2 --map speed=-1:1:2 --map turn_rate=0:1:2 --out k.csv"),
    ] {
        folder.done(&format!("{line} --force"));
        let rows = folder.read("k.csv");
        assert!(rows.lines().count() > 2, "{line}: {rows}");
        let document = beside(&folder, "k.csv");
        let command = document["notes"][0]["command"].as_str().unwrap().strip_prefix("noslip ").unwrap();
        assert!(command.contains(set), "{command}");
        std::fs::remove_file(folder.join("k.csv")).unwrap();
        folder.refused(command, &["k.csv-metadata.json", "exists already"]);
        folder.done(&format!("{command} --force"));
        assert_eq!(folder.read("k.csv"), rows, "{command}");
        // The scene that is told has the value of the command line.
        assert!(document["notes"][0]["scene"].as_str().unwrap().contains("offset = 0.4"), "{document}");
    }
    // A picture has no columns.
    folder.done("section scene.toml --plane heading=0.1 --duration 4 --starts 1 --out k.svg");
    assert!(!folder.names().contains(&"k.svg-metadata.json".to_owned()));
}

/// Files that `precision` writes, by runs of so long at most (s), with more that it does.
fn others(longest: &str, more: &str, files: &[&str]) {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    folder.done(&format!("precision scene.toml --methods dla --duration 1 --longest {longest} --csv k.csv {more}"));
    for file in files {
        let document = beside(&folder, file);
        assert_eq!(document["tableSchema"]["columns"][9]["datatype"], "boolean");
        assert!(document["notes"][0]["command"].as_str().unwrap().contains("--methods dla --duration 1.0"));
    }
    folder.done("compare scene.toml --methods dla --report compared");
    beside(&folder, "compared/scene.csv");
    assert!(folder.read("compared/index.html").contains("scene.csv-metadata.json"));
    folder.write("sweep.toml", "scene = \"scene.toml\"\n[grid]\n\"start.speed\" = [1.0, 2.0]\n");
    folder.done("ensemble sweep.toml --out e.csv");
    let document = beside(&folder, "e.csv");
    let last = document["tableSchema"]["columns"].as_array().unwrap().last().unwrap().clone();
    assert_eq!((&last["name"], &last["datatype"]), (&"error".into(), &"string".into()));
}

#[test]
fn work_precision_diagrams_comparisons_and_ensembles_have_one() {
    others("0.0000001", "", &["k.csv"]);
}

#[test]
#[ignore = "slow"]
fn work_precision_diagrams_comparisons_and_ensembles_have_one_at_length() {
    others("0.001", "--report pages", &["k.csv", "pages/scene.csv"]);
}
