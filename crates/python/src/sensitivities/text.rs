use super::motion::{Carried, DifferentiatedMotion, of_parameter, of_start};
use super::{Asked, SensitivityRows, no_key, refused};
use cli::Refusal;
use dla::AnyTangent;
use scene::{Built, Family, TextModel, TextScene, Varied};

/// The numbers of a run of a system of text, with their derivatives in a block of keys.
pub(super) fn rows(scene: &TextScene, asked: &Asked<'_>, keys: &[String]) -> Result<SensitivityRows, Refusal> {
    let scene = &scene.uncut();
    let found = keys.iter().map(|key| found(scene, key)).collect::<Result<Vec<_>, _>>()?;
    let parameters: Vec<String> = found.iter().filter_map(|key| key.as_ref().err()).cloned().collect();
    let family = Family::new(&scene.words, &scene.model, &parameters).map_err(|error| refused(&error))?;
    let place = |name: &String| parameters.iter().position(|other| other == name).unwrap_or(0);
    let varied: Vec<Varied> =
        found.iter().map(|key| key.clone().unwrap_or_else(|name| Varied::Parameter(place(&name)))).collect();
    let built = scene.built_in(&family).map_err(|error| refused(&error))?;
    let system = built.system();
    let Some(member) = (if let Built::Text(text) = system { text.member() } else { None }) else {
        return Err(refused(&"the steps of trains and other large systems have no derivatives"));
    };
    let n = scene.model.coordinates().len();
    let start = varied.iter().map(|&varied| {
        let (dq, dv) = family.start_along(&scene.start, varied);
        match varied {
            Varied::Parameter(place) => AnyTangent { q: dq, v: dv, ..of_parameter(place) },
            _ => of_start(dq, dv),
        }
    });
    let told = |at: &Carried<'_>| {
        let mut told = [&at.q[..n], &at.v[..n]].concat();
        told.push(at.energy());
        told.extend(family.told(at.t, &at.q[..n], &at.v[..n], &at.p));
        told
    };
    let (q, v) = (built.q.clone(), built.v.clone());
    let motion = DifferentiatedMotion { system, family: &*member, q, v };
    motion.rows(asked, start.collect(), (&columns(&scene.model), 2 * n), told)
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
