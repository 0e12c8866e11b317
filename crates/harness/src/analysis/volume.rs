/// Allowed error of every sum, relative to the sum of the sizes of all its terms: rounding of the derivatives and of the places between
/// nodes is far below, and an exponent with this error is accurate enough.
const RESOLVED: f64 = 1e-3;
/// Largest allowed error of a method of low order, besides.
const COARSE: f64 = 0.05;

/// The change of a volume of starts by the steps of a run, in two ways: by the determinants of their derivatives, and by the divergence of
/// the equations along them (Liouville). The two are one number.
///
/// They may differ by three errors: of the method, about `(h Omega)^p/12` of the rates `Omega` at which the steps stretch (the midpoint
/// rule has that coefficient); of the trapezoidal rule for the integral, estimated by the same rule with twice the step; and by a
/// thousandth.
#[derive(Debug)]
pub(super) struct Volume {
    order: i32,
    steps: u64,
    time: f64,
    by_steps: f64,
    by_flow: f64,
    /// The same integral with twice the step, and the beginning of its last step: length so far and divergence there.
    by_pairs: f64,
    pair: Option<(f64, f64)>,
    /// The largest difference of the two integrals.
    quadrature: f64,
    /// The sum of the sizes of all that is summed.
    traffic: f64,
}

/// Two sums of all exponents that are not the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Apart {
    /// The sums by the steps and by the equations, and their allowed difference (1/s).
    pub(super) sums: [f64; 2],
    pub(super) allowed: f64,
}

impl Volume {
    /// For steps of a method of the order `order`.
    pub(super) fn new(order: u32) -> Self {
        Self {
            order: order.try_into().unwrap_or(i32::MAX),
            steps: 0,
            time: 0.0,
            by_steps: 0.0,
            by_flow: 0.0,
            by_pairs: 0.0,
            pair: None,
            quadrature: 0.0,
            traffic: 0.0,
        }
    }

    /// Adds a step of length `h` (s), with the logarithms of the factors by which it stretches a frame, the logarithm of its determinant,
    /// and the divergence at its ends (1/s). Every second step tells whether the two sums still agree.
    pub(super) fn add(
        &mut self,
        h: f64,
        logs: &[f64],
        determinant: f64,
        [before, after]: [f64; 2],
    ) -> Option<Result<(), Apart>> {
        let step = 0.5 * h * (before + after);
        self.steps += 1;
        self.time += h;
        self.by_steps += determinant;
        self.by_flow += step;
        self.traffic += step.abs() + logs.iter().map(|log| log.abs()).sum::<f64>();
        let Some((first, start)) = self.pair.take() else {
            self.pair = Some((h, before));
            return None;
        };
        self.by_pairs += 0.5 * (first + h) * (start + after);
        self.quadrature = self.quadrature.max((self.by_pairs - self.by_flow).abs());
        let allowed = self.allowed(h);
        // Not a number is no agreement.
        if (self.by_steps - self.by_flow).abs() <= allowed {
            return Some(Ok(()));
        }
        let sums = [self.by_steps / self.time, self.by_flow / self.time];
        Some(Err(Apart { sums, allowed: allowed / self.time }))
    }

    fn allowed(&self, h: f64) -> f64 {
        let method = ((h * self.traffic / self.time).powi(self.order) / 12.0).min(COARSE);
        let rounding = 8.0 * f64::EPSILON * self.steps as f64;
        (RESOLVED + method) * self.traffic + self.quadrature + rounding
    }
}
