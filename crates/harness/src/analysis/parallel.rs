use dla::Stop;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::sync::Once;

/// Stack of a thread (bytes; taken as it is used). Kernels in registers are one function each; in a build without any optimisation every
/// number in it has a place of its own, some megabytes in all.
pub(crate) const STACK: usize = 32 << 20;

/// Makes the pool of threads that everything shares, if there is none yet: as many as the machine has cores, or as `RAYON_NUM_THREADS` asks
/// for, if these are fewer.
pub fn prepare_threads() {
    static POOL: Once = Once::new();
    POOL.call_once(|| {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let asked = std::env::var("RAYON_NUM_THREADS").ok().and_then(|asked| asked.trim().parse().ok());
        let threads = asked.filter(|asked| *asked > 0).map_or(cores, |asked: usize| asked.min(cores));
        // Where there is a pool already, it stays.
        rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build_global().unwrap_or_default();
    });
}

/// `each(0)` to `each(count - 1)`, in that order, computed on all threads.
///
/// If the caller ends this thread's work, all other threads end too. Each item is computed by itself, so that the number of threads
/// (`RAYON_NUM_THREADS`) changes nothing but the time.
pub fn in_parallel<T: Send>(count: usize, each: impl Fn(usize) -> T + Sync) -> Vec<T> {
    if rayon::current_thread_index().is_none() {
        prepare_threads();
    }
    let stop = Stop::of_thread();
    (0..count).into_par_iter().map(|i| stop.within(|| each(i))).collect()
}
