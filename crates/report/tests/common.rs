//! Reports to write, and what is read back from them.

use report::{Report, SceneReport, Series, write};
use std::fs;
use std::path::{Path, PathBuf};

pub(crate) const PICTURES: [&str; 3] = ["path", "constraint", "energy"];

/// A circle of unit radius, with errors that grow.
pub(crate) fn circle(label: &str, nodes: usize) -> Series {
    let time: Vec<f64> = (0..nodes).map(|k| 0.01 * k as f64).collect();
    Series {
        label: label.to_owned(),
        path: time.iter().map(|t| [t.sin(), 1.0 - t.cos()]).collect(),
        heading: time.clone(),
        rotor: vec![],
        followers: vec![],
        constraint: time.iter().map(|t| 1e-16 * (1.0 + t)).collect(),
        energy_error: time.iter().map(|t| 1e-9 * t).collect(),
        time,
        ..Series::default()
    }
}

/// Five nodes with the same values at each.
pub(crate) fn constant(path: [f64; 2], heading: f64, error: f64) -> Series {
    Series {
        label: "constant".to_owned(),
        path: vec![path; 5],
        heading: vec![heading; 5],
        rotor: vec![],
        followers: vec![],
        time: vec![0.0, 1.0, 2.0, 3.0, 4.0],
        constraint: vec![error; 5],
        energy_error: vec![error; 5],
        ..Series::default()
    }
}

pub(crate) fn scene(name: &str, series: Vec<Series>) -> SceneReport {
    SceneReport {
        name: name.to_owned(),
        title: format!("The scene {name}"),
        facts: vec![("mass".to_owned(), "1 kg".to_owned())],
        columns: ["method", "error", "note"].map(str::to_owned).to_vec(),
        rows: series.iter().map(|series| vec![series.label.clone(), "1.5e-16".to_owned(), "kept".to_owned()]).collect(),
        exact_path: series.first().map(|series| series.path.clone()),
        series,
        ..SceneReport::default()
    }
}

pub(crate) fn report(scenes: Vec<SceneReport>) -> Report {
    Report {
        title: "A comparison".to_owned(),
        intro: "What was done.\n\nAnd how.".to_owned(),
        scenes,
        ..Report::default()
    }
}

pub(crate) fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Writes the report into a folder of that name, which is new.
pub(crate) fn put(report: &Report, folder: &Path) -> Vec<PathBuf> {
    fs::create_dir(folder).unwrap();
    write(report, folder).unwrap()
}

/// Writes the report into a new folder, checks that its pictures are well-formed, and returns the page and the SVG files.
pub(crate) fn written(report: &Report) -> (String, Vec<(PathBuf, String)>) {
    let parent = tempfile::tempdir().unwrap();
    let files = put(report, &parent.path().join("out"));
    // A table alone has no pictures.
    let drawn = report.scenes.iter().filter(|scene| !scene.series.is_empty()).count();
    assert_eq!(files.len(), 1 + 6 * drawn);
    let mut pictures = Vec::new();
    for pair in files[1..].chunks(2) {
        let (file, picture) = (pair[0].clone(), fs::read_to_string(&pair[0]).unwrap());
        let document =
            roxmltree::Document::parse(&picture).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        assert!(document.root_element().has_tag_name(("http://www.w3.org/2000/svg", "svg")));
        check_numbers(&document);
        let png = fs::read(&pair[1]).unwrap();
        let lengths = document.root_element().attribute("viewBox").unwrap().split(' ').skip(2);
        // Ten units of the drawing to one of the picture, two pixels to that.
        let pixels: Vec<u32> = lengths.map(|length| (length.parse::<f64>().unwrap() / 5.0).round() as u32).collect();
        assert_eq!(size(&png).to_vec(), pixels);
        pictures.push((file, picture));
    }
    (fs::read_to_string(&files[0]).unwrap(), pictures)
}

/// Width and height that a PNG file says it has.
pub(crate) fn size(png: &[u8]) -> [u32; 2] {
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n") && &png[12..16] == b"IHDR");
    [16, 20].map(|at| u32::from_be_bytes(png[at..at + 4].try_into().unwrap()))
}

/// Every coordinate is a number within the picture.
pub(crate) fn check_numbers(document: &roxmltree::Document<'_>) {
    let frame: Vec<f64> = document
        .root_element()
        .attribute("viewBox")
        .unwrap()
        .split(' ')
        .map(|length| length.parse().unwrap())
        .collect();
    for node in document.descendants() {
        for pair in node.attribute("points").unwrap_or_default().split_whitespace() {
            let (x, y) = pair.split_once(',').unwrap();
            let (x, y): (f64, f64) = (x.parse().unwrap(), y.parse().unwrap());
            assert!((0.0..=frame[2]).contains(&x) && (0.0..=frame[3]).contains(&y), "{pair} outside of {frame:?}");
        }
    }
}

pub(crate) fn texts(picture: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(picture).unwrap();
    let texts = document.descendants().filter(|node| node.has_tag_name("text"));
    texts.map(|node| node.text().unwrap_or_default().trim().to_owned()).collect()
}
