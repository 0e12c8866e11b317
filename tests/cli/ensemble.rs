//! `noslip ensemble` under faults: ended by signals, beside another process, with a damaged spool. Nothing that was computed is lost, and
//! nothing that was not computed is in a result.
//!
//! `NOSLIP_TRIES=200 cargo test --test tests cli::ensemble` makes each fault so many times.
#![cfg(unix)]

use crate::processes::{Dice, damaged, ended, send, signals, started, tries, wait_for};
use crate::program::Folder;
use std::fs;
use std::time::{Duration, Instant};

const SWEEP: &str = "\
scene = \"turnaround\"
duration = 5.0
[random]
seed = 3
count = 500
\"start.turn_rate\" = { uniform = [0.05, 0.3] }
";

/// The result of a sweep that nothing disturbs, and how long it takes.
fn undisturbed(folder: &Folder, sweep: &str) -> (Vec<u8>, Duration) {
    let begin = Instant::now();
    folder.done(&format!("ensemble {sweep} --out whole.csv --force"));
    let result = fs::read(folder.join("whole.csv")).unwrap();
    fs::remove_file(folder.join("whole.csv")).unwrap();
    fs::remove_file(folder.join("whole.csv-metadata.json")).unwrap();
    (result, begin.elapsed())
}

/// The spool of all members, as a process leaves it that could not write the result: there is another file at the end.
fn spool(folder: &Folder, sweep: &str, out: &str) -> Vec<u8> {
    let part = format!("{out}.part");
    loop {
        let child = started(folder, &format!("ensemble {sweep} --out {out}"));
        wait_for(folder, &part, 60);
        folder.write(out, "other");
        let (code, told) = ended(child);
        let bytes = fs::read(folder.join(&part));
        fs::remove_file(folder.join(out)).unwrap();
        if code == Some(2) && told.contains("exists already") {
            fs::remove_file(folder.join(&part)).unwrap();
            return bytes.unwrap();
        }
        // It was done before the other file was there.
    }
}

#[test]
fn rows_are_in_the_spool_as_soon_as_they_are_done() {
    let folder = Folder::new();
    for method in ["dla", "rk4"] {
        folder
            .write("slow.toml", SWEEP.replace("duration = 5.0", &format!("duration = 1000.0\nmethod = \"{method}\"")));
        let child = started(&folder, "ensemble slow.toml --out slow.csv");
        wait_for(&folder, "slow.csv.part", 1000);
        send("-KILL", &child);
        assert_eq!(ended(child).0, None);
        let text = folder.read("slow.csv.part");
        assert!(text.starts_with("noslip ensemble ") && text.lines().count() < 400, "{method}");
        fs::remove_file(folder.join("slow.csv.part")).unwrap();
    }
}

/// The sweep with `members` members.
fn sweep(members: u32) -> String {
    SWEEP.replace("count = 500", &format!("count = {members}"))
}

fn killed_and_resumed(members: u32, tries: u64) {
    let (folder, mut dice) = (Folder::new(), Dice(1));
    folder.write("sweep.toml", sweep(members));
    let (whole, time) = undisturbed(&folder, "sweep.toml");
    let (mut cut, mut kept) = (0, 0);
    for number in 0..tries {
        let signal = ["-KILL", "-TERM", "-INT", "-HUP"][number as usize % 4];
        let mut line = "ensemble sweep.toml --out k.csv".to_owned();
        for resumed in 0.. {
            let child = started(&folder, &line);
            // The second process may be ended too, the third is not.
            if resumed < 2 && dice.below(resumed + 1) == 0 {
                std::thread::sleep(time.mul_f64(dice.below(1000) as f64 / 1000.0));
                send(signal, &child);
            }
            let (code, told) = ended(child);
            assert!(!told.contains("panicked"), "{told}");
            // A process may be killed when its result is there already, and what lies beside it is not yet removed.
            if code == Some(0) || code.is_none() && folder.join("k.csv").exists() {
                break;
            }
            // A signal that comes before the program listens ends it as it ends any other.
            assert!(
                code.is_none() || code == Some(130) && told.contains("--resume continues"),
                "{signal}: {code:?} {told}"
            );
            cut += 1;
            kept += u64::from(fs::metadata(folder.join("k.csv.part")).is_ok_and(|metadata| metadata.len() > 1000));
            line = "ensemble sweep.toml --out k.csv --resume".to_owned();
        }
        assert!(fs::read(folder.join("k.csv")).unwrap() == whole, "{signal} at try {number}");
        fs::remove_file(folder.join("k.csv")).unwrap();
        // A process that was killed while it wrote the metadata leaves their new file, in whose place the next one comes.
        for beside in ["k.csv-metadata.json", "k.csv-metadata.json.noslip-new", "k.csv.part"] {
            let _ = fs::remove_file(folder.join(beside));
        }
        assert_eq!(folder.names(), ["sweep.toml"]);
    }
    println!("{cut} runs were ended by a signal, {kept} of them with rows in the spool");
    assert!(cut > 0);
}

