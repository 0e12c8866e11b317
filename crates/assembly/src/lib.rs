//! Assemblies of many bodies: the discrete Lagrange-d'Alembert principle for systems of thousands of coordinates.
//!
//! An [`Assembly`] is a list of elements, each a small static [`System`](lagrangian::System) or a [`Joint`] on coordinates that
//! it shares with others. Its equations are sparse: [`SparseDla`] finds their pattern once and solves them with `faer`, so that a step
//! of a chain costs time and memory in proportion to its length.
//!
//! Ready parts are in [`parts`].

mod assembly;
mod contributions;
mod dla;
mod element;
mod equations;
mod error;
mod factor;
mod joint;
mod linear;
mod measures;
mod method;
mod motion;
pub mod parts;
mod pattern;
mod state;
mod subject;
mod system_element;
mod work;

pub use crate::assembly::Assembly;
pub use crate::dla::SparseDla;
pub use crate::error::AssemblyError;
pub use element::{Element, ElementBlocks, WIDEST};
pub use factor::Solver;
pub use joint::Joint;
pub use method::{AssemblyMethod, SparseComposition, assembly_method};
pub use state::AssemblyState;
pub use subject::AssemblySubject;
