//! What effects of a scene do not go with each other, or with the sleigh.

use super::{EffectInfo, SceneEffect};
use crate::error::SceneError;
use crate::table::TomlTable;
use sleigh::{Sleigh, TimeFunction};

/// Refuses imposed velocities whose kinetic energy is too large for a number.
pub(super) fn check_energy(table: &TomlTable<'_>, effect: &SceneEffect, sleigh: &Sleigh) -> Result<(), SceneError> {
    let SceneEffect::Servo { speed, turn_rate } = effect else { return Ok(()) };
    let inertia = sleigh.inertia() + sleigh.mass() * sleigh.offset().powi(2);
    for (key, function, mass, unit) in
        [("speed", speed, sleigh.mass(), "m/s"), ("turn_rate", turn_rate, inertia, "rad/s")]
    {
        let largest = function.as_ref().map_or(0.0, TimeFunction::largest);
        if !(0.5 * mass * largest * largest).is_finite() {
            let most = (f64::MAX / mass.max(1.0)).sqrt();
            let accepted = format!("values from -L to L with L = {most:.3e}, in {unit}");
            return Err(table.wrong(key, "makes the kinetic energy too large for a number", accepted));
        }
    }
    Ok(())
}

/// Refuses what does not go together: a second body, two ways to impose a velocity, what the sleigh cannot do.
pub(super) fn check_company(
    table: &TomlTable<'_>,
    (info, new): (&EffectInfo, &SceneEffect),
    others: &[SceneEffect],
    offset: f64,
) -> Result<(), SceneError> {
    if info.only_once && others.iter().any(|other| other.kind() == info.name) {
        return Err(table.wrong("kind", "is given twice", format!("one `{}` in a scene", info.name)));
    }
    let imposes = |effect: &SceneEffect| matches!(effect, SceneEffect::Servo { .. } | SceneEffect::Tracer { .. });
    if imposes(new) && others.iter().any(imposes) {
        let problem = "imposes velocities that another effect imposes already";
        return Err(table.wrong("kind", problem, "either a `servo` or a `tracer`".to_owned()));
    }
    if matches!(new, SceneEffect::Tracer { .. }) && offset == 0.0 {
        let problem = "cannot lead a centre of mass that lies at the blade, since the blade does not move sideways";
        return Err(table.wrong("kind", problem, "a `tracer` where `sleigh.offset` is not 0".to_owned()));
    }
    Ok(())
}
