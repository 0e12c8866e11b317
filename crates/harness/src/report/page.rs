//! The page.

use super::picture::Picture;
use super::xml::escape;
use super::{Numbers, Report, SceneReport, look};

/// The style, in the page itself, so that the page is one file.
const STYLE: &str = include_str!("style.css");
/// What comes before the page is shown, and what moves in it.
const HEAD: &str = include_str!("head.js");
const SCRIPT: &str = include_str!("page.js");

/// What the page shows of a scene beside its text.
pub(super) struct ShownScene<'a> {
    /// The name that its files start with.
    pub(super) name: &'a str,
    /// The paths, the constraint, the energy.
    pub(super) pictures: [Picture; 3],
    /// What else is shown against time.
    pub(super) figure: Option<Picture>,
    /// The figure that moves, where there is one.
    pub(super) animation: Option<String>,
}

/// The page of a report, given what it shows of its scenes.
pub(super) fn page(report: &Report, shown: &[ShownScene<'_>]) -> String {
    let mut page = head(&report.title, &report.intro);
    if report.scenes.len() > 1 {
        page += "<nav aria-label=\"Scenes\"><ul>\n";
        for (scene, shown) in report.scenes.iter().zip(shown) {
            page += &format!("<li><a href=\"#scene-{}\">{}</a></li>\n", escape(shown.name), escape(&scene.title));
        }
        page += "</ul></nav>\n";
    }
    page += "</header>\n<main>\n";
    for (scene, shown) in report.scenes.iter().zip(shown) {
        section(&mut page, scene, shown, &report.notes);
    }
    meanings(&mut page, &report.notes);
    page + &foot()
}

/// What a page begins with, up to its heading and the paragraphs below.
pub(super) fn head(title: &str, intro: &str) -> String {
    let title = escape(title);
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n<script>\n{HEAD}</script>\n</head>\n<body>\n<header>\n\
         <button type=\"button\" id=\"theme\" hidden></button>\n<h1>{title}</h1>\n"
    );
    page += "<div class=\"intro\">\n";
    for paragraph in intro.split("\n\n").filter(|paragraph| !paragraph.trim().is_empty()) {
        page += &format!("<p>{}</p>\n", escape(paragraph.trim()));
    }
    page + "</div>\n"
}

/// What it ends with.
pub(super) fn foot() -> String {
    format!("</main>\n<script>\n{SCRIPT}</script>\n</body>\n</html>\n")
}

/// The runs as buttons, which the script makes work: each shows its run in the pictures below, or does not.
fn legend(page: &mut String, scene: &SceneReport) {
    let drawn: Vec<_> = scene.series.iter().enumerate().filter(|(_, series)| series.is_drawn()).collect();
    if drawn.len() < 2 {
        return;
    }
    *page += "<div class=\"legend\" role=\"group\" aria-label=\"Methods shown in the pictures\" hidden>\n";
    for (method, series) in drawn {
        *page += &format!(
            "<button type=\"button\" aria-pressed=\"true\" data-shows=\"{}\">{}{}</button>\n",
            method % look::LOOKS,
            look::key(method),
            escape(&series.label)
        );
    }
    *page += "<button type=\"button\" data-shows=\"all\">all</button>\n";
    *page += "<button type=\"button\" data-shows=\"none\">none</button>\n</div>\n";
}

/// What the columns mean.
fn meanings(page: &mut String, notes: &[(String, String)]) {
    if notes.is_empty() {
        return;
    }
    *page += "<section id=\"columns\">\n<h2>What the columns mean</h2>\n<dl class=\"notes\">\n";
    for (column, meaning) in notes {
        *page += &format!("<dt>{}</dt><dd>{}</dd>\n", escape(column), escape(meaning));
    }
    *page += "</dl>\n</section>\n";
}

fn section(page: &mut String, scene: &SceneReport, shown: &ShownScene<'_>, notes: &[(String, String)]) {
    let name = shown.name;
    *page += &format!("<section id=\"scene-{}\">\n<h2>{}</h2>\n", escape(name), escape(&scene.title));
    facts(page, &scene.facts);
    if !scene.columns.is_empty() || !scene.rows.is_empty() {
        // The row of a method that the pictures show starts with the look of its line.
        let look = |row: &[String]| {
            scene.series.iter().position(|series| row.first() == Some(&series.label) && series.is_drawn())
        };
        table(page, &scene.columns, &scene.rows, notes, &look);
    }
    numbers(page, name, &scene.numbers);
    legend(page, scene);
    let [path, constraint, energy] = shown.pictures.each_ref().map(figure);
    // A run without a path, of a system without a place, has no empty picture of one.
    let path = scene.series.iter().any(|series| !series.path.is_empty()).then_some(path);
    let mut left: Vec<String> = path.into_iter().chain(shown.animation.clone()).collect();
    let mut right = vec![constraint, energy];
    if let Some(shown) = &shown.figure {
        left.append(&mut right);
        right.push(figure(shown));
    } else if left.is_empty() {
        left.push(right.remove(0));
    }
    columns(page, &[left, right]);
    *page += "</section>\n";
}

