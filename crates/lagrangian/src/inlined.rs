/// An array by its places, as [`std::array::from_fn`] makes it, but inlined whatever the compiler thinks of it; `blank` is what
/// stands there before.
///
/// What is compiled for registers that only some machines have must be one function: in a call that remains in it nothing is
/// known of them. So what computes with numbers in registers calls this one, with a closure that is marked `#[inline(always)]`;
/// a model calls [`Scalar::array`](crate::Scalar::array), which for other numbers is a function as any.
#[inline(always)]
pub fn array<T: Copy, const N: usize>(blank: T, f: impl Fn(usize) -> T) -> [T; N] {
    let mut all = [blank; N];
    let mut i = 0;
    while i < N {
        all[i] = f(i);
        i += 1;
    }
    all
}

/// An array by its places in their order, as [`std::array::from_fn`] makes it, of numbers that can be copied.
///
/// That one calls a function for every place, which is inlined where a program is optimised as a whole. In one that is not, as
/// with the profile that cargo gives, general steps take 1.1 to 1.75 times as long by it, and by the trapezoidal rule twice.
#[inline]
pub fn from_fn<T: Copy, const N: usize, F: FnMut(usize) -> T>(mut f: F) -> [T; N] {
    // Known when it is compiled, so that the library's way, which is a handful of functions, is compiled for empty arrays alone.
    if const { N == 0 } {
        return std::array::from_fn(f);
    }
    let mut all = [f(0); N];
    let mut i = 1;
    while i < N {
        all[i] = f(i);
        i += 1;
    }
    all
}

/// What a function makes of each place of an array of numbers that can be copied: as the `map` of an array, which is a handful of
/// functions that are compiled for every closure.
#[inline]
pub(crate) fn mapped<S: Copy, T: Copy, const N: usize>(of: &[S; N], mut f: impl FnMut(S) -> T) -> [T; N] {
    from_fn(|i| f(of[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a function that remembers: each place is asked for once, in order.
    #[test]
    fn places_are_those_of_the_standard_library() {
        fn same<const N: usize>() {
            let remembering = || {
                let mut sum = 1;
                move |i: usize| {
                    sum = 3 * sum + i;
                    sum
                }
            };
            let expected: [usize; N] = std::array::from_fn(remembering());
            assert_eq!(from_fn::<_, N, _>(remembering()), expected);
        }
        same::<0>();
        same::<1>();
        same::<2>();
        same::<7>();
    }
}
