//! The rows of `noslip run --out`: streamed, continued by `--resume` to the same bytes, in every format, with what made them.
//!
//! `NOSLIP_TRIES=200 cargo test --test tests cli::rows` makes each fault so many times.

use crate::processes::{Dice, damaged, tries};
use crate::program::{Folder, SCENE};
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::process::Stdio;

/// Every 7th node: neither the checkpoints nor the end are due.
const RUN: &str = "run scene.toml --every 7";
const DRAG: &str = "[[effects]]\nkind = \"drag\"\nalong = 0.1\n[[effects]]\nkind = \"thrust\"\nforce = 0.2\n";
const TRAILER: &str = "[[effects]]\nkind = \"trailers\"\ncount = 1\nmass = 0.5\ninertia = 0.1\nbar = 1.0\n";

fn folder() -> Folder {
    folder_of(200)
}

/// With scenes of `seconds` s.
fn folder_of(seconds: u32) -> Folder {
    let folder = Folder::new();
    let scene = format!("{}{DRAG}", SCENE.replace("duration = 2.0", &format!("duration = {seconds}.0")));
    folder.write("train.toml", format!("{scene}{TRAILER}"));
    folder.write("scene.toml", scene);
    folder
}

/// Removes the outputs of a run.
fn clear(folder: &Folder) {
    for name in folder.names().iter().filter(|name| name.starts_with("k.")) {
        fs::remove_file(folder.join(name)).unwrap();
    }
}

/// The output of a run that nothing disturbs, by the name that all outputs have.
fn undisturbed(folder: &Folder, file: &str) -> Vec<u8> {
    folder.done(&format!("{RUN} --out {file}"));
    let bytes = fs::read(folder.join(file)).unwrap();
    clear(folder);
    bytes
}

#[test]
fn a_longer_run_begins_with_the_shorter_one() {
    let runs = [("scene.toml", "k.csv"), ("train.toml", "k.csv"), ("scene.toml", "k.jsonl"), ("train.toml", "k.npz")];
    longer_begins_with_shorter(5, runs.into_iter().chain(parquet().map(|file| ("scene.toml", file))), &["1.85"]);
}

#[test]
#[ignore = "slow"]
fn a_longer_run_begins_with_the_shorter_one_at_length() {
    let formats = ["k.csv", "k.jsonl", "k.npz"].into_iter().chain(parquet());
    let runs = formats.flat_map(|file| ["scene.toml", "train.toml"].map(|scene| (scene, file)));
    longer_begins_with_shorter(200, runs, &["17.35", "50", "100"]);
}

fn parquet() -> Option<&'static str> {
    cfg!(feature = "parquet").then_some("k.parquet")
}

/// Scenes and files, and the durations at which the runs are saved.
fn longer_begins_with_shorter(
    seconds: u32,
    runs: impl Iterator<Item = (&'static str, &'static str)>,
    durations: &[&str],
) {
    let folder = folder_of(seconds);
    for (scene, file) in runs {
        let run = RUN.replace("scene.toml", scene);
        folder.done(&format!("{run} --out {file}"));
        let whole = fs::read(folder.join(file)).unwrap();
        clear(&folder);
        for duration in durations {
            folder.done(&format!("{run} --duration {duration} --out {file} --checkpoint k.save"));
            folder.done(&format!("{run} --out {file} --resume k.save"));
            assert!(fs::read(folder.join(file)).unwrap() == whole, "{file} of {scene} from {duration} s");
            clear(&folder);
        }
    }
    folder.done(&format!("{RUN} --duration 100 --checkpoint k.save"));
    folder.refused("run scene.toml --duration 50 --resume k.save", &["number of steps", "2000", "at most 1000"]);
}

#[cfg(unix)]
#[test]
fn ended_by_a_signal_and_resumed_the_bytes_are_the_same() {
    cut_and_resumed(50, 100, tries(3));
}

#[cfg(unix)]
#[test]
#[ignore = "slow"]
fn ended_by_a_signal_and_resumed_the_bytes_are_the_same_at_length() {
    cut_and_resumed(2000, 1000, tries(9));
}

