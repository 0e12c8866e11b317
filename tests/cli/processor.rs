//! A build for one machine says so where it is started on another.

use cli::{missing_instructions, wrong_processor};

#[test]
fn instructions_that_a_processor_lacks_are_named() {
    assert_eq!(wrong_processor(), None);
    assert_eq!(missing_instructions("fpu sse sse2").is_some(), cfg!(target_feature = "avx"));
    let all = "avx avx2 fma bmi1 bmi2 avx512f avx512bw avx512cd avx512dq avx512vl";
    assert_eq!(missing_instructions(all), None);
    if cfg!(target_feature = "fma") {
        assert_eq!(missing_instructions(&all.replace(" fma", "")), Some("fma"));
    }
}
