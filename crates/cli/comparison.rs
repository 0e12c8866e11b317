//! A comparison on one scene.

use crate::error::CliError;
use crate::table::{self, ComparisonRow};
use crate::terminal;
use harness::Drift;
use report::SceneReport;
use scene::AnyScene;

/// A comparison of more steps, of a train times its coordinates, has no computed reference, which would take longer than all of it.
pub(crate) const REFERRED: u64 = 1 << 22;

/// A comparison on one scene: the runs, method by method, with what the closed form says of them.
pub(crate) struct Comparison {
    pub(crate) rows: Vec<ComparisonRow>,
    pub(crate) report: SceneReport,
    /// How far it came, if Ctrl-C ended it.
    pub(crate) interrupted: Option<String>,
}

impl Comparison {
    /// Prints its table.
    pub(crate) fn print(&self, scene: &AnyScene) -> Result<(), CliError> {
        let head = (scene.title(), scene.name(), scene.run().duration);
        let table = table::comparison(head, &self.rows, self.interrupted.as_deref(), terminal::width());
        terminal::print(&table)
    }
}

/// The methods whose energy error starts smaller and becomes larger, each with the length of run (s) from which it is so.
pub(crate) fn better_than<'a>(drift: &Drift, others: &[(&'a str, Drift)]) -> Vec<(&'a str, f64)> {
    others.iter().filter_map(|(name, other)| Some((*name, drift.better_from(other)?))).collect()
}

/// The message if a signal came after all methods.
pub(crate) const WITHOUT_REFERENCE: &str =
    "all methods finished, the reference of their ends did not: there are no end errors";
