//! Every command of the book does what it is there for.

use super::pages::{Block, pages, root};
use crate::program::Folder;
use std::collections::BTreeSet;
use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// What takes minutes: marked `# long` on its page, and run by a test of its own.
const LONG: [&str; 9] = [
    "noslip compare egg-crate-attractor --duration 5000 --methods dla,dla4,gauss8,rk4-reduced,energy4",
    "noslip lyapunov docs/chaos/valley.toml --duration 20000 --out valley.svg",
    "noslip lyapunov docs/chaos/well.toml --map speed=-1.2:1.2:30 --map turn_rate=-1.1:1.1:24 --duration 200 --out map.svg",
    "noslip lyapunov egg-crate-attractor --step 0.1 --duration 20000",
    "noslip precision bowl --report pages",
    "noslip precision bowl --report pages --csv bowl.csv",
    "noslip section docs/chaos/valley.toml --plane center_y=0 --starts 4 --duration 6000 --out valley.svg",
    "noslip section docs/chaos/well.toml --energy 0.2 --plane along=0 --axes across,turn_rate --starts 24 --duration 1000 --out well.svg",
    "noslip section egg-crate-attractor --step 0.1 --plane turn_rate=0 --starts 4 --duration 8000 --out egg-crate.svg",
];

/// What another test runs as a whole (`tests/cli/stability.rs`); here it is parsed.
const TOGETHER: &str = "noslip stability --case ";

/// What is run in any case; others are parsed.
const QUICK: [&str; 8] = [
    "noslip check docs/guide/train.toml",
    "noslip check turnaround bowl hills",
    "noslip equations snakeboard",
    "noslip list methods",
    "noslip list scenes",
    "noslip lyapunov docs/guide/train.toml",
    "noslip run bowl --set sleigh.mass=-1",
    "noslip run turnaround",
];

/// Commands for other programs: a test does not build, install or measure.
const OTHERS: [&str; 17] = [
    "cargo build --release",
    "cargo run --release",
    "cargo test --workspace",
    "NOSLIP_MEASURE=1 cargo test",
    "cargo install mdbook --locked --no-default-features",
    "mdbook build docs",
    "benches/peers/run ",
    "docs/pictures/make.sh",
    "cd tests/long && cargo run",
    "pip install -r tests/independent/requirements.txt",
    "python tests/independent/",
    "cargo install cargo-fuzz",
    "cargo +nightly fuzz run --fuzz-dir tests/fuzz",
    "cargo install cargo-mutants",
    "CARGO_PROFILE_DEV_OPT_LEVEL=1 PROPTEST_CASES=64 cargo mutants",
    "rustup component add --toolchain nightly miri rust-src",
    "RUSTFLAGS= MIRIFLAGS=",
];

/// A line of a block of shell commands, and what its comment says of it.
#[derive(Debug)]
struct Line {
    words: String,
    long: bool,
    /// The exit code, from a comment such as `# exit 2`.
    code: i32,
}

impl Line {
    fn of(line: &str) -> Self {
        let (words, comment) = line.split_once('#').unwrap_or((line, ""));
        let code = comment.trim().strip_prefix("exit ").map_or(0, |code| code.parse().unwrap());
        Self { words: words.split_whitespace().collect::<Vec<_>>().join(" "), long: comment.trim() == "long", code }
    }
}

/// The lines of a block, those that end in a backslash joined with the next.
fn lines(block: &Block<'_>) -> Vec<Line> {
    let text = block.lines.join("\n").replace("\\\n", " ");
    text.lines().map(Line::of).filter(|line| !line.words.is_empty()).collect()
}

/// The words of a line, files of the repository by their full names; no quoted word has a space in it.
pub(super) fn words(line: &str) -> Vec<String> {
    let docs = format!("{}/docs/", root().display());
    let full = |word: &str| word.strip_prefix("docs/").map_or_else(|| word.to_owned(), |rest| docs.clone() + rest);
    line.split_whitespace().skip(1).map(|word| full(&word.replace('"', ""))).collect()
}

