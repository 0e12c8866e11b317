use crate::family::FamilySystem;
use crate::{FREE, Family, TextModel, TextStart, TextSystem};
use dla::{CompiledShape, Mechanism, ParametrisedMechanism, Shapes};
use std::sync::Arc;

/// Maximum number of coordinates of a system of text.
pub const MOST_COORDINATES: usize = 12;
/// Maximum number of constraints of a system of text.
pub const MOST_CONSTRAINTS: usize = 6;

/// A system of text as an object.
///
/// The mechanism has the coordinates and constraints of the model, and perhaps more behind them that pad the system to a shape: these
/// begin at rest at zero, and stay there.
pub trait TextMechanics: Send + Sync {
    /// The model that the texts describe.
    fn model(&self) -> &TextModel;

    /// The system for runs.
    fn mechanism(&self) -> Box<dyn Mechanism + '_>;

    /// The system as a member of the family that started it ([`Family::started`]); `None` for any other system.
    fn member(&self) -> Option<Box<dyn ParametrisedMechanism + '_>>;
}

/// A system of text in one shape.
struct Shaped<const N: usize, const M: usize> {
    system: TextSystem<N, M>,
    /// The family, with the values of its parameters.
    family: Option<(FamilySystem<N, M>, [f64; FREE])>,
}

impl<const N: usize, const M: usize> TextMechanics for Shaped<N, M>
where
    Shapes: CompiledShape<N, M>,
{
    fn model(&self) -> &TextModel {
        self.system.model()
    }

    fn mechanism(&self) -> Box<dyn Mechanism + '_> {
        Shapes::mechanism(&self.system, &())
    }

    fn member(&self) -> Option<Box<dyn ParametrisedMechanism + '_>> {
        let (family, values) = self.family.as_ref()?;
        Some(Shapes::member(&self.system, &(), family, *values))
    }
}

/// The system of a model. If the text gives no basis, the system has one for the neighbourhood of its start. Returns `None` if the model
/// exceeds [`MOST_COORDINATES`] or [`MOST_CONSTRAINTS`].
#[must_use]
pub fn started(model: &Arc<TextModel>, start: &TextStart) -> Option<Box<dyn TextMechanics>> {
    in_shape(model, start, None)
}

impl Family {
    /// The system of a member of the family, as [`started`].
    #[must_use]
    pub fn started(&self, start: &TextStart) -> Option<Box<dyn TextMechanics>> {
        in_shape(&self.member, start, Some(self))
    }
}

/// The system in the first shape that has room for it; each shape is compiled once. The last shape has room for twelve coordinates with any
/// number of constraints up to six.
fn in_shape(model: &Arc<TextModel>, start: &TextStart, family: Option<&Family>) -> Option<Box<dyn TextMechanics>> {
    let shapes = [shaped::<3, 1>, shaped::<4, 2>, shaped::<6, 3>, shaped::<8, 4>, shaped::<12, 6>, shaped::<18, 6>];
    shapes.into_iter().find_map(|shaped| shaped(model, start, family))
}

fn shaped<const N: usize, const M: usize>(
    model: &Arc<TextModel>,
    start: &TextStart,
    family: Option<&Family>,
) -> Option<Box<dyn TextMechanics>>
where
    Shapes: CompiledShape<N, M>,
{
    let system = TextSystem::<N, M>::new(Arc::clone(model), 0.0, &start.q)?;
    let family = family.and_then(|family| Some((family.shaped(0.0, &start.q)?, *family.values())));
    Some(Box::new(Shaped { system, family }))
}
