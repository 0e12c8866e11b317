use crate::error::CliError;
use crate::files::write_whole;
use scene::SceneSystem;
use sleigh::SleighState;
use std::io::{Error, Seek, Write};
use std::path::Path;

/// The formats a trajectory is written in.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Format {
    Csv,
    Npz,
}

impl Format {
    /// By the ending of the file's name.
    pub(crate) fn of(path: &Path) -> Result<Self, CliError> {
        match path.extension().and_then(|ending| ending.to_str()) {
            Some("csv") => Ok(Self::Csv),
            Some("npz") => Ok(Self::Npz),
            _ => Err(CliError::Ending { path: path.to_owned() }),
        }
    }
}

/// Names and units of the columns; in a `.npz` file the name alone is that of the array.
const COLUMNS: [(&str, &str); 9] = [
    ("t", "s"),
    ("x", "m"),
    ("y", "m"),
    ("heading", "rad"),
    ("speed", "m/s"),
    ("turn_rate", "rad/s"),
    ("energy", "J"),
    ("constraint", "m/s"),
    ("constraint_force", "N"),
];

/// A trajectory in the words of a scene.
#[derive(Debug)]
pub(crate) struct Columns(Vec<[f64; COLUMNS.len()]>);

impl Columns {
    pub(crate) fn new<Sys, const N: usize, const M: usize>(system: &Sys, nodes: &[dla::Node<N, M>]) -> Self
    where
        Sys: SceneSystem<N, M>,
    {
        let row = |node: &dla::Node<N, M>| {
            let state = system.sleigh_state(&node.q, &node.v);
            // The force of the first constraint, that of the blade; at the start there is no step to average it over.
            let force = node.multipliers.and_then(|all| all.first().copied()).unwrap_or(f64::NAN);
            let SleighState { x, y, heading, speed, turn_rate } = state;
            [node.t, x, y, heading, speed, turn_rate, node.energy, node.constraint, force]
        };
        Self(nodes.iter().map(row).collect())
    }

    /// Writes the file, whole or not at all.
    pub(crate) fn write(&self, path: &Path, format: Format, overwrite: bool) -> Result<(), CliError> {
        write_whole(path, overwrite, |file| match format {
            Format::Csv => self.csv(file),
            Format::Npz => self.npz(file),
        })
    }

    fn csv(&self, file: &mut impl Write) -> Result<(), Error> {
        let header: Vec<String> = COLUMNS.iter().map(|(name, unit)| format!("{name} [{unit}]")).collect();
        writeln!(file, "{}", header.join(","))?;
        for row in &self.0 {
            // `{:?}` prints the shortest text that reads back as the same number.
            write!(file, "{:?}", row[0])?;
            for value in &row[1..] {
                write!(file, ",{value:?}")?;
            }
            writeln!(file)?;
        }
        Ok(())
    }

    fn npz(&self, file: &mut (impl Write + Seek)) -> Result<(), Error> {
        use npyz::WriterBuilder;
        let mut archive = zip::ZipWriter::new(file);
        let options = zip::write::SimpleFileOptions::default()
            .compression_method(zip::CompressionMethod::Stored)
            .large_file(true);
        for (column, (name, _)) in COLUMNS.iter().enumerate() {
            archive.start_file(npyz::npz::file_name_from_array_name(name), options)?;
            let mut array = npyz::WriteOptions::new()
                .default_dtype()
                .shape(&[self.0.len() as u64])
                .writer(&mut archive)
                .begin_nd()?;
            array.extend(self.0.iter().map(|row| row[column]))?;
            array.finish()?;
        }
        archive.finish()?;
        Ok(())
    }
}
