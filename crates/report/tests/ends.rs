//! Runs that failed end in a cross, and runs that blew up do not scale the pictures.

use crate::common::{circle, report, scene, texts, written};
use report::{SceneReport, Series, path_picture};

fn ends(series: Vec<Series>) -> SceneReport {
    SceneReport { exact_path: None, ..scene("ends", series) }
}

/// The picture of the paths of these runs.
fn path(series: Vec<Series>) -> Vec<String> {
    vec![path_picture(&ends(series))]
}

/// All pictures of these runs, as the report has them.
fn all(series: Vec<Series>) -> Vec<String> {
    written(&report(vec![ends(series)])).1.into_iter().map(|(_, picture)| picture).collect()
}

fn blown_up() -> Series {
    let mut series = circle("wild", 300);
    series.path.iter_mut().enumerate().for_each(|(k, point)| *point = [f64::powi(1.5, k as i32), 0.0]);
    series.energy_error.iter_mut().enumerate().for_each(|(k, error)| *error = f64::powi(1.1, k as i32));
    series
}

#[test]
fn a_run_that_blew_up_does_not_scale_the_pictures() {
    check_scales(path, &[0]);
}

#[test]
#[ignore = "slow"]
fn a_run_that_blew_up_does_not_scale_the_pictures_in_full() {
    // The paths and the energy.
    check_scales(all, &[0, 2]);
}

fn check_scales(drawn: impl Fn(Vec<Series>) -> Vec<String>, places: &[usize]) {
    let diverged = Series { diverged: true, ..blown_up() };
    let figures = |series: Vec<Series>| -> Vec<Vec<String>> {
        let number = |text: &String| text.starts_with(|c: char| c.is_ascii_digit() || c == '−');
        drawn(series).iter().map(|picture| texts(picture).into_iter().filter(number).collect()).collect()
    };
    let alone = figures(vec![circle("calm", 300)]);
    let beside = figures(vec![circle("calm", 300), diverged]);
    // The control: a run that is only large scales them.
    let large = figures(vec![circle("calm", 300), blown_up()]);
    for &k in places {
        assert_eq!(alone[k], beside[k], "{k}");
        assert_ne!(alone[k], large[k], "{k}");
    }
}

#[test]
fn where_all_blew_up_they_are_shown() {
    let drawn = path(vec![Series { diverged: true, ..blown_up() }]).concat();
    assert!(texts(&drawn).iter().any(|text| text.contains("×10")), "{drawn}");
}

#[test]
fn a_run_that_failed_ends_in_a_cross() {
    check_crosses(path, 1);
}

#[test]
#[ignore = "slow"]
fn a_run_that_failed_ends_in_a_cross_in_full() {
    check_crosses(all, 3);
}

fn check_crosses(drawn: impl Fn(Vec<Series>) -> Vec<String>, pictures: usize) {
    let shapes = |failed: bool| -> Vec<usize> {
        let mut short = circle("short", 300);
        short.path.truncate(200);
        short.time.truncate(200);
        let drawn = drawn(vec![circle("whole", 300), Series { failed, ..short }]);
        drawn.iter().map(|picture| picture.matches("<polygon").count()).collect()
    };
    let (failed, whole) = (shapes(true), shapes(false));
    assert_eq!(failed.len(), pictures);
    assert_eq!(failed, whole.iter().map(|count| count + 1).collect::<Vec<_>>());
}
