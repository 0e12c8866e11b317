use crate::called::{self, Caller};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The exit code of a command that Ctrl-C ended: 128 and the number of the signal, as shells have it.
pub(crate) const EXIT_CODE: u8 = 130;

/// Whether somebody pressed Ctrl-C: the work then ends soon, and keeps what is done.
#[derive(Debug, Clone)]
pub(crate) enum Interrupt {
    /// Set by Ctrl-C.
    Signal(Arc<AtomicBool>),
    /// A program has called the command, and has the signals of its process to itself.
    Caller(Caller),
}

impl Interrupt {
    /// Looks out for it from now on. Who presses it twice does not want to wait.
    pub(crate) fn listen() -> Self {
        if let Some(caller) = called::caller() {
            return Self::Caller(caller);
        }
        let asked = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&asked);
        let handler = move || {
            if flag.swap(true, Ordering::Relaxed) {
                std::process::exit(i32::from(EXIT_CODE));
            }
        };
        // Where the system has no such signals, nobody can send one.
        let _ = ctrlc::set_handler(handler);
        Self::Signal(asked)
    }

    /// Whether the work is to end.
    pub(crate) fn asked(&self) -> bool {
        match self {
            Self::Signal(asked) => asked.load(Ordering::Relaxed),
            Self::Caller(caller) => caller.stops(),
        }
    }
}
