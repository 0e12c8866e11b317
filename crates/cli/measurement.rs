//! The results of `noslip precision`.

use harness::precision::{Clock, Curve};

/// The measurements of a scene.
pub(crate) struct Measurement {
    /// How long the motion takes (s).
    pub(crate) duration: f64,
    pub(crate) reference: KnownEnd<()>,
    pub(crate) clock: Clock,
    pub(crate) facts: Vec<(String, String)>,
    pub(crate) curves: Vec<Curve>,
}

/// The reference for the end of the motion.
pub(crate) struct KnownEnd<End> {
    /// True if the end is known in closed form; false if the method computed it.
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
    /// How well the end is known, without the end itself.
    pub(crate) fn told(&self) -> KnownEnd<()> {
        let &Self { closed, by, steps, error, .. } = self;
        KnownEnd { closed, by, steps, error, end: () }
    }
}
