/// The operators `+=`, `-=` and `*=` (by a plain number) of a [`Scalar`](crate::Scalar), from `+`, `-` and `*`:
/// `assigning_operators!([S: Scalar] Number<S>);`
#[macro_export]
macro_rules! assigning_operators {
    ([$($generics:tt)*] $number:ty) => {
        impl<$($generics)*> ::core::ops::AddAssign for $number {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }
        impl<$($generics)*> ::core::ops::SubAssign for $number {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }
        impl<$($generics)*> ::core::ops::MulAssign<f64> for $number {
            #[inline(always)]
            fn mul_assign(&mut self, factor: f64) {
                *self = *self * factor;
            }
        }
    };
}
