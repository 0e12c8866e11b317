/// The most coordinates that an element may have.
pub const WIDEST: usize = 24;

/// The first `N` numbers of a slice; zero where it is shorter, which no slice of an assembly is.
#[inline(always)]
pub(crate) fn local<const N: usize>(x: &[f64]) -> [f64; N] {
    lagrangian::from_fn(|i| x.get(i).copied().unwrap_or(0.0))
}
