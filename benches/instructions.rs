//! How many instructions everything takes, counted by callgrind: what an effect adds, and that one which is absent adds nothing.
//!
//! The program runs itself under `valgrind --tool=callgrind`, each case with two numbers of steps; the difference is the
//! steps alone. Counts repeat to the instruction where times do not. Valgrind knows not every AVX instruction, so build for a
//! machine that it does know: `RUSTFLAGS="-C target-cpu=x86-64-v2" cargo bench --bench instructions`. Words after `--` choose
//! the groups or cases that contain one of them.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

mod cases;

use cases::Case;
use std::process::{Command, ExitCode};

/// What counts as the same: the issue of inlining decisions, not of terms.
const SAME: f64 = 0.02;

/// Instructions of this program that repeats a case `times` times; `None` where valgrind cannot say.
fn count(case: usize, times: u64) -> Option<u64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(std::env::current_exe().ok()?)
        .args(["--case", &case.to_string(), &times.to_string()])
        .output()
        .ok()?;
    let log = String::from_utf8_lossy(&output.stderr).into_owned();
    let collected = log.lines().find_map(|line| line.split_once("Collected :"))?;
    collected.1.trim().parse().ok().filter(|_| output.status.success())
}

/// Counts the chosen cases; whether all that must be the same are.
fn count_all(cases: &[Case], chosen: impl Fn(&Case) -> bool) -> bool {
    let mut counts: Vec<(&Case, f64)> = Vec::new();
    let mut all_same = true;
    for (k, case) in cases.iter().enumerate().filter(|(_, case)| chosen(case)) {
        // What is left of the difference is the times between, without the start of the program.
        let [before, times] = [case.times() / 5, case.times()];
        let (Some(few), Some(many)) = (count(k, before), count(k, before + times)) else {
            println!("{}: not counted; this needs valgrind, and a build for a processor that it knows", case.name);
            return true;
        };
        if counts.last().is_none_or(|(last, _)| last.group != case.group) {
            println!("\n{}", case.group);
        }
        let each = (many - few) as f64 / times as f64;
        let other =
            counts.iter().find(|(other, _)| other.group == case.group && Some(other.name.as_str()) == case.same);
        let verdict = other.map_or(String::new(), |(other, count)| {
            let same = (each / count - 1.0).abs() <= SAME;
            all_same &= same;
            format!("  {:.3} of `{}`{}", each / count, other.name, if same { "" } else { ": NOT the same" })
        });
        println!("{:<45} {each:>14.1}{verdict}", case.name);
        counts.push((case, each));
    }
    all_same
}

fn main() -> ExitCode {
    let cases = cases::all();
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let Some(at) = arguments.iter().position(|argument| argument == "--case") {
        let number = |k: usize| arguments[at + k].parse::<u64>().expect("a number");
        (cases[usize::try_from(number(1)).expect("a case")].run)(number(2));
        return ExitCode::SUCCESS;
    }
    let words: Vec<&String> = arguments.iter().filter(|word| !word.starts_with('-')).collect();
    let chosen = |case: &Case| {
        words.is_empty() || words.iter().any(|word| case.group.contains(*word) || case.name.contains(*word))
    };
    if count_all(&cases, chosen) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
