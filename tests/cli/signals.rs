//! SIGINT, SIGTERM and SIGHUP end every long command, and what is done is written. A checkpoint that cannot be saved is tried again.
#![cfg(unix)]

use crate::processes::{ended, output, send, signals, started, tries, wait_for};
use crate::program::{Folder, SCENE};
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::time::{Duration, Instant};

/// Sends a signal to a command that would take much longer, after that time: it ends soon, with the code of an interruption, says how far it
/// came, and prints what it has.
fn interrupted(folder: &Folder, line: &str, signal: &str, wait: Duration, told: &str) -> Value {
    let child = started(folder, &format!("{line} --json"));
    std::thread::sleep(wait);
    let begin = Instant::now();
    send(signal, &child);
    let (code, printed, said) = output(child);
    assert_eq!(code, Some(130), "{line} {signal}: {said}");
    assert!(said.contains("error: interrupted: ") && said.contains(told), "{line} {signal}: {said}");
    assert!(begin.elapsed() < Duration::from_secs(30), "{line} {signal}: {:?}", begin.elapsed());
    serde_json::from_str(&printed).unwrap()
}

/// For a short test one of the signals, and the times after which it comes: the later ones where nothing is done by then.
fn one(which: usize) -> (Vec<&'static str>, [Duration; 3]) {
    let signals: Vec<_> = signals().collect();
    (vec![signals[which % signals.len()]], [200, 800, 3200].map(Duration::from_millis))
}

/// For a long one all of them.
fn all() -> (Vec<&'static str>, [Duration; 3]) {
    (signals().collect(), [1500, 6000, 24_000].map(Duration::from_millis))
}

/// What a command prints once it has something of `some`.
fn with_some(
    folder: &Folder,
    (line, told): (&str, &str),
    signal: &str,
    waits: [Duration; 3],
    some: impl Fn(&Value) -> bool,
) -> Value {
    let found = waits.iter().map(|wait| interrupted(folder, line, signal, *wait, told)).find(some);
    found.unwrap_or_else(|| panic!("{line} {signal}: nothing is done"))
}

#[test]
fn exponents_are_those_of_the_time_that_was_measured() {
    exponents(one(0));
}

#[test]
#[ignore = "slow"]
fn exponents_are_those_of_the_time_that_was_measured_at_length() {
    exponents(all());
}

fn exponents((signals, waits): (Vec<&str>, [Duration; 3])) {
    let folder = Folder::new();
    for signal in signals {
        let line = "lyapunov egg-crate-chaos --duration 1000000 --settle 1 --out k.csv --force";
        let told = (line, "the exponents cover ");
        let found = with_some(&folder, told, signal, waits, |found| found["duration"].as_f64() > Some(0.0));
        let duration = found["duration"].as_f64().unwrap();
        assert!(duration < 1e6, "{signal}: {found}");
        assert!(found["exponents"][0].is_f64(), "{signal}: {found}");
        let (_, rows) = crate::program::csv(&folder.read("k.csv"));
        assert!(rows.iter().all(|row| row[0] <= duration), "{signal}: {rows:?} and {duration}");
    }
}

#[test]
fn maps_have_the_starts_that_are_done() {
    map(one(1), 100, 1);
}

#[test]
#[ignore = "slow"]
fn maps_have_the_starts_that_are_done_at_length() {
    map(all(), 300, 20);
}

/// A map of `count` starts along each axis, of `duration` s each.
fn map((signals, waits): (Vec<&str>, [Duration; 3]), count: usize, duration: u32) {
    let folder = Folder::new();
    let line = format!(
        "lyapunov egg-crate-chaos --map speed=0.5:1.5:{count} --map heading=-1:1:{count} --duration {duration} --out map.csv --force"
    );
    let told = format!(" of {} starts finished", count * count);
    let known = |row: &Value| row.as_array().unwrap().iter().filter(|cell| cell.is_f64()).count();
    let known = |found: &Value| found["exponents"].as_array().unwrap().iter().map(known).sum::<usize>();
    for signal in signals {
        let known = known(&with_some(&folder, (line.as_str(), told.as_str()), signal, waits, |found| known(found) > 0));
        assert!(known < count * count, "{signal}: {known}");
        assert_eq!(folder.read("map.csv").lines().count(), 1 + known, "{signal}");
    }
}

