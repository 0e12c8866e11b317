use crate::multipliers::multipliers_along;
use crate::slices::TextSlices;
use crate::tapes::TapePoint;
use crate::{TextError, TextFunctions, TextModel, Words};
use dla::{ParametrisedMechanics, ReducedSeries};
use expression::formulas::{Formulas, Parameters};
use lagrangian::{AdmissibleBasis, Along, Constraint, Dual, Gradients, Scalar, Seeded};
use std::array::from_fn;
use std::sync::Arc;

/// Maximum number of free parameters: as many as a number carries directions.
pub const FREE: usize = dla::PARAMETERS;

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
        let (t, mut all) = (Seeded::constant(t), p.to_vec());
        if let Some(parameters) = self.free.before_multipliers {
            all.truncate(parameters);
            all.extend(multipliers_along(TextSlices { model: &self.free, sides: &[], p }, t, q, v));
        }
        let at = TapePoint { t, q, v, p: &all, sides: &[] };
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
        Box::new(SeededText { functions: self.0.rebased(basis), p: p.to_vec() })
    }

    fn series(&self, basis: u64) -> Result<ReducedSeries, &'static str> {
        let series = self.0.rebased(basis).series()?;
        Ok(ReducedSeries { constants: (series.constants.0, Arc::new([0.0; FREE])), ..series })
    }
}

/// The functions of a system of text on numbers with derivatives, at these values of the parameters that its model leaves free.
pub(crate) struct SeededText<const N: usize, const M: usize> {
    pub(crate) functions: TextFunctions<N, M>,
    pub(crate) p: Vec<Seeded>,
}

impl<const N: usize, const M: usize> SeededText<N, M> {
    fn fixed(&self) -> Vec<Along> {
        self.p.iter().map(|p| Dual::fixed(*p)).collect()
    }
}

impl<const N: usize, const M: usize> Gradients<N, M> for SeededText<N, M> {
    fn lagrangian(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> Seeded {
        self.functions.lagrangian_at(&self.p, t, q, v)
    }

    fn momentum(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> [Seeded; N] {
        self.functions.momentum_at(&self.p, t, q, v)
    }

    fn momentum_rate(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N], a: &[Seeded; N]) -> [Seeded; N] {
        let along = |x: &[Seeded; N], rate: &[Seeded; N]| from_fn(|i| Dual { re: x[i], eps: [rate[i]] });
        let t = Dual { re: t, eps: [Seeded::constant(1.0)] };
        self.functions.momentum_at(&self.fixed(), t, &along(q, v), &along(v, a)).map(|p: Along| p.eps[0])
    }

    fn slope(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> [Seeded; N] {
        self.functions.slopes_at(&self.p, t, q, v)[0]
    }

    fn force(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> Option<[Seeded; N]> {
        self.functions.force_at(&self.p, t, q, v)
    }

    fn constraint_along(&self, t: Along, q: &[Along; N]) -> Constraint<Along, N, M> {
        self.functions.constraint_at(&self.fixed(), t, q)
    }

    fn basis_along(&self, t: Along, q: &[Along; N]) -> Option<AdmissibleBasis<Along, N, M>> {
        Some(self.functions.basis_at(&self.fixed(), t, q))
    }

    fn holonomic(&self, t: Seeded, q: &[Seeded; N]) -> Option<[Option<Seeded>; M]> {
        self.functions.holonomic_at(&self.p, t, q)
    }

    fn nonlinear(&self, _t: Seeded, _q: &[Seeded; N], _v: &[Seeded; N]) -> Option<[Option<Dual<Seeded, N>>; M]> {
        None
    }
}
