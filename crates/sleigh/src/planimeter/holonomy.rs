use super::Moebius;
use super::moebius::wrapped;
use crate::SleighError;
use crate::error::finite;
use std::f64::consts::TAU;

/// A part of a path of the tracer (m, rad).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Leg {
    /// Straight by so much.
    Segment([f64; 2]),
    /// On a circle.
    Arc {
        /// Its radius (m).
        radius: f64,
        /// The angle of the tracer about the middle at the beginning (rad).
        from: f64,
        /// The angle that it runs, counterclockwise where positive (rad).
        by: f64,
    },
}

/// What one round of a closed path does to every heading.
///
/// The headings are lifted from the circle to the line, full turns counted.
#[derive(Debug, Clone, PartialEq)]
pub struct Holonomy {
    map: Moebius,
    /// The maps of pieces too short to turn a blade by half a turn, in their order.
    pieces: Vec<Moebius>,
}

/// A blade turns by less than its tracer moves, over `a`: a piece of at most this many `a` by less than half a turn.
const PIECE: f64 = 3.0;

/// The holonomy of a path of straight segments and arcs, the tracer `a` (m) ahead of the blade.
///
/// # Errors
/// [`SleighError`] where `a` is zero, or a number is not finite.
pub fn of_legs(legs: &[Leg], a: f64) -> Result<Holonomy, SleighError> {
    offset(a)?;
    let mut pieces = Vec::new();
    for leg in legs {
        match *leg {
            Leg::Segment([x, y]) => {
                finite("segment", [x, y])?;
                let parts = parts(x.hypot(y) / a)?;
                pieces.extend((0..parts).map(|_| Moebius::segment([x / f64::from(parts), y / f64::from(parts)], a)));
            }
            Leg::Arc { radius, from, by } => {
                finite("arc", [radius, from, by])?;
                let parts = parts(radius * by / a)?;
                let each = by / f64::from(parts);
                pieces.extend((0..parts).map(|k| Moebius::arc(radius / a, from + f64::from(k) * each, each)));
            }
        }
    }
    Ok(Holonomy::of(pieces))
}

/// The holonomy of any path, given by the velocity of its tracer (m/s) over a period (s), in `pieces` pieces of equal time.
///
/// `tan(theta/2)` goes through `w' = B(t) w` in homogeneous coordinates, `B = [[-x', y'], [y', x']] / (2 a)`; each piece is the
/// exponential of Magnus' series, of order four, and so a Moebius map itself. (Iserles and Norsett 1999, Philos. Trans. R.
/// Soc. A 357, 983-1019, section 5.) The velocity must be smooth within every piece.
///
/// # Errors
/// [`SleighError`] where `a` is zero, or the tracer moves farther than `3 a` in a piece.
pub fn of_curve(velocity: impl Fn(f64) -> [f64; 2], period: f64, pieces: u32, a: f64) -> Result<Holonomy, SleighError> {
    offset(a)?;
    let h = period / f64::from(pieces.max(1));
    // The two Gauss points, in fractions of a piece.
    let shift = 3.0_f64.sqrt() / 6.0;
    let mut maps = Vec::new();
    for k in 0..pieces {
        let middle = (f64::from(k) + 0.5) * h;
        let [x1, y1] = finite("the tracer's velocity", velocity(middle - shift * h))?;
        let [x2, y2] = finite("the tracer's velocity", velocity(middle + shift * h))?;
        if parts(h * f64::max(x1.hypot(y1), x2.hypot(y2)) / a)? > 1 {
            let problem = format!("piece {k} of {pieces} is longer than {PIECE} times the offset: take more pieces");
            return Err(SleighError::Path { problem });
        }
        // h (B1 + B2)/2 - sqrt(3)/12 h^2 [B1, B2], in the coordinates of `Moebius::exp`.
        let mean = 0.25 * h / a;
        let turned = 0.5 * shift * h * h * (x1 * y2 - y1 * x2) / (2.0 * a * a);
        maps.push(Moebius::exp([-mean * (x1 + x2), mean * (y1 + y2), turned]));
    }
    Ok(Holonomy::of(maps))
}

impl Holonomy {
    fn of(pieces: Vec<Moebius>) -> Self {
        let map = pieces.iter().fold(Moebius::IDENTITY, |map, piece| *piece * map);
        Self { map, pieces }
    }

    /// The map of the circle of headings.
    #[must_use]
    pub fn map(&self) -> Moebius {
        self.map
    }

    /// By how much one round turns a blade that begins with this heading, full turns included (rad).
    #[must_use]
    pub fn turn(&self, heading: f64) -> f64 {
        // Heading and turn apart: the turn keeps the digits that their sum would lose.
        let mut turn = 0.0;
        for piece in &self.pieces {
            turn += piece.change(heading + turn);
        }
        turn
    }

    /// The mean turn of many rounds (rad a round): the same for every heading, by Poincare's theorem.
    ///
    /// Where headings are fixed it is a number of full turns; else the angle of the rotation that the map is, whose full turns
    /// a few rounds tell, since the sum of `n` rounds is within a turn of `n` times the mean.
    #[must_use]
    pub fn mean_turn(&self) -> f64 {
        let Some(angle) = self.map.rotation() else {
            let fixed = self.map.fixed_headings().first().copied().unwrap_or(0.0);
            return (self.turn(fixed) / TAU).round() * TAU;
        };
        const ROUNDS: u32 = 8;
        let sum = (0..ROUNDS).fold(0.0, |sum, _| sum + self.turn(wrapped(sum)));
        let rough = sum / f64::from(ROUNDS);
        angle + ((rough - angle) / TAU).round() * TAU
    }
}

fn offset(a: f64) -> Result<(), SleighError> {
    finite("offset", [a])?;
    if a == 0.0 {
        let problem = "with the centre of mass at the blade (offset 0) a tracer cannot be led sideways".to_owned();
        return Err(SleighError::Path { problem });
    }
    Ok(())
}

/// How many pieces a length, in units of `a`, is cut into.
fn parts(length: f64) -> Result<u32, SleighError> {
    let parts = (length.abs() / PIECE).ceil().max(1.0);
    if parts > 1e6 {
        let problem = format!("the path is {length} times as long as the offset; at most a million times is accepted");
        return Err(SleighError::Path { problem });
    }
    Ok(parts as u32)
}
