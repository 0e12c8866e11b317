use std::f64::consts::{PI, TAU};
use std::ops::Mul;

/// A Moebius map of the circle of headings, `tan(theta/2) -> (a tan(theta/2) + b) / (c tan(theta/2) + d)`: an element of
/// PSL(2, R).
///
/// It is held as a matrix `[[a, b], [c, d]]` of determinant one, which acts on `(sin(theta/2), cos(theta/2))`; the matrix and
/// its negative are the same map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moebius {
    matrix: [[f64; 2]; 2],
}

/// The three kinds of Moebius maps of the circle, by the trace of the matrix of determinant one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// `|trace| < 2`: no heading is fixed; in the right coordinate the map is a rotation.
    Elliptic,
    /// `|trace| = 2`: one heading is fixed; or all are.
    Parabolic,
    /// `|trace| > 2`: two headings are fixed, and one of them attracts all others.
    Hyperbolic,
}

impl Class {
    /// The name in results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Elliptic => "elliptic",
            Self::Parabolic => "parabolic",
            Self::Hyperbolic => "hyperbolic",
        }
    }
}

impl Moebius {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self { matrix: [[1.0, 0.0], [0.0, 1.0]] };
    /// A trace nearer to 2 than this, relative to the square of the matrix' size, is 2: products of some hundred matrices have
    /// such rounding.
    const ROUNDING: f64 = 1e-13;

    /// The turn by `angle` (rad).
    #[must_use]
    pub fn turn(angle: f64) -> Self {
        let (sin, cos) = (0.5 * angle).sin_cos();
        Self { matrix: [[cos, sin], [-sin, cos]] }
    }

    /// The exponential of the traceless matrix `[[x, y + z], [y - z, -x]]`, whose square is `x^2 + y^2 - z^2` times one.
    #[must_use]
    pub fn exp([x, y, z]: [f64; 3]) -> Self {
        let square = x * x + y * y - z * z;
        let s = square.abs().sqrt();
        // cosh s and sinh(s)/s, or cos s and sin(s)/s; in their series near zero.
        let (c, d) = if s < 1e-4 {
            (1.0 + 0.5 * square * (1.0 + square / 12.0), 1.0 + square / 6.0 * (1.0 + square / 20.0))
        } else if square > 0.0 {
            (s.cosh(), s.sinh() / s)
        } else {
            (s.cos(), s.sin() / s)
        };
        Self { matrix: [[c + d * x, d * (y + z)], [d * (y - z), c - d * x]] }
    }

    /// The map of a tracer that moves straight by `(dx, dy)` (m) with the blade `a` (m) behind it: a tractrix,
    /// `tan(phi/2) -> tan(phi/2) e^{-d/a}` for the angle `phi` from the direction of the segment.
    #[must_use]
    pub fn segment([dx, dy]: [f64; 2], a: f64) -> Self {
        Self::exp([-0.5 * dx / a, 0.5 * dy / a, 0.0])
    }

    /// The map of a tracer that runs an arc of the radius `r a` by the angle `phi` (rad), from the angle `from` on,
    /// counterclockwise for `phi > 0`.
    ///
    /// For `beta` the heading less the angle of the tracer, `beta' = r cos beta - 1` is autonomous:
    /// `tan(beta/2)` goes through `exp(phi/2 [[0, r - 1], [r + 1, 0]])`.
    #[must_use]
    pub fn arc(r: f64, from: f64, phi: f64) -> Self {
        Self::turn(from + phi) * Self::exp([0.0, 0.5 * phi * r, -0.5 * phi]) * Self::turn(-from)
    }

    /// The matrix, of determinant one.
    #[must_use]
    pub fn matrix(&self) -> [[f64; 2]; 2] {
        self.matrix
    }

    /// The trace of the matrix, not negative.
    #[must_use]
    pub fn trace(&self) -> f64 {
        (self.matrix[0][0] + self.matrix[1][1]).abs()
    }

    /// Where a heading goes, up to full turns: the change, between `-pi` and `pi` (rad).
    #[must_use]
    pub fn change(&self, heading: f64) -> f64 {
        let (sin, cos) = (0.5 * heading).sin_cos();
        let [[a, b], [c, d]] = self.matrix;
        // The image, turned back by the heading: exact also where nothing changes.
        let (s, c) = (a * sin + b * cos, c * sin + d * cos);
        let half = f64::atan2(s * cos - c * sin, c * cos + s * sin);
        wrapped(2.0 * half)
    }

    /// Elliptic, parabolic or hyperbolic.
    #[must_use]
    pub fn class(&self) -> Class {
        let size = self.matrix.iter().flatten().map(|x| x * x).sum::<f64>();
        let beyond = self.trace() - 2.0;
        if beyond.abs() <= Self::ROUNDING * size {
            Class::Parabolic
        } else if beyond < 0.0 {
            Class::Elliptic
        } else {
            Class::Hyperbolic
        }
    }

    /// The angle by which an elliptic map turns in its own coordinate, up to full turns, between 0 and `2 pi` (rad).
    pub(super) fn rotation(&self) -> Option<f64> {
        if self.class() != Class::Elliptic {
            return None;
        }
        let [[a, b], [c, d]] = self.matrix;
        // b - c has the sign of the sine in every conjugate, and the matrix may have either sign.
        let (sine, half_trace) = (b - c, 0.5 * (a + d));
        let half_trace = if sine < 0.0 { -half_trace } else { half_trace };
        Some(2.0 * half_trace.clamp(-1.0, 1.0).acos())
    }

    /// The headings that stay (rad, between `-pi` and `pi`): none, one or two, the attracting one first.
    ///
    /// The eigenvectors of the matrix are `(sin(theta/2), cos(theta/2))`.
    #[must_use]
    pub fn fixed_headings(&self) -> Vec<f64> {
        let [[a, b], [c, d]] = self.matrix;
        let half = 0.5 * (a + d);
        let root = match self.class() {
            Class::Elliptic => return Vec::new(),
            Class::Parabolic => 0.0,
            Class::Hyperbolic => (0.25 * (a - d) * (a - d) + b * c).max(0.0).sqrt(),
        };
        // The larger eigenvalue attracts.
        let heading = |eigenvalue: f64| {
            // Of the two rows of M - eigenvalue the larger one says the direction.
            let rows = [[a - eigenvalue, b], [c, d - eigenvalue]];
            let larger = usize::from(rows[1][0].hypot(rows[1][1]) > rows[0][0].hypot(rows[0][1]));
            let [x, y] = rows[larger];
            wrapped(2.0 * f64::atan2(-y, x))
        };
        let outer = half + root.copysign(half);
        if root > 0.0 { vec![heading(outer), heading(half - root.copysign(half))] } else { vec![heading(outer)] }
    }
}

/// First the right map, then the left one.
impl Mul for Moebius {
    type Output = Self;

    fn mul(self, first: Self) -> Self {
        let ([[a, b], [c, d]], [[e, f], [g, h]]) = (self.matrix, first.matrix);
        Self { matrix: [[a * e + b * g, a * f + b * h], [c * e + d * g, c * f + d * h]] }
    }
}

/// An angle within half a turn of zero (rad).
pub(crate) fn wrapped(angle: f64) -> f64 {
    let turned = angle.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}
