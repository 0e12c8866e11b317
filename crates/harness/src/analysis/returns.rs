use lagrangian::from_fn;

/// What velocities may differ by where they repeat, relative to their range, and times relative to the period: what cubics between nodes leave,
/// `(h Omega)^4/384` of motions of the frequency `Omega`, is below it for `h Omega < 0.7`.
const REPEATS: f64 = 1e-3;
/// A plane is crossed at most so often in a period, and at least so many periods are needed (`docs/chaos.md`).
const MOST: usize = 64;
const PERIODS: usize = 4;
/// So many crossings are kept.
const KEPT: usize = 4096;

/// Values with their rates at a time (s).
pub(super) type Point<const N: usize> = (f64, [f64; N], [f64; N]);

/// When a signal comes back to where it was: it crosses the plane through one of its points, normal to its rate there.
#[derive(Debug)]
pub(super) struct Returns<const N: usize> {
    origin: [f64; N],
    normal: [f64; N],
    /// Times (s) and values of the crossings in the direction of the first, which is the origin.
    crossings: Vec<(f64, [f64; N])>,
    /// How far the signal went from there.
    range: f64,
}

impl<const N: usize> Returns<N> {
    pub(super) fn to((t, origin, rate): Point<N>) -> Self {
        let length = size(&rate);
        Self { origin, normal: rate.map(|x| x / length), crossings: vec![(t, origin)], range: 0.0 }
    }

    /// Looks at the signal between two neighbouring nodes.
    pub(super) fn add(&mut self, before: &Point<N>, after: &Point<N>) {
        self.range = self.range.max(size::<N>(&from_fn(|i| after.1[i] - self.origin[i])));
        let height = |at: &[f64; N]| (0..N).map(|i| self.normal[i] * (at[i] - self.origin[i])).sum::<f64>();
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

    /// The time after which all crossings repeat, if there is one (s). Each is compared with the first of its kind, so that what changes slowly does not repeat.
    pub(super) fn period(&self) -> Option<f64> {
        let count = self.crossings.len();
        let repeats = |every: usize| {
            let rounds = (count - 1) / every;
            let period = (self.crossings[rounds * every].0 - self.crossings[0].0) / rounds as f64;
            let alike = |(j, (time, at)): (usize, &(f64, [f64; N]))| {
                let (first, there) = &self.crossings[j % every];
                let late = time - first - (j / every) as f64 * period;
                size::<N>(&from_fn(|i| at[i] - there[i])) <= REPEATS * self.range && late.abs() <= REPEATS * period
            };
            self.crossings.iter().enumerate().all(alike).then_some(period)
        };
        (1..=MOST).take_while(|every| every * PERIODS < count).find_map(repeats)
    }
}

/// The cubic with the values and rates of two nodes, at a fraction of the way.
fn between<const N: usize>(before: &Point<N>, after: &Point<N>, c: f64) -> [f64; N] {
    let h = after.0 - before.0;
    from_fn(|i| {
        let (change, d0, d1) = (after.1[i] - before.1[i], h * before.2[i], h * after.2[i]);
        before.1[i] + c * (d0 + c * ((3.0 * change - 2.0 * d0 - d1) + c * (d0 + d1 - 2.0 * change)))
    })
}

pub(super) fn size<const N: usize>(x: &[f64; N]) -> f64 {
    x.iter().fold(0.0, |size: f64, x| size.hypot(*x))
}