#[test]
fn killed_at_any_time_and_resumed_the_bytes_are_the_same() {
    killed_and_resumed(160, tries(3));
}

#[test]
#[ignore = "slow"]
fn killed_at_any_time_and_resumed_the_bytes_are_the_same_at_length() {
    killed_and_resumed(500, tries(9));
}

/// Members that take long, of which a thread has at most one at a time.
fn stopped(duration: f64) {
    let folder = Folder::new();
    let long = format!("duration = {duration:?}\nmethod = \"rk4\"");
    folder.write("slow.toml", SWEEP.replace("duration = 5.0", &long));
    for signal in signals() {
        let child = started(&folder, "ensemble slow.toml --out slow.csv");
        wait_for(&folder, "slow.csv.part", 100);
        send(signal, &child);
        let (code, told) = ended(child);
        assert_eq!(code, Some(130), "{told}");
        assert!(told.contains("stopping after the members that have begun; Ctrl-C again ends at once"), "{told}");
        assert!(told.contains("of 500 members finished; the same command with --resume continues"), "{told}");
        fs::remove_file(folder.join("slow.csv.part")).unwrap();
    }
}

#[test]
fn a_signal_stops_it_between_members() {
    stopped(200.0);
}

#[test]
#[ignore = "slow"]
fn a_signal_stops_it_between_members_at_length() {
    stopped(5000.0);
}

fn two_processes(members: u32, mut dice: Dice, tries: u64) {
    let folder = Folder::new();
    folder.write("x.toml", sweep(members));
    folder.write("y.toml", sweep(members).replace("seed = 3", "seed = 4"));
    let (x, time) = undisturbed(&folder, "x.toml");
    let (y, _) = undisturbed(&folder, "y.toml");
    assert!(x != y);
    let mut refused = 0;
    for number in 0..tries {
        let first = started(&folder, "ensemble x.toml --out two.csv --force");
        std::thread::sleep(time.mul_f64(dice.below(1000) as f64 / 900.0));
        let second = started(&folder, "ensemble y.toml --out two.csv --force");
        let [first, second] = [ended(first), ended(second)];
        let result = fs::read(folder.join("two.csv")).unwrap();
        match (first.0, second.0) {
            (Some(0), Some(2)) => assert!(result == x, "try {number}"),
            (Some(2), Some(0)) => assert!(result == y, "try {number}"),
            // One after the other; the later one has the file, whichever began first.
            (Some(0), Some(0)) => assert!(result == y || result == x, "try {number}"),
            codes => panic!("{codes:?}: {} {}", first.1, second.1),
        }
        for (code, told) in [&first, &second] {
            if *code == Some(2) {
                refused += 1;
                assert!(told.contains(": another process is writing two.csv"), "{told}");
            }
        }
    }
    println!("{refused} processes were refused");
    assert!(refused > 0);
}

#[test]
fn two_processes_do_not_share_an_output() {
    two_processes(160, Dice(1), tries(2));
}

#[test]
#[ignore = "slow"]
fn two_processes_do_not_share_an_output_at_length() {
    two_processes(500, Dice(2), tries(6));
}

