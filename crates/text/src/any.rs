use crate::{TextModel, TextStart, TextSystem};
use dla::FullMechanics;
use std::sync::Arc;

/// A system of text has at most so many coordinates.
pub const MOST_COORDINATES: usize = 12;
/// And at most so many constraints.
pub const MOST_CONSTRAINTS: usize = 6;

/// A system of text as an object.
pub trait TextMechanics<const N: usize, const M: usize>: FullMechanics<N, M> + Sync {
    /// What the texts mean.
    fn model(&self) -> &TextModel;
}

impl<const N: usize, const M: usize> TextMechanics<N, M> for TextSystem<N, M> {
    fn model(&self) -> &TextModel {
        TextSystem::model(self)
    }
}

/// A system with its start.
pub struct StartedText<const N: usize, const M: usize> {
    /// The system.
    pub system: Box<dyn TextMechanics<N, M>>,
    /// Configuration at the start.
    pub q: [f64; N],
    /// Velocity at the start.
    pub v: [f64; N],
}

impl<const N: usize, const M: usize> std::fmt::Debug for StartedText<N, M> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Started").field("q", &self.q).field("v", &self.v).finish_non_exhaustive()
    }
}

/// The shapes that systems of text have, each compiled once.
macro_rules! shapes {
    ($($(#[$doc:meta])* $shape:ident $n:literal $m:literal;)*) => {
        /// A system of text by its shape, the first in this list that has room for it.
        #[derive(Debug)]
        pub enum AnyText {
            $($(#[$doc])* $shape(StartedText<$n, $m>),)*
        }

        impl AnyText {
            /// The system of a model; `None` where no shape has room for it, which those within the limits have.
            #[must_use]
            pub fn new(model: &Arc<TextModel>, start: &TextStart) -> Option<Self> {
                $(if let Some(started) = StartedText::new(model, start) {
                    return Some(Self::$shape(started));
                })*
                None
            }
        }

        /// The same text for whichever shape a system has.
        #[macro_export]
        macro_rules! with_text {
            ($any:expr, $started:ident => $result:expr) => {
                match $any {
                    $($crate::AnyText::$shape($started) => $result,)*
                }
            };
        }
    };
}

shapes! {
    /// Up to three coordinates and one constraint.
    Small 3 1;
    /// Four and two.
    Four 4 2;
    /// Six and three.
    Six 6 3;
    /// Eight and four.
    Eight 8 4;
    /// Twelve and six.
    Twelve 12 6;
    /// With any number of constraints up to six, twelve coordinates.
    Large 18 6;
}

impl<const N: usize, const M: usize> StartedText<N, M> {
    fn new(model: &Arc<TextModel>, start: &TextStart) -> Option<Self> {
        let system = Box::new(TextSystem::new(Arc::clone(model), 0.0, &start.q)?);
        let filled = |x: &[f64]| std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0));
        Some(Self { system, q: filled(&start.q), v: filled(&start.v) })
    }
}
