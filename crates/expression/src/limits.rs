/// How large a text may be, so that none, however it was made, takes long or fills the memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Characters of a text; of an expression that is written out, too.
    pub length: usize,
    /// Operations, signs and parentheses that are open within each other.
    pub depth: usize,
    /// Numbers, names and operations of a text.
    pub nodes: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { length: 1 << 20, depth: 256, nodes: 1 << 18 }
    }
}
