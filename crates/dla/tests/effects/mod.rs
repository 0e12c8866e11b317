//! The effects on the sleigh: three computations of the same motions, closed forms, what is kept, and runs in pieces.

mod balance;
mod braking;
mod closed_forms;
mod flywheel;
mod golden;
mod hand;
mod parts;
mod potentials;
mod strength;
mod tools;
mod turntable;
mod typed;
