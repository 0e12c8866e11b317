//! The charts of the analyses.

use crate::common::texts;
use report::{Cells, Chart, Layer, chart_svg};

/// Lines, dots and cells; values that are not finite, and empty lists, are drawn without a panic.
#[test]
fn charts_are_drawn() {
    let chart = |decades: [bool; 2], layers: Vec<Layer>| {
        let axes = ["time [s]".to_owned(), "so much [1/s]".to_owned()];
        chart_svg(&Chart { title: "A <chart>".to_owned(), axes, decades, layers })
    };
    let line = |points: Vec<[f64; 2]>| Layer::Curves { label: "one".to_owned(), curves: vec![points] };
    let cells = |values: Vec<Option<f64>>| {
        Layer::Cells(Cells { label: "value [1]".to_owned(), ranges: [[0.0, 2.0], [-1.0, 1.0]], columns: 2, values })
    };
    let odd = vec![[1.0, 2.0], [f64::NAN, 0.0], [10.0, f64::INFINITY], [-1.0, 3.0], [100.0, 2.5], [1000.0, 2.0]];
    let drawn = [
        chart([true, false], vec![line(odd.clone())]),
        chart([false; 2], vec![Layer::Dots(odd), Layer::Dots(vec![]), Layer::Dots(vec![[0.0; 2]])]),
        chart([false; 2], vec![cells(vec![Some(0.0), Some(0.5), None, Some(f64::NAN)])]),
        chart([false; 2], vec![cells(vec![])]),
        chart([true; 2], vec![]),
        chart([false, true], vec![line(vec![[0.0, 1e-300], [1.0, 0.0], [2.0, 1e-200], [3.0, 10.0]])]),
    ];
    for picture in &drawn {
        assert!(texts(picture).contains(&"so much [1/s]".to_owned()));
    }
    assert!(texts(&drawn[0]).contains(&"10²".to_owned()) && texts(&drawn[0]).contains(&"one".to_owned()));
    assert!(texts(&drawn[5]).contains(&"10⁻³⁰⁰".to_owned()) && !texts(&drawn[5]).contains(&"10⁻²⁹⁰".to_owned()));
    // Of the first dots three can be drawn; each is a line without length.
    assert_eq!(drawn[1].matches("h0").count(), 5);
    // Two cells have a value, of the first and of the last colour; sixteen colours are on the bar.
    assert_eq!(drawn[2].matches("V").count(), 4 + 32);
    assert_eq!(drawn[2].matches("<path").count(), 2 + 16);
    assert!(texts(&drawn[2]).contains(&"value [1]".to_owned()));
}
