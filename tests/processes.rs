//! Processes of the program that are ended by signals.

use crate::program::Folder;
use std::fs;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// How often a fault is made: `few` times unless `NOSLIP_TRIES` says another number.
pub fn tries(few: u64) -> u64 {
    std::env::var("NOSLIP_TRIES").ok().and_then(|tries| tries.parse().ok()).unwrap_or(few)
}

/// Numbers that look random: the high bits of a linear congruential generator (Knuth's constants).
#[derive(Debug)]
pub struct Dice(pub u64);

impl Dice {
    pub fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % end
    }
}

/// The program at work in a folder.
pub fn started(folder: &Folder, line: &str) -> Child {
    let mut command = folder.command(line.split_whitespace());
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// How it ended: the exit code, none after a signal, and what it said on standard error.
pub fn ended(child: Child) -> (Option<i32>, String) {
    let (code, _, told) = output(child);
    (code, told)
}

/// The same, with what it printed before that.
pub fn output(child: Child) -> (Option<i32>, String, String) {
    let output = child.wait_with_output().unwrap();
    let [printed, told] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (output.status.code(), printed, told)
}

pub fn send(signal: &str, child: &Child) {
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
}

/// Whether a closed terminal ends processes that are started here: `nohup` keeps that from them.
pub fn hangs_up() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_none_or(|mask| mask & 1 == 0)
}

/// The signals that ask for an end and reach a process that is started here.
pub fn signals() -> impl Iterator<Item = &'static str> {
    ["-INT", "-TERM", "-HUP"].into_iter().filter(|signal| *signal != "-HUP" || hangs_up())
}

/// Waits until a file has `bytes` bytes.
pub fn wait_for(folder: &Folder, name: &str, bytes: u64) {
    while fs::metadata(folder.join(name)).map_or(0, |metadata| metadata.len()) < bytes {
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Damages a text in one of seven ways: two lines exchanged, one doubled, removed, cut or lengthened, the end cut off, a bit flipped.
pub fn damaged(whole: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut rows: Vec<Vec<u8>> = whole.split_inclusive(|byte| *byte == b'\n').map(<[u8]>::to_vec).collect();
    let [one, other] = [(); 2].map(|()| dice.below(rows.len() as u64) as usize);
    let at = dice.below(whole.len() as u64) as usize;
    match dice.below(7) {
        0 => rows.swap(one, other),
        1 => rows.insert(other, rows[one].clone()),
        2 => drop(rows.remove(one)),
        3 => rows = vec![whole[..at].to_vec()],
        4 => rows[one].truncate(at % 60),
        5 => rows[one].extend(b"0,0.1,\"\n"),
        _ => {
            let mut bytes = whole.to_vec();
            bytes[at] ^= 1 << dice.below(8);
            return bytes;
        }
    }
    rows.concat()
}