fn quick(line: &Line) -> bool {
    QUICK.contains(&line.words.as_str())
}

/// Runs those commands of a block, in a folder of their own.
fn run(page: &str, block: &Block<'_>, runs: fn(&Line) -> bool) {
    let folder = Folder::new();
    for line in lines(block) {
        if line.words.starts_with("noslip") {
            // With `--help` the words before it are parsed, and nothing is done.
            let skipped = !runs(&line) || line.words.starts_with(TOGETHER);
            let help = skipped.then(|| "--help".to_owned());
            let outcome = folder.noslip(words(&line.words).into_iter().chain(help));
            let code = if skipped { 0 } else { line.code };
            assert_eq!(outcome.code, code, "{page}: {}: {}", line.words, outcome.stderr);
        } else if let Some(example) = line.words.strip_prefix("cargo run --example ") {
            let name = example.split(' ').next().unwrap();
            let file = format!("docs/examples/{name}.rs");
            let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
            assert!(
                manifest.contains(&format!("name = \"{name}\"\npath = \"{file}\"")),
                "{page}: {name} is no example"
            );
            assert!(root().join(&file).is_file(), "{page}: there is no {file}");
        } else {
            let known = OTHERS.iter().any(|other| line.words.starts_with(other));
            assert!(known, "{page}: what is to be done with {:?}?", line.words);
        }
    }
}

/// Whole scenes are valid, data can be read.
fn check(page: &str, block: &Block<'_>) {
    let text = block.lines.join("\n");
    if block.language == "toml" && (text.contains("[sleigh]") || text.contains("[system]")) {
        let folder = Folder::new();
        folder.write("scene.toml", &text);
        let outcome = folder.line("check scene.toml");
        assert_eq!(outcome.code, 0, "{page}: {}", outcome.stderr);
    } else if block.language == "json" {
        let value: Result<serde_json::Value, _> = serde_json::from_str(&text);
        assert!(value.is_ok(), "{page}: {value:?}");
    }
}

fn run_all(runs: fn(&Line) -> bool) {
    let pages = pages();
    let blocks: Vec<(&str, Block<'_>)> =
        pages.iter().flat_map(|page| page.blocks().into_iter().map(|block| (page.path.as_str(), block))).collect();
    let next = AtomicUsize::new(0);
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some((page, block)) = blocks.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if block.language == "sh" { run(page, block, runs) } else { check(page, block) }
                }
            });
        }
    });
    let commands = blocks.iter().filter(|(_, block)| block.language == "sh").flat_map(|(_, block)| lines(block));
    let (marked, others): (Vec<_>, Vec<_>) = commands.partition(|line| line.long);
    let mut marked: Vec<_> = marked.into_iter().map(|line| line.words).collect();
    marked.sort();
    marked.dedup();
    assert_eq!(marked, LONG, "marked `# long` on the left, known as long on the right");
    assert!(others.iter().filter(|line| line.words.starts_with("noslip ")).count() > 30, "{others:?}");
    let quick: BTreeSet<&str> = others.iter().filter(|line| quick(line)).map(|line| line.words.as_str()).collect();
    assert_eq!(quick.into_iter().collect::<Vec<_>>(), QUICK, "on the pages on the left, known as quick on the right");
}

#[test]
fn every_command_of_the_book_runs() {
    run_all(quick);
}

#[test]
#[ignore = "slow"]
fn every_command_of_the_book_runs_at_length() {
    run_all(|line| !line.long);
}

#[test]
#[ignore = "slow"]
fn every_long_command_of_the_book_runs() {
    run_all(|line| line.long);
}

/// The controls: what a page gets wrong is seen.
#[test]
fn a_wrong_command_is_seen() {
    for wrong in [
        "noslip run nowhere",
        "noslip list methods # exit 2",
        "noslip compare bowl --metods dla # long",
        "cargo run --example none",
        "rm -r docs",
    ] {
        let block = Block { language: "sh", lines: vec![wrong] };
        let seen = thread::spawn(move || run("a page", &block, |line| !line.long)).join();
        assert!(seen.is_err(), "{wrong}");
    }
}
