//! Figures on the pages are those of the program, to their last digit.

use super::commands::words;
use super::pages::Page;
use crate::program::Folder;
use serde_json::Value;

/// A line `page: command` for each command that prints JSON, and below it a line for each figure: where the value is, and what the
/// page says of it. Round-off differs from machine to machine, so it has a bound.
const FIGURES: &str = include_str!("figures.txt");

/// Half a unit of the last digit of a figure.
fn half_unit(figure: &str) -> f64 {
    let (digits, exponent) = figure.split_once('e').unwrap_or((figure, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    0.5 * 10_f64.powi(exponent.parse::<i32>().unwrap() - i32::try_from(decimals).unwrap())
}

/// What is wrong with a line such as `/error = 1.5e-3` or `/constraint/max < 1e-15`, beside the values of the program and the page.
fn fault(line: &str, values: &Value, page: &str) -> Option<String> {
    let [place, relation, figure] = line.split_whitespace().collect::<Vec<_>>()[..] else {
        return Some(format!("{line}: three words are expected"));
    };
    let Some(value) = values.pointer(place).and_then(Value::as_f64) else {
        return Some(format!("{line}: no number there"));
    };
    let said: f64 = figure.parse().unwrap();
    // The last digit of a decimal fraction is not exact in a binary one.
    let holds = match relation {
        "=" => (value - said).abs() <= half_unit(figure) * (1.0 + 1e-6),
        _ => value.abs() < said,
    };
    let stands = page.contains(figure.trim_start_matches('-'));
    (!holds || !stands).then(|| format!("{line}: the program says {value}; on the page: {stands}"))
}

/// The figures of one page by one command.
fn faults(page: &str, command: &str, lines: &[&str]) -> Vec<String> {
    let (text, outcome) = (Page::read(page).text, Folder::new().noslip(words(command)));
    assert_eq!(outcome.code, 0, "{page}: {command}: {}", outcome.stderr);
    let values: Value = serde_json::from_str(&outcome.stdout).unwrap();
    lines
        .iter()
        .filter_map(|line| fault(line, &values, &text))
        .map(|fault| format!("{page}: {command}: {fault}"))
        .collect()
}

#[test]
fn figures_are_those_of_the_program() {
    let groups =
        FIGURES.split("\n\n").map(|group| group.lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>());
    let mut wrong = Vec::new();
    for group in groups.filter(|group| !group.is_empty()) {
        let (page, command) = group[0].split_once(": ").unwrap();
        wrong.extend(faults(page, command, &group[1..]));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_wrong_figure_is_seen() {
    let values = serde_json::json!({"turn": 0.13125, "slip": 1e-3});
    let seen = |line| fault(line, &values, "a turn of 0.1313 or 0.1312 or 0.2 rad, a slip of 1e-15").is_some();
    assert!(!seen("/turn = 0.1313") && !seen("/turn = 0.1312") && !seen("/turn < 0.2"));
    for wrong in ["/turn = 0.1311", "/slip < 1e-15", "/turns = 0.1313", "/turn = 0.13126", "/turn 0.1313"] {
        assert!(seen(wrong), "{wrong}");
    }
}
