use crate::error::CliError;
use crate::files::write_whole;
use crate::first_error::FirstError;
use scene::SceneSystem;
use sleigh::SleighState;
use std::io::{Error, Seek, Write};
use std::path::Path;

/// The formats a trajectory is written in.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Format {
    Csv,
    Npz,
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Format {
    /// By the ending of the file's name.
    pub(crate) fn of(path: &Path) -> Result<Self, CliError> {
        let ending = path.extension().map(std::ffi::OsStr::to_ascii_lowercase);
        match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("csv") => Ok(Self::Csv),
            Some("npz") => Ok(Self::Npz),
            #[cfg(feature = "parquet")]
            Some("parquet") => Ok(Self::Parquet),
            #[cfg(not(feature = "parquet"))]
            Some("parquet") => Err(CliError::WithoutParquet { path: path.to_owned() }),
            _ => Err(CliError::Ending { path: path.to_owned() }),
        }
    }
}

/// Names and units of the columns of every trajectory; in a `.npz` file the name alone is that of the array.
const COLUMNS: [(&str, &str); 11] = [
    ("t", "s"),
    ("x", "m"),
    ("y", "m"),
    ("heading", "rad"),
    ("speed", "m/s"),
    ("turn_rate", "rad/s"),
    ("energy", "J"),
    ("constraint", "m/s"),
    ("constraint_force", "N"),
    ("center_x", "m"),
    ("center_y", "m"),
];

/// A table of numbers, with a header.
pub(crate) struct Columns {
    header: Vec<(String, &'static str)>,
    pub(crate) rows: Vec<Vec<f64>>,
}

impl Columns {
    /// Names with their units, and rows of as many numbers.
    pub(crate) fn new(header: Vec<(String, &'static str)>, rows: Vec<Vec<f64>>) -> Self {
        Self { header, rows }
    }

    /// A trajectory in the words of a scene: what the scene does not have has no column.
    fn of<const N: usize, const M: usize>(system: &dyn SceneSystem<N, M>, nodes: &[dla::Node<N, M>]) -> Self {
        let mut header: Vec<_> = COLUMNS.iter().map(|(name, unit)| ((*name).to_owned(), *unit)).collect();
        let mut rows = Vec::with_capacity(nodes.len());
        for node in nodes {
            // What holds from this node on.
            let piece = system.scene_piece(node.t);
            let SleighState { x, y, heading, speed, turn_rate } = piece.sleigh_state(&node.q, &node.v);
            let [center_x, center_y] = piece.centre(&node.q);
            let lambda = piece.motion(node.t, &node.q, &node.v).map_or([f64::NAN; M], |motion| motion.multiplier);
            // The first constraint is that of the blade.
            let force = lambda.first().copied().unwrap_or(0.0);
            let mut row = vec![node.t, x, y, heading, speed, turn_rate, node.energy, node.constraint, force];
            row.extend([center_x, center_y]);
            let (rotor, powers) = (piece.rotor(&node.q, &node.v), piece.powers(node.t, &node.q, &node.v, &lambda));
            if rows.is_empty() {
                if rotor.is_some() {
                    header.extend([("rotor_angle".to_owned(), "rad"), ("rotor_rate".to_owned(), "rad/s")]);
                }
                if !powers.is_empty() {
                    header.push(("work".to_owned(), "J"));
                }
                header.extend(powers.iter().map(|power| (format!("power_{}", power.name), "W")));
            }
            row.extend(rotor.into_iter().flatten());
            if !powers.is_empty() {
                row.push(node.work);
            }
            row.extend(powers.iter().map(|power| power.power));
            rows.push(row);
        }
        Self { header, rows }
    }

    /// The names of the columns, each with its unit.
    pub(crate) fn names(&self) -> impl Iterator<Item = String> {
        self.header.iter().map(|(name, unit)| format!("{name} [{unit}]"))
    }
}

/// The most nodes that a file holds: those of a run are in memory, at about 100 bytes each, before they are written.
const MOST_NODES: u64 = 10_000_000;

/// Refuses, before a run begins, one of which more nodes would be kept than fit in the memory.
pub(crate) fn check_size(steps: u64, every: u64) -> Result<(), CliError> {
    // The first, every `every`-th, and the last, which may be one of those.
    let nodes = |every: u64| 1 + steps.div_ceil(every);
    if nodes(every) <= MOST_NODES {
        return Ok(());
    }
    Err(CliError::TooManyNodes { nodes: nodes(every), most: MOST_NODES, every: steps.div_ceil(MOST_NODES - 1) })
}

/// Writes a trajectory in the words of a scene: a file that appears whole or not at all.
pub(crate) fn write<const N: usize, const M: usize>(
    system: &dyn SceneSystem<N, M>,
    nodes: &[dla::Node<N, M>],
    path: &Path,
    format: Format,
    overwrite: bool,
) -> Result<(), CliError> {
    write_columns(&Columns::of(system, nodes), path, format, overwrite)
}

/// The same of any columns.
pub(crate) fn write_columns(columns: &Columns, path: &Path, format: Format, overwrite: bool) -> Result<(), CliError> {
    write_whole(path, overwrite, |file| match format {
        Format::Csv => csv(file, columns),
        Format::Npz => {
            let mut file = FirstError::new(file);
            let outcome = npz(&mut file, columns);
            // What stopped the file is the reason of whatever the archive then stumbled over.
            file.into_result().and(outcome)
        }
        #[cfg(feature = "parquet")]
        Format::Parquet => crate::parquet_file::write(file, columns),
    })
}

fn csv(file: &mut impl Write, columns: &Columns) -> Result<(), Error> {
    let names: Vec<String> = columns.names().collect();
    writeln!(file, "{}", names.join(","))?;
    for row in &columns.rows {
        // `{:?}` prints the shortest text that reads back as the same number.
        write!(file, "{:?}", row[0])?;
        for value in &row[1..] {
            write!(file, ",{value:?}")?;
        }
        writeln!(file)?;
    }
    Ok(())
}

fn npz(file: &mut (impl Write + Seek), columns: &Columns) -> Result<(), Error> {
    use npyz::WriterBuilder;
    let mut archive = zip::ZipWriter::new(file);
    let options =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored).large_file(true);
    for (column, (name, _)) in columns.header.iter().enumerate() {
        archive.start_file(npyz::npz::file_name_from_array_name(name), options)?;
        let mut array = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&[columns.rows.len() as u64])
            .writer(&mut archive)
            .begin_nd()?;
        array.extend(columns.rows.iter().map(|row| row[column]))?;
        array.finish()?;
    }
    archive.finish()?;
    Ok(())
}
