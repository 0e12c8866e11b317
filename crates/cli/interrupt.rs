use crate::called;
use crate::error::INTERRUPTED;
use crate::terminal;
use dla::Stop;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// Signals within this time count as one.
const TOGETHER: Duration = Duration::from_secs(1);

/// Whether the work is to end soon and keep its results: after Ctrl-C (SIGINT), SIGTERM or SIGHUP. If a program called the command, the
/// program handles the signals of its process and requests the end itself.
#[derive(Debug, Clone)]
pub(crate) struct Interrupt(Stop);

impl Interrupt {
    /// Listens for signals from now on. A second signal after a while ends the process at once. Signals that come together count as one: a
    /// terminal, a shell and a wrapper may each send the same.
    pub(crate) fn listen() -> Self {
        Self::listen_saying("")
    }

    /// As [`Self::listen`], and prints `note` at the first signal.
    pub(crate) fn listen_saying(note: &'static str) -> Self {
        if let Some(caller) = called::caller() {
            return Self(caller.wish().clone());
        }
        let asked = Stop::default();
        let wish = asked.clone();
        let first = OnceLock::new();
        handle(move || {
            if wish.asked() {
                if first.get().is_some_and(|first: &Instant| first.elapsed() >= TOGETHER) {
                    std::process::exit(i32::from(INTERRUPTED));
                }
                return;
            }
            wish.ask();
            first.get_or_init(Instant::now);
            if !note.is_empty() {
                terminal::say("note", &note);
            }
        });
        Self(asked)
    }

    /// Whether the work is to end.
    pub(crate) fn asked(&self) -> bool {
        self.0.asked()
    }

    /// Runs `work` on this thread; a request to end stops it between two steps.
    pub(crate) fn attend<T>(&self, work: impl FnOnce() -> T) -> T {
        self.0.within(work)
    }
}

/// Calls `act` at every signal, in a thread of its own. A system without signals sends none.
#[cfg(unix)]
fn handle(act: impl Fn() + Send + 'static) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let hangs_up = (!is_ignored(SIGHUP)).then_some(SIGHUP);
    if let Ok(mut signals) = signal_hook::iterator::Signals::new([SIGINT, SIGTERM].into_iter().chain(hangs_up)) {
        let _ = std::thread::Builder::new().spawn(move || signals.forever().for_each(|_| act()));
    }
}

/// Whether the process was started so that a signal does nothing, as `nohup` starts one; known on Linux only.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

/// Calls `act` at Ctrl-C.
#[cfg(not(unix))]
fn handle(act: impl Fn() + Send + 'static) {
    let _ = ctrlc::set_handler(act);
}
