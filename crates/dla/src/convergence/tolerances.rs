//! Every tolerance by which an implicit method decides that its equations are solved.
//!
//! `eps = 2^-52` is the distance from one to the next number, `u = eps/2` the unit of rounding.
//!
//! | constant | value | from | used by |
//! |---|---|---|---|
//! | [`SETTLED`] | `4 eps` | a correction below it changes the last digits of its unknown only | Newton's method, chord method, projection |
//! | [`UNBIASED`] | `eps/64` | what a linear convergence leaves out has one sign in every step, and adds up over 10^6 of them | fixed points, assemblies |
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
//! | [`GROWTHS`] | `3` | so often in all the largest correction may grow | Newton's method |
//!
//! The unit of all is the component itself, except [`ROUNDINGS`], whose unit is the sum of the sizes of the terms of an
//! equation, in momenta. A correction is never called rounding by its size beside other unknowns, but for [`SLIGHT`]: where
//! forces are large and velocities small, the rounding of the equations is that of the forces.

/// Relative correction of a component that is settled.
pub const SETTLED: f64 = 4.0 * f64::EPSILON;

/// Relative change that a linear convergence may still leave.
pub const UNBIASED: f64 = f64::EPSILON / 64.0;

/// Relative change that a linear convergence may leave in a method that no bias is asked of: half a unit in the last place.
pub const HALF_A_UNIT: f64 = f64::EPSILON / 2.0;

/// Corrections below this part of the largest unknown are rounding where they stall.
pub const SLIGHT: f64 = 64.0 * f64::EPSILON;

/// The same of the changes of a fixed-point iteration, which go round in the rounding of all stages together.
pub const SLIGHT_OF_FIXED_POINT: f64 = 1024.0 * f64::EPSILON;

/// A residual of so many roundings of its terms is rounding.
pub const ROUNDINGS: f64 = 8.0;

/// A residual of so many roundings is rounding where corrections carry that of the linear equations too and cannot be refined further, or
/// where what is looked at is what a correction changes the equations by.
pub const OF_CORRECTION: f64 = 64.0;

/// A guess with a residual of so many roundings is as good as the solution.
pub const NEAR_ROUNDINGS: f64 = 64.0;

/// As [`SLIGHT`], of equations that do not know the sizes of their terms.
pub const BLIND: f64 = 1e-11;

/// A correction of more than this part of the one before stalls.
pub const STALL: f64 = 0.25;

/// A change of a fixed-point iteration of more than this part of the one before stalls.
pub const STALL_OF_FIXED_POINT: f64 = 0.5;

/// Simplified corrections shrink by at least as much, or their derivatives are not good enough.
pub const SHRINKING: f64 = 0.125;

/// The second correction over the first, where the solution is the one near the start.
pub const CONTRACTION: f64 = 0.25;

/// With derivatives of another point an unknown that goes to zero shrinks by the same factor for ever. It is zero below this
/// part of its start.
pub const GONE: f64 = f64::EPSILON * f64::EPSILON;

/// So many times in all the largest correction may grow.
pub const GROWTHS: u32 = 3;

/// Whether corrections of this size are rounding beside a largest unknown of that size, whatever the equations are. Below the
/// smallest normal number everything is, since what comes to rest ends there.
#[must_use]
#[inline(always)]
pub fn is_slight(correction: f64, size: f64) -> bool {
    correction <= (SLIGHT * size).max(f64::MIN_POSITIVE)
}

/// Changes of a fixed-point iteration of so many roundings of their terms are rounding: what contracts by a factor `L` may go round in
/// changes of `1/(1 - L)` times the rounding of all stages together.
pub const CYCLES: f64 = 64.0;

/// So often a change of a fixed-point iteration must have been rounding and not have shrunk.
pub const STALLS: u32 = 2;

/// After so many iterations in turn that changed nothing but by rounding a fixed-point iteration is at its end.
pub const QUIET: u32 = 16;

/// Changes of a fixed-point iteration that oscillate may grow by this factor above the least so far.
pub const GROWTH_OF_FIXED_POINT: f64 = 1e3;

/// Relative changes that may still be to come where an iteration in registers ends. What is left out is the same in every step, and
/// adds up: where the contraction was believed as the first iterations show it, a run of `gauss8` lost `5e-17` of its energy a step.
pub const LEFT: f64 = f64::EPSILON / 16.0;

/// Changes in registers below this part of what changes, that stall twice, are rounding.
pub const OF_ROW: f64 = 1e-12;

/// And below this part, once.
pub const NOISE: f64 = 1e-15;

/// No iteration in registers is expected to shrink its changes by more.
pub const SLOWEST: f64 = 0.05;
