use crate::element::TextElement;
use crate::family::FamilySystem;
use crate::{FREE, Family, TextFunctions, TextModel, TextStart, TextSystem};
use assembly::{Assembly, AssemblySubject};
use dla::{CompiledShape, Mechanism, ParametrisedMechanism, Shapes};
use std::fmt;
use std::sync::Arc;

/// Whether some shape has room for this number of coordinates and constraints.
pub(crate) const fn has_shape(coordinates: usize, constraints: usize) -> bool {
    TextFunctions::<18, 6>::has_room(coordinates, constraints)
}

/// A system of text in one of a few shapes, each of which is compiled once, or, if none has room for it, in its own size.
///
/// The mechanism has the coordinates and constraints of the model, and perhaps more behind them that pad the system to its shape: these
/// begin at rest at zero, and stay there. A system in its own size has no reduced equations; `dla` and its compositions run it.
pub struct TextMechanics(Shape);

/// A shape `(N, M)` has room for `n` coordinates and `m` constraints if `n <= N`, `m <= M` and `n - m <= N - M`.
enum Shape {
    Small(Shaped<4, 2>),
    Middle(Shaped<8, 5>),
    Large(Shaped<12, 6>),
    /// It has room for whatever one of the others has room for.
    Largest(Shaped<18, 6>),
    Own(InOwnSize),
}

/// Evaluates an expression of the system in its shape.
macro_rules! in_its_shape {
    ($shape:expr, $shaped:ident => $value:expr) => {
        match $shape {
            Shape::Small($shaped) => $value,
            Shape::Middle($shaped) => $value,
            Shape::Large($shaped) => $value,
            Shape::Largest($shaped) => $value,
            Shape::Own($shaped) => $value,
        }
    };
}

/// A system of text in one shape.
struct Shaped<const N: usize, const M: usize> {
    system: TextSystem<N, M>,
    /// The family, with the values of its parameters.
    family: Option<(FamilySystem<N, M>, [f64; FREE])>,
}

impl TextMechanics {
    /// The system of a model. If the text gives no basis, a system in a shape has one for the neighbourhood of its start. Returns `None` if
    /// the start has fewer coordinates than the model, or the model more constraints than coordinates.
    #[must_use]
    pub fn new(model: &Arc<TextModel>, start: &TextStart) -> Option<Self> {
        Self::in_first_shape(model, start, None)
    }

    /// The system of a member of a family, as [`new`](Self::new).
    #[must_use]
    pub fn of_family(family: &Family, start: &TextStart) -> Option<Self> {
        Self::in_first_shape(&family.member, start, Some(family))
    }

    /// The system in the first shape that has room for it.
    fn in_first_shape(model: &Arc<TextModel>, start: &TextStart, family: Option<&Family>) -> Option<Self> {
        let shape = (Shaped::new(model, start, family).map(Shape::Small))
            .or_else(|| Shaped::new(model, start, family).map(Shape::Middle))
            .or_else(|| Shaped::new(model, start, family).map(Shape::Large))
            .or_else(|| Shaped::new(model, start, family).map(Shape::Largest))
            .or_else(|| InOwnSize::new(model, start).map(Shape::Own));
        shape.map(Self)
    }

    /// The model that the texts describe.
    #[must_use]
    pub fn model(&self) -> &TextModel {
        in_its_shape!(&self.0, shaped => shaped.model())
    }

    /// The system for runs.
    #[must_use]
    pub fn mechanism(&self) -> Box<dyn Mechanism + '_> {
        in_its_shape!(&self.0, shaped => shaped.mechanism())
    }

    /// The system as a member of its family ([`of_family`](Self::of_family)); `None` for any other system.
    #[must_use]
    pub fn member(&self) -> Option<Box<dyn ParametrisedMechanism + '_>> {
        in_its_shape!(&self.0, shaped => shaped.member())
    }
}

impl fmt::Debug for TextMechanics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.mechanism().fmt(f)
    }
}

impl<const N: usize, const M: usize> Shaped<N, M>
where
    Shapes: CompiledShape<N, M>,
{
    fn new(model: &Arc<TextModel>, start: &TextStart, family: Option<&Family>) -> Option<Self> {
        let system = TextSystem::new(Arc::clone(model), 0.0, &start.q)?;
        let family = family.and_then(|family| Some((family.shaped(0.0, &start.q)?, *family.values())));
        Some(Self { system, family })
    }

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

/// A system of text in its own size.
struct InOwnSize {
    model: Arc<TextModel>,
    assembly: Assembly,
}

impl InOwnSize {
    fn new(model: &Arc<TextModel>, start: &TextStart) -> Option<Self> {
        let n = model.coordinates().len();
        if model.constraints() > n || start.q.len() < n {
            return None;
        }
        let mut assembly = Assembly::new();
        assembly.part("system", TextElement::new(Arc::clone(model)));
        Some(Self { model: Arc::clone(model), assembly })
    }

    fn model(&self) -> &TextModel {
        &self.model
    }

    fn mechanism(&self) -> Box<dyn Mechanism + '_> {
        Box::new(AssemblySubject::from(&self.assembly))
    }

    fn member(&self) -> Option<Box<dyn ParametrisedMechanism + '_>> {
        None
    }
}
