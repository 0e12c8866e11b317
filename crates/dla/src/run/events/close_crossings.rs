/// Why crossings may have been missed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Close {
    /// Number of crossings that follow another of the same event so closely that there may be more between them.
    pub count: u64,
    /// The largest spacing of the samples that found these crossings (s).
    pub spacing: f64,
    /// The smallest distance between two of them (s).
    pub nearest: f64,
    /// Number of times that a step, or one that a method makes of its own, was not seen as a whole: an event had no value at a sample, a
    /// shorter step had no solution, or the event changes more quickly than the samples show.
    pub incomplete: u64,
}

impl Close {
    /// Adds `incomplete` steps that were not seen as a whole; `None` if there is no doubt.
    #[must_use]
    pub fn with_incomplete(close: Option<Self>, incomplete: u64) -> Option<Self> {
        match (close, incomplete) {
            (close, 0) => close,
            (close, more) => {
                let close = close.unwrap_or_default();
                Some(Self { incomplete: close.incomplete + more, ..close })
            }
        }
    }

    /// The doubts of two motions together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let nearest = match (self.count, other.count) {
            (0, _) => other.nearest,
            (_, 0) => self.nearest,
            _ => self.nearest.min(other.nearest),
        };
        let spacing = self.spacing.max(other.spacing);
        Self { count: self.count + other.count, spacing, nearest, incomplete: self.incomplete + other.incomplete }
    }
}

/// The crossings that follow another of the same event by less than two spacings of the samples; `None` if all are further apart.
///
/// `crossings` are in the order of time, each with its event, its time (s) and the spacing (s). Signs change at most once between two
/// samples, so that crossings found by signs are a spacing apart on the mean, however many there are: a bound of one spacing tells too
/// little. A sine that is sampled too seldom looks like a sine of at most half the frequency of the samples, and in the faster half of
/// these its crossings are nearer than two spacings. So close crossings are a sign, and their absence is no proof: an alias may look slow.
///
/// `one_way` says for which events only crossings in one direction are given. Between two of them is one in the other direction, and they
/// are close if they are nearer than four spacings. A crossing with a spacing of zero was not looked for: the velocity jumped there.
pub fn close_crossings(
    crossings: impl IntoIterator<Item = (usize, f64, f64)>,
    one_way: impl Fn(usize) -> bool,
) -> Option<Close> {
    let (mut last, mut found): (Vec<Option<(f64, f64)>>, Option<Close>) = (Vec::new(), None);
    for (event, t, spacing) in crossings {
        if last.len() <= event {
            last.resize(event + 1, None);
        }
        if let Some((before, other)) = last[event].replace((t, spacing)) {
            let (factor, widest, apart) =
                (if one_way(event) { 4.0 } else { 2.0 }, f64::max(spacing, other), (t - before).abs());
            if f64::min(spacing, other) > 0.0 && apart < factor * widest {
                let one = Close { count: 1, spacing: widest, nearest: apart, incomplete: 0 };
                found = Some(found.map_or(one, |found| found.and(one)));
            }
        }
    }
    found
}
