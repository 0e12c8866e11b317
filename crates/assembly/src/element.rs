use dla::NotANumber;
use lagrangian::PowerSources;
use std::fmt::Debug;

/// Maximum number of coordinates of an element that shares them with others. An element that brings its own may have more.
pub const WIDEST: usize = 24;

/// Calls `then` with `n` zeros, which are on the stack for an element that shares its coordinates.
#[inline(always)]
pub(crate) fn with_room<T>(n: usize, then: impl FnOnce(&mut [f64]) -> T) -> T {
    if n <= WIDEST { then(&mut [0.0; WIDEST][..n]) } else { then(&mut vec![0.0; n]) }
}

/// The first `N` numbers of a slice, with zeros for missing ones. Slices of an assembly are long enough.
#[inline(always)]
pub(crate) fn local<const N: usize>(x: &[f64]) -> [f64; N] {
    lagrangian::from_fn(|i| x.get(i).copied().unwrap_or(0.0))
}

/// What an element adds to the equations of its assembly, in its own coordinates: `N` coordinates, `M` constraint rows.
///
/// Matrices are given by rows.
#[derive(Debug)]
pub struct ElementBlocks<'a> {
    /// Momenta or the residuals of the momentum equations, `N`; empty where they are not asked for.
    pub momentum: &'a mut [f64],
    /// What the constraints are to be met by, `M`.
    pub level: &'a mut [f64],
    /// Derivatives of the momenta in the velocities, `N x N`; empty of an element without inertia or forces, or where no
    /// derivatives are asked for.
    pub block: &'a mut [f64],
    /// Derivatives of the constraints in the velocities, `M x N`; empty where no derivatives are asked for.
    pub rows: &'a mut [f64],
    /// Whether derivatives are asked for.
    pub derivatives: bool,
}

/// A part of an assembly: a body, what acts on bodies, or what joins them.
///
/// It says of a step what the static integrator [`Dla`](dla::Dla) with midpoint rules says of its system, equation by
/// equation, in slices of its own length. [`Assembly::attach`](crate::Assembly::attach) makes one of any
/// [`System`](lagrangian::System), [`Assembly::join`](crate::Assembly::join) of any [`Joint`](crate::Joint).
pub trait Element: Debug + Send + Sync {
    /// The numbers `N` of coordinates and `M` of constraint rows.
    fn size(&self) -> (usize, usize);

    /// Whether it has inertia or forces: one that has only constraints fills no block of the matrix.
    fn acts(&self) -> bool;

    /// Which of its coordinates are angles.
    fn angles(&self, angles: &mut [bool]);

    /// The times at which it jumps, as [`Piecewise`](lagrangian::Piecewise) says; none by default.
    fn jump_times(&self, _from: f64, _to: f64) -> Vec<f64> {
        Vec::new()
    }

    /// The smooth piece of it that holds at the time `t` (s), continued to all times; `None`, the default, of one that never jumps.
    fn smooth_piece(&self, _t: f64) -> Option<Box<dyn Element>> {
        None
    }

    /// Which of its coordinates each may be measured from, at the end of a step and in [`misses`](Self::misses): where only their
    /// difference counts, it keeps the digits that large coordinates have lost. None by default.
    fn origins(&self, _origins: &mut [Option<usize>]) {}

    /// At the beginning of a step, `momentum = L_v(q, v)` and `rows = A(q)`.
    fn beginning(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>);

    /// The equations for the mean velocity `v` of a step from `q[0]` to `q[1] = q[0] + h v`: `momentum = D1 L_d + f_d^-` with
    /// its derivatives in `v`, and the constraints in `v` with their negative residuals: `g(q1)/h` of one on positions, `w_d` of
    /// others.
    fn increment(&self, step: (f64, f64), q: [&[f64]; 2], v: &[f64], out: ElementBlocks<'_>);

    /// The momentum at the end of a step, `D2 L_d + f_d^+`.
    fn end(&self, step: (f64, f64), q0: &[f64], v: &[f64], p1: &mut [f64]);

    /// At a velocity, `momentum = L_v(q, v)`, `block = L_vv`, `rows = A(q)` and `level = -(A v + b)`.
    fn velocity(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>);

    /// The sums of the sizes of the terms of its equations, for a bound on their rounding: `L_v` and `h (L_q + F)` in `momentum`, and
    /// the constraints, `A v + b` and of those on positions `g/h`, in `level`.
    fn sizes(&self, time: (f64, f64), q: &[f64], v: &[f64], momentum: &mut [f64], level: &mut [f64]);

    /// The continuous equations for accelerations: `block = L_vv`, `momentum = F + L_q - (d/dt L_v at v' = 0)`, `rows = A(q)` and
    /// `level = -(d/dt (A v + b) at v' = 0)`.
    fn motion(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>);

    /// The energy `v . L_v - L` (J).
    fn energy(&self, t: f64, q: &[f64], v: &[f64]) -> f64;

    /// The power of its forces and of the time in its Lagrangian (W).
    fn power(&self, t: f64, q: &[f64], v: &[f64]) -> f64;

    /// The largest `|A v + b|` of its constraints, and the largest `|g|` of those on positions.
    fn misses(&self, t: f64, q: &[f64], v: &[f64]) -> [f64; 2];

    /// By how much a step turns the constraint that turns most (rad); zero where no angle turns far.
    fn turn(&self, step: (f64, f64), q0: &[f64], v: &[f64]) -> f64;

    /// The kinds of power that the element may have.
    fn power_sources(&self) -> PowerSources;

    /// The damping of the change of velocity from the middle of a step to its end (J): see
    /// [`StepError::Overshoot`](dla::StepError::Overshoot).
    fn damping(&self, step: (f64, f64), q0: &[f64], v: [&[f64]; 2]) -> f64;

    /// The inertia of that change, and `|v . p|` (J).
    fn inertia(&self, step: (f64, f64), q0: &[f64], v: [&[f64]; 2]) -> [f64; 2];

    /// The first of its functions that is not finite, or has no finite derivative where a step needs one: see
    /// [`not_a_number`](dla::not_a_number). None by default.
    fn not_a_number(&self, _t: f64, _q: &[f64], _v: &[f64]) -> Option<NotANumber> {
        None
    }
}