#[test]
fn sections_have_the_starts_that_are_done() {
    section(one(2), 2000, 5);
}

#[test]
#[ignore = "slow"]
fn sections_have_the_starts_that_are_done_at_length() {
    section(all(), 50_000, 1);
}

/// `count` starts of `duration` s each.
fn section((signals, waits): (Vec<&str>, [Duration; 3]), count: usize, duration: u32) {
    let folder = Folder::new();
    let line =
        format!("section egg-crate-chaos --plane y=0 --starts {count} --duration {duration} --out section.csv --force");
    let starts = |found: &Value| found["starts"].as_array().unwrap().clone();
    for signal in signals {
        let told = (line.as_str(), " starts finished");
        let starts = starts(&with_some(&folder, told, signal, waits, |found| !starts(found).is_empty()));
        assert!(starts.len() < count, "{signal}: {}", starts.len());
        let points: usize = starts.iter().map(|start| start["points"].as_array().unwrap().len()).sum();
        assert_eq!(folder.read("section.csv").lines().count(), 1 + points, "{signal}");
    }
}

/// A start that has begun ends too, with the points that it has: it alone would take hours.
#[test]
fn a_long_start_of_a_section_ends_at_a_signal() {
    let folder = Folder::new();
    let (signals, waits) = one(0);
    let line = "section bowl --plane x=0 --starts 2 --duration 1000000";
    let starts = |found: &Value| found["starts"].as_array().unwrap().clone();
    for signal in signals {
        let found =
            with_some(&folder, (line, "0 of 2 starts finished"), signal, waits, |found| !starts(found).is_empty());
        assert!(starts(&found).iter().all(|start| start["interrupted"] == true), "{found}");
    }
}

/// A signal after the methods, while the reference of their ends is computed, is one all the same: there are rows, and no end errors.
#[test]
fn a_comparison_that_is_ended_in_its_reference_says_so() {
    let folder = Folder::new();
    let (signals, waits) = one(1);
    let line = "compare bowl --methods dla --duration 1000";
    let whole = |found: &Value| found["rows"][0].is_object() && found["rows"][0]["interrupted"].is_null();
    for signal in signals {
        let found = with_some(&folder, (line, "methods finished"), signal, waits, whole);
        assert!(found["interrupted"] == true && found["rows"][0]["error"].is_null(), "{found}");
    }
}

/// What accuracy costs is compared with a reference, which is made as a whole: it alone takes too long for a short test.
#[test]
#[ignore = "slow"]
fn work_precision_diagrams_have_the_methods_that_are_measured() {
    let folder = Folder::new();
    let (signals, [wait, ..]) = all();
    for signal in signals {
        let line = "precision turnaround --longest 3 --csv points.csv --force";
        let found = interrupted(&folder, line, signal, wait, " methods ");
        let points = found["points"].as_array().unwrap();
        assert_eq!(folder.read("points.csv").lines().count(), 1 + points.len(), "{signal}");
    }
}

#[test]
fn hard_cases_have_the_rows_that_are_done() {
    hard_cases(one(0));
}

#[test]
#[ignore = "slow"]
fn hard_cases_have_the_rows_that_are_done_at_length() {
    hard_cases(all());
}

fn hard_cases((signals, [wait, ..]): (Vec<&str>, [Duration; 3])) {
    let folder = Folder::new();
    for signal in signals {
        let found = interrupted(&folder, "stability", signal, wait, " rows finished");
        assert!(found.is_array() || found.is_object(), "{signal}: {found}");
    }
}

