//! Numbers in the vector registers of the machine, found at run time.
//!
//! [`Lanes`](crate::Lanes) leaves the choice of instructions to the compiler, which does well where every lane goes its own
//! way. Where lanes are mixed, as the stages of a step are, it takes the wrong loops for the vectors; a [`Pack`] is always the
//! instructions that it says. The crate `pulp` gives them without a line of `unsafe`.

mod instructions;
mod pack;
mod sincos;
mod square;
mod wide;

pub use instructions::Simd;
pub use pack::Pack;
pub use square::Square;
pub use wide::Wide;

/// Something to compute on packs of eight numbers.
pub trait Kernel {
    /// The result.
    type Output;
    /// Computes it with the registers of `simd`, `R` of which hold eight numbers.
    fn run<S: Simd, const R: usize>(self, simd: S) -> Self::Output;
}

/// Runs a kernel with the widest vector registers that multiply and add in one instruction; none where the machine has none
/// known here. Today these are those of AVX-512 and of AVX2 with FMA. A kernel gives the same bits in both.
#[inline(always)]
pub fn dispatch<K: Kernel>(kernel: K) -> Option<K::Output> {
    attempt(kernel).ok()
}

/// Runs a kernel as [`dispatch`] does, or one number after another: for many trajectories, whose numbers do not wait for one another.
#[inline(always)]
pub fn dispatch_always<K: Kernel>(kernel: K) -> K::Output {
    match attempt(kernel) {
        Ok(output) => output,
        Err(kernel) => one_by_one(kernel),
    }
}

/// Runs a part of a kernel as a function of its own, in the same registers.
///
/// All of a kernel is one function otherwise, in which a model stands as often as it is called, and compiling takes longer than
/// in proportion to its length. A call costs some nanoseconds: it is for what a step does once.
#[inline(never)]
pub fn apart<S: Simd, T>(simd: S, part: impl FnOnce() -> T) -> T {
    struct Part<F>(F);
    impl<T, F: FnOnce() -> T> pulp::WithSimd for Part<F> {
        type Output = T;
        #[inline(always)]
        fn with_simd<S: pulp::Simd>(self, _simd: S) -> T {
            self.0()
        }
    }
    simd.vectorize(Part(part))
}

/// Runs a kernel as [`dispatch`] does, or gives it back.
#[inline(always)]
fn attempt<K: Kernel>(kernel: K) -> Result<K::Output, K> {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V4::try_new() {
        return Ok(simd.vectorize(
            #[inline(always)]
            || kernel.run::<_, 1>(simd),
        ));
    }
    // A build for machines with the widest registers, as every build from this checkout on such a machine is, has no kernels for
    // others: they would be most of what kernels take to compile.
    #[cfg(not(all(
        target_feature = "avx512f",
        target_feature = "avx512bw",
        target_feature = "avx512cd",
        target_feature = "avx512dq",
        target_feature = "avx512vl"
    )))]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return Ok(simd.vectorize(
            #[inline(always)]
            || kernel.run::<_, 2>(simd),
        ));
    }
    Err(kernel)
}

/// Runs a kernel without vector registers.
#[cfg(not(all(
    target_feature = "avx2",
    target_feature = "bmi1",
    target_feature = "bmi2",
    target_feature = "fma",
    target_feature = "lzcnt"
)))]
#[inline(always)]
fn one_by_one<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<_, 8>(pulp::Scalar::new())
}

/// A build for machines with vector registers has nothing for others.
#[cfg(all(
    target_feature = "avx2",
    target_feature = "bmi1",
    target_feature = "bmi2",
    target_feature = "fma",
    target_feature = "lzcnt"
))]
#[cold]
fn one_by_one<K: Kernel>(_kernel: K) -> K::Output {
    unreachable!("the machine is not one that this program was built for")
}
