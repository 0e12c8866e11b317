use super::Simd;
use crate::from_fn;
use pulp::bytemuck;

/// Eight numbers in `R` registers.
#[derive(Debug, Clone, Copy)]
pub struct Pack<S: Simd, const R: usize> {
    simd: S,
    registers: [S::f64s; R],
}

/// Does the same with every register. For one register there is no loop, which the compiler would have to unroll in every operation of a
/// kernel; for several there is one without an iterator: without a loop the compiler splits numbers before it sees that they are packs, and
/// kernels take twice as long.
macro_rules! each_register {
    ($i:ident => $act:expr) => {
        if const { R == 1 } {
            let $i = 0;
            $act;
        } else {
            let mut $i = 0;
            while $i < R {
                $act;
                $i += 1;
            }
        }
    };
}

#[allow(
    clippy::redundant_closure_for_method_calls,
    reason = "a function may stay a call, in which the registers are not known"
)]
impl<S: Simd, const R: usize> Pack<S, R> {
    /// A number broadcast to every lane.
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

    /// The same numbers as one value: loaded from memory straight into a [`Wide`](super::Wide), they would be moved lane by lane.
    #[must_use]
    #[inline(always)]
    pub fn whole(self) -> Self {
        // This compiles to no instruction.
        self.map(
            #[inline(always)]
            |s, x| s.transmute_f64s_u64s(s.xor_u64s(s.transmute_u64s_f64s(x), s.splat_u64s(0))),
        )
    }

    /// The numbers one by one.
    #[must_use]
    #[inline(always)]
    pub fn lanes(&self) -> &[f64] {
        bytemuck::cast_slice(&self.registers)
    }

    /// The numbers one by one, to be changed.
    #[must_use]
    #[inline(always)]
    pub fn lanes_mut(&mut self) -> &mut [f64] {
        bytemuck::cast_slice_mut(&mut self.registers)
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
        for x in self.lanes_mut() {
            *x = f(*x);
        }
        self
    }

    /// The same constant for all.
    #[must_use]
    #[inline(always)]
    pub fn like(self, x: f64) -> Self {
        Self::splat(self.simd, x)
    }

    /// The instruction set.
    #[must_use]
    #[inline(always)]
    pub fn simd(&self) -> S {
        self.simd
    }

    #[inline(always)]
    pub(super) fn map(mut self, f: impl Fn(S, S::f64s) -> S::f64s) -> Self {
        each_register!(i => self.registers[i] = f(self.simd, self.registers[i]));
        self
    }

    #[inline(always)]
    pub(super) fn zip(mut self, o: Self, f: impl Fn(S, S::f64s, S::f64s) -> S::f64s) -> Self {
        each_register!(i => self.registers[i] = f(self.simd, self.registers[i], o.registers[i]));
        self
    }

    #[inline(always)]
    pub(super) fn zip3(mut self, a: Self, b: Self, f: impl Fn(S, S::f64s, S::f64s, S::f64s) -> S::f64s) -> Self {
        each_register!(i => self.registers[i] = f(self.simd, self.registers[i], a.registers[i], b.registers[i]));
        self
    }

    /// `self * factor + term`, rounded once.
    #[must_use]
    #[inline(always)]
    pub fn mul_add(mut self, factor: Self, term: Self) -> Self {
        let (s, f, c) = (self.simd, &factor.registers, &term.registers);
        each_register!(i => self.registers[i] = s.mul_add_e_f64s(self.registers[i], f[i], c[i]));
        self
    }

    /// The larger of this number and the absolute value of the other, in every lane; where one is NaN the result depends on the
    /// machine, and is the other with the registers of `dispatch`.
    #[must_use]
    #[inline(always)]
    pub fn max_abs(self, o: Self) -> Self {
        self.zip(
            o,
            #[inline(always)]
            |s, m, x| s.max_f64s(m, s.abs_f64s(x)),
        )
    }

