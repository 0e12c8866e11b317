//! SIGINT, SIGTERM and SIGHUP end every long command, and what is done is written. A checkpoint that cannot be saved is tried again.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "what the tests share is no test")]

#[path = "common/processes.rs"]
mod processes;
#[path = "common/program.rs"]
mod program;

use processes::{ended, output, send, signals, started, wait_for};
use program::{Folder, SCENE};
use serde_json::Value;
use std::fs;
use std::time::{Duration, Instant};

/// Sends a signal to a command that would take much longer: it ends soon, with the code of an interruption, says how far it came, and
/// prints what it has.
fn interrupted(folder: &Folder, line: &str, signal: &str, told: &str) -> Value {
    let child = started(folder, &format!("{line} --json"));
    std::thread::sleep(Duration::from_millis(1500));
    let begin = Instant::now();
    send(signal, &child);
    let (code, printed, said) = output(child);
    assert_eq!(code, Some(130), "{line} {signal}: {said}");
    assert!(said.contains("error: interrupted: ") && said.contains(told), "{line} {signal}: {said}");
    assert!(begin.elapsed() < Duration::from_secs(30), "{line} {signal}: {:?}", begin.elapsed());
    serde_json::from_str(&printed).unwrap()
}

#[test]
fn exponents_are_those_of_the_time_that_was_measured() {
    let folder = Folder::new();
    for signal in signals() {
        let line = "lyapunov egg-crate-chaos --duration 1000000 --settle 1 --out k.csv --force";
        let found = interrupted(&folder, line, signal, "the exponents cover ");
        let duration = found["duration"].as_f64().unwrap();
        assert!(duration > 0.0 && duration < 1e6, "{signal}: {found}");
        assert!(found["exponents"][0].is_f64(), "{signal}: {found}");
        let (_, rows) = program::csv(&folder.read("k.csv"));
        assert!(rows.iter().all(|row| row[0] <= duration), "{signal}: {rows:?} and {duration}");
    }
}

#[test]
fn maps_and_sections_have_the_starts_that_are_done() {
    let folder = Folder::new();
    for signal in signals() {
        let line = "lyapunov egg-crate-chaos --map speed=0.5:1.5:300 --map heading=-1:1:300 --duration 20 --out map.csv --force";
        let found = interrupted(&folder, line, signal, " of 90000 starts finished");
        let known = |row: &Value| row.as_array().unwrap().iter().filter(|cell| cell.is_f64()).count();
        let known: usize = found["exponents"].as_array().unwrap().iter().map(known).sum();
        assert!(known > 0 && known < 90_000, "{signal}: {known}");
        assert_eq!(folder.read("map.csv").lines().count(), 1 + known, "{signal}");

        let line = "section egg-crate-chaos --plane y=0 --starts 50000 --duration 1 --out section.csv --force";
        let found = interrupted(&folder, line, signal, " starts finished");
        let starts = found["starts"].as_array().unwrap();
        assert!(!starts.is_empty() && starts.len() < 50_000, "{signal}: {}", starts.len());
        let points: usize = starts.iter().map(|start| start["points"].as_array().unwrap().len()).sum();
        assert_eq!(folder.read("section.csv").lines().count(), 1 + points, "{signal}");
    }
}

#[test]
fn work_precision_diagrams_have_the_methods_that_are_measured() {
    let folder = Folder::new();
    for signal in signals() {
        let line = "precision turnaround --longest 3 --csv points.csv --force";
        let found = interrupted(&folder, line, signal, " methods finished");
        let points = found["points"].as_array().unwrap();
        assert_eq!(folder.read("points.csv").lines().count(), 1 + points.len(), "{signal}");
    }
}

#[test]
fn hard_cases_have_the_rows_that_are_done() {
    let folder = Folder::new();
    for signal in signals() {
        let found = interrupted(&folder, "stability", signal, " rows finished");
        assert!(found.is_array() || found.is_object(), "{signal}: {found}");
    }
}

#[test]
fn a_save_that_fails_is_told_at_once_and_tried_again() {
    let folder = Folder::new();
    folder.write("long.toml", SCENE.replace("duration = 2.0", "duration = 2000000.0"));
    fs::create_dir(folder.join("saves")).unwrap();
    let child = started(&folder, "run long.toml --checkpoint saves/s.save --checkpoint-every 1000");
    wait_for(&folder, "saves/s.save", 1);
    // The folder is gone for a while, as a disk that is not there.
    fs::rename(folder.join("saves"), folder.join("gone")).unwrap();
    std::thread::sleep(Duration::from_millis(500));
    fs::create_dir(folder.join("saves")).unwrap();
    wait_for(&folder, "saves/s.save", 1);
    send("-TERM", &child);
    let (code, told) = ended(child);
    assert_eq!(code, Some(130), "{told}");
    assert_eq!(told.matches("warning: cannot write saves/s.save").count(), 1, "{told}");
    assert!(told.contains("the run goes on, and the next save is tried"), "{told}");
    assert!(told.contains("--resume saves/s.save continues"), "{told}");
    // Nothing is left beside the checkpoint, and the run goes on from it.
    assert_eq!(program::names(&folder.join("saves")), ["s.save"]);
    let child = started(&folder, "run long.toml --resume saves/s.save");
    std::thread::sleep(Duration::from_millis(300));
    send("-TERM", &child);
    let (code, told) = ended(child);
    assert_eq!(code, Some(130), "{told}");

    // The control: where no save succeeds any more, that is an error in the end.
    folder.write("short.toml", SCENE.replace("duration = 2.0", "duration = 20000.0"));
    let child = started(&folder, "run short.toml --checkpoint saves/t.save --checkpoint-every 100");
    wait_for(&folder, "saves/t.save", 1);
    // In one move: a folder that is emptied may get a file meanwhile.
    fs::rename(folder.join("saves"), folder.join("taken")).unwrap();
    let (code, told) = ended(child);
    assert_eq!(code, Some(1), "{told}");
    assert!(told.contains("error: cannot write saves/t.save"), "{told}");
}
