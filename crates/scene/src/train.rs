use crate::{BuildError, Scene, SceneEffect, StartPlace, TrailersSpec};
use assembly::parts::{Trailer, Train};
use sleigh::{Guided, SleighError, SleighState};
use systems::Started;

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

    /// The train of a scene with trailers, and its start: see [`systems::train`].
    ///
    /// # Errors
    /// [`BuildError`] if a trailer or an effect has impossible parameters, which one read from a file has not.
    pub(crate) fn train(&self) -> Result<Option<(Train, StartPlace)>, BuildError> {
        let Some(spec) = self.trailers() else { return Ok(None) };
        let trailers = (0..spec.count).map(|k| spec.trailer(k)).collect::<Result<Vec<_>, _>>()?;
        let table_rate = self.table_rate().unwrap_or(0.0);
        let on_plane = Guided::turntable(self.sleigh, table_rate)?;
        let train = systems::train(self.guiding()?, trailers, self.rotor()?, self.acting()?, &on_plane)?;
        let start = train.start_on_turntable(table_rate, &self.admissible_start()?, &spec.headings);
        Ok(Some((train, start)))
    }

    /// The start of the first blade, with the velocities that the scene imposes in place of those that it gives.
    fn admissible_start(&self) -> Result<SleighState, SleighError> {
        if self.imposed()?.is_none() {
            return Ok(self.start);
        }
        let Started { system, q, v } = self.first_blade()?;
        Ok(system.sleigh_state(&q, &v))
    }
}
