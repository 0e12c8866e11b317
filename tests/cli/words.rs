//! Messages name the right thing, with numbers that can be read.

use crate::program::{FAILING, Folder, SCENE, names};
use std::fs;
use std::path::Path;

#[test]
fn numbers_in_messages_are_short() {
    let folder = Folder::new();
    let thrust = "[[effects]]\nkind = \"thrust\"\nforce = { times = [0.0, 1e308, 2.0], values = [1.0, 0.0, 1.0] }\n";
    folder.write("long.toml", format!("{SCENE}{thrust}"));
    folder.refused("check long.toml", &["1e308"]);
    assert!(folder.line("check long.toml").stderr.lines().all(|line| line.len() < 200));

    folder.write("stiff.toml", format!("{SCENE}[[effects]]\nkind = \"drag\"\nturning = 1e19\n"));
    let hint = folder.line("run stiff.toml --method dla").stderr;
    assert!(!hint.contains("to 0.00 ") && !hint.contains("00000000"), "{hint}");

    folder.write("fails.toml", FAILING);
    let told = folder.line("run fails.toml").stderr;
    let long = |word: &str| word.chars().filter(char::is_ascii_digit).count() > 8;
    assert!(!told.split_whitespace().any(long), "{told}");
    let text = folder.done("run turnaround");
    for line in
        text.lines().filter(|line| ["position", "heading", "velocity"].iter().any(|name| line.starts_with(name)))
    {
        assert!(!line.split_whitespace().any(long), "{line}");
    }
}

#[test]
fn a_comparison_that_is_resumed_goes_on_saving() {
    let folder = Folder::new();
    let line = "compare turnaround --methods dla,rk4 --duration 5 --json";
    folder.done(&format!("{line} --checkpoint saves --checkpoint-every 10"));
    fs::remove_file(folder.join("saves/rk4.save")).unwrap();
    folder.done(&format!("{line} --resume saves --checkpoint-every 20"));
    assert_eq!(names(&folder.join("saves")), ["dla.save", "rk4.save"]);
    folder.refused(&format!("{line} --checkpoint-every 20"), &["--checkpoint"]);
}

#[test]
fn messages_point_to_what_is_wrong() {
    let folder = Folder::new();
    folder.refused("compare circle --methods ,", &["an empty name is not a method", "dla"]);
    let told = folder.line("compare circle --methods ,").stderr;
    assert!(!told.contains("``"), "{told}");
    folder.write("noise.save", b"noslip checkpoint \xff\n");
    folder.refused("run turnaround --resume noise.save", &["noise.save", "not a checkpoint, or is damaged"]);
    folder.done("run turnaround --duration 5 --checkpoint a.save");
    let other = folder.line("run circle --resume a.save");
    other.assert_told(
        "another run",
        &["in the checkpoint, `scene` is `turnaround`", "in this run, `scene` is `circle`"],
    );
    for count in ["0", "100001", "1.5"] {
        let trailers = format!("[[effects]]\nkind = \"trailers\"\ncount = {count}\nmass = 1\ninertia = 1\nbar = 1\n");
        folder.write("train.toml", format!("{SCENE}{trailers}"));
        folder.refused("check train.toml", &["`effects.trailers.count`", "a whole number from 1 to 100000"]);
    }
}

/// Every text of the program and the book, this file and the changelog left out.
fn texts(folder: &Path, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.to_string_lossy().into_owned();
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or("");
        if path.is_dir() && !name.ends_with("target") {
            texts(&path, found);
        } else if matches!(ending, "rs" | "md") && !name.ends_with("CHANGELOG.md") {
            let text = fs::read_to_string(&path).unwrap();
            found.push((name, text.split_whitespace().filter(|word| *word != "\\").collect::<Vec<_>>().join(" ")));
        }
    }
}

#[test]
fn sentences_that_nobody_understands_are_gone() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = vec![("README.md".to_owned(), fs::read_to_string(root.join("README.md")).unwrap())];
    texts(&root.join("crates"), &mut all);
    texts(&root.join("docs"), &mut all);
    assert!(all.len() > 300, "{}", all.len());
    for sentence in [
        "What works on eight numbers at once",
        "the same of the discrete constraint of a step",
        "half its largest range about a line in a 32nd",
        "so their runs of 1e8 steps were not made again",
        "whose diagonal it is stretched by",
        "is not believed to be less than a twentieth",
        "is attached to coordinates that there are",
        "is the number that comes nearest to its bar among",
        "one of order 8 for a third more",
        "the one that was found is not connected",
        "0 that there are not",
        "a row that is none",
        "the table is no function of time",
        "is no number that the scene has",
        "times that\"",
        "A beginning from the last step.",
    ] {
        let found: Vec<&str> =
            all.iter().filter(|(_, text)| text.contains(sentence)).map(|(name, _)| name.as_str()).collect();
        assert!(found.is_empty(), "{sentence}: {found:?}");
    }
}
