//! A sweep in parts: each computed by a process of its own, merged to the bytes that one process would have written.

use crate::processes::{Dice, damaged, ended, started, tries};
use crate::program::{Folder, names};
use std::fs;

const SWEEP: &str = "\
scene = \"turnaround\"
duration = 5.0
[random]
seed = 3
count = 501
\"start.turn_rate\" = { uniform = [0.05, 0.3] }
";

/// A folder with the sweep, with `members` members.
fn folder(members: u32) -> Folder {
    let folder = Folder::new();
    folder.write("sweep.toml", SWEEP.replace("count = 501", &format!("count = {members}")));
    folder
}

fn parts(folder: &Folder) -> Vec<String> {
    names(&folder.join("parts")).into_iter().filter(|name| name.ends_with(".rows")).collect()
}

/// Parts in any order; more parts than members leave some empty.
fn merged(members: u32, parts: &[u32]) {
    let folder = folder(members);
    for out in ["r.csv", "r.npz", "r.jsonl"] {
        folder.done(&format!("ensemble sweep.toml --out {out}"));
    }
    let kept: Vec<(String, Vec<u8>)> = folder
        .names()
        .into_iter()
        .filter(|name| name.starts_with("r."))
        .map(|name| (name.clone(), fs::read(folder.join(&name)).unwrap()))
        .collect();
    assert_eq!(kept.len(), 5);
    for of in parts.iter().copied() {
        for part in (1..=of).rev() {
            folder.done(&format!("ensemble sweep.toml --out parts --part {part}/{of}"));
        }
        for (name, bytes) in kept.iter().filter(|(name, _)| !name.ends_with("json")) {
            folder.done(&format!("merge parts --out {name} --force"));
            assert!(fs::read(folder.join(name)).unwrap() == *bytes, "{name} of {of} parts");
        }
        assert_eq!(
            folder.read("r.csv-metadata.json").into_bytes(),
            kept.iter().find(|(name, _)| name == "r.csv-metadata.json").unwrap().1
        );
        fs::remove_dir_all(folder.join("parts")).unwrap();
    }
}

#[test]
fn merged_parts_have_the_bytes_of_one_process() {
    merged(53, &[3, 5]);
    merged(3, &[5]);
}

#[test]
#[ignore = "slow"]
fn merged_parts_have_the_bytes_of_one_process_at_length() {
    merged(501, &[1, 3, 40]);
}

#[test]
fn parts_of_a_system_of_text_are_those_of_one_sweep() {
    // What tells the sweep from others is the same in every process.
    let folder = Folder::new();
    folder.write(
        "sweep.toml",
        "scene = \"knife-edge\"\nduration = 1.0\n[grid]\n\"parameters.slope\" = [0.1, 0.2, 0.3]\n",
    );
    folder.done("ensemble sweep.toml --out whole.csv");
    for part in [2, 1, 3] {
        folder.done(&format!("ensemble sweep.toml --out parts --part {part}/3"));
    }
    folder.done("merge parts --out merged.csv");
    assert!(fs::read(folder.join("merged.csv")).unwrap() == fs::read(folder.join("whole.csv")).unwrap());
}

#[test]
fn a_part_that_is_made_twice_has_the_same_bytes_and_one_that_is_missing_is_named() {
    let folder = folder(501);
    folder.done("ensemble sweep.toml --out parts --part 1/3");
    folder.done("ensemble sweep.toml --out parts --part 3/3");
    folder.refused(
        "merge parts",
        &["no part continues the others with members 167 to 333 of 501", "compute the missing parts"],
    );
    let first = fs::read(folder.join("parts").join(&parts(&folder)[0])).unwrap();
    let again = folder.line("ensemble sweep.toml --out parts --part 1/3");
    assert!(again.code == 0 && again.stderr.contains("exists already and is kept"), "{again:?}");
    folder.done("ensemble sweep.toml --out parts --part 1/3 --force");
    assert!(fs::read(folder.join("parts").join(&parts(&folder)[0])).unwrap() == first);
    // The names have the members, and a hash: parts of another sweep are others.
    folder.write("other.toml", SWEEP.replace("seed = 3", "seed = 4"));
    folder.done("ensemble other.toml --out parts --part 2/3");
    folder.refused("merge parts", &["parts of 2 sweeps"]);
    folder.refused("merge .", &["the folder has no parts of a sweep"]);
    for wrong in ["0/3", "4/3", "1", "a/b", "1/0"] {
        folder
            .refused(&format!("ensemble sweep.toml --out parts --part {wrong}"), &["--part", "I/N, for example 3/64"]);
    }
}

