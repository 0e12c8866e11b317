/// Why crossings may have been missed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Close {
    /// How many crossings follow another of the same event so closely that there may be more between them.
    pub count: u64,
    /// The largest spacing of the samples by which these were found (s).
    pub spacing: f64,
    /// How near the nearest two of them are (s).
    pub nearest: f64,
    /// How often a step, or one of those that a method makes of its own, was not seen as a whole: an event had no value at a sample, a
    /// shorter step had no solution, or the event changes more quickly than the samples show.
    pub unseen: u64,
}

impl Close {
    /// The same with so many steps that were not seen as a whole; none where there is no doubt.
    #[must_use]
    pub fn with_unseen(close: Option<Self>, unseen: u64) -> Option<Self> {
        match (close, unseen) {
            (close, 0) => close,
            (close, more) => {
                let close = close.unwrap_or_default();
                Some(Self { unseen: close.unseen + more, ..close })
            }
        }
    }

    /// That of two motions.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let nearest = match (self.count, other.count) {
            (0, _) => other.nearest,
            (_, 0) => self.nearest,
            _ => self.nearest.min(other.nearest),
        };
        let spacing = self.spacing.max(other.spacing);
        Self { count: self.count + other.count, spacing, nearest, unseen: self.unseen + other.unseen }
    }
}

/// Which crossings follow another of the same event by less than two spacings of the samples; none where all are further apart.
///
/// They are given in the order in which they happened, each as the event, the time (s) and the spacing (s). Signs change at most
/// once between two samples, so that crossings found by signs are a spacing apart on the mean, however many there are: nearer
/// than one spacing tells too little. A sine that is looked at too seldom looks like another of at most half the frequency of the
/// samples, and in the faster half of what it may look like its crossings are nearer than two spacings. So this is a sign, and
/// its absence no proof: what looks slower is not told from what is slow.
///
/// `one_way` says of which events only crossings in one direction are given. Between two of them is one in the other, and they
/// are close where they are nearer than four spacings. A spacing of zero is that of a crossing which was not looked for, since
/// the velocity jumped there.
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
                let one = Close { count: 1, spacing: widest, nearest: apart, unseen: 0 };
                found = Some(found.map_or(one, |found| found.and(one)));
            }
        }
    }
    found
}
