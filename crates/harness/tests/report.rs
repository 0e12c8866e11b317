//! The report as a reader and a file system see it.

// What the helpers of these tests cannot do is a failed test, too.
#![allow(clippy::unwrap_used, clippy::panic)]

use harness::report::{Report, ReportError, SceneReport, Series, write};
use std::fs;
use std::path::{Path, PathBuf};

const PICTURES: [&str; 3] = ["path", "constraint", "energy"];

/// A circle of unit radius, with errors that grow.
fn circle(label: &str, nodes: usize) -> Series {
    let time: Vec<f64> = (0..nodes).map(|k| 0.01 * k as f64).collect();
    Series {
        label: label.to_owned(),
        path: time.iter().map(|t| [t.sin(), 1.0 - t.cos()]).collect(),
        heading: time.clone(),
        constraint: time.iter().map(|t| 1e-16 * (1.0 + t)).collect(),
        energy_error: time.iter().map(|t| 1e-9 * t).collect(),
        time,
    }
}

/// Five nodes with the same values at each.
fn constant(path: [f64; 2], heading: f64, error: f64) -> Series {
    Series {
        label: "constant".to_owned(),
        path: vec![path; 5],
        heading: vec![heading; 5],
        time: vec![0.0, 1.0, 2.0, 3.0, 4.0],
        constraint: vec![error; 5],
        energy_error: vec![error; 5],
    }
}

fn scene(name: &str, series: Vec<Series>) -> SceneReport {
    SceneReport {
        name: name.to_owned(),
        title: format!("The scene {name}"),
        facts: vec![("mass".to_owned(), "1 kg".to_owned())],
        columns: ["method", "error", "note"].map(str::to_owned).to_vec(),
        rows: series.iter().map(|series| vec![series.label.clone(), "1.5e-16".to_owned(), "kept".to_owned()]).collect(),
        exact_path: series.first().map(|series| series.path.clone()),
        series,
    }
}

fn report(scenes: Vec<SceneReport>) -> Report {
    Report { title: "A comparison".to_owned(), intro: "What was done.\n\nAnd how.".to_owned(), scenes }
}

fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Writes the report into a new folder, checks that its pictures are well-formed, and returns the page and the pictures.
fn written(report: &Report) -> (String, Vec<(PathBuf, String)>) {
    let parent = tempfile::tempdir().unwrap();
    let files = write(report, &parent.path().join("out"), false).unwrap();
    assert_eq!(files.len(), 1 + 3 * report.scenes.len());
    let read: Vec<(PathBuf, String)> =
        files.into_iter().map(|file| (file.clone(), fs::read_to_string(&file).unwrap())).collect();
    for (file, picture) in &read[1..] {
        let document =
            roxmltree::Document::parse(picture).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        assert!(document.root_element().has_tag_name(("http://www.w3.org/2000/svg", "svg")));
        check_numbers(&document);
    }
    (read[0].1.clone(), read[1..].to_vec())
}

