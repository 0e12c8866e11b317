use crate::With;

/// Something whose dependence on time may jump: a control from a table, a path with corners.
///
/// A step across a jump has no order. So a run is cut at the jumps and each part made with the [`piece`](Self::piece) that
/// holds there, which is smooth and has no hidden state: a method may evaluate it at both ends of the part.
pub trait Piecewise: Sized {
    /// The times of the jumps in the open interval from `from` to `to` (s), in any order.
    #[must_use]
    fn jumps(&self, _from: f64, _to: f64) -> Vec<f64> {
        Vec::new()
    }

    /// The smooth piece that holds at the time `t` (s), continued to all times.
    #[must_use]
    fn piece(&self, t: f64) -> Self;
}

/// Rounds `steps`, the time of a jump in steps from the start of a run, to a whole number. Returns `None` if the jump falls inside a step.
///
/// Times and steps are rounded decimals, which shows after some 1e6 steps.
#[must_use]
pub fn whole_steps(steps: f64) -> Option<f64> {
    let nearest = steps.round();
    let on_node = (steps - nearest).abs() <= f64::max(1e-9, 8.0 * f64::EPSILON * nearest.abs());
    on_node.then_some(nearest)
}

impl Piecewise for () {
    fn piece(&self, _t: f64) -> Self {}
}

impl<P: Piecewise> Piecewise for Vec<P> {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        self.iter().flat_map(|part| part.jumps(from, to)).collect()
    }
    fn piece(&self, t: f64) -> Self {
        self.iter().map(|part| part.piece(t)).collect()
    }
}

impl<P: Piecewise> Piecewise for Option<P> {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        self.iter().flat_map(|part| part.jumps(from, to)).collect()
    }
    fn piece(&self, t: f64) -> Self {
        self.as_ref().map(|part| part.piece(t))
    }
}

impl<P: Piecewise, const K: usize> Piecewise for [P; K] {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        self.iter().flat_map(|part| part.jumps(from, to)).collect()
    }
    fn piece(&self, t: f64) -> Self {
        std::array::from_fn(|k| self[k].piece(t))
    }
}

impl<A: Piecewise, B: Piecewise> Piecewise for (A, B) {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        [self.0.jumps(from, to), self.1.jumps(from, to)].concat()
    }
    fn piece(&self, t: f64) -> Self {
        (self.0.piece(t), self.1.piece(t))
    }
}

impl<B: Piecewise, E: Piecewise> Piecewise for With<B, E> {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        [self.body.jumps(from, to), self.effects.jumps(from, to)].concat()
    }
    fn piece(&self, t: f64) -> Self {
        Self { body: self.body.piece(t), effects: self.effects.piece(t) }
    }
}
