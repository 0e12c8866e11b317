//! Runs of the program, read back from the files that it writes.

use harness::stability::Seen;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// The program, and a folder for its files.
pub(crate) struct Program {
    path: PathBuf,
    folder: TempDir,
}

/// A run: the sleigh, its start, what acts on it, and how it is made.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Setup<'a> {
    /// Mass (kg), inertia (kg m^2), offset (m).
    pub(crate) body: [f64; 3],
    /// Place (m), heading (rad), speed (m/s), turn rate (rad/s).
    pub(crate) start: [f64; 5],
    /// Entries of a scene file.
    pub(crate) effects: &'a str,
    pub(crate) step: f64,
    pub(crate) duration: f64,
}

impl Setup<'_> {
    /// The sleigh of the cases, with nothing acting on it.
    pub(crate) const fn free(speed: f64, turn_rate: f64, step: f64, duration: f64) -> Self {
        Self { body: [1.0, 1.0, 0.5], start: [0.0, 0.0, 0.0, speed, turn_rate], effects: "", step, duration }
    }

    fn scene(&self) -> String {
        let ([mass, inertia, offset], [x, y, heading, speed, turn_rate]) = (self.body, self.start);
        format!(
            "[sleigh]\nmass = {mass:?}\ninertia = {inertia:?}\noffset = {offset:?}\n\
             [start]\nx = {x:?}\ny = {y:?}\nheading = {heading:?}\nspeed = {speed:?}\nturn_rate = {turn_rate:?}\n\
             [run]\nstep = {:?}\nduration = {:?}\n{}",
            self.step, self.duration, self.effects
        )
    }
}

impl Program {
    pub(crate) fn at(path: &Path) -> Result<Self, Box<dyn Error>> {
        Ok(Self { path: path.canonicalize()?, folder: TempDir::new()? })
    }

    /// The nodes of a run; of one that is refused on its way, those before.
    pub(crate) fn run(&self, method: &str, setup: &Setup<'_>) -> Result<Vec<Seen>, Box<dyn Error>> {
        let (scene, nodes) = (self.folder.path().join("scene.toml"), self.folder.path().join("nodes.csv"));
        fs::write(&scene, setup.scene())?;
        let made = Command::new(&self.path)
            .args(["run".as_ref(), scene.as_os_str(), "--method".as_ref(), method.as_ref()])
            .args(["--out".as_ref(), nodes.as_os_str(), "--force".as_ref()])
            .stdout(Stdio::null())
            .output()?;
        let text = fs::read_to_string(&nodes).map_err(|_| String::from_utf8_lossy(&made.stderr).into_owned())?;
        fs::remove_file(&nodes)?;
        read(&text)
    }
}

/// Place, heading, speed and turn rate of each node, and what its energy is wrong by.
fn read(text: &str) -> Result<Vec<Seen>, Box<dyn Error>> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let column = |name: &str| names.iter().position(|column| column.starts_with(name));
    let columns = ["x ", "y ", "heading ", "speed ", "turn_rate "].map(column);
    let (energy, work, constraint) = (column("energy "), column("work "), column("constraint "));
    let mut begin = None;
    let mut nodes = Vec::new();
    for line in lines {
        let row = line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        let at = |column: Option<usize>| column.and_then(|k| row.get(k)).copied().unwrap_or(0.0);
        let [x, y, heading, speed, turn_rate] = columns.map(at);
        let left = at(energy) - at(work);
        let first = *begin.get_or_insert(left);
        let values = [x, y, heading, speed, turn_rate, 0.0];
        nodes.push(Seen { t: row[0], values, energy_error: (left - first).abs(), constraint: at(constraint) });
    }
    Ok(nodes)
}
