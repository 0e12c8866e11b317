//! The PNG files, read back pixel by pixel.

use crate::common::{circle, put, report, scene, size};
use miniz_oxide::inflate::decompress_to_vec_zlib;
use std::fs;

/// The pixels of a PNG file whose rows are differences from the ones above.
fn pixels(png: &[u8]) -> (usize, Vec<[u8; 3]>) {
    let (mut at, mut data) = (8, Vec::new());
    while at < png.len() {
        let length = u32::from_be_bytes(png[at..at + 4].try_into().unwrap()) as usize;
        let (body, checksum) = (&png[at + 4..at + 8 + length], &png[at + 8 + length..at + 12 + length]);
        assert_eq!(crc32fast::hash(body).to_be_bytes(), checksum);
        if body.starts_with(b"IDAT") {
            data.extend(&body[4..]);
        }
        at += 12 + length;
    }
    let [width, height] = size(png).map(|length| length as usize);
    let rows = decompress_to_vec_zlib(&data).unwrap();
    assert_eq!(rows.len(), (3 * width + 1) * height);
    let mut above = vec![0_u8; 3 * width];
    let mut colours = Vec::new();
    for row in rows.chunks_exact(3 * width + 1) {
        assert_eq!(row[0], 2);
        above.iter_mut().zip(&row[1..]).for_each(|(above, difference)| *above = above.wrapping_add(*difference));
        colours.extend(above.chunks_exact(3).map(|colour| <[u8; 3]>::try_from(colour).unwrap()));
    }
    (width, colours)
}

#[test]
fn a_png_shows_lines_in_their_colours_and_letters_without_a_font_of_the_machine() {
    let parent = tempfile::tempdir().unwrap();
    let coast = scene("coast", vec![circle("dla", 700), circle("rk4", 700)]);
    let files = put(&report(vec![coast]), &parent.path().join("out"));
    let path = files.iter().find(|file| file.ends_with("coast-path.png")).unwrap();
    let (width, colours) = pixels(&fs::read(path).unwrap());
    let count = |rows: std::ops::Range<usize>, wanted: [u8; 3]| {
        let rows = rows.start * width..(rows.end * width).min(colours.len());
        colours[rows].iter().filter(|colour| **colour == wanted).count()
    };
    let height = colours.len() / width;
    assert_eq!(colours[0], [255; 3]);
    // The line of the first method, some two and a half units wide and a circle of 200 or more across.
    assert!(count(0..height, [0x00, 0x5b, 0x96]) > 1000);
    assert!(count(0..height, [0xb0, 0x44, 0x00]) > 300);
    // Nothing but figures and a name is below the axis: letters are made of whole pixels of the colour of text, too.
    let below = colours[(height - 70) * width..].iter();
    let dark = below.filter(|colour| colour[0] < 0x1d + 40).count();
    assert!(dark > 100, "{dark}");
}

#[test]
fn the_same_report_is_the_same_bytes() {
    let parent = tempfile::tempdir().unwrap();
    let coast = || report(vec![scene("coast", vec![circle("dla", 100)])]);
    let [one, other] = ["one", "other"].map(|name| put(&coast(), &parent.path().join(name)));
    for (one, other) in one.iter().zip(&other) {
        assert_eq!(fs::read(one).unwrap(), fs::read(other).unwrap(), "{}", one.display());
    }
}
