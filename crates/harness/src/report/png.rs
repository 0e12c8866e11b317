//! The PNG file of some pixels (ISO/IEC 15948): eight bits a colour, each row as its difference from the one above.

use miniz_oxide::deflate::compress_to_vec_zlib;

/// How hard to compress: pictures are mostly ground, of which the lower levels make little already.
const LEVEL: u8 = 6;
/// The filter `Up`.
const UP: u8 = 2;

/// Inches in a metre.
const INCHES: f64 = 1.0 / 0.0254;

/// The file of an image given its width and height, the red, green and blue of its pixels, row by row, and the pixels to an inch.
pub(super) fn encode([width, height]: [u32; 2], colours: &[[u8; 3]], dpi: f64) -> Vec<u8> {
    let row = 3 * width as usize;
    let mut filtered = Vec::with_capacity((row + 1) * height as usize);
    let mut above = vec![0_u8; row];
    for line in colours.as_flattened().chunks_exact(row.max(1)) {
        filtered.push(UP);
        filtered.extend(line.iter().zip(&above).map(|(here, above)| here.wrapping_sub(*above)));
        above.copy_from_slice(line);
    }
    let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
    // Eight bits, colours without transparency, the one compression and the one set of filters there are, no interlacing.
    header.extend([8, 2, 0, 0, 0]);
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    chunk(&mut file, *b"IHDR", &header);
    // The resolution across and upwards, in pixels to the metre.
    let resolution = ((dpi * INCHES).round() as u32).to_be_bytes();
    chunk(&mut file, *b"pHYs", &[&resolution[..], &resolution, &[1]].concat());
    chunk(&mut file, *b"IDAT", &compress_to_vec_zlib(&filtered, LEVEL));
    chunk(&mut file, *b"IEND", &[]);
    file
}

/// A chunk: its length, its kind, its content, and a checksum of the latter two.
fn chunk(file: &mut Vec<u8>, kind: [u8; 4], content: &[u8]) {
    let mut checksum = crc32fast::Hasher::new();
    checksum.update(&kind);
    checksum.update(content);
    // A picture of a page is far from four thousand million bytes.
    file.extend((content.len() as u32).to_be_bytes());
    file.extend(kind);
    file.extend(content);
    file.extend(checksum.finalize().to_be_bytes());
}
