//! What `noslip precision` measures.

use harness::precision::{Clock, Curve};

/// What was measured of a scene.
pub(crate) struct Measurement {
    /// How long the motion takes (s).
    pub(crate) duration: f64,
    pub(crate) reference: KnownEnd<()>,
    pub(crate) clock: Clock,
    pub(crate) facts: Vec<(String, String)>,
    pub(crate) curves: Vec<Curve>,
}

/// Where the motion truly ends.
pub(crate) struct KnownEnd<End> {
    /// In closed form; else by the method.
    pub(crate) closed: bool,
    /// The method that computes it, or that the closed form is checked against.
    pub(crate) by: &'static str,
    /// Its steps.
    pub(crate) steps: u64,
    /// How far it may be off (m or rad).
    pub(crate) error: f64,
    pub(crate) end: End,
}

impl<End> KnownEnd<End> {
    /// How well it is known, without where it is.
    pub(crate) fn told(&self) -> KnownEnd<()> {
        let &Self { closed, by, steps, error, .. } = self;
        KnownEnd { closed, by, steps, error, end: () }
    }
}
