//! Nonholonomic systems of the literature, each with what is known of it.
//!
//! A [`Model`] is a [`System`](lagrangian::System) with a source, a standard start, labels, invariants, its closed form
//! where there is one, and its accelerations written a second time, by hand from the reduced equations. The tests hold
//! the two texts of each model against each other, and its labels, invariants and closed form against both.
//!
//! ```
//! use models::{Model, RollingDisk};
//!
//! let disk = RollingDisk::new(1.0, 0.5, 0.125, 0.0625)?;
//! let (q, v) = disk.start();
//! assert!(lagrangian::constraint_residual(&disk, 0.0, &q, &v).iter().all(|slip| slip.abs() < 1e-15));
//! assert!(disk.labels().integrable && disk.exact(1.0).is_some());
//! # Ok::<(), models::ModelError>(())
//! ```
//!
//! Rigid bodies that turn in space have their attitude by a unit quaternion, [`Attitude`], so that no coordinates of these models
//! end anywhere. A model whose coordinates do says so by [`Model::regularity`], and is run by `dla::InChart`, which asks it.
//!
//! SI units, angles in radians. This crate knows no integrator.

mod ball;
mod chaplygin_ball;
mod compound_pendulum;
mod contact_oscillator;
mod error;
mod gauged_oscillator;
mod isokinetic;
mod knife_edge;
mod model;
mod particle;
mod quartic_oscillator;
mod roller_racer;
mod rolling_disk;
mod sleigh_on_arm;
mod snakeboard;
mod special;
mod suslov;
mod turntable_ball;

pub use chaplygin_ball::ChaplyginBall;
pub use compound_pendulum::CompoundPendulum;
pub use contact_oscillator::ContactOscillator;
pub use error::ModelError;
pub use gauged_oscillator::GaugedOscillator;
pub use isokinetic::IsokineticParticle;
pub use knife_edge::KnifeEdge;
pub use lagrangian::Attitude;
pub use model::{Labels, Model, ModelState};
pub use particle::Particle;
pub use quartic_oscillator::QuarticOscillator;
pub use roller_racer::RollerRacer;
pub use rolling_disk::RollingDisk;
pub use sleigh_on_arm::SleighOnArm;
pub use snakeboard::Snakeboard;
pub use suslov::Suslov;
pub use turntable_ball::TurntableBall;
