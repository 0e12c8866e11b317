//! Ensembles: many starts of a system, each summed up in a few numbers, in order and on all threads.

use crate::{Method, Run};
use dla::{Mechanism, Observer, Report, RunError, Schedule, Stop, View};
use lagrangian::linear::larger;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::collections::BTreeMap;
use std::ops::{ControlFlow, Range};
use std::sync::{Condvar, Mutex, MutexGuard, Once, PoisonError};

/// Stack of a thread (bytes; taken as it is used). Kernels in registers are one function each; in a build without any optimisation every
/// number in it has a place of its own, some megabytes in all.
const STACK: usize = 32 << 20;

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

/// A trajectory in a few numbers: its end, and extremes over the observed nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Time of the end (s).
    pub t: f64,
    /// The quantities at the end.
    pub end: Vec<f64>,
    /// The least of each.
    pub low: Vec<f64>,
    /// The largest of each.
    pub high: Vec<f64>,
    /// Energy at the start and at the end (J).
    pub energy: [f64; 2],
    /// `max |E - E0|` (J): an error, if nothing does work.
    pub energy_deviation: f64,
    /// `max |A(q) v + b|`.
    pub constraint: f64,
}

/// Quantities of a time (s), a configuration, angles with their full turns, and a velocity.
type Of<'a> = &'a dyn Fn(f64, &[f64], &[f64]) -> Vec<f64>;

/// The summary of one trajectory by any method, over every `every`-th of its nodes and the last. If it fails, the summary of its valid
/// part, with the failure.
pub fn summarise(
    system: &dyn Mechanism,
    method: &Method,
    (q, v): (&[f64], &[f64]),
    (schedule, every): (&Schedule, u64),
    of: Of<'_>,
) -> (Option<Summary>, Option<RunError>) {
    let mut looking = Looking { every: every.max(1), of, seen: None, last: None };
    let outcome = Run::of(system, method).observe(&mut looking).moves(schedule, &mut system.state(q, v));
    (looking.seen, outcome.err())
}

/// The observer of one trajectory.
struct Looking<'a> {
    every: u64,
    of: Of<'a>,
    seen: Option<Summary>,
    last: Option<u64>,
}

impl Looking<'_> {
    fn see(&mut self, node: &View<'_>) {
        if self.last.replace(node.k) == Some(node.k) {
            return;
        }
        let (t, energy) = (node.t, node.energy());
        let end = (self.of)(t, &node.state.unwrapped(), node.state.v());
        let seen = self.seen.get_or_insert_with(|| Summary {
            t,
            end: Vec::new(),
            low: end.clone(),
            high: end.clone(),
            energy: [energy; 2],
            energy_deviation: 0.0,
            constraint: 0.0,
        });
        for (k, value) in end.iter().enumerate() {
            (seen.low[k], seen.high[k]) = (seen.low[k].min(*value), seen.high[k].max(*value));
        }
        (seen.t, seen.end, seen.energy[1]) = (t, end, energy);
        seen.energy_deviation = larger(seen.energy_deviation, (energy - seen.energy[0]).abs());
        seen.constraint = larger(seen.constraint, node.constraint());
    }
}

impl Observer for Looking<'_> {
    fn start(&mut self, node: &View<'_>) {
        self.see(node);
    }

    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        if node.k.is_multiple_of(self.every) {
            self.see(node);
        }
        ControlFlow::Continue(())
    }

    fn end(&mut self, node: &View<'_>) {
        self.see(node);
    }
}
