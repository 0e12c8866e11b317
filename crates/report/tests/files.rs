//! What is in the folder, and what is not.

use crate::common::{PICTURES, circle, names, put, report, scene, texts, written};
use report::{Numbers, ReportError, SceneReport, file_stem, write};
use std::fs;
use std::path::Path;

#[test]
fn the_page_and_three_pictures_per_scene_are_written() {
    let parent = tempfile::tempdir().unwrap();
    let directory = parent.path().join("out");
    // A table alone has no pictures.
    let report = report(vec![
        scene("all", vec![]),
        scene("coast", vec![circle("dla", 700), circle("rk4", 700)]),
        scene("brake", vec![circle("dla", 1)]),
    ]);
    let files = put(&report, &directory);
    let mut expected = vec![directory.join("index.html")];
    for name in ["coast", "brake"] {
        let pair = |what| ["svg", "png"].map(|ending| directory.join(format!("{name}-{what}.{ending}")));
        expected.extend(PICTURES.into_iter().flat_map(pair));
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
    let files = put(&report(vec![scene("coast", vec![])]), &directory);
    assert_eq!(mode(&directory), mode(&folder));
    assert!(files.iter().all(|path| mode(path) == mode(&file)));
}

#[test]
fn scene_names_become_different_names_of_files_in_the_folder() {
    check_names(&["a b", "A-B"], &["a-b", "A-B-2"]);
    assert_eq!(["../up", "", "..", "/"].map(file_stem), ["up", "scene", "scene", "scene"]);
}

#[test]
#[ignore = "slow"]
fn scene_names_become_different_names_of_files_in_the_folder_in_full() {
    check_names(&["../up", "a b", "A-B", "", "..", "/"], &["up", "a-b", "A-B-2", "scene", "scene-2", "scene-3"]);
}

fn check_names(given: &[&str], stems: &[&str]) {
    let scenes = given.iter().map(|name| scene(name, vec![circle("dla", 5)]));
    let (page, pictures) = written(&report(scenes.collect()));
    let names: Vec<&str> = pictures.iter().map(|(file, _)| file.file_name().unwrap().to_str().unwrap()).collect();
    for stem in stems {
        assert!(names.contains(&format!("{stem}-path.svg").as_str()), "{stem} in {names:?}");
        assert!(page.contains(&format!("id=\"scene-{stem}\"")));
    }
}

#[test]
fn overwriting_keeps_foreign_files() {
    let parent = tempfile::tempdir().unwrap();
    let directory = parent.path().join("out");
    put(&report(vec![scene("coast", vec![circle("dla", 20)])]), &directory);
    fs::write(directory.join("notes.txt"), "mine").unwrap();
    fs::create_dir(directory.join("kept")).unwrap();
    let mut second = report(vec![scene("coast", vec![circle("rk4", 20)])]);
    second.title = "Another".to_owned();
    let files = write(&second, &directory).unwrap();
    assert_eq!(fs::read_to_string(directory.join("notes.txt")).unwrap(), "mine");
    assert!(fs::read_to_string(&files[0]).unwrap().contains("<h1>Another</h1>"));
    assert!(texts(&fs::read_to_string(&files[1]).unwrap()).contains(&"rk4".to_owned()));
    let mut expected: Vec<String> = ["index.html", "kept", "notes.txt"].map(str::to_owned).to_vec();
    expected.extend(PICTURES.iter().flat_map(|what| ["svg", "png"].map(|ending| format!("coast-{what}.{ending}"))));
    expected.sort();
    assert_eq!(names(&directory), expected);
}

#[test]
fn where_nothing_can_be_written_nothing_is_left() {
    let parent = tempfile::tempdir().unwrap();
    let fails = |scenes: Vec<SceneReport>, directory: &Path| {
        let error = write(&report(scenes), directory).unwrap_err();
        assert!(matches!(&error, ReportError::Io { path, .. } if path.starts_with(directory)), "{error:?}");
        assert!(std::error::Error::source(&error).is_some());
    };
    // The folder is missing, or the one above is a file.
    fails(vec![], &parent.path().join("missing"));
    fs::write(parent.path().join("file"), "mine").unwrap();
    fails(vec![], &parent.path().join("file").join("out"));
    // The folder itself is a file.
    fails(vec![], &parent.path().join("file"));
    assert_eq!(fs::read_to_string(parent.path().join("file")).unwrap(), "mine");
    // A file of the report is a folder: the files before it are not replaced either.
    let directory = parent.path().join("out");
    fs::create_dir_all(directory.join("coast-energy.svg")).unwrap();
    fs::write(directory.join("index.html"), "old").unwrap();
    fails(vec![scene("coast", vec![circle("dla", 20)])], &directory);
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
    assert!(matches!(write(&report(vec![]), &locked), Err(ReportError::Io { .. })));
    assert!(names(&locked).is_empty());
}

#[test]
fn numbers_stand_beside_the_page_and_are_linked() {
    let parent = tempfile::tempdir().unwrap();
    let mut coast = scene("coast", vec![circle("dla", 20)]);
    coast.numbers = vec![Numbers { ending: "csv", text: "method\ndla\n".to_owned() }];
    let files = put(&report(vec![coast]), &parent.path().join("out"));
    let csv = files.last().unwrap();
    assert!(csv.ends_with("coast.csv"));
    assert_eq!(fs::read_to_string(csv).unwrap(), "method\ndla\n");
    assert!(fs::read_to_string(&files[0]).unwrap().contains("<a href=\"coast.csv\">CSV</a>"));
}
