use super::motion::{Carried, DifferentiatedMotion, of_parameter, of_start};
use super::{Asked, BLOCK, SensitivityRows, no_key, refused};
use cli::Refusal;
use harness::ParametrisedMechanics;
use lagrangian::{Gradients, Seeded};
use scene::{Built, Family, FamilySystem, TextModel, TextScene, Varied, Visitor};

struct Shaped<const N: usize, const M: usize>(FamilySystem<N, M>);

impl<const N: usize, const M: usize> ParametrisedMechanics<N, M, BLOCK> for Shaped<N, M> {
    fn at(&self, basis: u64, p: &[Seeded; BLOCK]) -> Box<dyn Gradients<N, M> + '_> {
        self.0.at(basis, p)
    }
}

/// The numbers of a run of a system of text, with their derivatives in a block of keys.
pub(super) fn rows(scene: &TextScene, asked: &Asked<'_>, keys: &[String]) -> Result<SensitivityRows, Refusal> {
    let scene = &scene.uncut();
    let found = keys.iter().map(|key| found(scene, key)).collect::<Result<Vec<_>, _>>()?;
    let parameters: Vec<String> = found.iter().filter_map(|key| key.as_ref().err()).cloned().collect();
    let family = Family::new(&scene.words, &scene.model, &parameters).map_err(|error| refused(&error))?;
    let place = |name: &String| parameters.iter().position(|other| other == name).unwrap_or(0);
    let varied: Vec<Varied> =
        found.iter().map(|key| key.clone().unwrap_or_else(|name| Varied::Parameter(place(&name)))).collect();
    let of = Of { scene, family: &family, varied: &varied, asked };
    scene.visit(of).map_err(|error| refused(&error))?
}

/// What is asked of a scene, whatever its shape.
struct Of<'a> {
    scene: &'a TextScene,
    family: &'a Family,
    varied: &'a [Varied],
    asked: &'a Asked<'a>,
}

impl Visitor for Of<'_> {
    type Output = Result<SensitivityRows, Refusal>;

    fn visit<const N: usize, const M: usize>(self, system: Built<'_, N, M>, q: [f64; N], v: [f64; N]) -> Self::Output {
        let Self { scene, family, varied, asked } = self;
        let n = scene.model.coordinates().len();
        let Some(shaped) = family.shaped::<N, M>(0.0, &scene.start.q) else {
            return Err(refused(&"the system has more coordinates than this program supports"));
        };
        let filled = |x: &[f64]| std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0));
        let start = varied.iter().map(|&varied| {
            let (dq, dv) = family.start_along(&scene.start, varied);
            let mut tangent = of_start(filled(&dq), filled(&dv));
            if let Varied::Parameter(place) = varied {
                tangent.parameters = of_parameter::<N>(place).parameters;
            }
            tangent
        });
        let told = |at: &Carried<N>| {
            let mut told = [&at.q[..n], &at.v[..n]].concat();
            told.push(at.energy(&*shaped.at(0, &at.p)));
            told.extend(family.told(at.t, &at.q[..n], &at.v[..n], &at.p));
            told
        };
        let family = &Shaped(shaped.clone());
        let motion = DifferentiatedMotion { system, family, parameters: *self.family.values(), q, v };
        motion.rows(asked, start.collect(), (&columns(&scene.model), 2 * n), told)
    }
}

/// Coordinates, rates, energy and outputs.
fn columns(model: &TextModel) -> Vec<String> {
    let names = model.coordinates().iter().map(|of| of.name.clone());
    let rates = names.clone().map(|name| format!("{name}'"));
    names.chain(rates).chain(["energy".to_owned()]).chain(model.outputs().iter().cloned()).collect()
}

/// The key in full.
pub(super) fn full_key(scene: &TextScene, key: &str) -> Option<String> {
    let name = |i: usize| scene.model.coordinates().get(i).map(|of| of.name.as_str());
    match found(scene, key).ok()? {
        Ok(Varied::Coordinate(i)) => Some(format!("start.{}", name(i)?)),
        Ok(Varied::Rate(i)) => Some(format!("start.{}'", name(i)?)),
        Ok(Varied::Parameter(_)) => None,
        Err(parameter) => Some(format!("system.parameters.{parameter}")),
    }
}

/// What a key varies: a number of the start, or else the parameter of that name.
fn found(scene: &TextScene, key: &str) -> Result<Result<Varied, String>, Refusal> {
    let names: Vec<&str> = scene.model.coordinates().iter().map(|of| of.name.as_str()).collect();
    let bare = key.strip_prefix("start.").unwrap_or(key);
    if let Some(i) = names.iter().position(|name| *name == bare) {
        return Ok(Ok(Varied::Coordinate(i)));
    }
    let rate = bare.strip_suffix('\'').or_else(|| bare.strip_suffix("_dot"));
    if let Some(i) = names.iter().position(|name| Some(*name) == rate) {
        return Ok(Ok(Varied::Rate(i)));
    }
    let bare = key.strip_prefix("system.").unwrap_or(key);
    let bare = bare.strip_prefix("parameters.").unwrap_or(bare);
    if scene.words.parameters.iter().any(|(name, _)| name == bare) {
        return Ok(Err(bare.to_owned()));
    }
    let rates = names.iter().map(|name| format!("{name}'"));
    let parameters = scene.words.parameters.iter().map(|(name, _)| name.clone());
    let known: Vec<String> = names.iter().map(|name| (*name).to_owned()).chain(rates).chain(parameters).collect();
    Err(no_key(key, &known.join(", ")))
}
