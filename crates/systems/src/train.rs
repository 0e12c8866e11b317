use crate::{AnyEffect, EffectList, Guiding, Rotor};
use assembly::AssemblyError;
use assembly::parts::{Trailer, Train};
use lagrangian::With;
use sleigh::Guided;

/// The train behind a sleigh with what guides it and what acts on it.
///
/// The ground is under every blade: slopes, bowls, egg crates and hills act on each centre of mass, and the plane turns below all as it
/// does below the sleigh `on_plane`. What else acts does so on the first blade, which has the rotor.
///
/// # Errors
/// [`AssemblyError`] where a trailer or the rotor has impossible parameters.
pub fn train(
    lead: Guiding,
    trailers: Vec<Trailer>,
    rotor: Option<Rotor>,
    effects: Vec<AnyEffect>,
    on_plane: &Guided<0>,
) -> Result<Train, AssemblyError> {
    let ground: Vec<AnyEffect> = effects.iter().filter(|effect| effect.is_ground()).cloned().collect();
    let (effects, ground) = (EffectList::from(effects), EffectList::from(ground));
    let body = |trailer: &Trailer| With { body: on_plane.with_sleigh(trailer.sleigh), effects: ground.clone() };
    let train = match lead {
        // As another body it would be compiled once more, for one blade of many.
        Guiding::None(lead) => Train::new(With { body: Guided::from(lead), effects }, trailers, body),
        Guiding::Zero(lead) => Train::new(With { body: lead, effects }, trailers, body),
        Guiding::One(lead) => Train::new(With { body: lead, effects }, trailers, body),
        Guiding::Two(lead) => Train::new(With { body: lead, effects }, trailers, body),
    }?;
    match rotor {
        Some(Rotor { inertia, rate, torque }) => train.with_rotor(inertia, rate, torque),
        None => Ok(train),
    }
}