fn damaged_spools(duration: f64, tries: u64) {
    let (folder, mut dice) = (Folder::new(), Dice(3));
    folder.write("sweep.toml", sweep(64).replace("5.0", &format!("{duration:?}\nmethod = \"rk4\"")));
    let (whole, _) = undisturbed(&folder, "sweep.toml");
    let part = spool(&folder, "sweep.toml", "d.csv");
    assert_eq!(part.split(|byte| *byte == b'\n').count(), 1 + 64 + 1);
    let (mut refused, mut healed) = (0, 0);
    for number in 0..tries {
        let bytes = damaged(&part, &mut dice);
        fs::write(folder.join("d.csv.part"), &bytes).unwrap();
        let outcome = folder.line("ensemble sweep.toml --out d.csv --resume");
        assert!(!outcome.stderr.contains("panicked"), "try {number}: {outcome:?}");
        match outcome.code {
            0 => {
                healed += 1;
                assert!(fs::read(folder.join("d.csv")).unwrap() == whole, "try {number}");
                fs::remove_file(folder.join("d.csv")).unwrap();
                fs::remove_file(folder.join("d.csv-metadata.json")).unwrap();
            }
            _ => {
                refused += 1;
                outcome.assert_refused("damaged", &["d.csv.part:1:", "--force begins anew"]);
                assert!(!folder.join("d.csv").exists());
            }
        }
    }
    println!("{refused} refused, {healed} healed");
    assert!(healed > 0);
}

#[test]
fn a_damaged_spool_is_refused_or_healed() {
    damaged_spools(50.0, tries(8));
}

#[test]
#[ignore = "slow"]
fn a_damaged_spool_is_refused_or_healed_at_length() {
    damaged_spools(200.0, tries(40));
}

/// The rows of an older version that the trial left, and those that are none, with or without a checksum.
const OLD: [&str; 5] = ["", "0\n", "0,0.2,1000.0\n", "0,1.0,2.0,\"x\n", "0,0.08,1000.0,\n0,0.08,1000.0,\n"];
const NONE: [&str; 4] = ["0\n", "00000000 0,0.1,\n", "\u{e9}\n", "\n"];

/// The spools of the trial: of another version, empty, cut, with a row that is none.
fn no_spools(members: u32, old: &[&str], cuts: impl Fn(usize) -> Vec<usize>, none: &[&str]) {
    let folder = Folder::new();
    folder.write("sweep.toml", sweep(members));
    let (whole, _) = undisturbed(&folder, "sweep.toml");
    let version = "noslip ensemble 0.1.0 e90f7cecd7d40027\n";
    for rows in old {
        for out in ["old.csv", "old.npz"] {
            folder.write(&format!("{out}.part"), format!("{version}{rows}"));
            let told = [&format!("{out}.part:1:"), "another version of the program", "--force begins anew"];
            folder.refused(&format!("ensemble sweep.toml --out {out} --resume"), &told);
        }
    }
    // The first line alone, whole or cut, is a beginning; so is nothing.
    let spool = spool(&folder, "sweep.toml", "new.csv");
    let first = spool.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    for length in cuts(first) {
        fs::write(folder.join("new.csv.part"), &spool[..length]).unwrap();
        folder.done("ensemble sweep.toml --out new.csv --resume");
        assert!(fs::read(folder.join("new.csv")).unwrap() == whole, "{length} bytes");
        fs::remove_file(folder.join("new.csv")).unwrap();
    }
    for row in none {
        fs::write(folder.join("new.csv.part"), [&spool[..first], row.as_bytes()].concat()).unwrap();
        let outcome = folder.line("ensemble sweep.toml --out new.csv --resume");
        assert_eq!(outcome.code, 0, "{outcome:?}");
        assert!(outcome.stderr.contains("new.csv.part:2: damaged: the checksum"), "{}", outcome.stderr);
        assert!(fs::read(folder.join("new.csv")).unwrap() == whole, "{row:?}");
        fs::remove_file(folder.join("new.csv")).unwrap();
    }
}

#[test]
fn what_is_no_spool_of_the_sweep_is_refused_and_an_empty_one_begins() {
    no_spools(160, &OLD[3..], |first| vec![0, first - 1], &NONE[1..2]);
}

#[test]
#[ignore = "slow"]
fn what_is_no_spool_of_the_sweep_is_refused_and_an_empty_one_begins_at_length() {
    no_spools(500, &OLD, |first| vec![0, 1, first - 1, first], &NONE);
}

