use super::reduced::{Moment, ReducedSleigh};

/// Up to these distances in `s` and turns (rad) the path is integrated over time directly.
const SHORT: f64 = 2.0;
const SMALL_TURN: f64 = 8.0;
/// What one panel covers of each.
const PANEL: f64 = 1.0;
const PANEL_TURN: f64 = 4.0;

/// The blade's path `z = x + i y` in the frame of the start: `z = int_0^t u e^(i (theta - theta0)) dt`.
///
/// With `phi = gd s`, `sigma = k/|a|` and `ell = k^2/a` the path is `ell int tanh(s) e^(i psi) ds`,
/// `psi = sigma (phi - phi0)`, mirrored where `a omega0 < 0`. No formula costs more for a longer time or for more turns:
///
/// - A short piece is integrated over time.
/// - On the **tails**, where `g = e^-|s| < 1/sigma`, the path straightens: the integrand is its limit times
///   `F(g) = (1 - g^2)/(1 + g^2) e^(-2 i sigma atan g)`, and `(F - 1)/g` is analytic at `g = 0`, the infinite end.
/// - **Between** them the blade turns quickly. `e^(i sigma phi)` decays upwards in the complex plane of `phi`, so the
///   integral of `tan(phi) e^(i sigma phi)` between two points is that up from the first less that up from the second.
#[derive(Debug, Clone)]
pub(super) struct Path {
    /// `sigma`, infinite for a balanced sleigh.
    sigma: f64,
    ell: f64,
    /// `ell/sigma = k sign(a)`.
    ell_per_sigma: f64,
    /// `sign(a omega0)`.
    mirror: f64,
    s0: f64,
    start: ExactPoint,
}

/// The parts of the motion, in the order of `s`.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
enum PathPart {
    Past,
    Turning,
    Future,
}

impl Path {
    pub(super) fn new(reduced: &ReducedSleigh) -> Self {
        let (k, k_per_a) = (reduced.gyration, reduced.gyration_per_offset);
        let start = reduced.start();
        let mirror = k_per_a.signum() * start.turn_rate.signum();
        Self {
            sigma: k_per_a.abs(),
            ell: k * k_per_a,
            ell_per_sigma: k.copysign(k_per_a),
            mirror,
            s0: reduced.s0(),
            start: ExactPoint::new(reduced, &start, mirror),
        }
    }

    /// The displacement from the start at time `t`, which has the reduced state `moment`.
    pub(super) fn displacement(&self, reduced: &ReducedSleigh, t: f64, moment: &Moment) -> [f64; 2] {
        let (turn, distance) = (moment.turn.abs(), moment.tau.abs());
        if distance <= SHORT && turn <= SMALL_TURN {
            let panels = (distance / PANEL).max(turn / PANEL_TURN).ceil().max(1.0);
            return over_time(reduced, t / panels, panels);
        }
        let end = ExactPoint::new(reduced, moment, self.mirror);
        let (part, last) = (self.part(&self.start), self.part(&end));
        let [x, y] = self.journey(self.start, part, end, last);
        [x, self.mirror * y]
    }

    /// From part to part.
    fn journey(&self, mut from: ExactPoint, mut part: PathPart, end: ExactPoint, last: PathPart) -> [f64; 2] {
        let mut sum = [0.0; 2];
        while part != last {
            let forward = part < last;
            let future_edge = matches!((part, forward), (PathPart::Turning, true) | (PathPart::Future, false));
            let edge = self.edge(if future_edge { 1.0 } else { -1.0 });
            let [x, y] = self.piece(part, &from, &edge);
            sum = [sum[0] + x, sum[1] + y];
            from = edge;
            part = match part {
                PathPart::Turning if forward => PathPart::Future,
                PathPart::Turning => PathPart::Past,
                _ => PathPart::Turning,
            };
        }
        let [x, y] = self.piece(part, &from, &end);
        [sum[0] + x, sum[1] + y]
    }

    fn part(&self, point: &ExactPoint) -> PathPart {
        if self.sigma * point.g < 1.0 {
            if point.tanh < 0.0 { PathPart::Past } else { PathPart::Future }
        } else {
            PathPart::Turning
        }
    }

    fn piece(&self, part: PathPart, from: &ExactPoint, to: &ExactPoint) -> [f64; 2] {
        match part {
            PathPart::Turning => {
                let ([x0, y0], [x1, y1]) = (self.upwards(from), self.upwards(to));
                [self.ell_per_sigma * (x0 - x1), self.ell_per_sigma * (y0 - y1)]
            }
            PathPart::Past => self.tail(-1.0, from, to),
            PathPart::Future => self.tail(1.0, from, to),
        }
    }

    /// `psi` of the straight line before (`side = -1`) or after (`side = 1`) all turns.
    fn psi_limit(&self, side: f64) -> f64 {
        let ExactPoint { tanh, g, .. } = self.start;
        // e^(-side s0), with all its digits.
        let decay = if side * tanh >= 0.0 { g } else { g.recip() };
        side * 2.0 * self.sigma * decay.atan()
    }

