//! Runs that failed end in a cross, and runs that blew up do not scale the pictures.

use crate::common::{circle, report, scene, texts, written};
use harness::report::Series;

/// The picture of these runs whose file has that ending.
fn picture(series: Vec<Series>, ending: &str) -> String {
    let mut scene = scene("ends", series);
    scene.exact_path = None;
    let (_, pictures) = written(&report(vec![scene]));
    pictures.into_iter().find(|(file, _)| file.to_string_lossy().ends_with(ending)).unwrap().1
}

fn blown_up() -> Series {
    let mut series = circle("wild", 300);
    series.path.iter_mut().enumerate().for_each(|(k, point)| *point = [f64::powi(1.5, k as i32), 0.0]);
    series.energy_error.iter_mut().enumerate().for_each(|(k, error)| *error = f64::powi(1.1, k as i32));
    series
}

#[test]
fn a_run_that_blew_up_does_not_scale_the_pictures() {
    let diverged = Series { diverged: true, ..blown_up() };
    for ending in ["path.svg", "energy.svg"] {
        let alone = texts(&picture(vec![circle("calm", 300)], ending));
        let beside = texts(&picture(vec![circle("calm", 300), diverged.clone()], ending));
        let figures = |texts: &[String]| -> Vec<String> {
            texts.iter().filter(|text| text.starts_with(|c: char| c.is_ascii_digit() || c == '−')).cloned().collect()
        };
        assert_eq!(figures(&alone), figures(&beside), "{ending}");
        // The control: a run that is only large scales them.
        let large = texts(&picture(vec![circle("calm", 300), blown_up()], ending));
        assert_ne!(figures(&alone), figures(&large), "{ending}");
    }
}

#[test]
fn where_all_blew_up_they_are_shown() {
    let drawn = picture(vec![Series { diverged: true, ..blown_up() }], "path.svg");
    assert!(texts(&drawn).iter().any(|text| text.contains("×10")), "{drawn}");
}

#[test]
fn a_run_that_failed_ends_in_a_cross() {
    let shapes = |failed: bool, ending: &str| {
        let mut short = circle("short", 300);
        short.path.truncate(200);
        short.time.truncate(200);
        picture(vec![circle("whole", 300), Series { failed, ..short }], ending).matches("<polygon").count()
    };
    for ending in ["path.svg", "energy.svg", "constraint.svg"] {
        assert_eq!(shapes(true, ending), shapes(false, ending) + 1, "{ending}");
    }
}
