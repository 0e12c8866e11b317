use pulp::{Simd, bytemuck};

/// Eight numbers in `R` registers.
#[derive(Debug, Clone, Copy)]
pub struct Pack<S: Simd, const R: usize> {
    simd: S,
    registers: [S::f64s; R],
}

#[allow(
    clippy::redundant_closure_for_method_calls,
    reason = "a function may stay a call, in which the registers are not known"
)]
impl<S: Simd, const R: usize> Pack<S, R> {
    /// The same number in every place.
    #[must_use]
    #[inline(always)]
    pub fn splat(simd: S, x: f64) -> Self {
        Self { simd, registers: [simd.splat_f64s(x); R] }
    }

    /// The numbers of a row.
    #[must_use]
    #[inline(always)]
    pub fn load(simd: S, row: &[f64; 8]) -> Self {
        let (registers, _) = S::as_simd_f64s(row);
        let mut all = [simd.splat_f64s(0.0); R];
        all.copy_from_slice(&registers[..R]);
        Self { simd, registers: all }
    }

    /// The numbers one by one.
    #[must_use]
    #[inline(always)]
    pub fn lanes(&self) -> &[f64] {
        bytemuck::cast_slice(&self.registers)
    }

    /// The numbers as a row.
    #[must_use]
    #[inline(always)]
    pub fn row(&self) -> [f64; 8] {
        let lanes = self.lanes();
        let mut row = [0.0; 8];
        row.copy_from_slice(&lanes[..8]);
        row
    }

    /// Each number by itself, without vector instructions.
    #[must_use]
    #[inline(always)]
    pub fn each(mut self, f: impl Fn(f64) -> f64) -> Self {
        for x in bytemuck::cast_slice_mut::<S::f64s, f64>(&mut self.registers) {
            *x = f(*x);
        }
        self
    }

    /// The instruction set.
    #[must_use]
    #[inline(always)]
    pub fn simd(&self) -> S {
        self.simd
    }

    #[inline(always)]
    pub(super) fn map(mut self, f: impl Fn(S, S::f64s) -> S::f64s) -> Self {
        for i in 0..R {
            self.registers[i] = f(self.simd, self.registers[i]);
        }
        self
    }

    #[inline(always)]
    pub(super) fn zip(mut self, o: Self, f: impl Fn(S, S::f64s, S::f64s) -> S::f64s) -> Self {
        for i in 0..R {
            self.registers[i] = f(self.simd, self.registers[i], o.registers[i]);
        }
        self
    }

    #[inline(always)]
    pub(super) fn zip3(mut self, a: Self, b: Self, f: impl Fn(S, S::f64s, S::f64s, S::f64s) -> S::f64s) -> Self {
        for i in 0..R {
            self.registers[i] = f(self.simd, self.registers[i], a.registers[i], b.registers[i]);
        }
        self
    }

    /// `self * factor + term`, rounded once.
    #[must_use]
    #[inline(always)]
    pub fn mul_add(self, factor: Self, term: Self) -> Self {
        self.zip3(
            factor,
            term,
            #[inline(always)]
            |s, a, b, c| s.mul_add_e_f64s(a, b, c),
        )
    }

    /// The larger of this number and the absolute value of the other, in every place; the other where one is not a number.
    #[must_use]
    #[inline(always)]
    pub fn max_abs(self, o: Self) -> Self {
        self.zip(
            o,
            #[inline(always)]
            |s, m, x| s.max_f64s(m, s.abs_f64s(x)),
        )
    }

    /// The largest of the numbers, where all are numbers.
    #[must_use]
    #[inline(always)]
    pub fn largest(&self) -> f64 {
        let mut most = self.registers[0];
        for i in 1..R {
            most = self.simd.max_f64s(most, self.registers[i]);
        }
        self.simd.reduce_max_f64s(most)
    }

    /// `sum_j columns[j] self[j]`: the product of a matrix, given by its columns, with this vector.
    #[must_use]
    #[inline(always)]
    pub fn times<const C: usize>(&self, columns: &[Self; C]) -> Self {
        let (simd, x) = (self.simd, self.lanes());
        let mut sums = [Self::splat(simd, 0.0); 2];
        for j in 0..C {
            let factor = Self::splat(simd, x[j]);
            sums[j % 2] = if j < 2 { columns[j] * factor } else { columns[j].mul_add(factor, sums[j % 2]) };
        }
        sums[0] + sums[1]
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident $instruction:ident),*) => {$(
        impl<S: Simd, const R: usize> std::ops::$operator for Pack<S, R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: Self) -> Self {
                self.zip(
                    o,
                    #[inline(always)]
                    |s, a, b| s.$instruction(a, b),
                )
            }
        }
    )*};
}
operators!(Add add add_f64s, Sub sub sub_f64s, Mul mul mul_f64s, Div div div_f64s);

#[allow(clippy::redundant_closure_for_method_calls, reason = "as above")]
impl<S: Simd, const R: usize> std::ops::Neg for Pack<S, R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(
            #[inline(always)]
            |s, x| s.neg_f64s(x),
        )
    }
}
