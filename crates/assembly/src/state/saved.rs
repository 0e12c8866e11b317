use super::State;
use crate::Assembly;
use dla::{Checkpoint, CheckpointError};

/// What each coordinate is saved as.
const NAMES: [&str; 5] = ["q", "rest", "turns", "v", "acceleration"];

/// What a static state has beside, and a coordinate of an assembly does not.
const NONE: [&str; 4] = ["xi", "pi", "pi_rest", "past"];

impl State {
    /// Writes every bit that the next step depends on to a checkpoint.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        let mut lists: [Vec<f64>; 5] = Default::default();
        for coordinate in &self.coordinates {
            let mut own = Checkpoint::default();
            coordinate.save(&mut own);
            for (list, name) in lists.iter_mut().zip(NAMES) {
                // An acceleration that is not known is no number.
                list.push(own.list(name).ok().and_then(|own| own.first().copied()).unwrap_or(f64::NAN));
            }
        }
        for (list, name) in lists.iter().zip(NAMES) {
            checkpoint.put(name, list);
        }
    }

    /// The state that [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// [`CheckpointError`] where the checkpoint has none of so many coordinates.
    pub fn load(checkpoint: &Checkpoint, assembly: &Assembly) -> Result<Self, CheckpointError> {
        let count = assembly.coordinates();
        let list = |name: &str| {
            let list = checkpoint.list(name)?;
            if list.len() == count { Ok(list) } else { Err(CheckpointError::Missing { name: name.to_owned(), count }) }
        };
        let mut lists = Vec::new();
        for name in NAMES {
            lists.push((name, list(name)?));
        }
        let coordinate = |(i, angle): (usize, &bool)| {
            let mut own = Checkpoint::default();
            for (name, list) in &lists {
                own.put(name, if list[i].is_nan() { &[] } else { std::slice::from_ref(&list[i]) });
            }
            NONE.iter().for_each(|name| own.put(name, &[]));
            dla::State::load(&own, [*angle])
        };
        Ok(Self { coordinates: assembly.angles().iter().enumerate().map(coordinate).collect::<Result<_, _>>()? })
    }
}
