use super::AssemblyState;
use crate::Assembly;
use dla::{Checkpoint, CheckpointError};

/// The lists with one number for every coordinate.
const ONE: [&str; 4] = ["q", "rest", "turns", "v"];

/// The lists with any number of entries for a coordinate.
const SOME: [&str; 2] = ["acceleration", "past"];

/// The lists that a static state has and a coordinate of an assembly has not.
const NONE: [&str; 4] = ["xi", "pi", "pi_rest", "closed"];

impl AssemblyState {
    /// Writes every bit that the next step depends on to a checkpoint.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        let each: Vec<Checkpoint> = self.coordinates.iter().map(saved).collect();
        for name in ONE.into_iter().chain(SOME) {
            let lists: Vec<Vec<f64>> = each.iter().map(|own| own.list(name).unwrap_or_default()).collect();
            checkpoint.put(name, &lists.concat());
            if SOME.contains(&name) {
                let counts: Vec<f64> = lists.iter().map(|list| list.len() as f64).collect();
                checkpoint.put(&format!("{name}_counts"), &counts);
            }
        }
    }

    /// The state that [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// [`CheckpointError`] if the checkpoint has no state with the number of coordinates of the assembly.
    pub fn load(checkpoint: &Checkpoint, assembly: &Assembly) -> Result<Self, CheckpointError> {
        let count = assembly.coordinates();
        let mut each = vec![Checkpoint::default(); count];
        for name in ONE.into_iter().chain(SOME) {
            let missing = || CheckpointError::Missing { name: name.to_owned(), count };
            let list = checkpoint.list(name)?;
            let counts =
                if SOME.contains(&name) { checkpoint.list(&format!("{name}_counts"))? } else { vec![1.0; count] };
            if counts.len() != count {
                return Err(missing());
            }
            let mut rest = &list[..];
            for (own, count) in each.iter_mut().zip(&counts) {
                let (first, after) = rest.split_at_checked(*count as usize).ok_or_else(missing)?;
                own.put(name, first);
                rest = after;
            }
        }
        for own in &mut each {
            NONE.iter().for_each(|name| own.put(name, &[]));
        }
        let loaded = assembly.angles().iter().zip(&each).map(|(angle, own)| dla::State::load(own, [*angle]));
        loaded.collect::<Result<_, _>>().map(Self::of)
    }
}

fn saved(coordinate: &dla::State<1>) -> Checkpoint {
    let mut own = Checkpoint::default();
    coordinate.save(&mut own);
    own
}
