//! The closed paths of a tracer.

use approx::assert_relative_eq;
use lagrangian::{Dual, Piecewise, quadrature::gauss_legendre};
use sleigh::ClosedPath;
use std::f64::consts::PI;

/// A rectangle 2 m by 1 m in 6 s: corners at 2, 3, 5 and 6 s.
fn rectangle() -> ClosedPath {
    ClosedPath::polygon(vec![[1.0, -1.0], [3.0, -1.0], [3.0, 0.0], [1.0, 0.0]], 6.0).unwrap()
}

fn circle() -> ClosedPath {
    ClosedPath::circle(0.7, [0.1, 0.2], 5.0).unwrap()
}

/// Where the point is after the time from 0 to `end`, relative to its start, and the area swept about the start.
fn travelled(path: &ClosedPath, end: f64) -> ([f64; 2], f64) {
    let (nodes, weights) = gauss_legendre::<8>();
    let mut ends = path.jumps(0.0, end);
    // The circle needs pieces below a turn.
    ends.extend((1..8).map(|k| f64::from(k) * end / 8.0));
    ends.push(end);
    ends.sort_by(f64::total_cmp);
    let (mut at, mut area, mut t0) = ([0.0; 2], 0.0, 0.0);
    for t1 in ends {
        let (h, piece) = (t1 - t0, path.piece(0.5 * (t0 + t1)));
        let mut inner = [0.0; 2];
        for i in 0..8 {
            let v = piece.velocity(t0 + nodes[i] * h);
            // The place at the node, by the same rule over the part before it.
            let part = nodes[i] * h;
            let here: [f64; 2] = std::array::from_fn(|c| {
                at[c] + (0..8).map(|j| part * weights[j] * piece.velocity(t0 + nodes[j] * part)[c]).sum::<f64>()
            });
            area += 0.5 * h * weights[i] * (here[0] * v[1] - here[1] * v[0]);
            inner = [inner[0] + h * weights[i] * v[0], inner[1] + h * weights[i] * v[1]];
        }
        at = [at[0] + inner[0], at[1] + inner[1]];
        t0 = t1;
    }
    (at, area)
}

#[test]
fn they_close_and_enclose_their_area() {
    for (path, area) in [(rectangle(), 2.0), (circle(), PI * 0.49)] {
        let (end, swept) = travelled(&path, path.period());
        assert!(end.iter().all(|x| x.abs() < 1e-14), "{path:?} ends off by {end:?}");
        assert_relative_eq!(path.area(), area, max_relative = 1e-14);
        assert_relative_eq!(swept, area, max_relative = 1e-13);
        // The control: half a round is not closed.
        let (half, _) = travelled(&path, 0.5 * path.period());
        assert!(half[0].abs() > 1.0);
    }
    assert_relative_eq!(ClosedPath::polygon(vec![[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]], 1.0).unwrap().area(), -0.5);
    let to_and_fro = ClosedPath::polygon(vec![[0.0, 0.0], [3.0, 0.0]], 2.0).unwrap();
    assert_relative_eq!(to_and_fro.area(), 0.0);
    assert_relative_eq!(to_and_fro.piece(1.5).velocity(1.5)[0], -3.0);
}

#[test]
fn they_run_at_constant_speed() {
    for t in [0.1, 2.5, 4.9, 5.5, 11.0, -0.5, -3.5] {
        let v = rectangle().piece(t).velocity(t);
        assert_relative_eq!(v[0].hypot(v[1]), 1.0, max_relative = 1e-15);
        let v = circle().piece(t).velocity(t);
        assert_relative_eq!(v[0].hypot(v[1]), 2.0 * PI * 0.7 / 5.0, max_relative = 1e-15);
    }
    for (path, start) in [(rectangle(), [1.0, -1.0]), (circle(), [0.8, 0.2])] {
        assert!((0..2).all(|i| (path.start()[i] - start[i]).abs() < f64::EPSILON));
    }
    // The circle accelerates toward its middle, which is seen in its derivative.
    let v = circle().velocity(Dual::<f64, 1>::variable(0.0, 0));
    assert_relative_eq!(v[0].eps[0], -0.7 * (2.0 * PI / 5.0_f64).powi(2), max_relative = 1e-15);
    assert_relative_eq!(v[1].eps[0], 0.0);
}

#[test]
fn corners_are_jumps() {
    let path = rectangle();
    assert!(circle().jumps(-10.0, 100.0).is_empty());
    let near = |found: Vec<f64>, expected: &[f64]| {
        let mut found = found;
        found.sort_by(f64::total_cmp);
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (a, b) in found.iter().zip(expected) {
            assert_relative_eq!(a, b, max_relative = 4.0 * f64::EPSILON, epsilon = 1e-15);
        }
    };
    near(path.jumps(0.0, 6.0), &[2.0, 3.0, 5.0]);
    near(path.jumps(2.5, 9.5), &[3.0, 5.0, 6.0, 8.0, 9.0]);
    near(path.jumps(-4.5, 0.5), &[-4.0, -3.0, -1.0, 0.0]);
    near(path.jumps(3.1, 4.9), &[]);
    // Between two corners the direction is that of the edge.
    for (t, v) in [(1.0, [1.0, 0.0]), (2.5, [0.0, 1.0]), (4.0, [-1.0, 0.0]), (5.5, [0.0, -1.0]), (-0.5, [0.0, -1.0])] {
        let found = path.piece(t).velocity(t);
        assert_relative_eq!(found[0], v[0], epsilon = 1e-15);
        assert_relative_eq!(found[1], v[1], epsilon = 1e-15);
    }
}

/// Rounds shorter than a second, a corner at either end of the time asked for, and a time a rounding before a round.
#[test]
fn corners_at_the_edges() {
    let square = |period| ClosedPath::polygon(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], period).unwrap();
    assert_eq!(square(0.5).jumps(1.0, 2.0), [1.125, 1.25, 1.375, 1.5, 1.625, 1.75, 1.875]);
    assert_eq!(square(4.0).jumps(1.0, 3.0), [2.0]);
    assert_eq!(square(4.0).jumps(2.5, 8.0), [3.0, 4.0, 5.0, 6.0, 7.0]);
    // It counts as the last edge: `-1e-20` is a whole round after the one before.
    assert_eq!(square(4.0).piece(-1e-20).velocity(0.0), [0.0, -1.0]);
}
