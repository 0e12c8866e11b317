//! Scenes with trailers: assemblies, whose number of coordinates is not known to the compiler.

mod account;
mod columns;
mod compare;
mod in_memory;
mod precision;
mod run;

pub(crate) use columns::followers;
pub(crate) use compare::compare_scene;
pub(crate) use in_memory::in_memory;
pub(crate) use precision::measure;
pub(crate) use run::run;
