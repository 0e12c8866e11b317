use dla::Stop;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::sync::Once;

/// Of a thread (bytes; taken as it is used). Kernels in registers are one function each; in a build without any optimisation
/// every number in it has a place of its own, some megabytes in all.
pub(crate) const STACK: usize = 32 << 20;

/// `each(0)` to `each(count - 1)`, in that order, computed on all threads.
///
/// Whoever waits for this thread ends the others too. Each is computed by itself, so that the number of threads (`RAYON_NUM_THREADS`) changes nothing but the time.
pub fn in_parallel<T: Send>(count: usize, each: impl Fn(usize) -> T + Sync) -> Vec<T> {
    static POOL: Once = Once::new();
    if rayon::current_thread_index().is_none() {
        // Where there is a pool already, it stays.
        POOL.call_once(|| rayon::ThreadPoolBuilder::new().stack_size(STACK).build_global().unwrap_or_default());
    }
    let stop = Stop::of_thread();
    (0..count).into_par_iter().map(|i| stop.within(|| each(i))).collect()
}
