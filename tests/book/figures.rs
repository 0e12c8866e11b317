//! Figures on the pages are those of the program, to their last digit.

use super::commands::words;
use super::pages::Page;
use crate::program::Folder;
use serde_json::Value;
use std::collections::BTreeSet;

/// A line `page: command` for each command that prints JSON, and below it a line for each figure: where the value is, and what the
/// page says of it. Round-off differs from machine to machine, so it has a bound.
const FIGURES: &str = include_str!("figures.txt");

/// Commands that are run in any case.
const QUICK: [&str; 5] = [
    "noslip compare turnaround --methods implicit-midpoint --json",
    "noslip run braking --json",
    "noslip run docs/worked/friction.toml --event speed=1 --json",
    "noslip run knife-edge --method gauss16 --until unwrapped_theta=6.283185307179586 --json",
    "noslip run parking --json",
];

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
    let stands = stands(figure, page);
    (!holds || !stands).then(|| format!("{line}: the program says {value}; on the page: {stands}"))
}

/// Whether a page has a figure.
fn stands(figure: &str, page: &str) -> bool {
    page.contains(figure.trim_start_matches('-'))
}

/// The figures of a command that its page lacks.
fn lacking(page: &str, lines: &[&str]) -> Vec<String> {
    let text = Page::read(page).text;
    let lacks = |line: &&&str| !line.rsplit(' ').next().is_some_and(|figure| stands(figure, &text));
    lines.iter().filter(lacks).map(|line| format!("{page}: {line} is not on the page")).collect()
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

/// Those of the commands that `runs` names; the others are sought on their pages.
fn all(runs: fn(&str) -> bool) {
    let groups =
        FIGURES.split("\n\n").map(|group| group.lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>());
    let (mut wrong, mut known) = (Vec::new(), BTreeSet::new());
    for group in groups.filter(|group| !group.is_empty()) {
        let (page, command) = group[0].split_once(": ").unwrap();
        known.insert(command);
        let lines = &group[1..];
        wrong.extend(if runs(command) { faults(page, command, lines) } else { lacking(page, lines) });
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(QUICK.iter().all(|command| known.contains(command)), "{known:?}");
}

#[test]
fn figures_are_those_of_the_program() {
    all(|command| QUICK.contains(&command));
}

#[test]
#[ignore = "slow"]
fn figures_are_those_of_the_program_at_length() {
    all(|_| true);
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

/// A cell with two times has the second over the first, of the digits that it shows.
#[test]
fn ratios_of_times_are_those_of_the_times_beside_them() {
    let page = Page::read("docs/benchmarks.md");
    let time = |of: &str| of.rsplit(' ').next().and_then(|time| time.parse::<f64>().ok());
    let mut seen = 0;
    for cell in page.text.lines().filter(|line| line.starts_with("| `")).flat_map(|line| line.split(" | ")) {
        let Some((times, ratio)) = cell.split_once(": **") else { continue };
        let (ours, theirs) = times.split_once(", ").unwrap();
        let told: f64 = ratio.split("**").next().unwrap().parse().unwrap();
        let made = time(theirs).unwrap() / time(ours).unwrap();
        assert!((made - told).abs() <= 0.005 + 1e-9, "{cell}: {made}");
        seen += 1;
    }
    assert!(seen > 100, "{seen}");
}
