use crate::derivatives::{counted, switch};

/// In which unknowns the steps of a run go on: coordinates with multipliers, or the basis of admissible velocities.
///
/// Derivatives in coordinates serve long where the mass matrix is constant, those in a basis where that turns with a body. So the basis
/// is tried where derivatives in coordinates are often renewed; and a run stays in it where they are renewed half as often there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unknowns {
    /// Whether it is the basis.
    pub(crate) in_basis: bool,
    /// Whether it is to be.
    pub(crate) wanted: bool,
    /// Whether it stays as it is.
    pub(crate) decided: bool,
    /// Steps that have been looked at, and in how many of them derivatives had to be renewed.
    steps: u32,
    renewed: u32,
    /// In how many they had to be in coordinates.
    before: u32,
}

impl Unknowns {
    /// Of no step.
    pub(crate) const UNDECIDED: Self =
        Self { in_basis: false, wanted: false, decided: false, steps: 0, renewed: 0, before: 0 };
    /// So many steps are looked at,
    const TRIAL: u32 = 32;
    /// of which so many may renew their derivatives: each takes the time of some two corrections.
    const MANY: u32 = 4;

    /// That a step begins, in the basis or not as there is one.
    pub(crate) fn begin(&mut self, in_basis: bool) {
        self.decided |= self.wanted && !in_basis;
        (self.in_basis, self.wanted) = (in_basis, in_basis);
    }

    /// That a step has gone on from the last; and whether the next one is to begin anew, in the other unknowns.
    pub(crate) fn are_to_change(&mut self, renewed: bool) -> bool {
        self.steps += 1;
        self.renewed += u32::from(renewed);
        if self.steps < Self::TRIAL {
            return false;
        }
        let often = self.renewed;
        (self.steps, self.renewed) = (0, 0);
        if self.in_basis {
            self.decided = true;
            self.wanted = 2 * often <= self.before;
            return !self.wanted;
        }
        (self.wanted, self.before) = (often >= Self::MANY, often);
        self.wanted
    }

    /// Every number of it, in a fixed order.
    pub(crate) fn visit(&mut self, mut visit: impl FnMut(&mut f64)) {
        let Self { in_basis, wanted, decided, steps, renewed, before } = self;
        for flag in [in_basis, wanted, decided] {
            switch(flag, &mut visit);
        }
        for count in [steps, renewed, before] {
            counted(count, &mut visit);
            // What stands in a file may be any number.
            *count = Self::TRIAL.min(*count);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After how many steps, of which every `nth` renews its derivatives, others are wanted.
    fn change(unknowns: &mut Unknowns, nth: u32) -> Option<u32> {
        (1_u32..=100).find(|k| !unknowns.decided && unknowns.are_to_change(k.is_multiple_of(nth)))
    }

    #[test]
    fn the_basis_is_tried_where_derivatives_do_not_last() {
        let mut unknowns = Unknowns::UNDECIDED;
        assert_eq!(change(&mut unknowns, 20), None);
        let mut unknowns = Unknowns::UNDECIDED;
        assert_eq!(change(&mut unknowns, 4), Some(32));
        assert!(unknowns.wanted && !unknowns.decided);
        // Where there is none, that is all.
        let mut without = unknowns;
        without.begin(false);
        assert!(without.decided && !without.wanted);
        // Where they last no longer in it, it is left, for good.
        unknowns.begin(true);
        let (mut poor, mut good) = (unknowns, unknowns);
        assert_eq!(change(&mut poor, 5), Some(32));
        poor.begin(false);
        assert!(poor.decided && !poor.in_basis && !poor.wanted);
        assert_eq!(change(&mut good, 8), None);
        assert!(good.decided && good.in_basis && good.wanted);
    }
}
