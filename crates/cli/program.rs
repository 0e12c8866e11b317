//! The program's part in the last bits of results: its version and instructions.

use std::env::consts::ARCH;

/// The version of the program, with a hash of its sources if they were present when it was built: two builds of one version may differ.
pub(crate) fn version() -> String {
    match env!("NOSLIP_SOURCES") {
        "" => env!("CARGO_PKG_VERSION").to_owned(),
        hash => format!("{}+{hash}", env!("CARGO_PKG_VERSION")),
    }
}

/// The instructions that its kernels have on this machine.
pub(crate) fn instructions() -> String {
    format!("{ARCH} {}", lagrangian::simd::instructions())
}
