use crate::analysis::{STACK, prepare_threads};
use dla::Stop;
use std::collections::BTreeMap;
use std::ops::{ControlFlow, Range};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Maximum number of members ahead of the next one to be handed on, whose results wait in memory.
const AHEAD: u64 = 4096;

/// Computes members, on all threads, and hands their results to `sink`, in order and as soon as possible: all results that follow on the
/// last one, at least one. `Break` ends it. Once `stops` says so no further member begins; members that have begun are finished and handed
/// on. If the caller ends this thread's work ([`Stop`]), they are not.
///
/// Members do not depend on one another, so that the number of threads (`RAYON_NUM_THREADS`), and the place at which a sequence is taken up
/// again, change no bit. While one member takes long, further members get some thousand ahead of it, and then wait: the memory is bounded.
pub fn in_order<T: Send, E>(
    members: Range<u64>,
    stops: impl Fn() -> bool + Sync,
    each: impl Fn(u64) -> T + Sync,
    mut sink: impl FnMut(Vec<T>) -> ControlFlow<E>,
) -> ControlFlow<E> {
    prepare_threads();
    let threads = rayon::current_num_threads();
    let line = Line::new(members, threads);
    let stop = Stop::of_thread();
    let stops = || stops() || stop.asked();
    let compute = |member: u64| {
        let made = stop.within(|| each(member));
        // Members that were ended on the way have no results.
        if !stop.asked() {
            line.put(member, made);
        }
    };
    let work = || {
        let _leaving = Leaving(&line);
        while let Some(member) = line.next(&stops) {
            compute(member);
        }
    };
    std::thread::scope(|scope| {
        // Threads of its own: the threads of a pool may be waiting for this very call.
        let started = (0..threads).map(|_| std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, work));
        let missing = started.filter(Result::is_err).count();
        (0..missing).for_each(|_| line.leave());
        // If no thread can be started, this one does the work.
        while missing == threads
            && let Some(member) = line.next(&stops)
        {
            compute(member);
            sink(line.ready().unwrap_or_default())?;
        }
        while let Some(ready) = line.ready() {
            if let ControlFlow::Break(end) = sink(ready) {
                line.close();
                return ControlFlow::Break(end);
            }
        }
        ControlFlow::Continue(())
    })
}

/// Members that are to be computed, and results that wait for earlier ones.
struct Line<T> {
    state: Mutex<LineState<T>>,
    changed: Condvar,
    end: u64,
}

struct LineState<T> {
    /// The next member to be computed, and the next to be handed on.
    next: u64,
    handed: u64,
    done: BTreeMap<u64, T>,
    threads: usize,
}

impl<T> Line<T> {
    fn new(members: Range<u64>, threads: usize) -> Self {
        let state = LineState { next: members.start, handed: members.start, done: BTreeMap::new(), threads };
        Self { state: Mutex::new(state), changed: Condvar::new(), end: members.end }
    }

    fn lock(&self) -> MutexGuard<'_, LineState<T>> {
        // A thread that panics leaves nothing half done.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, state: MutexGuard<'a, LineState<T>>) -> MutexGuard<'a, LineState<T>> {
        self.changed.wait(state).unwrap_or_else(PoisonError::into_inner)
    }

    /// The next member to compute, once there is room for its result; `None` if all have begun, or none is to begin.
    fn next(&self, stops: &impl Fn() -> bool) -> Option<u64> {
        let mut state = self.lock();
        while state.next < self.end && state.next >= state.handed.saturating_add(AHEAD) {
            state = self.wait(state);
        }
        let member = state.next;
        if member >= self.end || stops() {
            return None;
        }
        state.next += 1;
        Some(member)
    }

    fn put(&self, member: u64, result: T) {
        self.lock().done.insert(member, result);
        self.changed.notify_all();
    }

    /// All results that are next; `None` once no thread is left to make one.
    fn ready(&self) -> Option<Vec<T>> {
        let mut state = self.lock();
        loop {
            let mut ready = Vec::new();
            while let Some(result) = {
                let next = state.handed;
                state.done.remove(&next)
            } {
                ready.push(result);
                state.handed += 1;
            }
            if !ready.is_empty() {
                self.changed.notify_all();
                return Some(ready);
            }
            if state.threads == 0 {
                return None;
            }
            state = self.wait(state);
        }
    }

    /// No further member begins.
    fn close(&self) {
        self.lock().next = self.end;
        self.changed.notify_all();
    }

    /// A thread has ended.
    fn leave(&self) {
        self.lock().threads -= 1;
        self.changed.notify_all();
    }
}

/// Leaves when it is dropped, also if a thread panics.
struct Leaving<'a, T>(&'a Line<T>);

impl<T> Drop for Leaving<'_, T> {
    fn drop(&mut self) {
        self.0.leave();
    }
}
