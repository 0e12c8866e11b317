//! Where `noslip run --out` writes: what is there is safe, and what cannot be written is said before the run.

use crate::program::{Folder, SCENE};

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    folder
}

#[test]
fn a_file_that_is_there_is_overwritten_on_demand_only() {
    for ending in ["csv", "npz"] {
        let folder = folder();
        let file = format!("old.{ending}");
        folder.write(&file, "old");
        folder.refused(&format!("run scene.toml --out {file}"), &[file.as_str(), "exists already", "--force"]);
        assert_eq!(folder.read(&file), "old");
        folder.done(&format!("run scene.toml --force --out {file}"));
        assert_ne!(std::fs::read(folder.join(&file)).unwrap(), b"old");
        let beside = (ending == "csv").then(|| format!("{file}-metadata.json"));
        let all: Vec<String> = [file].into_iter().chain(beside).chain(["scene.toml".to_owned()]).collect();
        assert_eq!(folder.names(), all);
    }
}

#[test]
fn a_place_that_cannot_be_written_is_said_before_the_run() {
    let folder = folder();
    std::fs::create_dir(folder.join("folder.csv")).unwrap();
    let long = format!("{}.csv", "a".repeat(300));
    for (out, told) in [
        ("none/run.csv", "in the folder none"),
        ("scene.toml/run.csv", "in the folder scene.toml"),
        ("folder.csv --force", "directory"),
        ("new.csv/", "directory"),
        (&long, "too long"),
    ] {
        // The run would take hours: that this ends at all shows that it is never begun.
        let line = format!("run scene.toml --duration 1e9 --every 1000000 --out {out}");
        let outcome = folder.line(&line);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (1, ""), "{out}: {outcome:?}");
        outcome.assert_told(out, &["cannot write", told]);
        assert!(!outcome.stderr.contains(".noslip-"), "{}", outcome.stderr);
    }
    assert_eq!(folder.names(), ["folder.csv", "scene.toml"]);
    folder.refused("run scene.toml --out folder.csv", &["folder.csv", "exists already"]);
}

#[cfg(unix)]
#[test]
fn a_link_is_refused_and_overwritten_where_it_leads() {
    let folder = folder();
    folder.write("target.csv", "old");
    std::os::unix::fs::symlink("target.csv", folder.join("link.csv")).unwrap();
    std::os::unix::fs::symlink("nowhere.csv", folder.join("dangling.csv")).unwrap();
    for link in ["link.csv", "dangling.csv"] {
        folder.refused(&format!("run scene.toml --out {link}"), &[link, "exists already"]);
    }
    folder.done("run scene.toml --force --out link.csv");
    assert!(folder.read("target.csv").starts_with("t [s]"));
    assert!(folder.join("link.csv").is_symlink());
    assert_eq!(folder.names(), ["dangling.csv", "link.csv", "link.csv-metadata.json", "scene.toml", "target.csv"]);
}

#[cfg(unix)]
#[test]
fn a_pipe_or_a_device_is_never_replaced() {
    use std::os::unix::fs::FileTypeExt;
    let folder = folder();
    let made = std::process::Command::new("mkfifo").arg(folder.join("pipe.csv")).status();
    assert!(made.is_ok_and(|status| status.success()));
    std::os::unix::fs::symlink("pipe.csv", folder.join("link.csv")).unwrap();
    for line in
        ["run scene.toml --force --out pipe.csv", "run scene.toml --force --out link.csv", "new --force pipe.csv"]
    {
        let outcome = folder.line(line);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (1, ""), "{line}: {outcome:?}");
        outcome.assert_told(line, &["cannot write", "not a regular file"]);
    }
    assert!(folder.join("pipe.csv").metadata().unwrap().file_type().is_fifo());
    assert_eq!(folder.names(), ["link.csv", "pipe.csv", "scene.toml"]);
}
