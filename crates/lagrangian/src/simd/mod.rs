//! Numbers in the vector registers of the machine, found at run time.
//!
//! [`Lanes`](crate::Lanes) leaves the choice of instructions to the compiler, which does well where lanes are independent.
//! Where lanes are mixed, as the stages of a step are, it vectorises the wrong loops; a [`Pack`] is always the instructions
//! that it says. The crate `pulp` gives them without a line of `unsafe`.

mod exp;
mod four;
mod instructions;
mod pack;
mod packed;
mod sincos;
mod wide;

pub use four::{Four, FourKernel, in_fours, in_plain_fours};
pub use instructions::Simd;
pub use pack::{Pack, Square};
pub use wide::{Wide, each, packed};

/// Something to compute on packs of eight numbers.
pub trait Kernel {
    /// The result.
    type Output;
    /// Computes it with the registers of `simd`, `R` of which hold eight numbers.
    fn run<S: Simd, const R: usize>(self, simd: S) -> Self::Output;
}

/// Runs a kernel with vector registers that multiply and add in one instruction: AVX-512 if the machine has it at full width, else AVX2.
/// Returns `None` on machines with neither. The two may take sums in different orders.
#[inline(always)]
pub fn dispatch<K: Kernel>(kernel: K) -> Option<K::Output> {
    #[cfg(target_arch = "x86_64")]
    {
        use build::{HALVED, NOT_WIDE, WIDE};
        if !HALVED
            && !NOT_WIDE
            && let Some(simd) = pulp::x86::V4::try_new()
            && (WIDE || !halved())
        {
            return Some(run::<_, _, 1>(simd, kernel));
        }
        if (!WIDE || HALVED)
            && let Some(simd) = pulp::x86::V3::try_new()
        {
            return Some(run::<_, _, 2>(simd, kernel));
        }
    }
    None
}

/// The name of the instruction set that kernels use on this machine. The last bit of results depends on it.
#[must_use]
pub fn instructions() -> &'static str {
    struct Registers;
    impl Kernel for Registers {
        type Output = usize;
        fn run<S: Simd, const R: usize>(self, _simd: S) -> usize {
            R
        }
    }
    match (dispatch(Registers), cfg!(target_feature = "fma")) {
        (Some(1), true) => "avx512, fused everywhere",
        (Some(1), false) => "avx512",
        (Some(_), true) => "avx2, fused everywhere",
        (Some(_), false) => "avx2",
        (None, _) => "without vectors",
    }
}

/// Whether the build compiles every function for the registers of a kernel, and not only the code inlined in the kernel.
#[cfg(target_arch = "x86_64")]
pub const KNOWN_WHEN_BUILT: bool = build::NARROW || build::WIDE;
/// Whether the build compiles every function for the registers of a kernel, and not only the code inlined in the kernel.
#[cfg(not(target_arch = "x86_64"))]
pub const KNOWN_WHEN_BUILT: bool = false;

/// Runs a kernel with these registers.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn run<S: Simd, K: Kernel, const R: usize>(simd: S, kernel: K) -> K::Output {
    simd.vectorize(
        #[inline(always)]
        || kernel.run::<_, R>(simd),
    )
}

/// The vector registers as far as they are known when the program is built. Kernels that cannot be used are not compiled: a build for one
/// machine, as builds from this checkout are, has one kernel instead of three, which take most of the time to compile.
#[cfg(target_arch = "x86_64")]
mod build {
    /// Registers of four numbers.
    pub(super) const NARROW: bool = cfg!(all(
        target_feature = "avx2",
        target_feature = "bmi1",
        target_feature = "bmi2",
        target_feature = "fma",
        target_feature = "lzcnt"
    ));
    /// Registers of eight.
    pub(super) const WIDE: bool = cfg!(all(
        target_feature = "avx512f",
        target_feature = "avx512bw",
        target_feature = "avx512cd",
        target_feature = "avx512dq",
        target_feature = "avx512vl"
    ));
    /// No registers of eight: the program is built for the machine that builds it, and that has none.
    pub(super) const NOT_WIDE: bool = cfg!(this_machine) && !WIDE;
    /// Registers of eight whose operations are made in halves, one after the other.
    pub(super) const HALVED: bool =
        WIDE && cfg!(all(target_feature = "sse4a", not(target_feature = "avx512vp2intersect")));
}

/// Whether the processor makes operations on registers of eight numbers in halves, one after the other: then a chain of dependent
/// operations is quicker in two registers of four. There is no flag for it; AMD's Zen 4, which does so, is recognised by its set of
/// instructions, which no other processor has.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn halved() -> bool {
    std::arch::is_x86_feature_detected!("sse4a") && !std::arch::is_x86_feature_detected!("avx512vp2intersect")
}

/// Runs a part of a kernel as a function of its own, in the same registers.
///
/// Otherwise a kernel is one function, in which a model is inlined at every call, and the time to compile grows faster than its length. A
/// call costs some nanoseconds: it is for what a step does once.
#[inline(never)]
pub fn apart<S: Simd, T>(simd: S, part: impl FnOnce() -> T) -> T {
    struct SimdPart<F>(F);
    impl<T, F: FnOnce() -> T> pulp::WithSimd for SimdPart<F> {
        type Output = T;
        #[inline(always)]
        fn with_simd<S: pulp::Simd>(self, _simd: S) -> T {
            self.0()
        }
    }
    simd.vectorize(SimdPart(part))
}
