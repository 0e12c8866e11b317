use super::{Guiding, Rotor, SceneSystem, SleighFamily, Started, columns};
use crate::{AnyEffect, BuildError, Column, EffectList, EffectPower, Scene, SceneEffect, StartPlace, TrailersSpec};
use assembly::parts::{Trailer, Train};
use assembly::{AssemblyError, AssemblySubject};
use dla::{Mechanism, Node, ParametrisedMechanism};
use lagrangian::With;
use sleigh::{Guided, SleighError, SleighState};

/// The train behind a sleigh with what guides it and what acts on it.
///
/// The ground is under every blade: slopes, bowls, egg crates and hills act on each centre of mass, and the plane turns below all as it
/// does below the sleigh `on_plane`. What else acts does so on the first blade, which has the rotor.
///
/// # Errors
/// [`AssemblyError`] where a trailer or the rotor has impossible parameters.
fn train(
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

/// A train in the words of its first blade.
impl SceneSystem for Train {
    fn mechanism(&self) -> Box<dyn Mechanism + '_> {
        Box::new(AssemblySubject::from(&self.assembly))
    }

    fn member<'a>(&'a self, _family: &'a SleighFamily) -> Option<Box<dyn ParametrisedMechanism + 'a>> {
        None
    }

    fn sleigh_state(&self, q: &[f64], v: &[f64]) -> SleighState {
        self.blade(q, v, 0)
    }

    /// The centre of mass of a train is not known.
    fn centre(&self, _q: &[f64]) -> [f64; 2] {
        [f64::NAN; 2]
    }

    fn rotor(&self, q: &[f64], v: &[f64]) -> Option<[f64; 2]> {
        self.rotor(q, v)
    }

    fn powers(&self, _t: f64, _q: &[f64], _v: &[f64], _lambda: &[f64]) -> Vec<EffectPower> {
        Vec::new()
    }

    fn scene_piece(&self, t: f64) -> Box<dyn SceneSystem + '_> {
        Box::new(self.smooth_piece(t))
    }

    fn columns(&self, _first: &Node) -> Vec<Column> {
        columns::of_train(self)
    }

    fn row(&self, node: &Node) -> Vec<f64> {
        columns::row_of_train(self, node)
    }

    fn train(&self) -> Option<&Train> {
        Some(self)
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

    /// The train of a scene with trailers, and its start: see [`train`].
    ///
    /// # Errors
    /// [`BuildError`] if a trailer or an effect has impossible parameters, which one read from a file has not.
    pub(super) fn train(&self) -> Result<Option<(Train, StartPlace)>, BuildError> {
        let Some(spec) = self.trailers() else { return Ok(None) };
        let trailers = (0..spec.count).map(|k| spec.trailer(k)).collect::<Result<Vec<_>, _>>()?;
        let table_rate = self.table_rate().unwrap_or(0.0);
        let on_plane = Guided::turntable(self.sleigh, table_rate)?;
        let train = train(self.guiding()?, trailers, self.rotor(), self.acting(), &on_plane)?;
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
