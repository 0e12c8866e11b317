//! Runs the program in a folder of its own.

use serde_json::Value;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A scene to make bad ones from.
pub const SCENE: &str = "\
title = \"A test\"
[sleigh]
mass = 1.0
inertia = 1.0
offset = 0.5
[start]
speed = -1.0
turn_rate = 0.1
[run]
step = 0.05
duration = 2.0
";

/// Steps so large that the midpoint rule gives up when the sleigh, going backward, swings round.
pub const FAILING: &str = "\
title = \"Too large a step\"
[sleigh]
mass = 1.0
inertia = 1.0
offset = 0.5
[start]
speed = -1.5
turn_rate = 1e-3
[run]
step = 2.9
duration = 29.0
";

/// An empty folder to run the program in, removed at the end.
#[derive(Debug)]
pub struct Folder(TempDir);

/// What a run of the program left.
#[derive(Debug)]
pub struct Outcome {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Folder {
    pub fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn join(&self, name: &str) -> PathBuf {
        self.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.join(name), content).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.join(name)).unwrap()
    }

    /// The names of everything in the folder, hidden files too, in order.
    pub fn names(&self) -> Vec<String> {
        names(self.path())
    }

    /// The program, in this folder, with nothing to read.
    pub fn command<A: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = A>) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_noslip"));
        command.args(arguments).current_dir(self.path()).stdin(Stdio::null());
        command
    }

    pub fn noslip<A: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = A>) -> Outcome {
        Outcome::of(self.command(arguments).output().unwrap())
    }

    /// The words of a command line, none of which has a space in it.
    pub fn line(&self, line: &str) -> Outcome {
        self.noslip(line.split_whitespace())
    }

    /// A command that must succeed silently, and what it prints.
    pub fn done(&self, line: &str) -> String {
        let outcome = self.line(line);
        assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""), "{line}");
        outcome.stdout
    }

    /// The value that such a command prints.
    pub fn json(&self, line: &str) -> Value {
        serde_json::from_str(&self.done(line)).unwrap()
    }

    /// A command that must be refused before anything is done: the message names each of `told`.
    pub fn refused(&self, line: &str, told: &[&str]) {
        self.line(line).assert_refused(line, told);
    }
}

impl Outcome {
    pub fn of(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        let code = output.status.code().expect("ended by a signal");
        Self { code, stdout: text(output.stdout), stderr: text(output.stderr) }
    }

    pub fn assert_refused(&self, what: &str, told: &[&str]) {
        assert_eq!((self.code, self.stdout.as_str()), (2, ""), "{what}: {self:?}");
        self.assert_told(what, told);
    }

    /// There is one message, without a panic in it, and it names each of `told`.
    pub fn assert_told(&self, what: &str, told: &[&str]) {
        assert!(self.stderr.starts_with("error: ") && !self.stderr.contains("panicked"), "{what}: {self:?}");
        assert!(self.stderr.ends_with('\n'), "{what}: {self:?}");
        for word in told {
            assert!(self.stderr.contains(word), "{what}: no {word:?} in {}", self.stderr);
        }
    }
}

/// The names of everything in a folder, in order.
pub fn names(folder: &Path) -> Vec<String> {
    let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name().into_string().unwrap();
    let mut names: Vec<String> = fs::read_dir(folder).unwrap().map(name).collect();
    names.sort();
    names
}

/// The names of all methods.
pub fn methods() -> Vec<String> {
    let all = Folder::new().json("list methods --json");
    let name = |method: &Value| method["name"].as_str().unwrap().to_owned();
    all.as_array().unwrap().iter().map(name).collect()
}

/// The names of the bundled scenes of systems of text.
pub const TEXTS: [&str; 12] = [
    "knife-edge",
    "rolling-disk",
    "falling-disk",
    "snakeboard",
    "roller-racer",
    "two-wheeled-robot",
    "wheelchair",
    "car-and-trailer",
    "chaplygin-ball",
    "ball-on-turntable",
    "ball-in-bowl",
    "bicycle",
];

/// The names of the bundled scenes of sleighs.
pub const SCENES: [&str; 18] = [
    "turnaround",
    "straight",
    "circle",
    "bowl",
    "valley",
    "egg-crate",
    "egg-crate-chaos",
    "egg-crate-attractor",
    "hills",
    "skate",
    "braking",
    "thrust-well",
    "flywheel",
    "shaker",
    "shaker-friction",
    "parking",
    "planimeter",
    "turntable",
];

/// The names and the rows of a file of comma-separated values; the units are dropped.
pub fn csv(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let header = lines.next().unwrap().split(',').map(|name| name.split(' ').next().unwrap().to_owned()).collect();
    let rows = lines.map(|line| line.split(',').map(|number| number.parse().unwrap()).collect()).collect();
    (header, rows)
}

/// The keys of an object, in order.
pub fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}
