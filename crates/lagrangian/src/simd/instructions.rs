/// An instruction set, with the permutations of lanes that `pulp` has no name for.
pub trait Simd: pulp::Simd {
    /// The instruction set again, where no number says that the machine has it.
    fn of_this_machine() -> Self;

    /// Permutes the lanes of a register: lane `i` to lane `i xor D`, with `D` 2, 4 or 6; bits of `D` beyond the lanes of a register are
    /// ignored.
    fn exchanged<const D: usize>(self, x: Self::f64s) -> Self::f64s;

    /// The lowest twelve bits moved to where a number has its exponent; the others are lost.
    fn as_exponent(self, x: Self::u64s) -> Self::u64s;
}

#[cfg(target_arch = "x86_64")]
impl Simd for pulp::x86::V3 {
    #[inline(always)]
    fn of_this_machine() -> Self {
        Self::try_new().unwrap_or_else(|| unreachable!("numbers are in registers that the machine has"))
    }
    #[inline(always)]
    fn exchanged<const D: usize>(self, x: Self::f64s) -> Self::f64s {
        if D & 2 == 2 { pulp::Simd::rotate_right_f64s(self, x, 2) } else { x }
    }
    #[inline(always)]
    fn as_exponent(self, x: Self::u64s) -> Self::u64s {
        self.shl_const_u64x4::<52>(x)
    }
}

#[cfg(target_arch = "x86_64")]
impl Simd for pulp::x86::V4 {
    #[inline(always)]
    fn of_this_machine() -> Self {
        Self::try_new().unwrap_or_else(|| unreachable!("numbers are in registers that the machine has"))
    }
    #[inline(always)]
    fn exchanged<const D: usize>(self, x: Self::f64s) -> Self::f64s {
        let x = pulp::cast(x);
        pulp::cast(match D {
            2 => self.avx512f._mm512_shuffle_f64x2::<0b10_11_00_01>(x, x),
            4 => self.avx512f._mm512_shuffle_f64x2::<0b01_00_11_10>(x, x),
            6 => self.avx512f._mm512_shuffle_f64x2::<0b00_01_10_11>(x, x),
            _ => x,
        })
    }
    #[inline(always)]
    fn as_exponent(self, x: Self::u64s) -> Self::u64s {
        pulp::cast(self.avx512f._mm512_slli_epi64::<52>(pulp::cast(x)))
    }
}
