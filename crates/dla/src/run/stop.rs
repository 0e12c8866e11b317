use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The wish of whoever waits for some work that it ends now, with what it has.
///
/// The work is done [within](Self::within) it; the loops over steps, and over the inner steps of adaptive methods, look at the wish of their
/// thread ([`stops`]) before each. So it reaches what takes no argument for it.
///
/// ```
/// use dla::{Stop, stops};
///
/// let stop = Stop::default();
/// stop.ask();
/// assert!(stop.within(stops) && !stops());
/// ```
#[derive(Debug, Clone, Default)]
pub struct Stop(Arc<AtomicBool>);

thread_local! {
    static OF_THREAD: RefCell<Option<Stop>> = const { RefCell::new(None) };
}

/// Whether the work of this thread is to end.
#[must_use]
#[inline]
pub fn stops() -> bool {
    OF_THREAD.with_borrow(|stop| stop.as_ref().is_some_and(Stop::asked))
}

impl Stop {
    /// Says that the work is to end.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether somebody has said so.
    #[must_use]
    #[inline]
    pub fn asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// The request of this thread, to hand it on to other threads; a new one if there is none.
    #[must_use]
    pub fn of_thread() -> Self {
        Self::of_thread_if_any().unwrap_or_default()
    }

    pub(crate) fn of_thread_if_any() -> Option<Self> {
        OF_THREAD.with_borrow(Clone::clone)
    }

    /// Does some work of this thread, which ends as soon as [`ask`](Self::ask) is called.
    pub fn within<T>(&self, work: impl FnOnce() -> T) -> T {
        /// Puts back the request before, also if the work panics.
        struct Before(Option<Stop>);
        impl Drop for Before {
            fn drop(&mut self) {
                OF_THREAD.set(self.0.take());
            }
        }
        let _before = Before(OF_THREAD.replace(Some(self.clone())));
        work()
    }
}
