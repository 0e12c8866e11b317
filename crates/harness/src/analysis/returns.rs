/// Largest difference of velocities that repeat, relative to their range, and of their times, relative to the period. The error of cubics
/// between nodes, `(h Omega)^4/384` for motions of the frequency `Omega`, is below it for `h Omega < 0.7`.
const REPEATS: f64 = 1e-3;
/// Maximum number of crossings of a plane in a period, and least number of periods (`docs/chaos.md`).
const MOST: usize = 64;
const PERIODS: usize = 4;
/// Maximum number of crossings that are kept.
const KEPT: usize = 4096;

/// Values with their rates at a time (s).
pub(super) type Point = (f64, Vec<f64>, Vec<f64>);

/// Detects the returns of a signal: it crosses the plane through one of its points, normal to its rate there.
#[derive(Debug)]
pub(super) struct Returns {
    origin: Vec<f64>,
    normal: Vec<f64>,
    /// Times (s) and values of the crossings in the direction of the first, which is the origin.
    crossings: Vec<(f64, Vec<f64>)>,
    /// The largest distance of the signal from the origin.
    range: f64,
}

impl Returns {
    pub(super) fn to((t, origin, rate): Point) -> Self {
        let length = size(&rate);
        let normal = rate.iter().map(|x| x / length).collect();
        Self { crossings: vec![(t, origin.clone())], origin, normal, range: 0.0 }
    }

    /// Looks at the signal between two neighbouring nodes.
    pub(super) fn add(&mut self, before: &Point, after: &Point) {
        self.range = self.range.max(apart(&after.1, &self.origin));
        let plane = || self.normal.iter().zip(&self.origin);
        let height = |at: &[f64]| plane().zip(at).map(|((normal, origin), at)| normal * (at - origin)).sum::<f64>();
        if !(height(&before.1) < 0.0 && height(&after.1) >= 0.0) || self.crossings.len() == KEPT {
            return;
        }
        let [mut below, mut above] = [0.0, 1.0];
        for _ in 0..f64::MANTISSA_DIGITS {
            let middle = 0.5 * (below + above);
            *(if height(&between(before, after, middle)) < 0.0 { &mut below } else { &mut above }) = middle;
        }
        let time = before.0 + above * (after.0 - before.0);
        self.crossings.push((time, between(before, after, above)));
    }

    /// The time after which all crossings repeat, if there is one (s). Each is compared with the first of its kind, so that a slow change
    /// is no repetition.
    pub(super) fn period(&self) -> Option<f64> {
        let count = self.crossings.len();
        let repeats = |every: usize| {
            let rounds = (count - 1) / every;
            let period = (self.crossings[rounds * every].0 - self.crossings[0].0) / rounds as f64;
            let alike = |(j, (time, at)): (usize, &(f64, Vec<f64>))| {
                let (first, there) = &self.crossings[j % every];
                let late = time - first - (j / every) as f64 * period;
                apart(at, there) <= REPEATS * self.range && late.abs() <= REPEATS * period
            };
            self.crossings.iter().enumerate().all(alike).then_some(period)
        };
        (1..=MOST).take_while(|every| every * PERIODS < count).find_map(repeats)
    }
}

/// The cubic with the values and rates of two nodes, at a fraction of the way.
fn between(before: &Point, after: &Point, c: f64) -> Vec<f64> {
    let h = after.0 - before.0;
    let values = before.1.iter().zip(&after.1);
    let rates = before.2.iter().zip(&after.2);
    let cubic = |((value, next), (rate, next_rate)): ((&f64, &f64), (&f64, &f64))| {
        let (change, d0, d1) = (next - value, h * rate, h * next_rate);
        value + c * (d0 + c * ((3.0 * change - 2.0 * d0 - d1) + c * (d0 + d1 - 2.0 * change)))
    };
    values.zip(rates).map(cubic).collect()
}

pub(super) fn size(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |size: f64, x| size.hypot(*x))
}

pub(super) fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |size: f64, (a, b)| size.hypot(a - b))
}
