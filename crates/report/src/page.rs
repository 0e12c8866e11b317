//! The page.

use super::figure::Figure;
use super::look::{self, Ink, LOOKS};
use super::svg::{dashes, escape};
use super::{Numbers, Report, SceneReport};

/// The name of the page.
pub(crate) const PAGE: &str = "index.html";
/// The style, in the page itself, so that the page is one file.
const STYLE: &str = include_str!("style.css");
/// What comes before the page is shown, and what moves in it.
const HEAD: &str = include_str!("head.js");
const SCRIPT: &str = include_str!("page.js");

/// What the page shows of a scene beside its text.
pub(crate) struct ShownScene<'a> {
    /// The name that its files start with.
    pub(crate) name: &'a str,
    /// The paths, the constraint, the energy, and what else is shown against time; or what accuracy costs.
    pub(crate) figures: Vec<Figure>,
    /// The figure that moves, if there is one.
    pub(crate) animation: Option<String>,
}

/// The page of a report, given what it shows of its scenes.
pub(crate) fn page(report: &Report, shown: &[ShownScene<'_>]) -> String {
    let mut page = head(&report.title, &report.intro);
    let scenes = || report.scenes.iter().zip(shown);
    if report.scenes.len() > 1 {
        page += "<nav aria-label=\"Scenes\"><ul>\n";
        for (scene, shown) in scenes() {
            page += &format!("<li><a href=\"#scene-{}\">{}</a></li>\n", escape(shown.name), escape(&scene.title));
        }
        page += "</ul></nav>\n";
    }
    page += "</header>\n<main>\n";
    scenes().for_each(|(scene, shown)| section(&mut page, scene, shown, &report.notes));
    let curve = |row: &[String]| {
        let mut curves = report.scenes.iter().flat_map(|scene| scene.costs.iter().flatten());
        curves.position(|curve| row.first() == Some(&curve.label))
    };
    for own in &report.tables {
        page += &format!("<section>\n<h2>{}</h2>\n", escape(&own.title));
        table(&mut page, &own.columns, &own.rows, &report.notes, &curve);
        page += "</section>\n";
    }
    if !report.notes.is_empty() {
        page += "<section id=\"columns\">\n<h2>What the columns mean</h2>\n<dl class=\"notes\">\n";
        for (column, meaning) in &report.notes {
            page += &format!("<dt>{}</dt><dd>{}</dd>\n", escape(column), escape(meaning));
        }
        page += "</dl>\n</section>\n";
    }
    page + &foot()
}

/// What a page begins with, up to its heading and the paragraphs below.
fn head(title: &str, intro: &str) -> String {
    let title = escape(title);
    let paragraphs = intro.split("\n\n").map(str::trim).filter(|paragraph| !paragraph.is_empty());
    let intro: String = paragraphs.map(|paragraph| format!("<p>{}</p>\n", escape(paragraph))).collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n<script>\n{HEAD}</script>\n</head>\n<body>\n<header>\n\
         <button type=\"button\" id=\"theme\" hidden></button>\n<h1>{title}</h1>\n\
         <div class=\"intro\">\n{intro}</div>\n"
    )
}

/// What it ends with.
fn foot() -> String {
    format!("</main>\n<script>\n{SCRIPT}</script>\n</body>\n</html>\n")
}

/// A sample of a method's line and marker.
fn key(method: usize) -> String {
    let points: Vec<String> =
        look::marker(method).iter().map(|[x, y]| format!("{:.1},{:.1}", x + 14.0, y + 6.0)).collect();
    let ink = Ink::Method(method);
    format!(
        "<svg class=\"key\" viewBox=\"0 0 28 12\" aria-hidden=\"true\"><path d=\"M0 6H28\" stroke=\"{colour}\" \
         stroke-width=\"{}\" stroke-dasharray=\"{}\"/><polygon fill=\"{colour}\" points=\"{}\"/></svg>",
        look::width(method),
        dashes(ink, 1.0),
        points.join(" "),
        colour = ink.colour(),
    )
}