fn damaged_parts(members: u32, tries: u64) {
    let (folder, mut dice) = (folder(members), Dice(7));
    folder.done("ensemble sweep.toml --out whole.csv");
    let whole = fs::read(folder.join("whole.csv")).unwrap();
    for part in 1..=2 {
        folder.done(&format!("ensemble sweep.toml --out parts --part {part}/2"));
    }
    let path = folder.join("parts").join(&parts(&folder)[1]);
    let (members, right) = (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap());
    for number in 0..tries {
        let bytes = damaged(&right, &mut dice);
        fs::write(&path, &bytes).unwrap();
        let outcome = folder.line("merge parts --out merged.csv --force");
        if bytes == right {
            assert_eq!(outcome.code, 0, "try {number}: {outcome:?}");
            continue;
        }
        assert!(outcome.code != 0 && !outcome.stderr.contains("panicked"), "try {number}: {outcome:?}");
        assert!(!folder.join("merged.csv").exists() || number > 0);
        let part = if members.contains("-0-") { "1/2" } else { "2/2" };
        let again = folder.line(&format!("ensemble sweep.toml --out parts --part {part}"));
        assert_eq!(again.code, 0, "try {number}: {again:?}");
        assert!(fs::read(&path).unwrap() == right, "try {number}");
        folder.done("merge parts --out merged.csv --force");
        assert!(fs::read(folder.join("merged.csv")).unwrap() == whole, "try {number}");
        fs::remove_file(folder.join("merged.csv")).unwrap();
    }
}

#[test]
fn a_damaged_part_is_made_again_and_never_merged() {
    damaged_parts(53, tries(4));
}

#[test]
#[ignore = "slow"]
fn a_damaged_part_is_made_again_and_never_merged_at_length() {
    damaged_parts(501, tries(20));
}

/// A sweep of `members` members, each of `duration` s.
#[cfg(unix)]
fn killed_and_shared(members: u32, duration: f64, tries: u64) {
    let folder = folder(members);
    let long = format!("duration = {duration:?}\nmethod = \"rk4\"");
    folder.write("sweep.toml", folder.read("sweep.toml").replace("duration = 5.0", &long));
    folder.done("ensemble sweep.toml --out whole.csv");
    let line = "ensemble sweep.toml --out parts --part 1/1";
    for (number, signal) in ["-KILL", "-TERM", "-INT"].into_iter().cycle().take(tries as usize).enumerate() {
        let child = started(&folder, line);
        std::thread::sleep(std::time::Duration::from_millis(40 * (number as u64 % 7)));
        let other = started(&folder, line);
        crate::processes::send(signal, &child);
        let (code, told) = ended(other);
        assert!(matches!(code, Some(0 | 2)), "{told}");
        assert!(code == Some(0) || told.contains("another process is writing"), "{told}");
        ended(child);
        let last = folder.line(line);
        assert_eq!(last.code, 0, "{last:?}");
        folder.done("merge parts --out merged.csv --force");
        assert!(
            fs::read(folder.join("merged.csv")).unwrap() == fs::read(folder.join("whole.csv")).unwrap(),
            "try {number}"
        );
        fs::remove_dir_all(folder.join("parts")).unwrap();
    }
}

#[cfg(unix)]
#[test]
fn a_part_that_was_killed_goes_on_and_two_processes_do_not_share_one() {
    killed_and_shared(64, 50.0, tries(2));
}

#[cfg(unix)]
#[test]
#[ignore = "slow"]
fn a_part_that_was_killed_goes_on_and_two_processes_do_not_share_one_at_length() {
    killed_and_shared(501, 200.0, tries(6));
}

