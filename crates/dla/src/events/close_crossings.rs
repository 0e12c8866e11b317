/// Crossings so close to one another that others may have been missed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Close {
    /// How many follow another of the same event so closely.
    pub count: u64,
    /// The largest spacing of the samples by which they were found (s).
    pub spacing: f64,
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
            let (apart, widest) = (if one_way(event) { 4.0 } else { 2.0 }, f64::max(spacing, other));
            if f64::min(spacing, other) > 0.0 && (t - before).abs() < apart * widest {
                let Close { count, spacing } = found.unwrap_or(Close { count: 0, spacing: 0.0 });
                found = Some(Close { count: count + 1, spacing: spacing.max(widest) });
            }
        }
    }
    found
}