/// The runs as buttons, which the script makes work: each shows its run in the pictures below, or does not.
fn legend(page: &mut String, scene: &SceneReport) {
    if scene.drawn().count() < 2 {
        return;
    }
    *page += "<div class=\"legend\" role=\"group\" aria-label=\"Methods shown in the pictures\" hidden>\n";
    for (method, series) in scene.drawn() {
        let (run, key, label) = (method % LOOKS, key(method), escape(&series.label));
        *page += &format!("<button type=\"button\" aria-pressed=\"true\" data-shows=\"{run}\">{key}{label}</button>\n");
    }
    *page += "<button type=\"button\" data-shows=\"all\">all</button>\n";
    *page += "<button type=\"button\" data-shows=\"none\">none</button>\n</div>\n";
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
    let mut right: Vec<String> = shown.figures.iter().map(figure).collect();
    if right.is_empty() {
        *page += "</section>\n";
        return;
    }
    let mut left = vec![right.remove(0)];
    // A run without a path, of a system without a place, has no empty picture of one.
    let place = scene.costs.is_some() || scene.series.iter().any(|series| !series.path.is_empty());
    left.retain(|_| place);
    left.extend(shown.animation.clone());
    if right.len() > 2 {
        left.extend(right.drain(..2));
    } else if left.is_empty() {
        left.push(right.remove(0));
    }
    columns(page, &[left, right]);
    *page += "</section>\n";
}

/// Names and values.
fn facts(page: &mut String, facts: &[(String, String)]) {
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
fn figure(figure: &Figure) -> String {
    let (file, drawing, caption) = (escape(&figure.file), figure.inline(""), escape(&figure.caption));
    format!(
        "<figure>\n<div class=\"scroll\">{drawing}</div>\n<figcaption>{caption} <a href=\"{file}.svg\">SVG</a> \
         <a href=\"{file}.png\">PNG</a></figcaption>\n</figure>\n"
    )
}

/// Figures in two columns, which stand one above the other where there is no room.
fn columns(page: &mut String, [left, right]: &[Vec<String>; 2]) {
    let (left, right) = (left.concat(), right.concat());
    *page += &format!("<div class=\"pictures\">\n<div>\n{left}</div>\n<div>\n{right}</div>\n</div>\n");
}

/// Where the numbers are.
fn numbers(page: &mut String, name: &str, numbers: &[Numbers]) {
    if numbers.is_empty() {
        return;
    }
    let shown = |ending: &str| match ending.split_once('-') {
        Some((ending, _)) => format!("metadata of the {}", ending.to_uppercase()),
        None => ending.to_uppercase(),
    };
    let name = escape(name);
    let link = |Numbers { ending, .. }: &Numbers| format!("<a href=\"{name}.{ending}\">{}</a>", shown(ending));
    *page +=
        &format!("<p class=\"numbers\">All digits: {}</p>\n", numbers.iter().map(link).collect::<Vec<_>>().join(" "));
}

/// A table; `notes` say what columns mean, and `shown` tells which look a row begins with, if with any.
fn table(
    page: &mut String,
    columns: &[String],
    rows: &[Vec<String>],
    notes: &[(String, String)],
    shown: &dyn Fn(&[String]) -> Option<usize>,
) {
    let width = rows.iter().map(Vec::len).fold(columns.len(), usize::max);
    let class: Vec<&str> =
        (0..width).map(|column| if numeric(rows, column, width) { " class=\"n\"" } else { "" }).collect();
    *page += "<div class=\"scroll\"><table>\n<thead><tr>";
    for (column, class) in class.iter().enumerate() {
        let heading = columns.get(column).map_or("", String::as_str);
        let note = notes.iter().find(|(name, _)| columns.get(column) == Some(name));
        let note = note.map_or_else(String::new, |(_, meaning)| format!(" title=\"{}\"", escape(meaning)));
        *page += &format!("<th scope=\"col\"{class}{note}>{}</th>", escape(heading));
    }
    *page += "</tr></thead>\n<tbody>\n";
    for row in rows {
        *page += "<tr>";
        let method = shown(row);
        for (column, cell) in row.iter().enumerate() {
            let key = method.filter(|_| column == 0).map_or_else(String::new, key);
            let spanned = spanned(row, width).filter(|_| column + 1 == row.len());
            let class = spanned.map_or_else(|| class[column].to_owned(), |columns| format!(" colspan=\"{columns}\""));
            // On a narrow screen a row is a list, and each cell has its heading beside it.
            let own = columns.get(column).filter(|_| spanned.is_none());
            let heading = own.map_or_else(String::new, |name| format!(" data-column=\"{}\"", escape(name)));
            *page += &format!("<td{class}{heading}>{key}{}</td>", escape(cell));
        }
        *page += "</tr>\n";
    }
    *page += "</tbody>\n</table></div>\n";
}

/// The number of columns that the last cell of a short row spans; `None` if the row is full.
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
    let mut cells = cells.filter(|cell| !missing(cell)).peekable();
    cells.peek().is_some() && cells.all(number)
}
