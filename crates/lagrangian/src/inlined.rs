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
