use crate::{Scalar, System, Traced};

/// What the functions of a system tell of how smooth its motion may be, without a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Smoothness {
    /// Whether a function has corners or jumps: an absolute value, a sign, the larger of two, a choice, a power that is not whole.
    pub corners: bool,
    /// Whether the time has a part in one, so that something may happen of which no state tells.
    pub driven: bool,
}

impl Smoothness {
    /// The smoothness of a system.
    pub fn of<Sys: System<N, M>, const N: usize, const M: usize>(system: &Sys) -> Self {
        let (t, q) = (Traced::TIME, [Traced::STATE; N]);
        let force = system.force(t, &q, &q).unwrap_or([Traced::zero(); N]);
        let (rows, b) = system.constraint(t, &q);
        let constraint = rows.iter().flatten().chain(&b);
        let all = force.iter().chain(constraint).copied().chain([system.lagrangian(t, &q, &q)]);
        all.fold(Self { corners: false, driven: false }, |seen, x| Self {
            corners: seen.corners || x.corner,
            driven: seen.driven || x.of_time,
        })
    }
}
