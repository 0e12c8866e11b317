//! Tells the program a hash of the sources that its numbers depend on.
//!
//! Cargo runs this script again if one of the sources has changed; the program is then linked again in any case.

use std::fs;
use std::path::{Path, PathBuf};

fn main() {
    let crates = Path::new("crates");
    let mut sources = vec![PathBuf::from("Cargo.lock"), crates.join("cli")];
    let folders = fs::read_dir(crates).map(|found| found.flatten().map(|entry| entry.path()).collect());
    let folders: Vec<PathBuf> = folders.unwrap_or_default();
    // The results depend on Python only by the way it is called.
    let numbers = folders.iter().filter(|folder| !folder.ends_with("cli") && !folder.ends_with("python"));
    sources.extend(numbers.map(|folder| folder.join("src")));
    sources.retain(|source| source.exists());
    sources.sort();
    for source in &sources {
        println!("cargo::rerun-if-changed={}", source.display());
    }
    let mut files: Vec<PathBuf> = sources.iter().flat_map(|source| below(source)).collect();
    files.sort();
    // FNV-1a of 64 bits.
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for file in &files {
        let content = fs::read(file).unwrap_or_default();
        for byte in file.to_string_lossy().bytes().chain(content) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    println!("cargo::rustc-env=NOSLIP_SOURCES={hash:016x}");
}

/// All files in a folder, or the file itself.
fn below(path: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(path) else { return vec![path.to_owned()] };
    entries.flatten().flat_map(|entry| below(&entry.path())).collect()
}