    /// Where a tail meets the part between: `g = 1/sigma`.
    fn edge(&self, side: f64) -> ExactPoint {
        let g = self.sigma.recip();
        let one_plus = g.mul_add(g, 1.0);
        ExactPoint {
            tau: side * self.sigma.ln() - self.s0,
            psi: self.psi_limit(side) - side * 2.0 * self.sigma * g.atan(),
            tanh: side * (1.0 - g) * (1.0 + g) / one_plus,
            sech: 2.0 * g / one_plus,
            g,
        }
    }

    /// `ell` times the integral along a tail.
    fn tail(&self, side: f64, from: &ExactPoint, to: &ExactPoint) -> [f64; 2] {
        let ([x0, y0], [x1, y1]) = (self.bend(from.g), self.bend(to.g));
        // The two tails are each other's mirror image: s -> -s conjugates F.
        let (along, across) = (to.tau - from.tau - side * (x1 - x0), -(y1 - y0));
        rotated([side * self.ell * along, side * self.ell * across], self.psi_limit(side))
    }

    /// `int_0^g (F - 1)/g dg`.
    fn bend(&self, g: f64) -> [f64; 2] {
        panel(0.0, g, |g| {
            if g == 0.0 {
                return [0.0, -2.0 * self.sigma];
            }
            let alpha = 2.0 * self.sigma * g.atan();
            let (sin, cos) = alpha.sin_cos();
            let sin_half = (0.5 * alpha).sin();
            let one_plus = g.mul_add(g, 1.0);
            [
                -2.0 * g * cos / one_plus - 2.0 * sin_half * (sin_half / g),
                -((1.0 - g) * (1.0 + g) / one_plus) * (sin / g),
            ]
        })
    }

    /// `i e^(i psi) int_0^inf tan(phi + i q/sigma) e^-q dq`, cut where `e^-q` is below rounding. The poles of the tangent
    /// are at `q = +-i sigma (pi/2 -+ phi)`, at least `pi/2` away in the part between the tails: the panels widen with `q`.
    fn upwards(&self, point: &ExactPoint) -> [f64; 2] {
        const PANELS: [f64; 5] = [0.0, 2.0, 6.0, 14.0, 40.0];
        let ExactPoint { tanh, sech, psi, .. } = *point;
        let mut sum = [0.0; 2];
        for ends in PANELS.windows(2) {
            let [x, y] = panel(ends[0], ends[1], |q| {
                let rise = (q / self.sigma).tanh();
                let ratio = rise / sech;
                let weight = (-q).exp() / (sech * (1.0 + (tanh * ratio) * (tanh * ratio)));
                [-ratio * weight, tanh * (1.0 - rise * rise) * weight]
            });
            sum = [sum[0] + x, sum[1] + y];
        }
        rotated(sum, psi)
    }
}

/// The integral over time in equal panels.
fn over_time(reduced: &ReducedSleigh, step: f64, panels: f64) -> [f64; 2] {
    let mut sum = [0.0; 2];
    let mut index = 0.0;
    while index < panels {
        let [x, y] = panel(index * step, (index + 1.0) * step, |t| {
            let moment = reduced.at(t);
            let (sin, cos) = moment.turn.sin_cos();
            [moment.speed * cos, moment.speed * sin]
        });
        sum = [sum[0] + x, sum[1] + y];
        index += 1.0;
    }
    sum
}

pub(super) fn rotated([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [x * cos - y * sin, x * sin + y * cos]
}

/// A point of the motion as the path needs it.
#[derive(Debug, Clone, Copy)]
struct ExactPoint {
    /// `s - s0`.
    tau: f64,
    psi: f64,
    tanh: f64,
    sech: f64,
    /// `e^-|s|`.
    g: f64,
}

impl ExactPoint {
    /// `mirror` is the sign of `a omega0`.
    fn new(reduced: &ReducedSleigh, moment: &Moment, mirror: f64) -> Self {
        let spin = reduced.gyration * moment.turn_rate.abs();
        Self {
            tau: moment.tau,
            psi: mirror * moment.turn,
            tanh: moment.speed / reduced.speed,
            sech: spin / reduced.speed,
            g: spin / (reduced.speed + moment.speed.abs()),
        }
    }
}

/// Nodes in `(0, 1)` and weights of the Gauss-Legendre rule with 16 nodes on `[-1, 1]`, exact to degree 31.
const RULE: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_5),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_6),
    (0.458_016_777_657_227_37, 0.169_156_519_395_002_54),
    (0.617_876_244_402_643_8, 0.149_595_988_816_576_73),
    (0.755_404_408_355_003, 0.124_628_971_255_533_88),
    (0.865_631_202_387_831_8, 0.095_158_511_682_492_79),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_894),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_096),
];

/// `int_from^to f` for `f` analytic and slowly varying over the interval: one Gauss-Legendre panel.
fn panel(from: f64, to: f64, f: impl Fn(f64) -> [f64; 2]) -> [f64; 2] {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut sum = [0.0; 2];
    for (node, weight) in RULE {
        let (left, right) = (f(middle - half * node), f(middle + half * node));
        sum[0] += weight * (left[0] + right[0]);
        sum[1] += weight * (left[1] + right[1]);
    }
    [half * sum[0], half * sum[1]]
}
