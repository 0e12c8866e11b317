//! Sheets for papers: what stands where, in each format.

use crate::common::{check_numbers, size, texts};
use proptest::prelude::*;
use report::{FigureFormat, Panel, Paper, Sheet, sheet};
use roxmltree::Document;

const PAPER: Paper = Paper { size: [16.0, 9.0], dpi: 150.0 };

fn panel(axes: [&str; 2], curves: Vec<Vec<[f64; 2]>>) -> Panel {
    Panel { axes: axes.map(str::to_owned), curves, ..Panel::default() }
}

fn line(slope: f64) -> Vec<[f64; 2]> {
    (0..=100).map(|k| 0.1 * f64::from(k)).map(|t| [t, slope * t]).collect()
}

fn one(panels: Vec<Panel>) -> Sheet {
    Sheet { title: "A sheet; dla, step 0.1 s".to_owned(), runs: vec!["dla".to_owned()], panels }
}

fn svg(drawn: &Sheet) -> String {
    String::from_utf8(sheet(drawn, &PAPER, FigureFormat::Svg).unwrap()).unwrap()
}

/// The corners of the lines of a colour.
fn lines(picture: &str, colour: &str) -> Vec<Vec<[f64; 2]>> {
    let document = Document::parse(picture).unwrap();
    let drawn = document.descendants().filter(|node| node.attribute("stroke") == Some(colour));
    let points = |text: &str| {
        let pair = |pair: &str| pair.split_once(',').map(|(x, y)| [x, y].map(|x| x.parse().unwrap()));
        text.split_whitespace().filter_map(pair).collect()
    };
    drawn.filter_map(|node| node.attribute("points")).map(points).collect()
}

#[test]
fn axes_have_titles_and_the_figure_names_what_it_shows() {
    let picture =
        svg(&one(vec![panel(["t [s]", "speed [m/s]"], vec![line(0.5)]), panel(["t [s]", "turn"], vec![line(1.0)])]));
    let told = texts(&picture);
    for text in ["A sheet; dla, step 0.1 s", "t [s]", "speed [m/s]", "turn"] {
        assert!(told.iter().any(|told| told == text), "{text}: {told:?}");
    }
    // The upright titles are turned, the others are not.
    assert_eq!(picture.matches("rotate(270").count(), 2, "{picture}");
    // 16 cm and 9 cm, at 96 units to an inch; whatever the size of letters.
    let document = Document::parse(&picture).unwrap();
    let lengths =
        ["width", "height"].map(|name| document.root_element().attribute(name).unwrap().parse::<f64>().unwrap());
    assert_eq!(lengths.map(f64::round).map(|length| length as u32), [605, 340]);
}

/// A straight line stays one, and rises from left to right as its numbers do.
#[test]
fn a_line_is_drawn_where_its_numbers_are() {
    let picture = svg(&one(vec![panel(["t [s]", "x [m]"], vec![line(2.0)])]));
    let drawn = lines(&picture, "#005B96");
    let [first, .., last] = drawn[0][..] else { panic!("{drawn:?}") };
    assert!(last[0] > first[0] && last[1] < first[1], "{first:?} {last:?}");
    // Between the ticks 0 and 10 of the axis across lies all of it, and its middle is that of the numbers.
    for [x, y] in &drawn[0] {
        let share = (x - first[0]) / (last[0] - first[0]);
        // Two units of the drawing, a fifth of one of the picture, of rounding.
        assert!((first[1] + share * (last[1] - first[1]) - y).abs() < 2.0, "{drawn:?}");
    }
}

#[test]
fn a_path_is_as_long_upwards_as_across() {
    let square = vec![[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0], [0.0, 0.0]];
    let picture = svg(&one(vec![Panel { path: true, ..panel(["x [m]", "y [m]"], vec![square]) }]));
    let drawn = lines(&picture, "#005B96").concat();
    let extent = |axis: usize| {
        let all = || drawn.iter().map(|point| point[axis]);
        all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
    };
    assert!((extent(0) - extent(1)).abs() <= 2.0 && extent(0) > 100.0, "{} {}", extent(0), extent(1));
}