/// Every coordinate is a number within the picture.
fn check_numbers(document: &roxmltree::Document<'_>) {
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

fn texts(picture: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(picture).unwrap();
    let texts = document.descendants().filter(|node| node.has_tag_name("text"));
    texts.map(|node| node.text().unwrap_or_default().trim().to_owned()).collect()
}

#[test]
fn the_page_and_three_pictures_per_scene_are_written() {
    let parent = tempfile::tempdir().unwrap();
    let directory = parent.path().join("out");
    let report = report(vec![scene("coast", vec![circle("dla", 700), circle("rk4", 700)]), scene("brake", vec![])]);
    let files = write(&report, &directory, false).unwrap();
    let mut expected = vec![directory.join("index.html")];
    for name in ["coast", "brake"] {
        expected.extend(PICTURES.map(|what| directory.join(format!("{name}-{what}.svg"))));
    }
    assert_eq!(files, expected);
    assert!(files.iter().all(|file| file.is_file()));
    assert_eq!(names(parent.path()), ["out"]);
    assert_eq!(names(&directory).len(), files.len());
}

#[cfg(unix)]
#[test]
fn the_files_can_be_read_by_whoever_may_read_other_new_files() {
    use std::os::unix::fs::PermissionsExt;
    let mode = |path: &Path| path.metadata().unwrap().permissions().mode() & 0o777;
    let parent = tempfile::tempdir().unwrap();
    let (folder, file) = (parent.path().join("folder"), parent.path().join("file"));
    fs::create_dir(&folder).unwrap();
    fs::write(&file, "").unwrap();
    let directory = parent.path().join("out");
    for overwrite in [false, true] {
        let files = write(&report(vec![scene("coast", vec![])]), &directory, overwrite).unwrap();
        assert_eq!(mode(&directory), mode(&folder));
        assert!(files.iter().all(|path| mode(path) == mode(&file)));
    }
}

#[test]
fn the_page_holds_every_row_every_fact_and_every_picture() {
    let mut coast = scene("coast", vec![circle("dla", 50), circle("rk4", 50)]);
    coast.rows = (0..7).map(|k| vec![format!("method {k}"), format!("{k}.25e-7"), format!("note {k}")]).collect();
    let report = report(vec![coast, scene("brake", vec![circle("dla", 50)])]);
    let (page, pictures) = written(&report);
    for scene in &report.scenes {
        assert!(page.contains(&format!("<h2>{}</h2>", scene.title)));
        for cell in scene.rows.iter().flatten() {
            assert!(page.contains(&format!(">{cell}</td>")), "{cell}");
        }
        for (fact, value) in &scene.facts {
            assert!(page.contains(&format!("<dt>{fact}</dt><dd>{value}</dd>")));
        }
    }
    for (_, picture) in &pictures {
        let shapes = picture.split_once("fill=\"#ffffff\"/>").unwrap().1.strip_suffix("</svg>\n").unwrap();
        assert!(page.contains(shapes));
    }
    assert!(page.contains("<p>What was done.</p>") && page.contains("<p>And how.</p>"));
    assert!(page.contains("prefers-color-scheme: dark") && page.contains("name=\"viewport\""));
    // Numbers and what says that they are missing stand to the right, words to the left.
    assert!(page.contains("<td class=\"n\">0.25e-7</td>") && page.contains("<td>note 0</td>"));
}

#[test]
fn a_method_without_a_run_stands_in_the_table_alone() {
    let drawn = scene("drawn", vec![circle("first", 50), circle("refuses", 50), circle("last", 50)]);
    let mut left_out = drawn.clone();
    left_out.series[1] = circle("refuses", 0);
    left_out.rows[1] = vec!["refuses".to_owned(), "refused: it cannot".to_owned()];
    let (full, with) = written(&report(vec![drawn]));
    let (page, without) = written(&report(vec![left_out]));
    // The last cell takes the columns that are left, and does not make a column of words of one of numbers.
    assert!(page.contains("<td>refuses</td><td colspan=\"2\">refused: it cannot</td>"));
    assert!(page.contains("<td class=\"n\">1.5e-16</td>") && !full.contains("colspan"));
    for ((_, with), (_, without)) in with.iter().zip(&without) {
        let named = |picture: &str, name: &str| texts(picture).iter().any(|text| text == name);
        assert!(named(with, "refuses") && !named(without, "refuses"));
        assert!(named(without, "first") && named(without, "last"));
    }
    // The third method keeps its look, whoever else is drawn.
    let key = |page: &str| page.split_once("</svg>last</td>").unwrap().0.rsplit_once("<svg").unwrap().1.to_owned();
    assert_eq!(key(&full), key(&page));
}

#[test]
fn the_page_needs_nothing_from_elsewhere() {
    let (page, _) = written(&report(vec![scene("coast", vec![circle("dla", 50)])]));
    let page = page.replace("http://www.w3.org/2000/svg", "");
    for foreign in ["http:", "https:", "<script", "<link", "@import", "url(", "src="] {
        assert!(!page.contains(foreign), "{foreign}");
    }
}

#[test]
fn text_is_escaped_wherever_it_appears() {
    let hostile = "<b a=\"1\" c='2'>&\u{1}</b>";
    let mut scene = scene("coast", vec![circle(hostile, 20)]);
    scene.title = hostile.to_owned();
    scene.facts = vec![(hostile.to_owned(), hostile.to_owned())];
    scene.columns = vec![hostile.to_owned()];
    let mut report = report(vec![scene.clone(), scene]);
    report.title = hostile.to_owned();
    report.intro = hostile.to_owned();
    let (page, pictures) = written(&report);
    let escaped = "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;\u{fffd}&lt;/b&gt;";
    assert!(page.contains(&format!("<h1>{escaped}</h1>")) && page.contains(&format!("<dd>{escaped}</dd>")));
    assert!(!page.contains("<b") || page.matches("<b").count() == page.matches("<body").count());
    assert!(!page.contains('\u{1}'));
    assert!(texts(&pictures[0].1).contains(&hostile.replace('\u{1}', "\u{fffd}")));
}

#[test]
fn scene_names_become_different_names_of_files_in_the_folder() {
    let scenes = ["../up", "a b", "A-B", "", "..", "/"].map(|name| scene(name, vec![circle("dla", 5)]));
    let (page, pictures) = written(&report(scenes.to_vec()));
    let names: Vec<&str> = pictures.iter().map(|(file, _)| file.file_name().unwrap().to_str().unwrap()).collect();
    for stem in ["up", "a-b", "A-B-2", "scene", "scene-2", "scene-3"] {
        assert!(names.contains(&format!("{stem}-path.svg").as_str()), "{stem} in {names:?}");
        assert!(page.contains(&format!("id=\"scene-{stem}\"")));
    }
}

#[test]
fn degenerate_series_are_drawn_without_a_panic() {
    let empty = Series {
        path: vec![],
        heading: vec![],
        time: vec![],
        constraint: vec![],
        energy_error: vec![],
        ..circle("", 0)
    };
    let uneven = Series { heading: vec![0.0; 3], constraint: vec![1.0; 7], ..circle("uneven", 20) };
    let mut straight = constant([0.0, 0.0], 0.0, 0.0);
    straight.path = (0..5).map(|k| [f64::from(k), 0.0]).collect();
    let mut holes = circle("holes", 20);
    holes.path[3] = [f64::NAN, 0.0];
    holes.heading[0] = f64::INFINITY;
    holes.time[7] = f64::NAN;
    holes.constraint[9] = f64::INFINITY;
    holes.energy_error = vec![f64::NAN; 20];
    let mut wild = circle("wild", 20);
    wild.path[19] = [f64::MAX, -f64::MAX];
    wild.path[18] = [1e99, -1e99];
    wild.constraint[19] = f64::MAX;
    wild.energy_error[18] = f64::from_bits(1);
    let mut late = circle("late", 20);
    late.time.iter_mut().for_each(|time| *time += 1e15);
    let all = [
        empty,
        circle("one node", 1),
        uneven,
        straight,
        holes,
        wild,
        late,
        constant([0.0, 0.0], 0.0, 0.0),
        constant([1e8, -1e8], 1e8, 1e8),
        constant([1e-300, 1e-300], 1e-300, 1e-300),
        constant([1e300, 0.0], 0.0, 1e300),
        constant([f64::NAN; 2], f64::NAN, f64::NAN),
        constant([f64::INFINITY, f64::NEG_INFINITY], f64::INFINITY, f64::INFINITY),
    ];
    for series in &all {
        let mut alone = scene("alone", vec![series.clone()]);
        written(&report(vec![alone.clone()]));
        alone.exact_path = None;
        written(&report(vec![alone.clone()]));
        alone.exact_path = Some(vec![]);
        alone.series.push(circle("dla", 30));
        written(&report(vec![alone.clone()]));
        alone.series.reverse();
        alone.exact_path = Some(vec![[3.0, 4.0]]);
        written(&report(vec![alone]));
    }
    written(&report(vec![scene("together", all.to_vec())]));
    written(&report(vec![scene("many", (0..60).map(|k| circle(&format!("method {k}"), 30)).collect())]));
    written(&report(vec![]));
    written(&Report { title: String::new(), intro: String::new(), scenes: vec![scene("", vec![])] });
}

#[test]
fn a_metre_is_as_long_upwards_as_across() {
    let mut circle = circle("dla", 629);
    circle.label = "circle".to_owned();
    let (_, pictures) = written(&report(vec![SceneReport { exact_path: None, ..scene("coast", vec![circle]) }]));
    let document = roxmltree::Document::parse(&pictures[0].1).unwrap();
    let points = document.descendants().filter_map(|node| node.attribute("points")).max_by_key(|points| points.len());
    let points: Vec<[f64; 2]> = points
        .unwrap()
        .split_whitespace()
        .map(|pair| pair.split_once(',').map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()]).unwrap())
        .collect();
    let extent = |axis: usize| {
        let values = points.iter().map(|point| point[axis]);
        values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
    };
    assert!((extent(0) / extent(1) - 1.0).abs() < 0.01, "{} by {}", extent(0), extent(1));
}

