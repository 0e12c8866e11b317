use std::fmt::Debug;

/// Four numbers in one register, for one trajectory with four unknowns.
///
/// The results have the same bits in registers and in plain numbers.
pub trait Four: Copy + Debug {
    /// A number broadcast to every lane.
    #[must_use]
    fn like(self, x: f64) -> Self;
    /// These numbers.
    #[must_use]
    fn of(self, row: &[f64; 4]) -> Self;
    /// The numbers.
    #[must_use]
    fn row(self) -> [f64; 4];
    /// The first number.
    #[must_use]
    fn first(self) -> f64;
    /// The first number broadcast to every lane.
    #[must_use]
    fn spread(self) -> Self;
    /// The permutation that exchanges lanes 0 and 1, and 2 and 3.
    #[must_use]
    fn neighbours(self) -> Self;
    /// The permutation that exchanges lanes 0 and 2, and 1 and 3.
    #[must_use]
    fn opposites(self) -> Self;
    /// The sum.
    #[must_use]
    fn plus(self, o: Self) -> Self;
    /// The product, lane by lane.
    #[must_use]
    fn times(self, o: Self) -> Self;
    /// `self * factor + term`, rounded once.
    #[must_use]
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// The largest absolute value, if no number is NaN.
    #[must_use]
    fn largest(self) -> f64;
}

/// Something to compute on fours.
pub trait FourKernel {
    /// The result.
    type Output;
    /// Computes it with fours like this one, which is zero.
    fn run<F: Four>(self, zero: F) -> Self::Output;
}

/// Runs a kernel in the registers of the machine, or on plain numbers where none are known here.
#[inline(always)]
pub fn in_fours<K: FourKernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(
            #[inline(always)]
            || kernel.run(registers::Register::zero(simd)),
        );
    }
    kernel.run(Plain([0.0; 4]))
}

/// Runs a kernel on plain numbers.
#[inline(always)]
pub fn in_plain_fours<K: FourKernel>(kernel: K) -> K::Output {
    kernel.run(Plain([0.0; 4]))
}

#[derive(Debug, Clone, Copy)]
struct Plain([f64; 4]);

impl Plain {
    #[inline(always)]
    fn zip(self, o: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(crate::from_fn(|i| f(self.0[i], o.0[i])))
    }
}

impl Four for Plain {
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        Self([x; 4])
    }
    #[inline(always)]
    fn of(self, row: &[f64; 4]) -> Self {
        Self(*row)
    }
    #[inline(always)]
    fn row(self) -> [f64; 4] {
        self.0
    }
    #[inline(always)]
    fn first(self) -> f64 {
        self.0[0]
    }
    #[inline(always)]
    fn spread(self) -> Self {
        Self([self.0[0]; 4])
    }
    #[inline(always)]
    fn neighbours(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([b, a, d, c])
    }
    #[inline(always)]
    fn opposites(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([c, d, a, b])
    }
    #[inline(always)]
    fn plus(self, o: Self) -> Self {
        self.zip(o, |a, b| a + b)
    }
    #[inline(always)]
    fn times(self, o: Self) -> Self {
        self.zip(o, |a, b| a * b)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Self(crate::from_fn(|i| self.0[i].mul_add(factor.0[i], term.0[i])))
    }
    #[inline(always)]
    fn largest(self) -> f64 {
        self.0.iter().fold(0.0, |most, x| crate::linear::larger(most, x.abs()))
    }
}

#[cfg(target_arch = "x86_64")]
mod registers {
    use super::Four;
    use pulp::x86::V3;
    use pulp::{Simd, cast, f64x4};

    #[derive(Debug, Clone, Copy)]
    pub(super) struct Register {
        simd: V3,
        x: f64x4,
    }

    impl Register {
        #[inline(always)]
        pub(super) fn zero(simd: V3) -> Self {
            Self { simd, x: simd.splat_f64s(0.0) }
        }
        #[inline(always)]
        fn with(self, x: f64x4) -> Self {
            Self { x, ..self }
        }
    }

    impl Four for Register {
        #[inline(always)]
        fn like(self, x: f64) -> Self {
            self.with(self.simd.splat_f64s(x))
        }
        #[inline(always)]
        fn of(self, row: &[f64; 4]) -> Self {
            self.with(cast(*row))
        }
        #[inline(always)]
        fn row(self) -> [f64; 4] {
            cast(self.x)
        }
        #[inline(always)]
        fn first(self) -> f64 {
            self.simd.avx2._mm256_cvtsd_f64(cast(self.x))
        }
        #[inline(always)]
        fn spread(self) -> Self {
            let first = self.simd.avx._mm256_castpd256_pd128(cast(self.x));
            self.with(cast(self.simd.avx2._mm256_broadcastsd_pd(first)))
        }
        #[inline(always)]
        fn neighbours(self) -> Self {
            self.with(cast(self.simd.avx._mm256_permute_pd::<0b0101>(cast(self.x))))
        }
        #[inline(always)]
        fn opposites(self) -> Self {
            let x = cast(self.x);
            self.with(cast(self.simd.avx._mm256_permute2f128_pd::<1>(x, x)))
        }
        #[inline(always)]
        fn plus(self, o: Self) -> Self {
            self.with(self.simd.add_f64s(self.x, o.x))
        }
        #[inline(always)]
        fn times(self, o: Self) -> Self {
            self.with(self.simd.mul_f64s(self.x, o.x))
        }
        #[inline(always)]
        fn mul_add(self, factor: Self, term: Self) -> Self {
            self.with(self.simd.mul_add_e_f64s(self.x, factor.x, term.x))
        }
        #[inline(always)]
        fn largest(self) -> f64 {
            self.simd.reduce_max_f64s(self.simd.abs_f64s(self.x))
        }
    }
}
