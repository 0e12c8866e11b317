use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// `each(0)` to `each(count - 1)`, in that order, computed on all threads.
///
/// Each is computed by itself, so that the number of threads (`RAYON_NUM_THREADS`) changes nothing but the time.
pub fn in_parallel<T: Send>(count: usize, each: impl Fn(usize) -> T + Sync) -> Vec<T> {
    (0..count).into_par_iter().map(&each).collect()
}
