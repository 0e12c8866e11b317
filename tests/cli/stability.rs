//! `noslip stability`: every hard case with every method, against the table of what comes of them, from which the rows of
//! `docs/stability.md` of who passes are made.
//!
//! After a change that is meant to change an outcome, one command writes the table and the rows anew:
//!
//! ```text
//! NOSLIP_WRITE=1 cargo test --release --test tests cli::stability::refresh -- --ignored
//! ```

mod page;
mod table;

use crate::program::{Folder, keys, methods};
use page::{listed, row, section, with_row, words};
use serde_json::Value;
use std::fs;
use table::Table;

const TABLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cli/stability/expected.txt");
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/stability.md");

fn text(row: &Value, key: &str) -> String {
    row[key].as_str().unwrap().to_owned()
}

/// What comes of every case and method in a run of the program with such flags: none fails, nothing is silent.
fn found(folder: &Folder, flags: &str) -> Table {
    let found = folder.json(&format!("stability --json{flags}"));
    assert_eq!(keys(&found), ["cases"]);
    let rows = found["cases"].as_array().unwrap();
    let mut table = Table::default();
    for row in rows {
        assert_eq!(keys(row), ["case", "method", "outcome", "measured", "bar", "why"]);
        let (outcome, why) = (text(row, "outcome"), text(row, "why"));
        assert!(outcome == "pass" || outcome == "refused", "{row}");
        assert!(outcome == "pass" || why.len() > 20, "a refusal says why: {row}");
        table.add(&text(row, "case"), &text(row, "method"), outcome == "pass", &why);
    }
    table
}

fn expected() -> Table {
    Table::parse(&fs::read_to_string(TABLE).unwrap())
}

/// A refusal is an answer to most of the cases, and would hide a method that has come to refuse what it could do: so what each of them
/// does with each case is expected, and a difference in either direction is told.
fn assert_expected(found: &Table, expected: &Table) {
    let differences = found.differences(expected);
    assert!(
        differences.is_empty(),
        "{}\nif this is meant: NOSLIP_WRITE=1 cargo test --release --test tests cli::stability::refresh -- --ignored",
        differences.join("\n")
    );
}

#[test]
fn every_outcome_is_expected() {
    let (folder, expected) = (Folder::new(), expected());
    assert_expected(&found(&folder, " --case jumps"), &expected.part("jumps", None));
    for (case, methods) in [("fast", ["dla", "gauss8", "rk4"]), ("parallel-blades", ["dla", "gauss8", "energy2"])] {
        let found = found(&folder, &format!(" --case {case} --methods {}", methods.join(",")));
        assert_expected(&found, &expected.part(case, Some(&methods)));
    }
}

#[test]
#[ignore = "slow"]
fn every_outcome_is_expected_at_length() {
    let folder = Folder::new();
    let (found, expected) = (found(&folder, ""), expected());
    assert_expected(&found, &expected);
    assert_complete(&folder, &found);
}

#[test]
fn the_table_has_every_case_and_method() {
    assert_complete(&Folder::new(), &expected());
}

/// Every case is there, with every method, and passes with one of them.
fn assert_complete(folder: &Folder, table: &Table) {
    let methods = methods();
    let cases = folder.json("list cases --json");
    for case in cases.as_array().unwrap() {
        let of_it = table.of(case["name"].as_str().unwrap());
        // Five where another system than a scene is needed.
        assert!(of_it.len() == methods.len() || of_it.len() == 5, "{case}");
        assert!(of_it.iter().all(|(method, _)| methods.iter().any(|known| known == method)), "{case}");
        // Of the steep hill the honest answer is a refusal: no method sees what lies between its nodes.
        assert!(of_it.iter().any(|(_, passes)| *passes) || case["refusable"] == true, "{case} passes with no method");
    }
}

/// The page tells of each case, in the words of the program, and who passes and refuses, from the table.
#[test]
fn the_page_tells_of_every_case() {
    let cases = Folder::new().json("list cases --json");
    let (page, expected) = (fs::read_to_string(PAGE).unwrap(), expected());
    let named: Vec<_> = cases.as_array().unwrap().iter().map(|case| case["name"].as_str().unwrap()).collect();
    assert_eq!(expected.cases(), named, "the cases of the table and their order");
    for case in cases.as_array().unwrap() {
        let name = case["name"].as_str().unwrap();
        let section = section(&page, name).unwrap_or_else(|| panic!("{name} has no section"));
        for key in ["hard", "shows", "bar"] {
            let told = words(section).contains(&words(case[key].as_str().unwrap()));
            assert!(told, "{name}: the page says another {key}");
        }
        assert_eq!(listed(section), Some(&*row(expected.of(name))), "{name}: who passes is not that of the table");
    }
}

#[test]
fn differences_are_told_in_both_directions() {
    let table = |rows: &[(&str, &str, bool)]| {
        let mut table = Table::default();
        rows.iter().for_each(|(case, method, passes)| table.add(case, method, *passes, "for a reason"));
        table
    };
    let expected = table(&[("fast", "dla", true), ("fast", "rk4", false), ("late", "dla", true)]);
    assert_eq!(Table::parse(&expected.to_string()).to_string(), expected.to_string());
    assert!(Table::parse(&expected.to_string()).differences(&expected).is_empty());
    let found = table(&[("fast", "dla", false), ("fast", "rk4", true), ("cusp", "dla", true)]);
    assert_eq!(
        found.differences(&expected),
        [
            "fast, dla: refused, where pass is expected: for a reason",
            "fast, rk4: pass, where refused is expected: for a reason",
            "cusp, dla: pass, where nothing is expected: for a reason",
            "late, dla: nothing, where pass is expected",
        ]
    );
}

/// Writes table and page anew, where `NOSLIP_WRITE=1` asks for it.
#[test]
#[ignore = "NOSLIP_WRITE=1 writes the table of what is expected, and the rows of the page"]
fn refresh() {
    if std::env::var("NOSLIP_WRITE").as_deref() != Ok("1") {
        return;
    }
    let (found, page) = (found(&Folder::new(), ""), fs::read_to_string(PAGE).unwrap());
    fs::write(TABLE, found.to_string()).unwrap();
    let page = found.cases().iter().fold(page, |page, case| with_row(&page, case, &row(found.of(case))));
    fs::write(PAGE, page).unwrap();
}

#[test]
fn one_hard_case() {
    let folder = Folder::new();
    let text = folder.done("stability --case jumps --methods dla,gauss8");
    let count = "2 pass, 0 refused, 0 missed a bar that is not claimed, 0 failed\n";
    assert!(text.contains("jumps") && text.ends_with(count), "{text}");
    let whole = folder.done("stability --case jumps --methods dla,gauss8 --wide");
    assert!(whole.lines().count() == 4 && whole.contains(" jumps ") && whole.ends_with(count), "{whole}");
    let missed = folder.done("stability --case small-spin --methods dla,gni");
    assert!(missed.contains(" gni      missed ") && missed.lines().all(|line| line.chars().count() <= 80), "{missed}");
    folder.refused("stability --case jump", &["unknown case `jump`", "did you mean `jumps`?", "small-spin"]);
    folder.refused("stability --case jumps --methods nope", &["unknown method"]);
    assert!(folder.done("list cases").contains("small-spin"));
}
