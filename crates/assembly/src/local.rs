/// Maximum number of coordinates of an element.
pub const WIDEST: usize = 24;

/// The first `N` numbers of a slice, with zeros for missing ones. Slices of an assembly are long enough.
#[inline(always)]
pub(crate) fn local<const N: usize>(x: &[f64]) -> [f64; N] {
    lagrangian::from_fn(|i| x.get(i).copied().unwrap_or(0.0))
}
