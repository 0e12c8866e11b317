use super::effect::SceneEffect;
use super::readers;
use crate::error::SceneError;
use crate::table::TomlTable;

/// A kind of effect: all that scenes, the program and its documents say of it is made from its row.
#[derive(Debug, Clone, Copy)]
pub struct EffectInfo {
    /// The name in files.
    pub name: &'static str,
    /// Its keys, beside `kind`.
    pub keys: &'static [&'static str],
    /// What the effect does, in a few words.
    pub summary: &'static str,
    /// Whether a scene may have only one effect of this kind, as for effects that replace the body.
    pub only_once: bool,
    /// Reads its keys.
    pub(super) read: fn(&TomlTable<'_>) -> Result<SceneEffect, SceneError>,
}

/// Every kind of effect, in the order of the documentation.
pub const EFFECTS: &[EffectInfo] = &[
    EffectInfo {
        name: "slope",
        keys: &["gravity"],
        summary: "uniform tangential gravity, gravity = [gx, gy] in m/s^2",
        only_once: false,
        read: readers::slope,
    },
    EffectInfo {
        name: "bowl",
        keys: &["stiffness", "center"],
        summary: "quadratic well at the centre of mass, stiffness = [kx, ky] in N/m",
        only_once: false,
        read: readers::bowl,
    },
    EffectInfo {
        name: "egg_crate",
        keys: &["height", "wave_number"],
        summary: "periodic landscape V0 (cos(kx X) + cos(ky Y))",
        only_once: false,
        read: readers::egg_crate,
    },
    EffectInfo {
        name: "hills",
        keys: &["hills"],
        summary: "Gaussian hills, each {height, x, y, width}",
        only_once: false,
        read: readers::hills,
    },
    EffectInfo {
        name: "flywheel",
        keys: &["inertia", "rotor_rate", "torque"],
        summary: "rotor on the sleigh, free or with a motor torque",
        only_once: true,
        read: readers::flywheel,
    },
    EffectInfo {
        name: "drag",
        keys: &["along", "turning"],
        summary: "viscous drag along the blade and against turning",
        only_once: false,
        read: readers::drag,
    },
    EffectInfo {
        name: "quadratic_drag",
        keys: &["along", "turning"],
        summary: "drag by the square of the speed, and of the turn rate",
        only_once: false,
        read: readers::quadratic_drag,
    },
    EffectInfo {
        name: "friction",
        keys: &["along", "smoothing", "turning", "turning_smoothing"],
        summary: "Coulomb friction or rolling resistance along the blade and against turning, smoothed at rest",
        only_once: false,
        read: readers::friction,
    },
    EffectInfo {
        name: "thrust",
        keys: &["force"],
        summary: "force along the blade, constant or a function of time",
        only_once: false,
        read: readers::thrust,
    },
    EffectInfo {
        name: "torque",
        keys: &["torque"],
        summary: "torque on the heading, constant or a function of time",
        only_once: false,
        read: readers::torque,
    },
    EffectInfo {
        name: "moving_mass",
        keys: &["mass", "x", "y"],
        summary: "a mass moved in the body along a given path",
        only_once: false,
        read: readers::moving_mass,
    },
    EffectInfo {
        name: "servo",
        keys: &["speed", "turn_rate"],
        summary: "imposed speed, turn rate or both",
        only_once: true,
        read: readers::servo,
    },
    EffectInfo {
        name: "tracer",
        keys: &["path"],
        summary: "centre of mass led along a closed path: the planimeter",
        only_once: true,
        read: readers::tracer,
    },
    EffectInfo {
        name: "turntable",
        keys: &["rate"],
        summary: "a plane that turns about the origin",
        only_once: true,
        read: readers::turntable,
    },
    EffectInfo {
        name: "trailers",
        keys: &["count", "mass", "inertia", "offset", "hitch", "bar", "headings"],
        summary: "a train of further blades, each hinged to the one before it",
        only_once: true,
        read: readers::trailers,
    },
];
