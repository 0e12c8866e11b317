//! The pictures: what they show, of whatever numbers.

use crate::common::{check_numbers, circle, constant, report, scene, texts, written};
use report::{Report, SceneReport, Series, path_picture};

/// Series that are empty, uneven, not finite, huge, tiny, late, or all of one value.
fn degenerate() -> [Series; 13] {
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
    [
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
    ]
}

/// Each of them alone and beside another, with an exact path and without.
fn scenes_of(series: &Series) -> [SceneReport; 4] {
    let alone = scene("alone", vec![series.clone()]);
    let without = SceneReport { exact_path: None, ..alone.clone() };
    let mut beside = SceneReport { exact_path: Some(vec![]), ..alone.clone() };
    beside.series.push(circle("dla", 30));
    let mut behind = SceneReport { exact_path: Some(vec![[3.0, 4.0]]), ..beside.clone() };
    behind.series.reverse();
    [alone, without, beside, behind]
}

#[test]
fn degenerate_series_are_drawn_without_a_panic() {
    let all = degenerate();
    for scene in all.iter().flat_map(scenes_of) {
        check_numbers(&roxmltree::Document::parse(&path_picture(&scene)).unwrap());
    }
    // Those with holes and huge values, in all pictures.
    written(&report(vec![scene("together", all[4..6].to_vec())]));
    written(&report(vec![]));
}

#[test]
#[ignore = "slow"]
fn degenerate_series_are_drawn_without_a_panic_at_length() {
    let all = degenerate();
    for scene in all.iter().flat_map(scenes_of) {
        written(&report(vec![scene]));
    }
    written(&report(vec![scene("together", all.to_vec())]));
    written(&report(vec![scene("many", (0..60).map(|k| circle(&format!("method {k}"), 30)).collect())]));
    written(&report(vec![]));
    written(&Report { scenes: vec![scene("", vec![])], ..Report::default() });
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
    check_peak(20_000);
}

#[test]
#[ignore = "slow"]
fn a_long_series_keeps_its_peak_in_few_points_in_full() {
    check_peak(200_000);
}

fn check_peak(nodes: usize) {
    let mut series = circle("dla", nodes);
    series.constraint = vec![1e-16; nodes];
    // Node 123 456 of 200 000.
    series.constraint[nodes * 15_432 / 25_000] = 1e-3;
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
fn rounding_lies_on_one_line_and_decades_are_superscripts() {
    // What comes and goes from node to node, beside a method that slips.
    let [mut rounding, mut slipping] = ["dla", "rk4"].map(|label| circle(label, 100));
    rounding.constraint = (0..100).map(|k| if k % 2 == 0 { 0.0 } else { 3e-16 }).collect();
    slipping.constraint = (0..100).map(|k| 1e-9 * f64::from(k)).collect();
    let (page, pictures) = written(&report(vec![scene("coast", vec![rounding, slipping])]));
    let texts = texts(&pictures[1].1);
    assert!(texts.contains(&"≤ 10⁻¹⁵".to_owned()) && texts.contains(&"10⁻⁸".to_owned()), "{texts:?}");
    assert!(page.contains("Values below 10⁻¹⁵ and exact zeros lie on the dashed line."), "{page}");
    // The line of the one is flat: two corners, of the same height. Those of the legend and of its name at the end are shorter.
    let lines = pictures[1].1.split("data-run=\"0\" stroke=").skip(1).filter_map(|line| line.split("points=\"").nth(1));
    let lines = lines.map(|line| line.split('"').next().unwrap().split_whitespace().collect::<Vec<_>>());
    let heights =
        |line: &Vec<&str>| line.iter().map(|pair| pair.split(',').nth(1).unwrap().to_owned()).collect::<Vec<_>>();
    let longest = lines.max_by_key(Vec::len).unwrap();
    let heights = heights(&longest);
    assert!(heights.len() > 2 && heights.iter().all(|height| *height == heights[0]), "{heights:?}");
}

/// A method that is exact beside others that are not, and that grows: nothing of it is cut off.
#[test]
fn what_grows_from_zero_is_shown_from_its_smallest_size() {
    let mut series = circle("dla", 100);
    series.energy_error = (0..100).map(|k| 1e-9 * f64::from(k)).collect();
    let (page, pictures) = written(&report(vec![scene("coast", vec![series])]));
    let texts = texts(&pictures[2].1);
    assert!(texts.contains(&"≤ 10⁻⁹".to_owned()) && texts.contains(&"10⁻⁷".to_owned()), "{texts:?}");
    assert!(page.contains("Values below 10⁻⁹"), "{page}");
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
    assert_eq!(page.matches("Curves that leave the picture: euler.").count(), 3);
    assert!(texts(&pictures[0].1).contains(&"0.2".to_owned()), "{:?}", texts(&pictures[0].1));
    assert!(texts(&pictures[1].1).contains(&"10⁻¹⁶".to_owned()), "{:?}", texts(&pictures[1].1));
}
