//! Outputs that are full, closed, or watched: no panic, no half file, no noise.
#![cfg(target_os = "linux")]

use crate::program::{Folder, Outcome};
use std::fs::File;
use std::process::{Command, Stdio};

const PRINTING: [&str; 7] = [
    "list methods",
    "list scenes --json",
    "check turnaround",
    "run circle",
    "run circle --json",
    "compare circle --methods dla",
    "--help",
];

fn full() -> File {
    File::options().write(true).open("/dev/full").unwrap()
}

#[test]
fn a_full_standard_output_is_an_error() {
    let folder = Folder::new();
    for line in PRINTING {
        let outcome = Outcome::of(
            folder
                .command(line.split(' '))
                .stdout(full())
                .stderr(Stdio::piped())
                .spawn()
                .and_then(std::process::Child::wait_with_output)
                .unwrap(),
        );
        assert_eq!(outcome.code, 1, "{line}: {outcome:?}");
        outcome.assert_told(line, &["cannot write to standard output", "No space left"]);
    }
}

#[test]
fn a_full_standard_error_changes_no_exit_code() {
    let folder = Folder::new();
    for (line, code) in
        [("run nowhere", 2), ("run circle --bogus", 2), ("run circle --alpha 0.1", 0), ("list methods", 0)]
    {
        let status = folder.command(line.split(' ')).stdout(Stdio::null()).stderr(full()).status().unwrap();
        assert_eq!(status.code(), Some(code), "{line}");
    }
    let status = folder.command(["list", "methods"]).stdout(full()).stderr(full()).status().unwrap();
    assert_eq!(status.code(), Some(1));
}

#[test]
fn a_reader_who_leaves_is_no_error() {
    let folder = Folder::new();
    for line in PRINTING {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let child = folder.command(line.split(' ')).stdout(writer).stderr(Stdio::piped()).spawn().unwrap();
        let outcome = Outcome::of(child.wait_with_output().unwrap());
        assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""), "{line}");
    }
    // The files are written all the same.
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let line = "compare circle --methods dla --duration 1 --report report";
    assert!(folder.command(line.split(' ')).stdout(writer).status().unwrap().success());
    assert!(folder.join("report/index.html").is_file());
}

/// The result is printed, the file is not there, and the message names it.
fn assert_no_half_file(outcome: &Outcome, file: &str) {
    assert_eq!(outcome.code, 1, "{outcome:?}");
    outcome.assert_told(file, &["cannot write", file]);
    assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
    assert!(outcome.stdout.contains("position") && !outcome.stdout.contains(file), "{}", outcome.stdout);
}

#[test]
fn a_file_beyond_the_limit_of_its_size_leaves_nothing() {
    for file in ["run.csv", "run.npz"] {
        let folder = Folder::new();
        // Without its signal, the limit is an error of the write, as a full disk is.
        let script = "trap '' XFSZ; ulimit -f 8; exec \"$0\" run turnaround --out \"$1\"";
        let mut shell = Command::new("sh");
        shell.args(["-c", script, env!("CARGO_BIN_EXE_noslip"), file]).current_dir(folder.path());
        assert_no_half_file(&Outcome::of(shell.output().unwrap()), file);
        assert!(folder.names().is_empty(), "{:?}", folder.names());
    }
}

/// A file system of a few kilobytes, while it lives.
struct Small(Folder);

impl Small {
    fn mount() -> Option<Self> {
        let folder = Folder::new();
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", "size=32k", "tmpfs"]).arg(folder.path());
        let mounted = mount.stderr(Stdio::null()).status().is_ok_and(|status| status.success());
        mounted.then(|| Self(folder))
    }
}

impl Drop for Small {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0.path()).status();
    }
}

#[test]
fn a_full_disk_leaves_nothing() {
    let Some(small) = Small::mount() else {
        eprintln!("skipped: no file system may be mounted here");
        return;
    };
    for file in ["run.csv", "run.npz"] {
        assert_no_half_file(&small.0.line(&format!("run turnaround --out {file}")), file);
        assert!(small.0.names().is_empty(), "{:?}", small.0.names());
    }
    let outcome = small.0.line("compare turnaround --methods dla,rk4 --report report");
    assert_eq!(outcome.code, 1);
    outcome.assert_told("report", &["report", "No space left"]);
    assert!(small.0.names().is_empty(), "{:?}", small.0.names());
}
