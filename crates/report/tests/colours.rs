//! The colours of lines: whether they stand out, and can be told apart by a colour-blind eye.

use crate::common::{circle, report, scene, written};
use std::collections::BTreeSet;

/// Red, green and blue as light, from 0 to 1 (IEC 61966-2-1).
fn light(colour: &str) -> [f64; 3] {
    [1, 3, 5].map(|at| {
        let value = f64::from(u8::from_str_radix(&colour[at..at + 2], 16).unwrap()) / 255.0;
        if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    })
}

fn product(matrix: &[[f64; 3]; 3], vector: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| (0..3).map(|k| row[k] * vector[k]).sum::<f64>())
}

/// Contrast of two colours (Web Content Accessibility Guidelines 2.2).
fn contrast(a: &str, b: &str) -> f64 {
    let [a, b] = [a, b].map(|colour| 0.05 + product(&[[0.2126, 0.7152, 0.0722]; 3], light(colour))[0]);
    f64::max(a / b, b / a)
}

/// What an eye without the long or the middle cones sees (Machado, Oliveira and Fernandes 2009, table 1).
const BLIND: [[[f64; 3]; 3]; 2] = [
    [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
];

/// The colour in CIELAB, where distances are what an eye sees.
fn lab(light: [f64; 3]) -> [f64; 3] {
    let xyz = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];
    let [x, y, z] = product(&xyz, light.map(|part| part.clamp(0.0, 1.0)));
    let root = |t: f64| if t > 0.008856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
    let [x, y, z] = [root(x / 0.9505), root(y), root(z / 1.089)];
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The nearest two of some colours to an eye that lacks a kind of cones.
fn nearest(colours: &[String]) -> f64 {
    let mut least = f64::INFINITY;
    for blind in &BLIND {
        let seen: Vec<[f64; 3]> = colours.iter().map(|colour| lab(product(blind, light(colour)))).collect();
        for (k, a) in seen.iter().enumerate() {
            let apart = |b: &[f64; 3]| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
            least = seen[..k].iter().map(apart).fold(least, f64::min);
        }
    }
    least
}

#[test]
fn lines_stand_out_on_both_grounds_and_differ_to_colour_blind_eyes() {
    let seven = (0..7).map(|k| circle(&format!("method {k}"), 20)).collect();
    let (page, _) = written(&report(vec![scene("coast", seven)]));
    // What the keys of the table are drawn with, and what the style puts in their places.
    let keys: BTreeSet<&str> = page
        .split("class=\"key\"")
        .skip(1)
        .map(|key| key.split("stroke=\"").nth(1).unwrap().split('"').next().unwrap())
        .collect();
    let [mut on_light, mut on_dark] = [vec!["#1d2329".to_owned()], vec!["#dfe4e8".to_owned()]];
    for colour in keys.into_iter().filter(|colour| *colour != "currentColor") {
        for what in ["stroke", "fill"] {
            let start = format!("[{what}=\"{colour}\"] {{ {what}: light-dark({colour}, ");
            let rule = page.split(&start).nth(1).unwrap_or_else(|| panic!("no rule {start}"));
            on_dark.push(rule[..7].to_owned());
        }
        on_light.push(colour.to_owned());
    }
    on_dark.dedup();
    for (colours, ground) in [(on_light, "#ffffff"), (on_dark, "#161b20")] {
        assert!(page.contains(ground) && colours.len() == 7, "{colours:?}");
        // 3 is what the guidelines ask of lines.
        assert!(colours.iter().all(|colour| contrast(colour, ground) >= 3.0), "{colours:?} on {ground}");
        // As far apart as the colours of Okabe and Ito, whose nearest two are 17.9 apart; what the eye can just tell is 2.3.
        assert!(nearest(&colours) > 15.0, "{colours:?}: {}", nearest(&colours));
    }
    // Red and green of the same lightness are what cannot be told apart.
    assert!(nearest(&["#b85c00".to_owned(), "#7d7d00".to_owned()]) < 10.0);
}
