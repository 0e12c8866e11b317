use lagrangian::mapped;
use std::fmt;

/// The sizes of the last corrections of an iteration: of `F'(x)^-1 F(x)`, which is the residual in the units of the unknowns, for any units
/// of the equations (Deuflhard 2004, Newton Methods for Nonlinear Problems, section 1.4).
///
/// The size is fixed, so that an error that carries it can be copied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct History {
    sizes: [f64; Self::KEPT],
    made: u32,
}

impl Default for History {
    fn default() -> Self {
        Self::new()
    }
}

impl History {
    /// The number of corrections that are kept.
    pub const KEPT: usize = 6;

    /// No corrections yet.
    #[must_use]
    #[inline(always)]
    pub const fn new() -> Self {
        Self { sizes: [0.0; Self::KEPT], made: 0 }
    }

    /// Adds the size of a correction; the oldest is forgotten.
    #[inline(always)]
    pub fn push(&mut self, size: f64) {
        self.sizes[self.made as usize % Self::KEPT] = size;
        self.made = self.made.saturating_add(1);
    }

    /// The same sizes in units of `size`.
    #[must_use]
    pub fn relative_to(mut self, size: f64) -> Self {
        if size > 0.0 {
            self.sizes = mapped(&self.sizes, |correction| correction / size);
        }
        self
    }

    /// How many corrections were made in all.
    #[must_use]
    pub fn made(&self) -> u32 {
        self.made
    }

    /// The corrections kept, oldest first.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        let kept = self.made.min(Self::KEPT as u32);
        (self.made - kept..self.made).map(|i| self.sizes[i as usize % Self::KEPT])
    }

    /// The ratio of the last correction to the one before; `None` if there are fewer than two.
    #[must_use]
    pub fn last_ratio(&self) -> Option<f64> {
        let [before, last] = [2, 1].map(|back| self.made.checked_sub(back));
        let size = |i: u32| self.sizes[i as usize % Self::KEPT];
        before.zip(last).map(|(before, last)| size(last) / size(before))
    }

    /// The last correction; `None` if there was none.
    #[must_use]
    pub fn last(&self) -> Option<f64> {
        self.made.checked_sub(1).map(|i| self.sizes[i as usize % Self::KEPT])
    }
}

impl fmt::Display for History {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.made as usize > Self::KEPT {
            f.write_str(".. ")?;
        }
        for (i, size) in self.iter().enumerate() {
            let comma = if i == 0 { "" } else { ", " };
            write!(f, "{comma}{size:.1e}")?;
        }
        Ok(())
    }
}
