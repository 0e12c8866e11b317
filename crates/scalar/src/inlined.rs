/// An array by a function of the index, as [`std::array::from_fn`] makes it, but always inlined; the array is filled with `blank` first.
///
/// Target features are a property of a function: a call that is not inlined is compiled without the vector registers that only some
/// machines have. So code on registers calls this function, with a closure that is marked `#[inline(always)]`; a model calls
/// [`Scalar::array`](crate::Scalar::array), which for other numbers is an ordinary function.
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

/// An array by a function of the index, in order, as [`std::array::from_fn`] makes it, of numbers that can be copied.
///
/// The standard one calls a function for every index, which is inlined only with link-time optimisation. With cargo's own release profile
/// general steps take 1.1 to 1.75 times as long with the standard one, and by the trapezoidal rule twice (Zen 3).
#[inline]
pub fn from_fn<T: Copy, const N: usize, F: FnMut(usize) -> T>(mut f: F) -> [T; N] {
    // A constant condition: the standard function, which is a handful of functions, is compiled for empty arrays only.
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

/// A function that stays one: for code that is long, and would be inlined in much that is compiled.
#[inline(never)]
pub fn called<T>(f: impl FnOnce() -> T) -> T {
    f()
}

/// A function applied to each element of an array of numbers that can be copied: the `map` of an array, without the handful of functions
/// that are compiled for every closure of that.
#[inline]
pub fn mapped<S: Copy, T: Copy, const N: usize>(of: &[S; N], mut f: impl FnMut(S) -> T) -> [T; N] {
    from_fn(|i| f(of[i]))
}
