use crate::tapes::TapePoint;
use crate::{TextError, TextFunctions, TextModel, Words};
use dla::ParametrisedMechanics;
use expression::formulas::{Formulas, Parameters};
use lagrangian::{AdmissibleBasis, Constraint, Gradients, Parametrised, Scalar, Seeded, SeededMember, System};
use std::array::from_fn;
use std::sync::Arc;

/// Maximum number of free parameters: as many as a number carries directions.
pub const FREE: usize = 8;

/// The system of some texts as a function of a few of its parameters.
///
/// The texts are derived once more with these parameters as variables, so their values are not folded into the formulas.
#[derive(Debug, Clone)]
pub struct Family {
    /// The system with a value for each parameter.
    pub(crate) member: Arc<TextModel>,
    /// The system with the parameters as variables.
    pub(crate) free: Arc<TextModel>,
    /// The values of the parameters.
    pub(crate) values: [f64; FREE],
}

impl Family {
    /// The family of the system of `words` in the parameters with these names, at most [`FREE`]. `member` is the system itself.
    ///
    /// # Errors
    /// [`TextError`] if the texts make no system.
    pub fn new(words: &Words, member: &Arc<TextModel>, parameters: &[String]) -> Result<Self, TextError> {
        let names = parameters.get(..FREE).unwrap_or(parameters);
        let value = |name: &String| words.parameters.iter().find(|(other, _)| other == name).cloned();
        let free: Vec<(String, f64)> = names.iter().filter_map(value).collect();
        // What is not free is an abbreviation for its number.
        let fixed = words.parameters.iter().filter(|(name, _)| !names.contains(name));
        let mut texts = words.clone();
        texts.abbreviations = fixed.map(|(name, value)| (name.clone(), format!("{value:?}"))).collect();
        texts.abbreviations.extend(words.abbreviations.iter().cloned());
        texts.parameters.clone_from(&free);
        let model = TextModel::of(&texts, Formulas::of(&texts, Parameters::Variables)?, member.eliminations.clone())?;
        let values = from_fn(|k| free.get(k).map_or(0.0, |(_, value)| *value));
        Ok(Self { member: Arc::clone(member), free: Arc::new(model), values })
    }

    /// The values of the parameters, followed by zeros.
    #[must_use]
    pub fn values(&self) -> &[f64; FREE] {
        &self.values
    }

    /// The family as systems of this shape. If the text gives no basis, they have one for the neighbourhood of `q` at the time `t` (s).
    /// Returns `None` if the shape has no room for the system.
    #[must_use]
    pub fn shaped<const N: usize, const M: usize>(&self, t: f64, q: &[f64]) -> Option<FamilySystem<N, M>> {
        let member = TextFunctions::new(Arc::clone(&self.member), t, q)?;
        Some(FamilySystem(member.of_model(&self.free)))
    }

    /// The outputs at a state.
    #[must_use]
    pub fn told(&self, t: f64, q: &[Seeded], v: &[Seeded], p: &[Seeded; FREE]) -> Vec<Seeded> {
        let mut told = vec![Seeded::zero(); self.free.outputs.len()];
        let at = TapePoint { t: Seeded::constant(t), q, v, p, sides: &[] };
        self.free.told.evaluate(self.free.coordinates.len(), at, |k, x| told[k] = x);
        told
    }
}

/// A [`Family`] with systems of `N` coordinates and `M` constraints.
#[derive(Debug, Clone, PartialEq)]
pub struct FamilySystem<const N: usize, const M: usize>(TextFunctions<N, M>);

/// The basis zero is the one it has.
impl<const N: usize, const M: usize> ParametrisedMechanics<N, M, FREE> for FamilySystem<N, M> {
    fn at(&self, basis: u64, p: &[Seeded; FREE]) -> Box<dyn Gradients<N, M> + '_> {
        Box::new(SeededMember { family: Self(self.0.rebased(basis)), parameters: *p })
    }
}

impl<const N: usize, const M: usize> Parametrised<N, M, FREE> for FamilySystem<N, M> {
    fn lagrangian<S: Scalar>(&self, p: &[S; FREE], t: S, q: &[S; N], v: &[S; N]) -> S {
        self.0.lagrangian_at(p, t, q, v)
    }

    fn constraint<S: Scalar>(&self, p: &[S; FREE], t: S, q: &[S; N]) -> Constraint<S, N, M> {
        self.0.constraint_at(p, t, q)
    }

    fn force<S: Scalar>(&self, p: &[S; FREE], t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        self.0.force_at(p, t, q, v)
    }

    fn admissible_basis<S: Scalar>(&self, p: &[S; FREE], t: S, q: &[S; N]) -> Option<AdmissibleBasis<S, N, M>> {
        Some(self.0.basis_at(p, t, q))
    }

    fn holonomic<S: Scalar>(&self, p: &[S; FREE], t: S, q: &[S; N]) -> Option<[Option<S>; M]> {
        self.0.holonomic_at(p, t, q)
    }

    fn angles(&self) -> [bool; N] {
        System::angles(&self.0)
    }
}
