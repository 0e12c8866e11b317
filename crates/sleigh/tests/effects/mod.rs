//! The effects by themselves: derivatives, what they refuse, functions of time and paths, what bodies pass on.

mod bodies;
mod closed;
mod derivatives;
mod forces;
mod guided_motion;
mod imposed;
mod own_axes;
mod paths;
mod pushed;
mod refusals;
mod time;
