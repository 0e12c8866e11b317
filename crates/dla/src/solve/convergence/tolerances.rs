//! Every tolerance by which an implicit method decides that its equations are solved.
//!
//! `eps = 2^-52` is the distance from one to the next number, `u = eps/2` the unit of rounding.
//!
//! | constant | value | from | used by |
//! |---|---|---|---|
//! | [`SETTLED`] | `4 eps` | a correction below it changes the last digits of its unknown only | Newton's method, chord method, projection |
//! | [`UNBIASED`] | `eps/64` | what a linear convergence leaves out has one sign in every step, and adds up over 10^6 of them | fixed points, frozen Jacobians, assemblies |
//! | [`HALF_A_UNIT`] | `eps/2` | as much as the rounding of the result | the implicit midpoint baseline |
//! | [`SLIGHT`] | `64 eps` | momenta `M v` are rounded to `u M v` in some tens of operations | all: cheap, asked first |
//! | [`SLIGHT_OF_FIXED_POINT`] | `1024 eps` | the same, of all stages together, twice without shrinking | fixed points |
//! | [`ROUNDINGS`] | `8` | residual over the running error bound of its terms; Newton's method attains a small multiple of one (Tisseur 2001) | all: asked where corrections stall |
//! | [`OF_CORRECTION`] | `64` | the same, with the rounding of linear equations of some tens of unknowns | Lobatto stages, assemblies, refined corrections |
//! | [`CYCLES`] | `64` | a fixed point that contracts by `L` goes round in `1/(1 - L)` roundings of its stages | fixed points |
//! | [`NEAR_ROUNDINGS`] | `64` | a start that misses its equations by so few roundings is its solution | continuation |
//! | [`BLIND`] | `1e-11` | the largest unknown, for equations that do not tell the sizes of their terms | users' own equations |
//! | [`STALL`], [`STALL_OF_FIXED_POINT`] | `1/4`, `1/2` | a correction that shrinks by less is rounding or no convergence | Newton's method; fixed points |
//! | [`SHRINKING`] | `1/8` | a frozen Jacobian that does worse is renewed | chord method |
//! | [`CONTRACTION`] | `1/4` | Newton and Kantorovich: `h0 = 2 theta <= 1/2` (Deuflhard 2004, sections 2.1 and 3.3) | continuation |
//! | [`GONE`] | `eps^2` | an unknown that has lost all digits of its start twice is zero | simplified corrections |
//! | [`LEFT`] | `eps/16` | as [`UNBIASED`], with the rate of contraction measured | eight stages in registers |
//! | [`OF_ROW`], [`NOISE`] | `1e-12`, `1e-15` | of a number itself, where the terms are not known: what stalls above goes the slow way | registers |
//! | [`SLOWEST`] | `1/20` | a search that begins near its end shrinks faster at first than it goes on | registers |
//! | [`QUIET`], [`STALLS`] | `16`, `2` | what goes round among roundings is at its end | fixed points |
//! | [`GROWTH_OF_FIXED_POINT`] | `1e3` | changes that oscillate may grow for a while | fixed points |
//! | [`GROWTHS`] | `3` | how many times in all the largest correction may grow | Newton's method |
//!
//! The unit of all is the component itself, except [`ROUNDINGS`], whose unit is the sum of the sizes of the terms of an equation, in
//! momenta. Except for [`SLIGHT`], a correction is never called rounding by its size beside other unknowns: if forces are large and
//! velocities small, the forces determine the rounding of the equations.

/// Relative correction of a component that is settled.
pub const SETTLED: f64 = 4.0 * f64::EPSILON;

/// Relative change that a linear convergence may still leave.
pub const UNBIASED: f64 = f64::EPSILON / 64.0;

/// Relative change that a linear convergence may leave in a method that no bias is asked of: half a unit in the last place.
pub const HALF_A_UNIT: f64 = f64::EPSILON / 2.0;

/// Corrections below this fraction of the largest unknown are rounding if they stall.
pub const SLIGHT: f64 = 64.0 * f64::EPSILON;

/// As [`SLIGHT`], for the changes of a fixed-point iteration, which cycle in the rounding of all stages together.
pub const SLIGHT_OF_FIXED_POINT: f64 = 1024.0 * f64::EPSILON;

/// A residual of at most this number of roundings of its terms is rounding.
pub const ROUNDINGS: f64 = 8.0;

/// As [`ROUNDINGS`], if corrections also carry the rounding of linear equations that cannot be refined further, or if the test looks at
/// what a correction changes in the equations.
pub const OF_CORRECTION: f64 = 64.0;

/// A guess whose residual is at most this number of roundings is as good as the solution.
pub const NEAR_ROUNDINGS: f64 = 64.0;

/// As [`SLIGHT`], for equations that do not know the sizes of their terms.
pub const BLIND: f64 = 1e-11;

/// A correction above this fraction of the one before stalls.
pub const STALL: f64 = 0.25;

/// A change of a fixed-point iteration above this fraction of the one before stalls.
pub const STALL_OF_FIXED_POINT: f64 = 0.5;

/// Simplified corrections shrink to this fraction at most, or their derivatives are not good enough.
pub const SHRINKING: f64 = 0.125;

/// Largest ratio of the second correction to the first if the solution is the one near the start.
pub const CONTRACTION: f64 = 0.25;

/// With derivatives of another point an unknown that goes to zero shrinks by the same factor for ever. Below this fraction of its start it
/// counts as zero.
pub const GONE: f64 = f64::EPSILON * f64::EPSILON;

/// Number of times in all that the largest correction may grow.
pub const GROWTHS: u32 = 3;

/// Whether corrections of this size are rounding beside a largest unknown `size`, for any equations. Every correction below the smallest
/// normal number is rounding, since a motion that comes to rest ends there.
#[must_use]
#[inline(always)]
pub fn is_slight(correction: f64, size: f64) -> bool {
    correction <= (SLIGHT * size).max(f64::MIN_POSITIVE)
}

/// Changes of a fixed-point iteration of at most this number of roundings of their terms are rounding: an iteration that contracts by a
/// factor `L` may cycle in changes of `1/(1 - L)` times the rounding of all stages together.
pub const CYCLES: f64 = 64.0;

/// Number of changes of a fixed-point iteration that must be rounding and not shrink before it counts as stalled.
pub const STALLS: u32 = 2;

/// A fixed-point iteration ends after this number of iterations in turn that change its values by rounding only.
pub const QUIET: u32 = 16;

/// Changes of a fixed-point iteration that oscillate may grow by this factor above the least so far.
pub const GROWTH_OF_FIXED_POINT: f64 = 1e3;

/// Relative changes that may still be to come when an iteration in registers ends. The omitted part is the same in every step, and adds up:
/// when the contraction was taken from the first iterations, a run of `gauss8` lost `5e-17` of its energy a step.
pub const LEFT: f64 = f64::EPSILON / 16.0;

/// Changes in registers below this fraction of the changing value, that stall twice, are rounding.
pub const OF_ROW: f64 = 1e-12;

/// Changes in registers below this fraction, that stall once, are rounding.
pub const NOISE: f64 = 1e-15;

/// Least factor by which an iteration in registers is expected to shrink its changes.
pub const SLOWEST: f64 = 0.05;
