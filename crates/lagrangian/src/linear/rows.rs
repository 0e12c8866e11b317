use std::fmt;

/// Some of the rows of a constraint, of the first 64.
///
/// As text they are counted from one: `row 2`, `rows 1 and 3`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Rows(u64);

impl Rows {
    /// How many rows can be told apart.
    const MOST: usize = u64::BITS as usize;

    /// No row.
    #[must_use]
    pub fn none() -> Self {
        Self::default()
    }

    /// These, and the row `k` (from 0).
    #[must_use]
    pub fn with(self, k: usize) -> Self {
        if k < Self::MOST { Self(self.0 | 1 << k) } else { self }
    }

    /// Whether the row `k` (from 0) is among them.
    #[must_use]
    pub fn contains(self, k: usize) -> bool {
        k < Self::MOST && self.0 >> k & 1 == 1
    }

    /// The rows of both.
    #[must_use]
    pub fn and(self, others: Self) -> Self {
        Self(self.0 | others.0)
    }

    /// How many there are.
    #[must_use]
    pub fn count(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The rows, from 0, in their order.
    pub fn iter(self) -> impl Iterator<Item = usize> {
        (0..Self::MOST).filter(move |k| self.contains(*k))
    }
}

impl FromIterator<usize> for Rows {
    fn from_iter<I: IntoIterator<Item = usize>>(rows: I) -> Self {
        rows.into_iter().fold(Self::none(), Self::with)
    }
}

impl fmt::Display for Rows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.count();
        f.write_str(match count {
            0 => return f.write_str("no row"),
            1 => "row ",
            _ => "rows ",
        })?;
        for (place, k) in self.iter().enumerate() {
            let before = match place {
                0 => "",
                _ if place + 1 == count => " and ",
                _ => ", ",
            };
            write!(f, "{before}{}", k + 1)?;
        }
        Ok(())
    }
}
