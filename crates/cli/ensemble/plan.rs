use super::identity;
use super::members::method_of;
use super::parts::{name, stem};
use super::share::Share;
use crate::error::CliError;
use crate::in_memory::Refusal;
use crate::inspect;
use scene::Sweep;

/// The parts that a sweep is computed in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SweepPlan {
    /// The beginning of the names of its files: a hash of all that its rows depend on, and the version of the program.
    pub stem: String,
    /// How many members there are.
    pub members: u64,
    /// The names of the files of the parts, in order.
    pub parts: Vec<String>,
}

/// Splits the sweep in the file `sweep` into `parts` parts, or one part per member if there are fewer members.
///
/// # Errors
/// [`Refusal`] with the first error of the sweep, or if `parts` is zero.
pub fn plan(sweep: &str, parts: u64) -> Result<SweepPlan, Refusal> {
    Ok(made(sweep, parts)?)
}

fn made(sweep: &str, parts: u64) -> Result<SweepPlan, CliError> {
    if parts == 0 {
        return Err(CliError::Request("0 parts: accepted are whole numbers from 1".to_owned()));
    }
    let names = inspect::method_names();
    let sweep = Sweep::load(sweep, &names)?;
    method_of(&sweep, sweep.scene.run())?;
    let (stem, members) = (stem(&identity(&sweep)), sweep.count());
    let of = parts.min(members);
    let part = |number| name(&stem, &Share::new(number, of).members(members));
    Ok(SweepPlan { parts: (1..=of).map(part).collect(), stem, members })
}
