//! What the page has to move, before anything moves.

use crate::common::{circle, constant, report, scene, written};
use approx::assert_abs_diff_eq;
use report::{SceneReport, Series};

/// The animation of a page with one, if there is one.
pub(crate) fn animation(page: &str) -> Option<&str> {
    page.split_once("<figure class=\"animation\"").map(|(_, rest)| rest.split("</figure>").next().unwrap())
}

/// A list of numbers of the animation.
fn list(animation: &str, name: &str) -> Vec<f64> {
    let rest = animation.split_once(&format!("\"{name}\":[")).unwrap_or_else(|| panic!("{name}")).1;
    rest.split(']').next().unwrap().split(',').map(|number| number.parse().unwrap()).collect()
}

fn alone(series: Series) -> SceneReport {
    SceneReport { exact_path: None, ..scene("coast", vec![series]) }
}

#[test]
fn a_straight_line_stands_for_the_nodes_left_out() {
    let series = circle("dla", 700);
    let (page, pictures) = written(&report(vec![alone(series.clone())]));
    let animation = animation(&page).unwrap();
    let [t, x, y, heading] = ["t", "x", "y", "heading"].map(|name| list(animation, name));
    assert!(t.len() > 20 && t.len() < 400, "{}", t.len());
    assert!([x.len(), y.len(), heading.len()].iter().all(|length| *length == t.len()));
    // Pixels of the drawing to a metre, from the circle of two metres.
    let extent = |values: &[f64]| {
        let fold = |worst: f64, pick: fn(f64, f64) -> f64| values.iter().copied().fold(worst, pick);
        fold(f64::MIN, f64::max) - fold(f64::MAX, f64::min)
    };
    let metre = extent(&x) / 2.0;
    for (k, time) in series.time.iter().enumerate() {
        let hi = t.partition_point(|node| node < time).clamp(1, t.len() - 1);
        let share = (time - t[hi - 1]) / (t[hi] - t[hi - 1]);
        let at = |values: &[f64]| values[hi - 1] + share * (values[hi] - values[hi - 1]);
        // A quarter of a unit of the picture, ten of the drawing, and what rounding adds at both ends.
        assert_abs_diff_eq!(at(&x) - x[0], metre * series.path[k][0], epsilon = 2.5 + 2.0 + 0.01 * metre);
        assert_abs_diff_eq!(y[0] - at(&y), metre * series.path[k][1], epsilon = 2.5 + 2.0 + 0.01 * metre);
        assert_abs_diff_eq!(at(&heading), series.heading[k].to_degrees(), epsilon = 0.5 + 0.1);
    }
    assert!(pictures.iter().all(|(_, picture)| !picture.contains("class=\"sleigh\"")));
}

#[test]
fn its_drawing_is_well_formed_and_shows_the_sleigh_at_the_start() {
    let (page, _) = written(&report(vec![alone(circle("dla", 700))]));
    let animation = animation(&page).unwrap();
    let drawing = &animation[animation.find("<svg").unwrap()..animation.rfind("</svg>").unwrap() + 6];
    let document = roxmltree::Document::parse(drawing).unwrap();
    let classed = |class: &str| document.descendants().find(|node| node.attribute("class") == Some(class));
    let transform = classed("sleigh").unwrap().attribute("transform").unwrap();
    assert!(transform.starts_with("translate(") && transform.ends_with("rotate(-0.00)"), "{transform}");
    assert_eq!(classed("trail").unwrap().attribute("points").unwrap().split(' ').count(), 1);
    assert!(classed("body").is_some() && classed("rotor").is_none());
    // What only a script makes work is hidden where there is none.
    assert!(animation.contains("<div class=\"controls\" hidden>"));
}

#[test]
fn a_rotor_turns_where_there_is_one() {
    let mut series = circle("dla", 100);
    series.rotor = series.time.iter().map(|t| 3.0 * t).collect();
    let (page, _) = written(&report(vec![alone(series)]));
    let animation = animation(&page).unwrap();
    assert!(animation.contains("class=\"rotor\"") && animation.contains("The wheel on the sleigh is the rotor"));
    let (t, rotor) = (list(animation, "t"), list(animation, "rotor"));
    assert_abs_diff_eq!(*rotor.last().unwrap(), (3.0 * t.last().unwrap()).to_degrees(), epsilon = 0.1);
}

#[test]
fn nothing_that_could_move_is_no_animation() {
    check_still(vec![alone(circle("one", 1))]);
}

#[test]
#[ignore = "slow"]
fn nothing_that_could_move_is_no_animation_in_full() {
    let series = [circle("none", 0), circle("one", 1), constant([f64::NAN; 2], 0.0, 0.0)];
    check_still(series.map(alone).into_iter().chain([scene("empty", vec![])]).collect());
}

fn check_still(scenes: Vec<SceneReport>) {
    for still in scenes {
        assert!(animation(&written(&report(vec![still])).0).is_none());
    }
    // A sleigh at rest is one: its time goes on.
    assert!(animation(&written(&report(vec![alone(constant([1.0, 2.0], 0.5, 0.0))])).0).is_some());
}

#[test]
fn a_long_run_is_a_small_animation() {
    let (page, _) = written(&report(vec![alone(circle("dla", 1001))]));
    // Eighteen scenes together stay below half a megabyte.
    assert!(animation(&page).unwrap().len() < 28_000, "{}", animation(&page).unwrap().len());
}

#[test]
fn the_blades_behind_move_with_it() {
    let alone_page = written(&report(vec![alone(circle("dla", 200))])).0;
    assert!(!alone_page.contains("class=\"follower\"") && !animation(&alone_page).unwrap().contains("followers"));
    let lead = circle("dla", 200);
    // Each a metre behind the one before, as it is.
    let behind = |k: usize| {
        let blades = lead.path.iter().zip(&lead.heading);
        blades.map(|([x, y], heading)| [x - k as f64, *y, *heading]).collect::<Vec<_>>()
    };
    let train = Series { followers: vec![behind(1), behind(2)], ..lead.clone() };
    let (page, _) = written(&report(vec![alone(train)]));
    let animation = animation(&page).unwrap();
    assert_eq!(animation.matches("class=\"follower\"").count(), 2);
    assert_eq!(animation.matches("class=\"bars\"").count(), 1);
    let followers = animation.split_once("\"followers\":[").unwrap().1;
    let (x, second) = (list(animation, "x"), list(followers, "x"));
    assert_eq!(x.len(), second.len());
    let gap = x[0] - second[0];
    assert!(gap > 10.0 && x.iter().zip(&second).all(|(lead, behind)| (lead - behind - gap).abs() <= 2.0));
}
