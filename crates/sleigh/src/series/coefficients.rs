use super::OwnAxes;
use lagrangian::simd::Four;

/// The highest power of time in the series of a step.
pub(crate) const ORDER: usize = 20;

/// `1/(k + 1)`.
pub(crate) const RECIPROCALS: [f64; ORDER + 4] = {
    let (mut all, mut k) = ([0.0; ORDER + 4], 0);
    while k < all.len() {
        all[k] = 1.0 / (k as f64 + 1.0);
        k += 1;
    }
    all
};

/// The unknowns `z = (omega, u, Y, X)`, of which [`OwnAxes`] says `z' = constant + damped o z + linear o P z + omega y` with
/// `y = turned o N z`, place by place, `N` exchanging neighbours and `P` pairs.
pub(super) struct SeriesEquations<F> {
    constant: F,
    damped: F,
    linear: F,
    turned: F,
}

impl<F: Four> SeriesEquations<F> {
    #[inline(always)]
    pub(super) fn new(zero: F, axes: &OwnAxes) -> Self {
        let OwnAxes { lead, gain, along, turning, damping, .. } = *axes;
        Self {
            constant: zero.of(&[turning[0], along[0], 0.0, 0.0]),
            damped: zero.of(&[-damping[1], -damping[0], 0.0, 0.0]),
            linear: zero.of(&[turning[1], along[1], 0.0, 1.0]),
            turned: zero.of(&[-gain, lead, -1.0, 1.0]),
        }
    }
}

/// The coefficients `z_k` of `z(t + s) = sum_k z_k s^k`, with the coefficients of `y` and `omega`.
///
/// `(k + 1) z_{k+1} = damped o z_k + linear o P z_k + sum_j omega_j y_{k-j}`. (Jorba and Zou 2005, Experimental Mathematics 14, 99-117, section 2.)
pub(super) struct SeriesTerms<F> {
    pub(super) z: [F; ORDER + 1],
    y: [F; ORDER],
    omega: [f64; ORDER + 4],
}

impl<F: Four> SeriesTerms<F> {
    #[inline(always)]
    pub(super) fn new(zero: F) -> Self {
        Self { z: [zero; ORDER + 1], y: [zero; ORDER], omega: [0.0; ORDER + 4] }
    }

    /// Computes the series about `z`. Without damping, the damping term is left out.
    #[inline(always)]
    pub(super) fn expand<const DAMPED: bool>(&mut self, equations: &SeriesEquations<F>, z: F) {
        macro_rules! orders {
            ($($k:literal)*) => {{
                // Written out, so that every sum has a length that is known when it is compiled.
                let y = equations.turned.times(z.neighbours());
                let start = (y, equations.turned.times(z.spread()));
                $(let z = self.next::<$k, DAMPED>(equations, start, z);)*
                self.z[ORDER] = z;
            }};
        }
        orders!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19);
    }

    /// `z_{K+1}` from `z = z_K` and the coefficients before it; `start` is `y_0` and `turned omega_0`.
    ///
    /// Every coefficient waits for the one before. The sum therefore starts with the middle terms, which are known first, and ends with the
    /// newest ones, so that only two products wait for `z`.
    #[inline(always)]
    fn next<const K: usize, const DAMPED: bool>(
        &mut self,
        equations: &SeriesEquations<F>,
        (y0, turned): (F, F),
        z: F,
    ) -> F {
        let (neighbours, opposites, omega) = (z.neighbours(), z.opposites(), z.spread());
        (self.z[K], self.omega[K]) = (z, z.first());
        if const { K == 0 } {
            self.y[0] = y0;
            let rest = if DAMPED { z.mul_add(equations.damped, equations.constant) } else { equations.constant };
            return omega.mul_add(y0, opposites.mul_add(equations.linear, rest));
        }
        self.y[K] = equations.turned.times(neighbours);
        let part = z.like(RECIPROCALS[K]);
        let known = self.sum::<K>(z.like(0.0), part);
        let sum = neighbours.mul_add(part.times(turned), known);
        let sum = omega.mul_add(part.times(y0), sum);
        let sum = if DAMPED { z.mul_add(part.times(equations.damped), sum) } else { sum };
        opposites.mul_add(part.times(equations.linear), sum)
    }

    /// `part sum_{0 < j < K} omega_j y_{K-j}`.
    #[inline(always)]
    fn sum<const K: usize>(&self, zero: F, part: F) -> F {
        let omega = |j: usize| zero.like(self.omega[j]);
        match K {
            1 => zero,
            2 => part.times(omega(1)).times(self.y[1]),
            _ => {
                // Plain loops: with an iterator they are not written out.
                let (mut below, mut above, mut j) = (zero, zero, K / 2);
                while j >= 2 {
                    below = omega(j).mul_add(self.y[K - j], below);
                    j -= 1;
                }
                j = K / 2 + 1;
                while j < K - 1 {
                    above = omega(j).mul_add(self.y[K - j], above);
                    j += 1;
                }
                let sum = part.times(below.plus(above));
                let sum = omega(K - 1).mul_add(part.times(self.y[1]), sum);
                self.y[K - 1].mul_add(part.times(omega(1)), sum)
            }
        }
    }

    /// `z` after the time `h`, and by how much the heading has turned.
    #[inline(always)]
    pub(super) fn after(&self, h: f64) -> (F, f64) {
        let zero = self.z[0].like(0.0);
        let (h1, h2, h4) = (zero.like(h), zero.like(h * h), zero.like((h * h) * (h * h)));
        // In four parts, by powers of h^4; those of the turn are four numbers of one.
        let mut parts = [self.z[ORDER], zero, zero, zero];
        let mut turn = zero;
        for k in (0..ORDER / 4).rev() {
            for (i, part) in parts.iter_mut().enumerate() {
                *part = part.mul_add(h4, self.z[4 * k + i]);
            }
            let four = |x: &[f64; ORDER + 4]| zero.of(&lagrangian::from_fn(|i| x[4 * k + i]));
            turn = turn.mul_add(h4, four(&self.omega).times(four(&RECIPROCALS)));
        }
        let [z0, z1, z2, z3] = parts;
        let z = z3.mul_add(h1, z2).mul_add(h2, z1.mul_add(h1, z0));
        let [t0, t1, t2, t3] = turn.row();
        (z, h * ((t0 + h * t1) + h * h * (t2 + h * t3)))
    }
}
