use crate::StepError;

/// The stack that a step takes of its thread, in numbers of eight bytes: nothing in a step is allocated, so the arrays of a large system
/// are all there.
///
/// The counts of a method are fitted to the measured use of its steps, with a tenth and more to spare. A method compares them with
/// [`StackUse::LIMIT`] before its first array is made:
///
/// ```
/// use dla::{StackUse, StepError};
///
/// /// A step that keeps ten matrices of masses and two of rows.
/// fn step<const N: usize, const M: usize>() -> Result<(), StepError> {
///     const USE: StackUse = StackUse { squares: 10, rows: 2 };
///     // Decided when the program is compiled: of a system that is too large nothing of the rest is there.
///     if const { USE.exceeds::<N, M>() } {
///         return Err(USE.refusal::<N, M>());
///     }
///     Ok(())
/// }
/// assert!(step::<60, 20>().is_ok());
/// assert!(matches!(step::<150, 50>(), Err(StepError::TooLarge { coordinates: 150, .. })));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StackUse {
    /// Matrices of `N x N` numbers.
    pub squares: usize,
    /// Matrices of `M x N` numbers.
    pub rows: usize,
}

impl StackUse {
    /// Largest stack of a step (bytes): three quarters of the 2 MiB that a thread has by default, in tests and in thread pools too. The
    /// rest is the caller's.
    pub const LIMIT: usize = 3 << 19;

    /// The stack of a step on a system with `N` coordinates and `M` constraints (bytes).
    #[must_use]
    pub const fn bytes<const N: usize, const M: usize>(self) -> usize {
        /// The part that does not depend on the system.
        const BASE: usize = 1 << 16;
        /// The numbers of each coordinate that carry a block of second derivatives, `(8 + 1)^2`, in a few arrays.
        const CARRIED: usize = 4 * 81;
        BASE + size_of::<f64>() * N * (CARRIED + self.squares * N + self.rows * M)
    }

    /// Whether the stack of a step exceeds the limit.
    #[must_use]
    pub const fn exceeds<const N: usize, const M: usize>(self) -> bool {
        self.bytes::<N, M>() > Self::LIMIT
    }

    /// The error of a step that is not begun.
    #[cold]
    #[must_use]
    pub const fn refusal<const N: usize, const M: usize>(self) -> StepError {
        StepError::TooLarge { coordinates: N, constraints: M, bytes: self.bytes::<N, M>(), limit: Self::LIMIT }
    }
}