    /// The largest of the numbers, if none is NaN.
    #[must_use]
    #[inline(always)]
    pub fn largest(&self) -> f64 {
        let mut most = self.registers[0];
        for i in 1..R {
            most = self.simd.max_f64s(most, self.registers[i]);
        }
        self.simd.reduce_max_f64s(most)
    }

    /// The product of a [`Square`], its terms loaded, with this vector.
    #[must_use]
    #[inline(always)]
    pub fn times(&self, terms: &[Self; 8]) -> Self {
        let [x2, x4, x6] = [self.exchanged::<2>(), self.exchanged::<4>(), self.exchanged::<6>()];
        let mut near = terms[0] * *self;
        near = terms[1].mul_add(self.neighbours_exchanged(), near);
        near = terms[2].mul_add(x2, near);
        near = terms[3].mul_add(x2.neighbours_exchanged(), near);
        let mut far = terms[4] * x4;
        far = terms[5].mul_add(x4.neighbours_exchanged(), far);
        if const { R == 1 } {
            // Permutations across the halves of a register have a longer latency: their products are summed by themselves.
            near + (far + terms[7].mul_add(x6.neighbours_exchanged(), terms[6] * x6))
        } else {
            far = terms[6].mul_add(x6, far);
            near + terms[7].mul_add(x6.neighbours_exchanged(), far)
        }
    }

    /// The sum of the numbers, first of each with that in the mirror: a row and its mirror image have the same sum to the last
    /// bit.
    #[must_use]
    #[inline(always)]
    pub fn folded(&self) -> f64 {
        let pairs = *self + self.exchanged::<6>().neighbours_exchanged();
        let fours = pairs + pairs.neighbours_exchanged();
        let sum = fours + fours.exchanged::<2>();
        sum.lanes()[0]
    }

    /// The permutation of lane `i` to lane `i xor D`, with `D` 2, 4 or 6.
    #[inline(always)]
    fn exchanged<const D: usize>(self) -> Self {
        const { assert!(R <= 2, "registers of four or eight numbers") };
        let mut ends = self;
        if const { R == 2 && D & 4 == 4 } {
            ends.registers.reverse();
        }
        ends.map(
            #[inline(always)]
            |s, x| s.exchanged::<D>(x),
        )
    }

    /// The permutation of lane `i` to lane `i xor 1`.
    #[inline(always)]
    fn neighbours_exchanged(self) -> Self {
        self.map(
            #[inline(always)]
            |s, x| pulp::cast(s.swap_re_im_c64s(pulp::cast(x))),
        )
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident $instruction:ident),*) => {$(
        impl<S: Simd, const R: usize> std::ops::$operator for Pack<S, R> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, o: Self) -> Self {
                let s = self.simd;
                each_register!(i => self.registers[i] = s.$instruction(self.registers[i], o.registers[i]));
                self
            }
        }
    )*};
}
operators!(Add add add_f64s, Sub sub sub_f64s, Mul mul mul_f64s, Div div div_f64s);

macro_rules! with_numbers {
    ($($operator:ident $method:ident),*) => {$(
        impl<S: Simd, const R: usize> std::ops::$operator<f64> for Pack<S, R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, x: f64) -> Self {
                self.$method(Self::splat(self.simd, x))
            }
        }
    )*};
}
with_numbers!(Add add, Sub sub, Mul mul, Div div);

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

/// A square matrix of eight rows, in the order in which its product with a vector in registers takes it.
///
/// To broadcast one lane of a register is slow, to permute its lanes is not. So term `d` has, in row `i`, the coefficient of the number
/// that the permutation by the bits of `d` brings there, the one at `i xor d`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Square {
    /// The terms.
    pub terms: [[f64; 8]; 8],
}

impl Square {
    /// The matrix with these columns.
    #[must_use]
    pub fn of_columns(columns: &[[f64; 8]; 8]) -> Self {
        Self { terms: from_fn(|term| from_fn(|i| columns[i ^ term][i])) }
    }
}
