use super::OwnAxes;
use super::coefficients::{ORDER, RECIPROCALS};
use lagrangian::simd::{Pack, Simd};

/// The numbers of [`OwnAxes`], of eight trajectories.
pub(super) struct Axes<S: Simd, const R: usize> {
    lead: Pack<S, R>,
    minus_gain: Pack<S, R>,
    along: [Pack<S, R>; 2],
    turning: [Pack<S, R>; 2],
    /// `-d_omega` and `-d_u`, where some trajectory is damped.
    damped: Option<[Pack<S, R>; 2]>,
}

impl<S: Simd, const R: usize> Axes<S, R> {
    #[inline(always)]
    pub(super) fn load(simd: S, of: &[OwnAxes; 8]) -> Self {
        let load = |number: &dyn Fn(&OwnAxes) -> f64| {
            let mut row = [0.0; 8];
            for lane in 0..8 {
                row[lane] = number(&of[lane]);
            }
            Pack::load(simd, &row)
        };
        Self {
            lead: load(&|axes| axes.lead),
            minus_gain: load(&|axes| -axes.gain),
            along: [load(&|axes| axes.along[0]), load(&|axes| axes.along[1])],
            turning: [load(&|axes| axes.turning[0]), load(&|axes| axes.turning[1])],
            damped: of
                .iter()
                .any(OwnAxes::is_damped)
                .then(|| [load(&|axes| -axes.damping[1]), load(&|axes| -axes.damping[0])]),
        }
    }
}

/// The series of eight trajectories: [`SeriesTerms`](super::coefficients::Series) with a register for every unknown.
pub(super) struct EightSeries<S: Simd, const R: usize> {
    pub(super) omega: [Pack<S, R>; ORDER + 1],
    pub(super) u: [Pack<S, R>; ORDER + 1],
    pub(super) y: [Pack<S, R>; ORDER + 1],
    pub(super) x: [Pack<S, R>; ORDER + 1],
}

impl<S: Simd, const R: usize> EightSeries<S, R> {
    /// About these numbers.
    #[inline(always)]
    pub(super) fn about([omega, u, y, x]: [Pack<S, R>; 4]) -> Self {
        let all = |first| {
            let mut all = [Pack::splat(omega.simd(), 0.0); ORDER + 1];
            all[0] = first;
            all
        };
        Self { omega: all(omega), u: all(u), y: all(y), x: all(x) }
    }

    /// The coefficients after the first.
    #[inline(always)]
    pub(super) fn expand(&mut self, axes: &Axes<S, R>) {
        let zero = Pack::splat(self.omega[0].simd(), 0.0);
        for k in 0..ORDER {
            let (mut of_omega, mut of_u, mut of_y, mut of_x) = (zero, zero, zero, zero);
            for j in 0..=k {
                let omega = self.omega[j];
                of_omega = omega.mul_add(self.omega[k - j], of_omega);
                of_u = omega.mul_add(self.u[k - j], of_u);
                of_y = omega.mul_add(self.y[k - j], of_y);
                of_x = omega.mul_add(self.x[k - j], of_x);
            }
            let constant = |number: Pack<S, R>| if k == 0 { number } else { zero };
            let part = Pack::splat(zero.simd(), RECIPROCALS[k]);
            let pushed = |[constantly, slope]: [Pack<S, R>; 2], at| slope.mul_add(at, constant(constantly));
            let (mut on_omega, mut on_u) = (pushed(axes.turning, self.y[k]), pushed(axes.along, self.x[k]));
            if let Some([omega, u]) = axes.damped {
                (on_omega, on_u) = (self.omega[k].mul_add(omega, on_omega), self.u[k].mul_add(u, on_u));
            }
            self.omega[k + 1] = part * of_u.mul_add(axes.minus_gain, on_omega);
            self.u[k + 1] = part * of_omega.mul_add(axes.lead, on_u);
            self.y[k + 1] = -(part * of_x);
            self.x[k + 1] = part * (self.u[k] + of_y);
        }
    }

    /// The largest coefficient of this power, of each trajectory.
    #[inline(always)]
    pub(super) fn largest(&self, k: usize) -> Pack<S, R> {
        let zero = Pack::splat(self.omega[0].simd(), 0.0);
        zero.max_abs(self.omega[k]).max_abs(self.u[k]).max_abs(self.y[k]).max_abs(self.x[k])
    }

    /// What the four are after the times `h`, and by how much the headings have turned.
    #[inline(always)]
    pub(super) fn after(&self, h: Pack<S, R>) -> ([Pack<S, R>; 4], Pack<S, R>) {
        let mut turn = self.omega[ORDER] * RECIPROCALS[ORDER];
        let [mut omega, mut u, mut y, mut x] = [self.omega[ORDER], self.u[ORDER], self.y[ORDER], self.x[ORDER]];
        for k in (0..ORDER).rev() {
            turn = turn.mul_add(h, self.omega[k] * RECIPROCALS[k]);
            omega = omega.mul_add(h, self.omega[k]);
            u = u.mul_add(h, self.u[k]);
            y = y.mul_add(h, self.y[k]);
            x = x.mul_add(h, self.x[k]);
        }
        ([omega, u, y, x], turn * h)
    }
}