#[test]
fn a_long_series_keeps_its_peak_in_few_points() {
    let nodes = 200_000;
    let mut series = circle("dla", nodes);
    series.constraint = vec![1e-16; nodes];
    series.constraint[123_456] = 1e-3;
    let (page, pictures) = written(&report(vec![scene("coast", vec![series])]));
    let (_, constraint) = &pictures[1];
    assert!(texts(constraint).contains(&"10⁻¹⁶".to_owned()), "{:?}", texts(constraint));
    assert!(texts(constraint).iter().any(|text| ["10⁻⁴", "10⁻³", "10⁻²"].contains(&text.as_str())));
    let document = roxmltree::Document::parse(constraint).unwrap();
    let longest = document
        .descendants()
        .filter(|node| node.has_tag_name("polyline"))
        .filter_map(|node| node.attribute("points"))
        .map(|points| points.split_whitespace().count())
        .max()
        .unwrap();
    assert!((100..=600).contains(&longest), "{longest} points");
    assert!(page.contains("Each point is the largest value of a short stretch of time."));
    assert!(pictures.iter().all(|(_, picture)| picture.len() < 200_000));
}

#[test]
fn zeros_lie_on_a_line_of_their_own_and_decades_are_superscripts() {
    let mut series = circle("dla", 100);
    series.constraint = (0..100).map(|k| if k % 2 == 0 { 0.0 } else { 3e-16 }).collect();
    let (page, pictures) = written(&report(vec![scene("coast", vec![series])]));
    let texts = texts(&pictures[1].1);
    assert!(texts.contains(&"10⁻¹⁶".to_owned()) && texts.contains(&"10⁻¹⁵".to_owned()), "{texts:?}");
    // One zero on the axis of time, one on the other.
    assert_eq!(texts.iter().filter(|text| *text == "0").count(), 2);
    assert!(page.contains("Exact zeros lie on the dashed line."));
}

