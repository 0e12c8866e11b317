//! Assemblies of many bodies: the discrete Lagrange-d'Alembert principle for systems of thousands of coordinates.
//!
//! An [`Assembly`] is a list of elements, each a small static [`System`](lagrangian::System) or a [`Joint`] on coordinates that
//! it shares with others. Its equations are sparse: [`SparseDla`] finds their pattern once and solves them with `faer`, so that a step
//! of a chain costs time and memory in proportion to its length.
//!
//! Ready parts are in [`parts`].

mod assembly;
mod composition;
mod contributions;
mod dla;
mod element;
mod element_system;
mod equations;
mod error;
mod factor;
mod impulse;
mod joint;
mod linear;
mod local;
mod measures;
mod motion;
mod one_step;
pub mod parts;
mod pattern;
mod projection;
mod settling;
mod singular;
mod state;
mod subject;
mod system_element;
mod terms;
mod work;

pub use crate::assembly::Assembly;
pub use crate::dla::SparseDla;
pub use crate::error::AssemblyError;
pub use composition::SparseComposition;
pub use element::{Element, ElementBlocks};
pub use factor::Solver;
pub use joint::Joint;
pub use local::WIDEST;
pub use one_step::{AssemblyMethod, assembly_method};
pub use state::AssemblyState;
pub use subject::AssemblySubject;
