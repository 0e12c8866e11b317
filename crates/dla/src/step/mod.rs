//! What a step is: the state that it moves, its report and its errors.

pub(crate) mod assembly_fault;
pub(crate) mod closed_step_error;
pub(crate) mod hint;
pub(crate) mod one_step;
pub(crate) mod resolved;
pub(crate) mod runaway;
pub(crate) mod stack;
pub(crate) mod state;
