use crate::analysis::in_parallel;
use std::ops::{ControlFlow, Range};

/// Groups that are computed between two visits to the sink.
const GROUPS: u64 = 256;

/// Computes members in groups of `size`, on all threads, and hands what each group gives to `sink`, in order; `Break` ends it.
///
/// A group is the same members always, counted from zero, and knows nothing of the others, so that the number of threads
/// (`RAYON_NUM_THREADS`), and where a sequence is taken up again, change no bit. Only a few groups are in memory.
pub fn in_order<T: Send, E>(
    members: Range<u64>,
    size: u64,
    each: impl Fn(Range<u64>) -> T + Sync,
    mut sink: impl FnMut(T) -> ControlFlow<E>,
) -> ControlFlow<E> {
    let size = size.max(1);
    let groups = members.end.div_ceil(size);
    let mut next = members.start / size;
    while next < groups {
        let count = GROUPS.min(groups - next);
        let group = |i: usize| {
            let begin = (next + i as u64) * size;
            each(begin..members.end.min(begin + size))
        };
        for result in in_parallel(count as usize, group) {
            sink(result)?;
        }
        next += count;
    }
    ControlFlow::Continue(())
}