/// What is below the rounding of numbers near 1 lies on one line, and not in a barcode.
#[test]
fn sizes_below_rounding_lie_on_the_floor() {
    let noise: Vec<[f64; 2]> = (0..600).map(|k| [f64::from(k), if k % 2 == 0 { 0.0 } else { 5e-17 }]).collect();
    let growing = (0..600).map(|k| [f64::from(k), 1e-15 * f64::from(k)]).collect();
    let mut two = one(vec![Panel { decades: true, ..panel(["t [s]", "|A v|"], vec![noise, growing]) }]);
    two.runs.push("rk4".to_owned());
    let picture = svg(&two);
    assert!(texts(&picture).iter().any(|text| text == "10⁻¹⁶"), "{:?}", texts(&picture));
    let floor: Vec<f64> =
        lines(&picture, "#005B96").into_iter().filter(|line| line.len() > 1).flatten().map(|[_, y]| y).collect();
    // Of the sample in the legend and of the curve.
    let mut heights = floor.clone();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    assert_eq!(heights.len(), 2, "{heights:?}");
    assert!(texts(&picture).iter().any(|text| text == "rk4"));
}

#[test]
fn a_png_has_its_resolution_and_a_pdf_its_size() {
    let drawn = one(vec![panel(["t [s]", "x [m]"], vec![line(2.0)])]);
    let png = sheet(&drawn, &PAPER, FigureFormat::Png).unwrap();
    assert_eq!(size(&png), [945, 531]);
    let at = png.windows(4).position(|word| word == b"pHYs").unwrap() + 4;
    // 150 pixels to an inch.
    assert_eq!(u32::from_be_bytes(png[at..at + 4].try_into().unwrap()), 5906);
    let pdf = sheet(&drawn, &PAPER, FigureFormat::Pdf).unwrap();
    let text = String::from_utf8_lossy(&pdf);
    assert!(text.starts_with("%PDF-") && text.trim_end().ends_with("%%EOF"));
    let sides = text.split_once("/MediaBox [0 0 ").unwrap().1.split(']').next().unwrap();
    let sides: Vec<f64> = sides.split(' ').map(|side| side.parse().unwrap()).collect();
    for (side, length) in sides.iter().zip(PAPER.size) {
        assert!((side - length / 2.54 * 72.0).abs() < 0.01, "{sides:?}");
    }
    assert_eq!(pdf, sheet(&drawn, &PAPER, FigureFormat::Pdf).unwrap());
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -1e3..1e3, 1 => any::<f64>(), 1 => Just(0.0), 1 => Just(f64::NAN)]
}

/// A sheet of equal panels, and its width and height.
fn any_sheet() -> impl Strategy<Value = (Sheet, [f64; 2])> {
    let points = proptest::collection::vec((any_number(), any_number()), 0..40);
    let kind = (any::<bool>(), any::<bool>());
    (points, 0_usize..9, kind, (3.0..40.0, 3.0..40.0)).prop_map(|(points, panels, (decades, path), (width, height))| {
        let curve: Vec<[f64; 2]> = points.iter().map(|(t, x)| [*t, *x]).collect();
        let equal = Panel { decades: decades && !path, path, ..panel(["t [s]", "x [m]"], vec![curve]) };
        (one(vec![equal; panels]), [width, height])
    })
}

/// Whatever the numbers, the picture is well-formed and nothing lies outside.
fn check_sheet(drawn: &Sheet, size: [f64; 2]) -> Result<(), TestCaseError> {
    let paper = Paper { size, dpi: 40.0 };
    let text = String::from_utf8(sheet(drawn, &paper, FigureFormat::Svg).unwrap()).unwrap();
    check_numbers(&Document::parse(&text).unwrap());
    prop_assert!(sheet(drawn, &paper, FigureFormat::Png).is_ok() && sheet(drawn, &paper, FigureFormat::Pdf).is_ok());
    Ok(())
}

/// Figures of sixteen digits are wider than a paper of 3 cm.
#[test]
fn long_figures_push_no_curve_off_a_narrow_paper() {
    let far = panel(["t [s]", "x [m]"], vec![vec![[0.0, -183_848_980_633_521.66]]]);
    check_sheet(&one(vec![far]), [3.0, 30.58]).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn any_numbers_make_a_picture((drawn, size) in any_sheet()) {
        check_sheet(&drawn, size)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    #[ignore = "slow"]
    fn any_numbers_make_a_picture_at_length((drawn, size) in any_sheet()) {
        check_sheet(&drawn, size)?;
    }
}