/// Names and values.
pub(super) fn facts(page: &mut String, facts: &[(String, String)]) {
    if facts.is_empty() {
        return;
    }
    *page += "<dl>\n";
    for (fact, value) in facts {
        *page += &format!("<div><dt>{}</dt><dd>{}</dd></div>\n", escape(fact), escape(value));
    }
    *page += "</dl>\n";
}

/// A picture with its caption.
pub(super) fn figure(picture: &Picture) -> String {
    let file = escape(&picture.file);
    format!(
        "<figure>\n<div class=\"scroll\">{}</div>\n<figcaption>{} <a href=\"{file}.svg\">SVG</a> \
         <a href=\"{file}.png\">PNG</a></figcaption>\n</figure>\n",
        picture.inline(),
        escape(&picture.caption),
    )
}

/// Figures in two columns, which stand one above the other where there is no room.
pub(super) fn columns(page: &mut String, columns: &[Vec<String>; 2]) {
    *page += "<div class=\"pictures\">\n";
    for column in columns {
        *page += &format!("<div>\n{}</div>\n", column.concat());
    }
    *page += "</div>\n";
}

/// Where the numbers are.
pub(super) fn numbers(page: &mut String, name: &str, numbers: &[Numbers]) {
    if numbers.is_empty() {
        return;
    }
    let shown = |ending: &str| match ending.split_once('-') {
        Some((ending, _)) => format!("metadata of the {}", ending.to_uppercase()),
        None => ending.to_uppercase(),
    };
    let links = numbers
        .iter()
        .map(|Numbers { ending, .. }| format!("<a href=\"{}.{ending}\">{}</a>", escape(name), shown(ending)));
    *page += &format!("<p class=\"numbers\">All digits: {}</p>\n", links.collect::<Vec<_>>().join(" "));
}

/// A table; `notes` say what columns mean, and `shown` tells which look a row begins with, if with any.
pub(super) fn table(
    page: &mut String,
    columns: &[String],
    rows: &[Vec<String>],
    notes: &[(String, String)],
    shown: &dyn Fn(&[String]) -> Option<usize>,
) {
    let width = rows.iter().map(Vec::len).fold(columns.len(), usize::max);
    let numeric: Vec<bool> = (0..width).map(|column| numeric(rows, column, width)).collect();
    let class = |column: usize| if numeric[column] { " class=\"n\"" } else { "" };
    let text = |row: &[String], column: usize| row.get(column).map_or_else(String::new, |cell| escape(cell));
    *page += "<div class=\"scroll\"><table>\n<thead><tr>";
    for column in 0..width {
        let note = notes.iter().find(|(name, _)| columns.get(column) == Some(name));
        let note = note.map_or_else(String::new, |(_, meaning)| format!(" title=\"{}\"", escape(meaning)));
        *page += &format!("<th scope=\"col\"{}{note}>{}</th>", class(column), text(columns, column));
    }
    *page += "</tr></thead>\n<tbody>\n";
    for row in rows {
        *page += "<tr>";
        let method = shown(row);
        for column in 0..row.len() {
            let key = method.filter(|_| column == 0).map_or_else(String::new, look::key);
            let class = match spanned(row, width).filter(|_| column + 1 == row.len()) {
                Some(columns) => format!(" colspan=\"{columns}\""),
                None => class(column).to_owned(),
            };
            // On a narrow screen a row is a list, and each cell has its heading beside it.
            let own = columns.get(column).filter(|_| spanned(row, width).is_none() || column + 1 < row.len());
            let heading = own.map_or_else(String::new, |name| format!(" data-column=\"{}\"", escape(name)));
            *page += &format!("<td{class}{heading}>{key}{}</td>", text(row, column));
        }
        *page += "</tr>\n";
    }
    *page += "</tbody>\n</table></div>\n";
}

/// How many columns the last cell of a row takes, where it takes more than its own.
fn spanned(row: &[String], width: usize) -> Option<usize> {
    (!row.is_empty() && row.len() < width).then(|| width + 1 - row.len())
}

/// Whether a column holds numbers, with or without units, and nothing else but signs for a missing one.
fn numeric(rows: &[Vec<String>], column: usize, width: usize) -> bool {
    let missing =
        |cell: &str| matches!(cell.to_lowercase().as_str(), "" | "-" | "–" | "—" | "nan" | "inf" | "-inf" | "n/a");
    let number = |cell: &str| {
        let sign =
            |c: char| c.is_whitespace() || matches!(c, '+' | '-' | '−' | '<' | '>' | '≤' | '≥' | '~' | '≈' | '.');
        cell.trim_start_matches(sign).starts_with(|c: char| c.is_ascii_digit())
    };
    // A cell that takes several columns is text and belongs to none of them.
    let own = |row: &&Vec<String>| spanned(row, width).is_none() || column + 1 < row.len();
    let cells = rows.iter().filter(own).filter_map(|row| row.get(column)).map(|cell| cell.trim());
    let mut cells = cells.filter(|cell| !missing(cell));
    let first = cells.next();
    first.is_some_and(number) && cells.all(number)
}
