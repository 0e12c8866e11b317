use assembly::AssemblyState;

/// A step that was made.
pub(super) struct AssemblyStep<'a> {
    /// The number of the node it began at, and the time (s).
    pub(super) k: u64,
    pub(super) t0: f64,
    pub(super) h: f64,
    pub(super) before: &'a AssemblyState,
    pub(super) after: &'a AssemblyState,
}

/// The node at which a run ends within a step: the time (s) and the state.
pub(super) type LastNode = (f64, AssemblyState);