#[test]
fn a_method_that_blows_up_does_not_hide_the_others() {
    let mut blown = circle("euler", 50);
    for k in 20..50 {
        let size = 10_f64.powi(7 * (k - 20));
        let node = usize::try_from(k).unwrap();
        blown.path[node] = [size, size];
        blown.constraint[node] = size;
        blown.energy_error[node] = size;
    }
    let (page, pictures) = written(&report(vec![scene("coast", vec![circle("dla", 50), blown])]));
    assert_eq!(page.matches("Running out of the picture: euler.").count(), 3);
    assert!(texts(&pictures[0].1).contains(&"0.2".to_owned()), "{:?}", texts(&pictures[0].1));
    assert!(texts(&pictures[1].1).contains(&"10⁻¹⁶".to_owned()), "{:?}", texts(&pictures[1].1));
}

#[test]
fn an_existing_folder_is_left_alone_unless_told_otherwise() {
    let parent = tempfile::tempdir().unwrap();
    let directory = parent.path().join("out");
    fs::create_dir(&directory).unwrap();
    let error = write(&report(vec![]), &directory, false).unwrap_err();
    assert!(matches!(&error, ReportError::Exists { path } if *path == directory), "{error}");
    assert!(error.to_string().contains("exists"));
    assert!(names(&directory).is_empty());
}

