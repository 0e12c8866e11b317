use crate::{Dual, Scalar, System, Traced, mapped};

/// What may do work on a system: each of these where no evaluation can tell that it does none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PowerSources {
    /// Time in the Lagrangian.
    pub time: bool,
    /// Forces.
    pub forces: bool,
    /// Constraints with another `b` than zero, which move.
    pub constraints: bool,
}

impl PowerSources {
    /// Whatever there is.
    pub const ALL: Self = Self { time: true, forces: true, constraints: true };

    /// Nothing.
    pub const NONE: Self = Self { time: false, forces: false, constraints: false };

    /// Whether there is any.
    #[must_use]
    #[inline(always)]
    pub fn any(self) -> bool {
        self.time || self.forces || self.constraints
    }

    /// The power sources of two systems together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            time: self.time || other.time,
            forces: self.forces || other.forces,
            constraints: self.constraints || other.constraints,
        }
    }

    /// The power sources of a system, found by tracing its functions without numbers.
    pub fn of<Sys: System<N, M>, const N: usize, const M: usize>(system: &Sys) -> Self {
        let (t, q) = (Traced::TIME, [Traced::STATE; N]);
        Self {
            time: system.lagrangian(t, &q, &q).of_time,
            forces: system.force(t, &q, &q).is_some_and(|force| !force.iter().all(Scalar::is_zero)),
            constraints: !system.constraint(t, &q).1.iter().all(Scalar::is_zero),
        }
    }
}

/// The power `F . v` of the generalised forces (W); `None` without forces.
#[inline]
pub fn force_power<Sys, const N: usize, const M: usize>(system: &Sys, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<f64>
where
    Sys: System<N, M>,
{
    system.force(t, q, v).map(|force| (0..N).map(|i| force[i] * v[i]).sum())
}

/// The power `-dL/dt` at which explicit time feeds the energy `v . L_v - L` (W).
#[inline(never)]
pub fn lagrangian_power<Sys, const N: usize, const M: usize>(system: &Sys, t: f64, q: &[f64; N], v: &[f64; N]) -> f64
where
    Sys: System<N, M>,
{
    let time = Dual { re: t, eps: [1.0] };
    -system.lagrangian(time, &mapped(q, Dual::fixed), &mapped(v, Dual::fixed)).eps[0]
}

/// What the functions of a system tell of how smooth its motion may be, without a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Smoothness {
    /// Whether a function has corners or jumps: an absolute value, a sign, the larger of two, a choice, a power that is not whole.
    pub corners: bool,
    /// Whether the time has a part in one, so that something may happen of which no state tells.
    pub driven: bool,
    /// Whether a function may change within a narrow interval, such as `tanh`, `exp` or a quotient.
    pub narrow: bool,
}

impl Smoothness {
    /// The smoothness of a system.
    pub fn of<Sys: System<N, M>, const N: usize, const M: usize>(system: &Sys) -> Self {
        let (t, q) = (Traced::TIME, [Traced::STATE; N]);
        let force = system.force(t, &q, &q).unwrap_or([Traced::zero(); N]);
        let (rows, b) = system.constraint(t, &q);
        let constraint = rows.iter().flatten().chain(&b);
        let all = force.iter().chain(constraint).copied().chain([system.lagrangian(t, &q, &q)]);
        all.fold(Self { corners: false, driven: false, narrow: false }, |seen, x| Self {
            corners: seen.corners || x.corner,
            driven: seen.driven || x.of_time,
            narrow: seen.narrow || x.narrow,
        })
    }
}
