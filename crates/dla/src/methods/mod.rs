//! The methods.

pub(crate) mod baseline;
pub(crate) mod composition;
pub(crate) mod dla;
pub(crate) mod energy;
pub(crate) mod gauss;
pub(crate) mod gni;
pub(crate) mod hermite;
pub(crate) mod lobatto;
pub(crate) mod rebased;
pub(crate) mod reduced_flow;
pub(crate) mod taylor;
