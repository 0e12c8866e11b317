/// A scene that is part of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bundled {
    /// The name under which [`Scene::load`](crate::Scene::load) finds it.
    pub name: &'static str,
    /// Its text, with comments.
    pub text: &'static str,
}

macro_rules! bundle {
    ($($name:literal),* $(,)?) => {
        &[$(Bundled { name: $name, text: include_str!(concat!("../../../docs/scenes/", $name, ".toml")) }),*]
    };
}

/// Every bundled scene, in the order in which to present them.
#[must_use]
pub fn bundled() -> &'static [Bundled] {
    bundle![
        "turnaround",
        "straight",
        "circle",
        "bowl",
        "valley",
        "egg-crate",
        "egg-crate-chaos",
        "egg-crate-attractor",
        "hills",
        "skate",
        "braking",
        "thrust-well",
        "flywheel",
        "shaker",
        "shaker-friction",
        "parking",
        "planimeter",
        "turntable",
    ]
}

/// What a scene may say, as a JSON schema: keys, types, units in parentheses at the end of each description.
pub const SCHEMA: &str = include_str!("../../../docs/scene.schema.json");

/// Every bundled scene of a system of text, in the order in which to present them.
#[must_use]
pub fn bundled_texts() -> &'static [Bundled] {
    bundle![
        "knife-edge",
        "rolling-disk",
        "falling-disk",
        "snakeboard",
        "roller-racer",
        "two-wheeled-robot",
        "wheelchair",
        "car-and-trailer",
        "chaplygin-ball",
        "ball-on-turntable",
        "ball-in-bowl",
        "bicycle",
    ]
}

/// The bundled scene of that name, of either kind; underscores in a name are taken for hyphens, as effects are spelled with them.
pub(crate) fn named(name: &str) -> Option<&'static Bundled> {
    let name = name.replace('_', "-");
    bundled().iter().chain(bundled_texts()).find(|scene| scene.name == name)
}

pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    bundled().iter().chain(bundled_texts()).map(|scene| scene.name)
}

pub(crate) const TEMPLATE: &str = include_str!("template.toml");
