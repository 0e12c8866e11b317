use crate::family::FamilySystem;
use crate::{FREE, Family, TextModel, TextStart, TextSystem};
use dla::{Mechanism, Member, ParametrisedMechanism, Subject};
use std::sync::Arc;

/// A system of text has at most so many coordinates.
pub const MOST_COORDINATES: usize = 12;
/// And at most so many constraints.
pub const MOST_CONSTRAINTS: usize = 6;

/// A system of text as an object.
///
/// Its own coordinates and constraints are those of its model. Its mechanism has perhaps more, behind them, that fill up a shape: they
/// begin at rest at zero, and stay there.
pub trait TextMechanics: Send + Sync {
    /// What the texts mean.
    fn model(&self) -> &TextModel;

    /// The system for runs.
    fn mechanism(&self) -> Box<dyn Mechanism + '_>;

    /// The same as the member of the family that it was started from ([`Family::started`]); none of any other system.
    fn member(&self) -> Option<Box<dyn ParametrisedMechanism + '_>>;
}

/// A system of a shape.
struct Shaped<const N: usize, const M: usize> {
    system: TextSystem<N, M>,
    /// With the values of the parameters.
    family: Option<(FamilySystem<N, M>, [f64; FREE])>,
}

impl<const N: usize, const M: usize> TextMechanics for Shaped<N, M> {
    fn model(&self) -> &TextModel {
        self.system.model()
    }

    fn mechanism(&self) -> Box<dyn Mechanism + '_> {
        Box::new(Subject::new(&self.system, &()))
    }

    fn member(&self) -> Option<Box<dyn ParametrisedMechanism + '_>> {
        let (family, values) = self.family.as_ref()?;
        Some(Box::new(Member::new(Subject::new(&self.system, &()), family, *values)))
    }
}

/// The system of a model, with a basis for the neighbourhood of its start where the text gives none; `None` where it is too large, which
/// those within the limits are not.
#[must_use]
pub fn started(model: &Arc<TextModel>, start: &TextStart) -> Option<Box<dyn TextMechanics>> {
    in_shape(model, start, None)
}

impl Family {
    /// The same of the member of a family.
    #[must_use]
    pub fn started(&self, start: &TextStart) -> Option<Box<dyn TextMechanics>> {
        in_shape(&self.member, start, Some(self))
    }
}

/// The shapes that systems of text have, each compiled once: the first that has room for a system is its own. In the last there is room
/// for any number of constraints up to six, on twelve coordinates.
fn in_shape(model: &Arc<TextModel>, start: &TextStart, family: Option<&Family>) -> Option<Box<dyn TextMechanics>> {
    let shapes = [shaped::<3, 1>, shaped::<4, 2>, shaped::<6, 3>, shaped::<8, 4>, shaped::<12, 6>, shaped::<18, 6>];
    shapes.into_iter().find_map(|shaped| shaped(model, start, family))
}

fn shaped<const N: usize, const M: usize>(
    model: &Arc<TextModel>,
    start: &TextStart,
    family: Option<&Family>,
) -> Option<Box<dyn TextMechanics>> {
    let system = TextSystem::<N, M>::new(Arc::clone(model), 0.0, &start.q)?;
    let family = family.and_then(|family| Some((family.shaped(0.0, &start.q)?, *family.values())));
    Some(Box::new(Shaped { system, family }))
}