/// Runs of `seconds` s, saved after every `every` steps, are ended `tries` times.
#[cfg(unix)]
fn cut_and_resumed(seconds: u32, every: u64, tries: u64) {
    let folder = folder_of(seconds);
    let formats = ["k.csv", "k.npz", "k.jsonl"];
    let whole = formats.map(|file| undisturbed(&folder, file));
    let begin = std::time::Instant::now();
    undisturbed(&folder, formats[0]);
    let time = begin.elapsed();
    let (mut random, mut cut) = (1u64, 0);
    for number in 0..tries {
        let (which, signal) = (number as usize % 3, ["-KILL", "-TERM", "-INT", "-HUP"][number as usize % 4]);
        let file = formats[which];
        let saved = format!("{RUN} --out {file} --checkpoint k.save --checkpoint-every {every}");
        let mut child =
            folder.command(saved.split_whitespace()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        std::thread::sleep(time.mul_f64((random >> 33) as f64 / (1u64 << 31) as f64));
        std::process::Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        if !child.wait().unwrap().success() {
            cut += 1;
            let resume = if folder.join("k.save").exists() { "--resume k.save" } else { "--force" };
            folder.done(&format!("{RUN} --out {file} {resume}"));
        }
        assert!(fs::read(folder.join(file)).unwrap() == whole[which], "{file} {signal} at try {number}");
        clear(&folder);
    }
    println!("{cut} of {tries} runs were ended by a signal");
    assert!(cut > 0);
}

#[test]
fn rows_that_are_not_those_of_the_run_are_not_continued() {
    let folder = folder();
    folder.done(&format!("{RUN} --duration 100 --out k.csv --checkpoint k.save"));
    let rows = folder.read("k.csv");
    folder.write("k.csv", rows.replacen("0.3", "0.4", 1));
    let resume = format!("{RUN} --out k.csv --resume k.save");
    folder.refused(&resume, &["k.csv", "begins with the rows", "--force"]);
    folder.write("k.csv", &rows[..rows.len() / 2]);
    folder.refused(&resume, &["k.csv", "begins with the rows", "--force"]);
    folder.done(&format!("{RUN} --duration 100 --out k.npz --checkpoint n.save"));
    folder.done("run scene.toml --duration 50 --every 7 --out k.npz --force");
    folder.refused(
        &resume.replace("k.csv --resume k", "k.npz --resume n"),
        &["k.npz", "begins with the rows", "--force"],
    );
    folder.write("k.npz", "no archive");
    folder.refused(
        &resume.replace("k.csv --resume k", "k.npz --resume n"),
        &["k.npz", "begins with the rows", "--force"],
    );
    folder.write("k.csv", &rows);
    folder.refused("run scene.toml --every 3 --out k.csv --resume k.save", &["--every 3", "every 7"]);
    // A file of another name has the rest.
    let outcome = folder.line("run scene.toml --out k.rest.csv --resume k.save");
    assert_eq!(outcome.code, 0, "{outcome:?}");
    assert!(outcome.stderr.contains("warning: k.rest.csv: no rows"), "{}", outcome.stderr);
    assert!(folder.read("k.rest.csv").lines().nth(1).unwrap().starts_with("100.05"));
}

/// A checkpoint of which a bit is flipped, or a line is exchanged, doubled, removed or cut.
#[test]
fn a_damaged_checkpoint_is_refused_or_the_bytes_are_the_same() {
    damage(tries(12));
}

#[test]
#[ignore = "slow"]
fn a_damaged_checkpoint_is_refused_or_the_bytes_are_the_same_in_full() {
    damage(tries(40));
}

fn damage(tries: u64) {
    let (folder, mut dice) = (folder(), Dice(5));
    let run = "run scene.toml --every 7 --out k.csv";
    folder.done(&format!("{run} --duration 20"));
    let whole = fs::read(folder.join("k.csv")).unwrap();
    clear(&folder);
    folder.done(&format!("{run} --duration 10 --checkpoint k.save"));
    let [save, rows] = ["k.save", "k.csv"].map(|name| fs::read(folder.join(name)).unwrap());
    let (mut refused, mut same) = (0, 0);
    for number in 0..tries {
        fs::write(folder.join("k.csv"), &rows).unwrap();
        let bytes = damaged(&save, &mut dice);
        fs::write(folder.join("k.save"), &bytes).unwrap();
        let outcome = folder.line(&format!("{run} --duration 20 --resume k.save"));
        if outcome.code == 0 {
            same += 1;
            assert!(fs::read(folder.join("k.csv")).unwrap() == whole, "try {number}");
        } else {
            refused += 1;
            outcome.assert_refused("damaged", &["k.save"]);
            assert!(fs::read(folder.join("k.csv")).unwrap() == rows, "try {number}");
        }
    }
    println!("{refused} refused, {same} to the same bytes");
    assert!(refused > 0);
}

#[test]
fn standard_output_has_the_rows_and_nothing_else() {
    // Some more than a pipe holds.
    let folder = folder_of(40);
    folder.done("run scene.toml --out k.csv");
    folder.done("run scene.toml --out k.jsonl");
    for (format, file) in [("", "k.csv"), ("--format csv", "k.csv"), ("--format jsonl", "k.jsonl")] {
        let outcome = folder.line(&format!("run scene.toml --out - {format}"));
        assert_eq!((outcome.code, outcome.stdout), (0, folder.read(file)), "{format}");
        assert!(outcome.stderr.contains("energy error"), "{}", outcome.stderr);
    }
    // The format that is asked for, whatever the name.
    folder.done("run scene.toml --out k.txt --format csv");
    assert_eq!(folder.read("k.txt"), folder.read("k.csv"));
    folder.refused("run scene.toml --out - --json", &["--json", "--out -"]);
    folder.refused("run scene.toml --out - --format npz", &["--format csv or jsonl"]);
    folder.refused("run scene.toml --out k.txt --format xml", &["csv, jsonl, npz"]);
}

#[test]
fn lines_are_objects_with_the_numbers_of_the_table() {
    let folder = folder();
    folder.done("run scene.toml --out k.csv");
    folder.done("run scene.toml --out k.jsonl");
    let (names, rows) = crate::program::csv(&folder.read("k.csv"));
    let lines: Vec<Value> = folder.read("k.jsonl").lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), rows.len());
    for (line, row) in lines.iter().zip(&rows) {
        assert_eq!(crate::program::keys(line), names);
        for (name, number) in names.iter().zip(row) {
            assert_eq!(line[name].as_f64().unwrap().to_bits(), number.to_bits());
        }
    }
}

