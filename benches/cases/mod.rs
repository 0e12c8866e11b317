//! What is measured, for the clock (`cost`) and for the count of instructions (`instructions`) alike.

mod effects;
mod many;
mod methods;
mod parts;
mod systems;

/// One thing that a bench measures.
pub(crate) struct Case {
    /// What it belongs to.
    pub(crate) group: &'static str,
    /// Its name in the group.
    pub(crate) name: String,
    /// Repeats the case this number of times.
    pub(crate) run: Box<dyn Fn(u64)>,
    /// The case of the same group that it must cost the same as.
    pub(crate) same: Option<&'static str>,
}

impl Case {
    fn new(group: &'static str, name: impl Into<String>, run: impl Fn(u64) + 'static) -> Self {
        Self { group, name: name.into(), run: Box::new(run), same: None }
    }

    /// How often it is done in one measurement.
    pub(crate) fn times(&self) -> u64 {
        match self.group {
            many::REPORT => 1,
            many::ENSEMBLE => 64,
            _ => 500,
        }
    }

    /// Of a term that is absent, no instruction is left.
    fn same_as(self, other: &'static str) -> Self {
        Self { same: Some(other), ..self }
    }
}

/// All of them.
pub(crate) fn all() -> Vec<Case> {
    [methods::cases(), effects::cases(), parts::cases(), many::cases()].into_iter().flatten().collect()
}