#[test]
fn a_save_that_fails_is_told_at_once_and_tried_again() {
    let folder = Folder::new();
    folder.write("long.toml", SCENE.replace("duration = 2.0", "duration = 2000000.0"));
    fs::create_dir(folder.join("saves")).unwrap();
    let mut child = started(&folder, "run long.toml --checkpoint saves/s.save --checkpoint-every 1000");
    let mut said = BufReader::new(child.stderr.take().unwrap());
    wait_for(&folder, "saves/s.save", 1);
    // The folder is gone for a while, as a disk that is not there.
    fs::rename(folder.join("saves"), folder.join("gone")).unwrap();
    let mut told = String::new();
    while !told.contains("warning: cannot write saves/s.save") {
        assert!(said.read_line(&mut told).unwrap() > 0, "{told}");
    }
    fs::create_dir(folder.join("saves")).unwrap();
    wait_for(&folder, "saves/s.save", 1);
    send("-TERM", &child);
    said.read_to_string(&mut told).unwrap();
    let (code, _) = ended(child);
    assert_eq!(code, Some(130), "{told}");
    assert_eq!(told.matches("warning: cannot write saves/s.save").count(), 1, "{told}");
    assert!(told.contains("the run goes on, and the next save is tried"), "{told}");
    assert!(told.contains("--resume saves/s.save continues"), "{told}");
    // Nothing is left beside the checkpoint, and the run goes on from it.
    assert_eq!(crate::program::names(&folder.join("saves")), ["s.save"]);
    let child = started(&folder, "run long.toml --resume saves/s.save --checkpoint r.save --checkpoint-every 1000");
    wait_for(&folder, "r.save", 1);
    send("-TERM", &child);
    let (code, told) = ended(child);
    assert_eq!(code, Some(130), "{told}");
}

/// Where no save succeeds any more, that is an error in the end.
#[test]
fn a_run_that_cannot_be_saved_is_an_error() {
    let folder = Folder::new();
    // Saved so often that it takes long while it can be saved.
    folder.write("short.toml", SCENE.replace("duration = 2.0", "duration = 1000.0"));
    fs::create_dir(folder.join("saves")).unwrap();
    let child = started(&folder, "run short.toml --checkpoint saves/t.save --checkpoint-every 5");
    wait_for(&folder, "saves/t.save", 1);
    // In one move: a folder that is emptied may get a file meanwhile.
    fs::rename(folder.join("saves"), folder.join("taken")).unwrap();
    let (code, told) = ended(child);
    assert_eq!(code, Some(1), "{told}");
    assert!(told.contains("error: cannot write saves/t.save"), "{told}");
}

/// A wrapper and a terminal may each send the signal, one shortly after the other: each of the gaps (ms) is tried `tries` times.
fn two_signals(gaps: &[f64], tries: u64) {
    let folder = Folder::new();
    folder.write("long.toml", SCENE.replace("duration = 2.0", "duration = 2000000.0"));
    let line = "run long.toml --out k.csv --checkpoint k.save --checkpoint-every 1000000000";
    let mut saved = 0;
    for number in 0..tries {
        for gap in gaps {
            let child = started(&folder, line);
            wait_for(&folder, "k.csv.part", 1 << 12);
            send("-TERM", &child);
            std::thread::sleep(Duration::from_secs_f64(1e-3 * gap));
            // It may have ended by then.
            let _ = std::process::Command::new("kill").args(["-TERM", &child.id().to_string()]).output();
            let (code, told) = ended(child);
            assert_eq!(code, Some(130), "{told}");
            assert!(folder.join("k.save").exists(), "try {number}, {gap} ms: {told}");
            assert_eq!(folder.names(), ["k.csv", "k.csv-metadata.json", "k.save", "long.toml"]);
            folder.names().iter().filter(|name| name.starts_with("k.")).for_each(|name| {
                fs::remove_file(folder.join(name)).unwrap();
            });
            saved += 1;
        }
    }
    println!("{saved} of {saved} saved");
}

#[test]
fn two_signals_that_come_together_are_one() {
    two_signals(&[0.5, 10.0], tries(1));
}

#[test]
#[ignore = "slow"]
fn two_signals_that_come_together_are_one_at_length() {
    two_signals(&[0.0, 0.5, 2.0, 10.0, 50.0], tries(40));
}

/// The control: who waits and sends another means it.
#[test]
fn a_second_signal_after_a_while_ends_at_once() {
    let folder = Folder::new();
    // One member takes very long.
    let sweep =
        "scene = \"turnaround\"\nduration = 1e7\nstep = 0.001\nmethod = \"rk4\"\n[grid]\n\"start.speed\" = [0.1]\n";
    folder.write("slow.toml", sweep);
    let child = started(&folder, "ensemble slow.toml --out slow.csv");
    wait_for(&folder, "slow.csv.part", 1);
    send("-TERM", &child);
    std::thread::sleep(Duration::from_millis(1500));
    send("-TERM", &child);
    let begin = Instant::now();
    let (code, told) = ended(child);
    assert_eq!(code, Some(130), "{told}");
    assert!(begin.elapsed() < Duration::from_secs(5), "{:?}", begin.elapsed());
}