#[test]
fn a_file_says_what_made_it() {
    let folder = folder();
    folder.done("run scene.toml --step 0.1 --every 3 --out k.csv");
    let document: Value = serde_json::from_str(&folder.read("k.csv-metadata.json")).unwrap();
    assert_eq!((&document["@context"], &document["url"]), (&"http://www.w3.org/ns/csvw".into(), &"k.csv".into()));
    let header = folder.read("k.csv").lines().next().unwrap().to_owned();
    let columns = document["tableSchema"]["columns"].as_array().unwrap();
    let titles: Vec<&str> = columns.iter().map(|column| column["titles"].as_str().unwrap()).collect();
    assert_eq!(titles.join(","), header);
    assert_eq!((&columns[4]["name"], &columns[4]["schema:unitText"]), (&"speed".into(), &"m/s".into()));
    // The command makes the same bytes again, and so does the scene that is told.
    let notes = &document["notes"][0];
    assert!(notes["program"].as_str().unwrap().starts_with("noslip "));
    let rows = folder.read("k.csv");
    let command = notes["command"].as_str().unwrap().strip_prefix("noslip ").unwrap();
    folder.done(&format!("{command} --force"));
    assert_eq!(folder.read("k.csv"), rows);
    folder.write("told.toml", notes["scene"].as_str().unwrap());
    folder.done("run told.toml --every 3 --out k.told.csv");
    assert_eq!(folder.read("k.told.csv"), rows);
    // The same text is in an archive, as an array of its own.
    folder.done("run scene.toml --step 0.1 --every 3 --out k.npz");
    let archive = fs::read(folder.join("k.npz")).unwrap();
    let text: Vec<u8> = "\"schema:unitText\"".chars().flat_map(|c| u32::from(c).to_le_bytes()).collect();
    assert!(archive.windows(text.len()).any(|window| window == text));
}

#[test]
fn a_scene_comes_from_standard_input() {
    let folder = folder();
    let fed = |line: &str, text: &str| {
        let mut command = folder.command(line.split_whitespace());
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
        crate::program::Outcome::of(child.wait_with_output().unwrap())
    };
    folder.done("run scene.toml --out k.csv");
    let scene = folder.read("scene.toml");
    let outcome = fed("run - --out -", &scene);
    assert_eq!((outcome.code, outcome.stdout), (0, folder.read("k.csv")));
    assert_eq!(fed("check -", &scene).code, 0);
    fed("run -", &scene.replace("mass = 1.0", "mass = -1.0")).assert_refused("-", &["stdin:3:8", "mass"]);
    fed("check -", "").assert_refused("-", &["stdin", "the scene is empty"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_reader_who_has_seen_enough_ends_the_run() {
    let folder = folder();
    let mut command = folder.command("run scene.toml --duration 1e7 --out -".split_whitespace());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    assert!(child.wait().unwrap().success());
}
