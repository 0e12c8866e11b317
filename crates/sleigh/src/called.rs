/// A function that stays one: for code that is long, and would be inlined in much that is compiled.
#[inline(never)]
pub(crate) fn called<T>(f: impl FnOnce() -> T) -> T {
    f()
}
