//! Steps that are made in parts: how a step is divided, and when it resolves the motion.

mod divided;
mod halved;