/// The file that says what the sweep is has a checksum: of any damage it is written again, and nothing is merged before.
fn damaged_descriptions(tries: u64) {
    let (folder, mut dice) = (folder(53), Dice(11));
    folder.done("ensemble sweep.toml --out whole.csv");
    let whole = fs::read(folder.join("whole.csv")).unwrap();
    for part in 1..=2 {
        folder.done(&format!("ensemble sweep.toml --out parts --part {part}/2"));
    }
    let name = names(&folder.join("parts")).into_iter().find(|name| name.ends_with(".json")).unwrap();
    let path = folder.join("parts").join(&name);
    let right = fs::read_to_string(&path).unwrap();
    let changed = [
        ("\"members\": 53", "\"members\": 32"),
        ("\"m/s\"", "\"m/h\""),
        ("rk4", "dla"),
        ("\"x\"", "\"y\""),
        ("title", "titel"),
    ];
    let changed = changed.iter().filter(|(old, _)| right.contains(old)).map(|(old, new)| right.replacen(old, new, 1));
    let texts: Vec<Vec<u8>> = changed
        .map(String::into_bytes)
        .chain([Vec::new(), b"{}".to_vec()])
        .chain((0..tries).map(|_| damaged(right.as_bytes(), &mut dice)))
        .filter(|text| text != right.as_bytes())
        .collect();
    assert!(texts.len() >= 6);
    for text in &texts {
        fs::write(&path, text).unwrap();
        let shown = String::from_utf8_lossy(text).into_owned();
        let outcome = folder.line("merge parts --out merged.csv");
        outcome.assert_refused(&shown, &[name.as_str(), "damaged", "writes the file again"]);
        let again = folder.line("ensemble sweep.toml --out parts --part 1/2");
        assert!(again.code == 0 && again.stderr.contains("is kept"), "{again:?}");
        folder.done("merge parts --out merged.csv");
        assert!(fs::read(folder.join("merged.csv")).unwrap() == whole, "{shown}");
        for file in ["merged.csv", "merged.csv-metadata.json"] {
            fs::remove_file(folder.join(file)).unwrap();
        }
    }
    // So is one of two sweeps: the other is not taken for it.
    folder.write("other.toml", SWEEP.replace("seed = 3", "seed = 4"));
    folder.done("ensemble other.toml --out parts --part 1/2");
    fs::write(&path, "{").unwrap();
    folder.refused("merge parts", &[name.as_str(), "damaged"]);
    fs::remove_file(&path).unwrap();
    folder.refused("merge parts", &[name.as_str(), "missing"]);
    println!("all found");
}

#[test]
fn a_damaged_description_of_a_sweep_is_never_believed() {
    damaged_descriptions(tries(1));
}

#[test]
#[ignore = "slow"]
fn a_damaged_description_of_a_sweep_is_never_believed_at_length() {
    damaged_descriptions(tries(80));
}

#[test]
fn parts_of_another_program_or_machine_are_told_apart() {
    let folder = folder(53);
    folder.done("ensemble sweep.toml --out parts --part 1/1");
    let place = folder.join("parts");
    let name = names(&place).into_iter().find(|name| name.ends_with(".json")).unwrap();
    let text = fs::read_to_string(place.join(&name)).unwrap();
    let about: serde_json::Value = serde_json::from_str(&text).unwrap();
    let [version, instructions, identity] =
        ["version", "instructions", "identity"].map(|key| about[key].as_str().unwrap().to_owned());
    assert!(version.starts_with("0.1.0+") && version.len() == 6 + 16, "{version}");
    assert!(identity.contains(&version) && identity.contains(&instructions), "{identity}");
    // As another machine would have written it.
    for (old, new, told) in
        [(&instructions, "vax", "machines with"), (&version, "0.1.0+0123456789abcdef", "the versions")]
    {
        let mut other = about.clone();
        for key in ["version", "instructions", "identity"] {
            other[key] = about[key].as_str().unwrap().replace(old.as_str(), new).into();
        }
        other.as_object_mut().unwrap().remove("checksum");
        other["checksum"] = format!("{:08x}", crc32(other.to_string().as_bytes())).into();
        let identity = other["identity"].as_str().unwrap();
        let hash = identity
            .bytes()
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
        let file = place.join(format!("{hash:016x}-0.1.0.json"));
        fs::write(&file, format!("{other:#}\n")).unwrap();
        folder.refused("merge parts", &["parts of 2 sweeps", told, new, "differ in the last bits"]);
        fs::remove_file(file).unwrap();
    }
    folder.done("merge parts");
}

/// CRC-32, bit by bit (ISO 3309).
fn crc32(bytes: &[u8]) -> u32 {
    let bit = |sum: u32, _| if sum & 1 == 1 { (sum >> 1) ^ 0xedb8_8320 } else { sum >> 1 };
    !bytes.iter().fold(u32::MAX, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), bit))
}

#[cfg(unix)]
#[test]
fn files_of_parts_have_the_rights_that_the_user_gives_to_new_files() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder(53);
    let script = "umask 027; exec \"$0\" ensemble sweep.toml --out parts --part 1/1";
    let mut shell = std::process::Command::new("sh");
    assert!(
        shell
            .args(["-c", script, env!("CARGO_BIN_EXE_noslip")])
            .current_dir(folder.path())
            .output()
            .unwrap()
            .status
            .success()
    );
    let place = folder.join("parts");
    for name in names(&place) {
        assert_eq!(fs::metadata(place.join(&name)).unwrap().permissions().mode() & 0o777, 0o640, "{name}");
    }
}
