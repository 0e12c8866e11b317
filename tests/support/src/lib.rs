//! Systems of the literature, each with a start and what is known of its motion, for the tests of several crates.
//!
//! Bodies that turn in space, constraints on positions and a constraint on the speed are written in Rust; all others are texts.

mod attitude;
mod ball;
mod chaplygin_ball;
mod compound_pendulum;
mod isokinetic;
mod model;
mod sleigh_on_arm;
mod special;
mod suslov;
mod tests;
mod texts;
mod turntable_ball;

#[doc(hidden)]
pub use lagrangian;

pub use attitude::Attitude;
pub use chaplygin_ball::ChaplyginBall;
pub use compound_pendulum::CompoundPendulum;
pub use isokinetic::IsokineticParticle;
pub use model::{Model, ModelState};
pub use sleigh_on_arm::SleighOnArm;
pub use suslov::Suslov;
pub use texts::{ContactOscillator, KnifeEdge, Particle, QuarticOscillator, RollerRacer, RollingDisk, Snakeboard};
pub use turntable_ball::TurntableBall;
