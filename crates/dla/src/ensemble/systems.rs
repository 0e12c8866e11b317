/// The systems of `W` trajectories that go together.
pub trait Systems<Sys, const W: usize> {
    /// The system of a lane.
    fn of(&self, lane: usize) -> &Sys;

    /// The system of all lanes, where they share one.
    fn common(&self) -> Option<&Sys>;
}

/// One system for all.
#[derive(Debug)]
pub struct Same<'a, Sys>(pub &'a Sys);

/// A system for each lane.
#[derive(Debug)]
pub struct Each<'a, Sys, const W: usize>(pub &'a [Sys; W]);

impl<Sys, const W: usize> Systems<Sys, W> for Same<'_, Sys> {
    #[inline(always)]
    fn of(&self, _lane: usize) -> &Sys {
        self.0
    }

    #[inline(always)]
    fn common(&self) -> Option<&Sys> {
        Some(self.0)
    }
}

impl<Sys, const W: usize> Systems<Sys, W> for Each<'_, Sys, W> {
    #[inline(always)]
    fn of(&self, lane: usize) -> &Sys {
        &self.0[lane]
    }

    #[inline(always)]
    fn common(&self) -> Option<&Sys> {
        None
    }
}

impl<Sys> Clone for Same<'_, Sys> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<Sys> Copy for Same<'_, Sys> {}

impl<Sys, const W: usize> Clone for Each<'_, Sys, W> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<Sys, const W: usize> Copy for Each<'_, Sys, W> {}
