use crate::derivatives::{counted, switch};

/// The formulation of predicted steps: coordinates with multipliers, or the basis of admissible velocities (null space).
///
/// A frozen Jacobian serves long in coordinates if the mass matrix is constant, and in the basis if the basis turns with a body. So the
/// basis is tried if the Jacobian in coordinates is renewed often; and a run stays in the basis if the Jacobian is renewed at most half as
/// often there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unknowns {
    /// Whether steps are solved in the basis.
    pub(crate) in_basis: bool,
    /// Whether the next step made without memory is to change to the basis.
    pub(crate) wanted: bool,
    /// Whether the choice is final.
    pub(crate) decided: bool,
    /// Steps of the present trial, and the number of them that renewed the Jacobian.
    steps: u32,
    renewed: u32,
    /// The number of steps of the trial in coordinates that renewed it.
    before: u32,
}

impl Unknowns {
    /// Before the first step.
    pub(crate) const UNDECIDED: Self =
        Self { in_basis: false, wanted: false, decided: false, steps: 0, renewed: 0, before: 0 };
    /// Number of steps of a trial.
    const TRIAL: u32 = 32;
    /// The basis is tried if at least this number of them renew the Jacobian, each time for the cost of some two corrections.
    const MANY: u32 = 4;

    /// Begins a series of predicted steps, in the basis or in coordinates; a system without a basis decides for coordinates.
    pub(crate) fn begin(&mut self, in_basis: bool) {
        self.decided |= self.wanted && !in_basis;
        (self.in_basis, self.wanted) = (in_basis, in_basis);
    }

    /// Counts a predicted step; returns whether the next one is to be made without memory, to change the formulation.
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

    /// Visits every number of it, in a fixed order.
    pub(crate) fn visit(&mut self, mut visit: impl FnMut(&mut f64)) {
        let Self { in_basis, wanted, decided, steps, renewed, before } = self;
        for flag in [in_basis, wanted, decided] {
            switch(flag, &mut visit);
        }
        for count in [steps, renewed, before] {
            counted(count, &mut visit);
            // A file may hold any number.
            *count = Self::TRIAL.min(*count);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After how many steps, of which every `nth` renews the Jacobian, a change is wanted.
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
        // A system without a basis stays in coordinates.
        let mut without = unknowns;
        without.begin(false);
        assert!(without.decided && !without.wanted);
        // Where the Jacobian lasts no longer in the basis, the run leaves it for good.
        unknowns.begin(true);
        let (mut poor, mut good) = (unknowns, unknowns);
        assert_eq!(change(&mut poor, 5), Some(32));
        poor.begin(false);
        assert!(poor.decided && !poor.in_basis && !poor.wanted);
        assert_eq!(change(&mut good, 8), None);
        assert!(good.decided && good.in_basis && good.wanted);
    }
}
