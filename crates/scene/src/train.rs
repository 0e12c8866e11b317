use crate::{AnyEffect, EffectList, Scene, SceneEffect, TrailersSpec};
use assembly::parts::{Trailer, Train};
use assembly::{AssemblyError, AssemblyState};
use lagrangian::{System, With};
use sleigh::{Guided, SleighError, SleighState};
use systems::Guiding;
use thiserror::Error;

/// Why a scene makes no train, which one read from a file does.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TrainError {
    /// A sleigh or an effect of it.
    #[error(transparent)]
    Sleigh(#[from] SleighError),
    /// The assembly.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
}

/// The train behind a sleigh with what guides it and what acts on it.
fn led<Body: System<3, 1> + Send + Sync + 'static>(
    lead: Guiding,
    trailers: Vec<Trailer>,
    effects: EffectList,
    body: impl Fn(&Trailer) -> Body,
) -> Result<Train, AssemblyError> {
    match lead {
        // As another body it would be compiled once more, for one blade of many.
        Guiding::None(lead) => Train::new(With { body: Guided::from(lead), effects }, trailers, body),
        Guiding::Zero(lead) => Train::new(With { body: lead, effects }, trailers, body),
        Guiding::One(lead) => Train::new(With { body: lead, effects }, trailers, body),
        Guiding::Two(lead) => Train::new(With { body: lead, effects }, trailers, body),
    }
}

impl TrailersSpec {
    /// The trailer, counted from 0.
    fn trailer(&self, k: usize) -> Result<Trailer, SleighError> {
        let own = |list: &[f64]| list.get(k).or(list.first()).copied().unwrap_or(f64::NAN);
        let [mass, inertia, offset] = [&self.mass, &self.inertia, &self.offset].map(|list| own(list));
        Trailer::new(mass, inertia, offset, own(&self.hitch), own(&self.bar))
    }
}

impl Scene {
    /// Whether blades follow the sleigh: the scene is then an assembly.
    #[must_use]
    pub fn has_trailers(&self) -> bool {
        self.trailers().is_some()
    }

    /// The trailers as the scene has them.
    #[must_use]
    pub fn trailers(&self) -> Option<&TrailersSpec> {
        self.effects.iter().find_map(|effect| if let SceneEffect::Trailers(spec) = effect { Some(spec) } else { None })
    }

    /// The train of a scene with trailers, and its start.
    ///
    /// The ground is under every blade: slopes, bowls, egg crates and hills act on each centre of mass, and a turntable turns below all.
    /// What else acts does so on the first blade.
    ///
    /// # Errors
    /// [`TrainError`] where a trailer or an effect has impossible parameters, which one read from a file has not.
    pub fn train(&self) -> Result<Option<(Train, AssemblyState)>, TrainError> {
        let Some(spec) = self.trailers() else { return Ok(None) };
        let trailers = (0..spec.count).map(|k| spec.trailer(k)).collect::<Result<Vec<_>, _>>()?;
        let effects = self.acting()?;
        let ground: Vec<AnyEffect> = effects.iter().filter(|effect| effect.is_ground()).cloned().collect();
        let (effects, ground) = (EffectList::from(effects), EffectList::from(ground));
        let table_rate = self.table_rate();
        let train = if let Some(rate) = table_rate {
            let table = Guided::turntable(self.sleigh, rate)?;
            let body = |trailer: &Trailer| With { body: table.with_sleigh(trailer.sleigh), effects: ground.clone() };
            led(self.guiding()?, trailers, effects, body)?
        } else {
            led(self.guiding()?, trailers, effects, |trailer| With { body: trailer.sleigh, effects: ground.clone() })?
        };
        let start = train.start_on_turntable(table_rate.unwrap_or(0.0), &self.driven_start()?, &spec.headings);
        Ok(Some((train, start)))
    }

    /// The start, with the velocities that a servo imposes in place of those of the scene.
    fn driven_start(&self) -> Result<SleighState, SleighError> {
        let mut start = self.start;
        for effect in &self.effects {
            if let SceneEffect::Servo { speed, turn_rate } = effect {
                for (place, function) in [(&mut start.speed, speed), (&mut start.turn_rate, turn_rate)] {
                    if let Some(function) = function {
                        *place = function.build()?.value(0.0_f64);
                    }
                }
            }
        }
        Ok(start)
    }
}