/// A process that is ended between two of its last renames leaves what the same command ends with.
#[test]
fn what_was_ended_between_its_last_files_is_resumed() {
    let folder = Folder::new();
    folder.write("sweep.toml", sweep(64));
    let (whole, _) = undisturbed(&folder, "sweep.toml");
    let part = spool(&folder, "sweep.toml", "r.csv");
    fs::write(folder.join("r.csv.part"), &part).unwrap();
    folder.done("ensemble sweep.toml --out r.csv --resume");
    let told = folder.read("r.csv-metadata.json");
    let names = folder.names();
    // With what made it, before the rows; with the rows too, before the spool is removed; and by a program that wrote the rows first.
    for (rows, metadata) in [(false, true), (true, true), (true, false)] {
        fs::write(folder.join("r.csv.part"), &part).unwrap();
        if !rows {
            fs::remove_file(folder.join("r.csv")).unwrap();
        }
        if !metadata {
            fs::remove_file(folder.join("r.csv-metadata.json")).unwrap();
        }
        folder.done("ensemble sweep.toml --out r.csv --resume");
        assert!(fs::read(folder.join("r.csv")).unwrap() == whole, "{rows} {metadata}");
        assert_eq!((folder.read("r.csv-metadata.json"), folder.names()), (told.clone(), names.clone()));
    }
    // The result of anybody else is not overwritten, before and after the members are computed.
    for spool in [&part[..], &part[..part.len() / 2]] {
        fs::write(folder.join("r.csv"), "mine").unwrap();
        fs::write(folder.join("r.csv.part"), spool).unwrap();
        folder
            .line("ensemble sweep.toml --out r.csv --resume")
            .assert_told("another result", &["r.csv exists already"]);
        assert_eq!((folder.read("r.csv"), folder.read("r.csv-metadata.json")), ("mine".to_owned(), told.clone()));
    }
}

#[test]
fn the_scene_of_a_sweep_lies_beside_it_or_in_the_working_folder() {
    let folder = Folder::new();
    let text = crate::program::SCENE;
    fs::create_dir(folder.join("sub")).unwrap();
    folder.write("sub/near.toml", text);
    folder.write("far.toml", text);
    for scene in ["near.toml", "far.toml", "turnaround"] {
        folder.write(
            "sub/sweep.toml",
            format!("scene = \"{scene}\"\nduration = 1.0\n[grid]\n\"start.speed\" = [0.1, 0.2]\n"),
        );
        folder.done("ensemble sub/sweep.toml --out r.csv --force");
        // The same sweep, seen from elsewhere, has the same parts.
        folder.done("ensemble sub/sweep.toml --out parts --part 1/2");
        if scene != "far.toml" {
            let mut command = folder.command(["ensemble", "sweep.toml", "--out", "../parts", "--part", "2/2"]);
            assert!(command.current_dir(folder.join("sub")).output().unwrap().status.success());
            folder.done("merge parts --out m.csv --force");
            assert_eq!(folder.read("m.csv"), folder.read("r.csv"));
        }
        fs::remove_dir_all(folder.join("parts")).unwrap();
    }
}

/// Threads beyond the cores of the machine help nobody.
#[cfg(target_os = "linux")]
#[test]
fn there_are_no_more_threads_than_cores() {
    let folder = Folder::new();
    folder.write("slow.toml", sweep(64).replace("5.0", "2000.0\nmethod = \"rk4\""));
    let mut command = folder.command(["ensemble", "slow.toml", "--out", "slow.csv"]);
    let mut child = command.env("RAYON_NUM_THREADS", "3000").stderr(std::process::Stdio::null()).spawn().unwrap();
    wait_for(&folder, "slow.csv.part", 100);
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
    child.kill().unwrap();
    child.wait().unwrap();
    let threads = status.lines().find_map(|line| line.strip_prefix("Threads:")).unwrap();
    let cores = std::thread::available_parallelism().unwrap().get();
    // Those of the pool, of the sweep, and a few beside them.
    assert!(threads.trim().parse::<usize>().unwrap() <= 2 * cores + 8, "{threads}");
}
