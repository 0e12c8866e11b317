/// Placeholder.
#[derive(Debug)]
pub struct Exact;
