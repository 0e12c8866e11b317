/// A state of the sleigh in the words of a scene: position and heading of the blade, and the two admissible velocities.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SleighState {
    /// Position of the blade's contact point (m).
    pub x: f64,
    /// Position of the blade's contact point (m).
    pub y: f64,
    /// Heading `theta`, with its full turns (rad).
    pub heading: f64,
    /// Forward speed `u` of the blade (m/s).
    pub speed: f64,
    /// Turn rate `omega` (rad/s).
    pub turn_rate: f64,
}

impl SleighState {
    /// Coordinates `(x, y, theta)` and velocities `(u cos theta, u sin theta, omega)`.
    #[must_use]
    pub fn to_coordinates(&self) -> ([f64; 3], [f64; 3]) {
        let (sin, cos) = self.heading.sin_cos();
        ([self.x, self.y, self.heading], [self.speed * cos, self.speed * sin, self.turn_rate])
    }

    /// The state of the given coordinates and velocities; `speed` is the velocity's component along the blade.
    #[must_use]
    pub fn from_coordinates(q: &[f64; 3], v: &[f64; 3]) -> Self {
        let (sin, cos) = q[2].sin_cos();
        Self { x: q[0], y: q[1], heading: q[2], speed: v[0] * cos + v[1] * sin, turn_rate: v[2] }
    }
}
