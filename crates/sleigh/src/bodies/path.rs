use crate::SleighError;
use crate::error::{finite, positive};
use crate::planimeter::{Holonomy, Leg, of_legs};
use lagrangian::{Piecewise, Scalar};
use serde::Serialize;
use std::f64::consts::TAU;

/// A closed path that a point runs once in every period, at constant speed: a circle, or a polygon.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClosedPath {
    #[serde(flatten)]
    shape: PathShape,
    period: f64,
}

/// The shape of a closed path.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PathShape {
    /// A circle, counterclockwise from `center + (radius, 0)`.
    Circle {
        /// Radius (m).
        radius: f64,
        /// Middle (m).
        center: [f64; 2],
    },
    /// A polygon, from its first vertex.
    Polygon(Polygon),
}

/// A polygon that a point runs along.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Polygon {
    vertices: Vec<[f64; 2]>,
    /// When each edge begins, as a fraction of the period; one more entry for the end.
    #[serde(skip)]
    begins: Vec<f64>,
    /// The edge on which the point is.
    #[serde(skip)]
    current: usize,
}

impl Polygon {
    /// The vertices (m), in their order.
    #[must_use]
    pub fn vertices(&self) -> &[[f64; 2]] {
        &self.vertices
    }
}

impl ClosedPath {
    /// The circle about `center` (m), counterclockwise from `center + (radius, 0)` for a positive radius (m) and period (s).
    ///
    /// # Errors
    /// [`SleighError`] names the quantity that is not finite, or the radius or period that is not positive.
    pub fn circle(radius: f64, center: [f64; 2], period: f64) -> Result<Self, SleighError> {
        positive("radius", radius)?;
        positive("period", period)?;
        finite("center", center)?;
        Ok(Self { shape: PathShape::Circle { radius, center }, period })
    }

    /// The polygon with these vertices (m), in their order and back to the first.
    ///
    /// # Errors
    /// [`SleighError`] where there are fewer than two vertices, neighbours coincide, a number is not finite, or the period
    /// is not positive.
    pub fn polygon(vertices: Vec<[f64; 2]>, period: f64) -> Result<Self, SleighError> {
        positive("period", period)?;
        let fail = |problem: &str| Err(SleighError::Path { problem: problem.to_owned() });
        if vertices.len() < 2 {
            return fail("a polygon has at least two vertices");
        }
        for vertex in &vertices {
            finite("polygon", *vertex)?;
        }
        let mut begins = vec![0.0];
        let mut length = 0.0;
        for (k, from) in vertices.iter().enumerate() {
            let to = vertices[(k + 1) % vertices.len()];
            let edge = f64::hypot(to[0] - from[0], to[1] - from[1]);
            if edge == 0.0 {
                return fail("two neighbouring vertices of the polygon coincide");
            }
            length += edge;
            begins.push(length);
        }
        finite("the length of the polygon", [length])?;
        for begin in &mut begins {
            *begin /= length;
        }
        Ok(Self { shape: PathShape::Polygon(Polygon { vertices, begins, current: 0 }), period })
    }

    /// Where the path begins at `t = 0` (m).
    #[must_use]
    pub fn start(&self) -> [f64; 2] {
        match &self.shape {
            PathShape::Circle { radius, center } => [center[0] + radius, center[1]],
            PathShape::Polygon(Polygon { vertices, .. }) => vertices[0],
        }
    }

    /// What is run through.
    #[must_use]
    pub fn shape(&self) -> &PathShape {
        &self.shape
    }

    /// The path with all lengths of its shape times a factor; a circle keeps its middle.
    ///
    /// # Errors
    /// As [`circle`](Self::circle) and [`polygon`](Self::polygon).
    pub fn scaled(&self, factor: f64) -> Result<Self, SleighError> {
        match &self.shape {
            PathShape::Circle { radius, center } => Self::circle(radius * factor, *center, self.period),
            PathShape::Polygon(Polygon { vertices, .. }) => {
                Self::polygon(vertices.iter().map(|vertex| vertex.map(|x| x * factor)).collect(), self.period)
            }
        }
    }

    /// The period (s).
    #[must_use]
    pub fn period(&self) -> f64 {
        self.period
    }

    /// The area inside, positive counterclockwise (m^2).
    #[must_use]
    pub fn area(&self) -> f64 {
        match &self.shape {
            PathShape::Circle { radius, .. } => 0.5 * TAU * radius * radius,
            PathShape::Polygon(Polygon { vertices, .. }) => {
                let twice = |k: usize| {
                    let (a, b) = (vertices[k], vertices[(k + 1) % vertices.len()]);
                    a[0] * b[1] - b[0] * a[1]
                };
                0.5 * (0..vertices.len()).map(twice).sum::<f64>()
            }
        }
    }

    /// The straight segments and arcs of one round.
    #[must_use]
    pub fn legs(&self) -> Vec<Leg> {
        match &self.shape {
            PathShape::Circle { radius, .. } => vec![Leg::Arc { radius: *radius, from: 0.0, by: TAU }],
            PathShape::Polygon(Polygon { vertices, .. }) => {
                let next = |k: usize| vertices[(k + 1) % vertices.len()];
                let edges = vertices.iter().enumerate();
                edges.map(|(k, from)| Leg::Segment([next(k)[0] - from[0], next(k)[1] - from[1]])).collect()
            }
        }
    }

    /// What one round does to the heading of a blade that a tracer leads along the path, `a` (m) ahead of it: exact.
    ///
    /// # Errors
    /// [`SleighError`] where `a` is zero.
    pub fn holonomy(&self, a: f64) -> Result<Holonomy, SleighError> {
        of_legs(&self.legs(), a)
    }

    /// The velocity along the path at the time `t` (m/s).
    #[inline(always)]
    pub fn velocity<S: Scalar>(&self, t: S) -> [S; 2] {
        match &self.shape {
            PathShape::Circle { radius, .. } => {
                let rate = TAU / self.period;
                let (sin, cos) = (t * rate).sin_cos();
                [sin * (-radius * rate), cos * (radius * rate)]
            }
            PathShape::Polygon(Polygon { vertices, begins, current }) => {
                let (from, to) = (vertices[*current], vertices[(current + 1) % vertices.len()]);
                let time = (begins[current + 1] - begins[*current]) * self.period;
                [0, 1].map(|i| S::constant((to[i] - from[i]) / time))
            }
        }
    }
}

impl Piecewise for ClosedPath {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        let PathShape::Polygon(Polygon { begins, .. }) = &self.shape else {
            return Vec::new();
        };
        let (first, last) = ((from / self.period).floor(), (to / self.period).ceil());
        let mut jumps = Vec::new();
        let mut round = first;
        while round < last {
            jumps.extend(begins[1..].iter().map(|begin| (round + begin) * self.period));
            round += 1.0;
        }
        jumps.retain(|t| from < *t && *t < to);
        jumps
    }

    fn piece(&self, t: f64) -> Self {
        let mut piece = self.clone();
        if let PathShape::Polygon(Polygon { begins, current, vertices }) = &mut piece.shape {
            let fraction = (t / self.period).rem_euclid(1.0);
            let begun = begins.partition_point(|begin| *begin <= fraction);
            *current = begun.saturating_sub(1).min(vertices.len() - 1);
        }
        piece
    }
}
