use crate::args::SceneArguments;
use crate::error::CliError;
use crate::file_roles::FileRoles;
use crate::files::{check_file, ending, write_whole};
use crate::format::csv_header;
use crate::provenance::{Provenance, described, label, metadata_of};
use report::{Chart, chart_svg};
use scene::Column;
use std::io::Write;
use std::path::Path;

/// A file of an analysis: numbers or a picture, by the ending of its name.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ChartFile<'a> {
    Csv(&'a Path),
    Svg(&'a Path),
}

impl<'a> ChartFile<'a> {
    /// Chooses the format by the ending of `path`. Fails, before the work begins, if the file could not be written.
    pub(crate) fn of(path: &'a Path, scene: &str, overwrite: bool) -> Result<Self, CliError> {
        FileRoles::of(scene).rows("--out", Some(path)).check()?;
        let file = match ending(path).as_str() {
            "csv" => Self::Csv(path),
            "svg" => Self::Svg(path),
            _ => return Err(CliError::ChartEnding { path: path.to_owned() }),
        };
        check_file(path, overwrite)?;
        if let Self::Csv(path) = file {
            check_file(&metadata_of(path), overwrite)?;
        }
        Ok(file)
    }

    pub(crate) fn path(self) -> &'a Path {
        let (Self::Csv(path) | Self::Svg(path)) = self;
        path
    }

    /// Writes the rows below their header, with what made them in a file beside; or the chart.
    pub(crate) fn write(
        self,
        overwrite: bool,
        provenance: &Provenance,
        (columns, rows): (&[Column], &dyn Fn() -> Vec<Vec<f64>>),
        chart: impl FnOnce() -> Chart,
    ) -> Result<(), CliError> {
        match self {
            Self::Csv(path) => {
                write_whole(path, overwrite, |file| {
                    writeln!(file, "{}", csv_header(columns.iter().map(label)))?;
                    for row in rows() {
                        let cells: Vec<String> = columns.iter().zip(&row).map(|(column, x)| cell(column, *x)).collect();
                        writeln!(file, "{}", cells.join(","))?;
                    }
                    Ok(())
                })?;
                provenance.write_beside(path, &described(columns))
            }
            Self::Svg(path) => write_whole(path, overwrite, |file| file.write_all(chart_svg(&chart()).as_bytes())),
        }
    }
}

/// Checks the file of `--picture`, before the work begins.
pub(crate) fn check_picture(path: Option<&Path>, shared: &SceneArguments) -> Result<(), CliError> {
    let Some(path) = path else { return Ok(()) };
    FileRoles::of(&shared.scene).writes("--picture", Some(path)).check()?;
    check_file(path, shared.force)
}

/// Writes the file of `--picture`.
pub(crate) fn write_picture(
    path: Option<&Path>,
    shared: &SceneArguments,
    chart: impl FnOnce() -> Chart,
) -> Result<(), CliError> {
    let Some(path) = path else { return Ok(()) };
    write_whole(path, shared.force, |file| file.write_all(chart_svg(&chart()).as_bytes()))
}

/// A number as a file has it: one of a column of whole numbers without a point.
fn cell(column: &Column, x: f64) -> String {
    if column.whole { format!("{x:.0}") } else { format!("{x:?}") }
}
