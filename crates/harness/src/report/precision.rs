//! The report of work against precision: diagrams and tables on one page.

use super::diagram::{Abscissa, picture};
use super::xml::escape;
use super::{Numbers, PAGE, ReportError, files, numbered, page};
use crate::precision::Curve;
use std::path::{Path, PathBuf};

/// What the report of a measurement shows; numbers of tables are finished text.
#[derive(Debug, Clone)]
pub struct PrecisionReport {
    /// The heading of the page.
    pub title: String,
    /// What was measured, in a few sentences; an empty line starts a new paragraph.
    pub intro: String,
    /// The short name that the picture files start with; characters unfit for a file name become `-`.
    pub name: String,
    /// The heading of the scene.
    pub heading: String,
    /// Names and values.
    pub facts: Vec<(String, String)>,
    /// The points that the diagrams show.
    pub curves: Vec<Curve>,
    /// The tables below them.
    pub tables: Vec<PrecisionTable>,
    /// Files of numbers to put beside the page as `NAME.ENDING`.
    pub numbers: Vec<Numbers>,
}

/// A table of finished text. The last cell of a row that is shorter than the others takes the columns that are left.
#[derive(Debug, Clone)]
pub struct PrecisionTable {
    /// The heading.
    pub title: String,
    /// The headings of the columns.
    pub columns: Vec<String>,
    /// The rows; one that begins with the label of a curve begins with its look.
    pub rows: Vec<Vec<String>>,
}

/// Writes a page `index.html` with the diagrams `NAME-time` and `NAME-step`, each as `.svg` and `.png`, and the numbers into a folder, as
/// [`write()`](super::write()) does.
///
/// # Errors
/// As [`write()`](super::write()).
pub fn write_precision(
    report: &PrecisionReport,
    directory: &Path,
    overwrite: bool,
) -> Result<Vec<PathBuf>, ReportError> {
    if !overwrite && directory.symlink_metadata().is_ok() {
        return Err(ReportError::Exists { path: directory.to_path_buf() });
    }
    let name = files::stems(std::iter::once(report.name.as_str())).remove(0);
    let time = "What accuracy costs: the error at the end against the time of a run. A point further down is more exact, \
                one further left is faster. The broad band joins the points that no other point beats in both; thin \
                    dashes have the slopes of the orders; small dots are round-off. A pointer over a point shows its \
                    numbers.";
    let step = "The same errors against the step, where a slope is the order of the method.";
    let pictures = [("time", Abscissa::Seconds, time), ("step", Abscissa::Step, step)]
        .into_iter()
        .map(|(what, abscissa, caption)| {
            let title = format!("{}: error against {what}", report.heading);
            picture(&report.curves, abscissa, [format!("{name}-{what}"), title, caption.to_owned()])
        })
        .collect::<Result<Vec<_>, _>>()?;
    let labels: Vec<String> = report.curves.iter().map(Curve::label).collect();
    let shown = |row: &[String]| labels.iter().position(|label| row.first() == Some(label));

    let mut text = page::head(&report.title, &report.intro);
    text += &format!("</header>\n<main>\n<section>\n<h2>{}</h2>\n", escape(&report.heading));
    page::facts(&mut text, &report.facts);
    page::columns(
        &mut text,
        &[&pictures[..1], &pictures[1..]].map(|pictures| pictures.iter().map(page::figure).collect()),
    );
    page::numbers(&mut text, &name, &report.numbers);
    text += "</section>\n";
    for table in &report.tables {
        text += &format!("<section>\n<h2>{}</h2>\n", escape(&table.title));
        page::table(&mut text, &table.columns, &table.rows, &[], &shown);
        text += "</section>\n";
    }
    text += &page::foot();
    let mut contents = vec![(PAGE.to_owned(), text.into_bytes())];
    for picture in &pictures {
        contents.extend(picture.files()?);
    }
    contents.extend(numbered(&name, &report.numbers));
    files::write_all(directory, &contents, overwrite)
}
