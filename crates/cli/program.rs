//! The program's part in the last bits of results, its version and instructions; and whether the processor is one that the program was built
//! for: a build for one machine uses its instructions everywhere, and another machine ends it without a word.

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

/// The instructions that the compiler was told to use, by the names of Linux.
const BUILT_WITH: [(bool, &str); 10] = [
    (cfg!(target_feature = "avx"), "avx"),
    (cfg!(target_feature = "avx2"), "avx2"),
    (cfg!(target_feature = "fma"), "fma"),
    (cfg!(target_feature = "bmi1"), "bmi1"),
    (cfg!(target_feature = "bmi2"), "bmi2"),
    (cfg!(target_feature = "avx512f"), "avx512f"),
    (cfg!(target_feature = "avx512bw"), "avx512bw"),
    (cfg!(target_feature = "avx512cd"), "avx512cd"),
    (cfg!(target_feature = "avx512dq"), "avx512dq"),
    (cfg!(target_feature = "avx512vl"), "avx512vl"),
];

/// The error if the processor lacks instructions that the program uses, as far as the system tells (Linux, x86-64).
///
/// The detection of the standard library takes for granted what the program was built for, so it says nothing of that.
#[must_use]
pub fn wrong_processor() -> Option<String> {
    let about = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let flags = about.lines().find_map(|line| line.strip_prefix("flags")?.trim_start().strip_prefix(':'))?;
    let missing = missing_instructions(flags)?;
    Some(format!(
        "this build of noslip uses the instructions {missing}, which the processor does not have: it was built for another machine; \
         `RUSTFLAGS=\"-C target-cpu=x86-64\"` builds for any"
    ))
}

/// The first set of instructions that the program uses and that is not among these flags.
#[must_use]
pub fn missing_instructions(flags: &str) -> Option<&'static str> {
    let has = |name: &str| flags.split_whitespace().any(|flag| flag == name);
    BUILT_WITH.iter().find(|(built, name)| *built && !has(name)).map(|(_, name)| *name)
}