#[test]
fn overwriting_keeps_foreign_files() {
    let parent = tempfile::tempdir().unwrap();
    let directory = parent.path().join("out");
    write(&report(vec![scene("coast", vec![circle("dla", 20)])]), &directory, true).unwrap();
    fs::write(directory.join("notes.txt"), "mine").unwrap();
    fs::create_dir(directory.join("kept")).unwrap();
    let mut second = report(vec![scene("coast", vec![circle("rk4", 20)])]);
    second.title = "Another".to_owned();
    let files = write(&second, &directory, true).unwrap();
    assert_eq!(fs::read_to_string(directory.join("notes.txt")).unwrap(), "mine");
    assert!(fs::read_to_string(&files[0]).unwrap().contains("<h1>Another</h1>"));
    assert!(texts(&fs::read_to_string(&files[1]).unwrap()).contains(&"rk4".to_owned()));
    let expected = ["coast-constraint.svg", "coast-energy.svg", "coast-path.svg", "index.html", "kept", "notes.txt"];
    assert_eq!(names(&directory), expected);
}

#[test]
fn where_nothing_can_be_written_nothing_is_left() {
    let parent = tempfile::tempdir().unwrap();
    let report = report(vec![scene("coast", vec![circle("dla", 20)])]);
    let fails = |directory: &Path, overwrite: bool| {
        let error = write(&report, directory, overwrite).unwrap_err();
        assert!(matches!(&error, ReportError::Io { path, .. } if path.starts_with(directory)), "{error:?}");
        assert!(std::error::Error::source(&error).is_some());
    };
    // The folder above is missing, or is a file.
    fails(&parent.path().join("missing").join("out"), false);
    fs::write(parent.path().join("file"), "mine").unwrap();
    fails(&parent.path().join("file").join("out"), false);
    // The folder itself is a file.
    fails(&parent.path().join("file"), true);
    assert_eq!(fs::read_to_string(parent.path().join("file")).unwrap(), "mine");
    // A file of the report is a folder: the files before it are not replaced either.
    let directory = parent.path().join("out");
    fs::create_dir_all(directory.join("coast-energy.svg")).unwrap();
    fs::write(directory.join("index.html"), "old").unwrap();
    fails(&directory, true);
    assert_eq!(names(&directory), ["coast-energy.svg", "index.html"]);
    assert_eq!(fs::read_to_string(directory.join("index.html")).unwrap(), "old");
    assert_eq!(names(parent.path()), ["file", "out"]);
}

#[cfg(unix)]
#[test]
fn a_folder_without_permission_stays_as_it_was() {
    use std::os::unix::fs::PermissionsExt;
    let parent = tempfile::tempdir().unwrap();
    let locked = parent.path().join("locked");
    fs::create_dir(&locked).unwrap();
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o555)).unwrap();
    // Who may do everything is not stopped by permissions, and this test says nothing.
    if fs::write(locked.join("probe"), "").is_ok() {
        return;
    }
    assert!(matches!(write(&report(vec![]), &locked.join("out"), false), Err(ReportError::Io { .. })));
    assert!(matches!(write(&report(vec![]), &locked, true), Err(ReportError::Io { .. })));
    assert!(names(&locked).is_empty());
}
