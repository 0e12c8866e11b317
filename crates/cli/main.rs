//! The command line of noslip.
fn main() {}
