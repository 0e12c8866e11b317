//! Times of code: elapsed time, and the processor's time of this thread.

use std::time::Instant;

/// A measured time (s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Taken {
    /// Elapsed time.
    pub(crate) wall: f64,
    /// The processor's time of this thread, without what other threads did meanwhile; elapsed time if the system has none.
    pub(crate) cpu: f64,
}

/// Calls `f` the given number of times and takes the time of one call.
pub(crate) fn take(calls: u32, mut f: impl FnMut()) -> Taken {
    let (cpu, wall) = (thread_seconds(), Instant::now());
    for _ in 0..calls {
        f();
    }
    let (wall, after) = (wall.elapsed().as_secs_f64(), thread_seconds());
    let spent = cpu.zip(after).map_or(wall, |(before, after)| after - before);
    let one = f64::from(calls.max(1)).recip();
    Taken { wall: one * wall, cpu: one * spent }
}

/// Keeps the thread on its present core while it lives: caches stay warm, and one clock is read.
///
/// If the system cannot do that, or forbids it, nothing happens.
#[derive(Debug)]
pub(crate) struct Pinned {
    #[cfg(target_os = "linux")]
    before: Option<rustix::thread::CpuSet>,
}

#[cfg(target_os = "linux")]
mod linux {
    use super::Pinned;
    use rustix::thread::{CpuSet, sched_getaffinity, sched_getcpu, sched_setaffinity};
    use rustix::time::{ClockId, clock_gettime};

    pub(super) fn thread_seconds() -> f64 {
        let time = clock_gettime(ClockId::ThreadCPUTime);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    }

    impl Pinned {
        pub(crate) fn here() -> Self {
            let core = sched_getcpu();
            let before = sched_getaffinity(None).ok().filter(|_| core < CpuSet::MAX_CPU).filter(|_| {
                let mut one = CpuSet::new();
                one.set(core);
                sched_setaffinity(None, &one).is_ok()
            });
            Self { before }
        }

        pub(crate) fn holds(&self) -> bool {
            self.before.is_some()
        }
    }

    impl Drop for Pinned {
        fn drop(&mut self) {
            if let Some(before) = &self.before {
                // Were it refused, the thread would stay on a core that it may run on.
                let _ = sched_setaffinity(None, before);
            }
        }
    }
}

#[cfg(target_os = "linux")]
fn thread_seconds() -> Option<f64> {
    Some(linux::thread_seconds())
}

#[cfg(not(target_os = "linux"))]
fn thread_seconds() -> Option<f64> {
    None
}

#[cfg(not(target_os = "linux"))]
impl Pinned {
    pub(crate) fn here() -> Self {
        Self {}
    }

    pub(crate) fn holds(&self) -> bool {
        false
    }
}

/// Whether times are the processor's rather than the wall's.
pub(crate) fn has_thread_time() -> bool {
    cfg!(target_os = "linux")
}
