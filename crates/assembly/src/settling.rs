use dla::Newton;

/// The arrays of the convergence test of an assembly's iteration: of [`Convergence`](dla::convergence::Convergence) with as many components
/// as there are unknowns.
#[derive(Debug, Default)]
pub(crate) struct AssemblySettling {
    pub(crate) newton: Newton,
    pub(crate) last: Vec<f64>,
    pub(crate) rounding: Vec<bool>,
    pub(crate) start: Vec<f64>,
    /// The sums of the sizes of the terms of the equations, and by how much a correction changes these.
    pub(crate) sizes: Vec<f64>,
    pub(crate) changes: Vec<f64>,
    /// The multipliers of the correction before.
    pub(crate) reactions: Vec<f64>,
    /// Whether the last iteration contracted from its start, so that its result is the solution near there.
    pub(crate) certain: bool,
    /// A correction below this leads to no other solution: see [`rounding_of_place`](dla::convergence::rounding_of_place).
    pub(crate) near: f64,
}

/// Number of refinements of a linear solution if corrections stall above the round-off of the equations.
pub(crate) const REFINEMENTS: u32 = 2;

impl AssemblySettling {
    /// Arrays for these numbers of unknowns and constraints.
    pub(crate) fn new(unknowns: usize, rows: usize) -> Self {
        Self {
            newton: Newton::default(),
            last: vec![0.0; unknowns],
            rounding: vec![false; unknowns],
            start: vec![0.0; unknowns],
            sizes: vec![0.0; unknowns + rows],
            changes: vec![0.0; unknowns + rows],
            reactions: vec![0.0; rows],
            certain: true,
            near: 0.0,
        }
    }
}
