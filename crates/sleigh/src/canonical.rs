use crate::{Sleigh, SleighState};

impl Sleigh {
    /// One explicit step of length `h` (s) of the free sleigh that preserves its invariant measure `du domega / |omega|`, and with it
    /// `dx dy dtheta du domega / |omega|`, to round-off.
    ///
    /// With `s = ln |omega|` the reduced motion is Hamiltonian, `H = a/2 e^(2 s) + c/2 u^2` with `c = m a / J`:
    ///
    /// ```text
    /// u' = dH/ds = a omega^2,        s' = -dH/du = -c u.
    /// ```
    ///
    /// This is its leapfrog: half a step of `u`, a whole one of `s`, half a step of `u`. It is symmetric, of second order, and
    /// keeps the sign of `omega`. While `s` moves, `omega` decays exponentially and the blade runs its chord to second order, so
    /// that it does not slip. (The scheme: Hairer, Lubich and Wanner 2006, section I.1.4.)
    ///
    /// ```
    /// use sleigh::{Sleigh, SleighState};
    ///
    /// let sleigh = Sleigh::new(1.0, 1.0, 0.5)?;
    /// let mut state = SleighState { speed: -1.0, turn_rate: -1e-3, ..SleighState::default() };
    /// for _ in 0..2000 {
    ///     state = sleigh.canonical_step(0.05, &state);
    /// }
    /// assert!(state.speed > 0.99 && state.turn_rate < 0.0); // it has turned around
    /// # Ok::<(), sleigh::SleighError>(())
    /// ```
    #[must_use]
    pub fn canonical_step(&self, h: f64, state: &SleighState) -> SleighState {
        let (a, c) = (self.offset(), self.spin_gain());
        let kick = |u: f64, omega: f64| u + 0.5 * h * a * omega * omega;
        let u = kick(state.speed, state.turn_rate);
        let decay = h * c * u;
        let omega = state.turn_rate * (-decay).exp();

        // The integral of omega, and the chord of the arc.
        let turn = h * state.turn_rate * if decay == 0.0 { 1.0 } else { -(-decay).exp_m1() / decay };
        let half = 0.5 * turn;
        let chord = h * u * if half == 0.0 { 1.0 } else { half.sin() / half };
        let (sin, cos) = (state.heading + half).sin_cos();
        SleighState {
            x: state.x + chord * cos,
            y: state.y + chord * sin,
            heading: state.heading + turn,
            speed: kick(u, omega),
            turn_rate: omega,
        }
    }
}
