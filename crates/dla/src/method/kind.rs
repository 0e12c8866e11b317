/// The families of methods, as a program tells them apart, with the number that tells the members of a family apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MethodKind {
    /// `dla`
    Dla,
    /// `dla-trapezoid`
    DlaTrapezoid,
    /// `dla-alpha`
    DlaAlpha,
    /// `dla4`, `dla6`, `dla8`: the composition of `dla` of that order
    Composed(u32),
    /// `lobatto3` to `lobatto5`, by their stages
    Lobatto(usize),
    /// `gauss4` to `gauss16`, by their stages, from two to eight
    Gauss(usize),
    /// `gauss-adaptive`
    GaussAdaptive,
    /// `taylor`
    Taylor,
    /// `energy2` to `energy8`, by their stages, from one to four
    Energy(usize),
    /// `gni`
    Gni,
    /// `rk4`
    Rk4,
    /// `rk4-projected`
    Rk4Projected,
    /// `rk4-reduced`
    Rk4Reduced,
    /// `implicit-midpoint`
    ImplicitMidpoint,
    /// `dop853`
    Dop853,
}

impl MethodKind {
    /// Whether the method chooses steps of its own within a step of the run, by a tolerance.
    #[must_use]
    pub fn is_adaptive(self) -> bool {
        matches!(self, Self::GaussAdaptive | Self::Taylor | Self::Dop853)
    }
}
