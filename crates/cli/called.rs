use dla::Stop;
use harness::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget};
use std::cell::RefCell;
use std::ffi::OsString;
use std::sync::{Arc, Mutex, PoisonError};

/// A program's handle on a command that it calls: it can end the command and read its progress.
#[derive(Debug, Clone, Default)]
pub struct Caller {
    stop: Stop,
    bar: Arc<Mutex<Option<ProgressBar>>>,
}

impl Caller {
    /// Asks the command to end soon, as Ctrl-C does; finished work is kept.
    pub fn stop(&self) {
        self.stop.ask();
    }

    /// Whether the command is to end.
    #[must_use]
    pub fn stops(&self) -> bool {
        self.stop.asked()
    }

    /// The stop request that the command checks.
    pub(crate) fn wish(&self) -> &Stop {
        &self.stop
    }

    /// Runs `work` on this thread; the caller can end it between two steps.
    pub fn attend<T>(&self, work: impl FnOnce() -> T) -> T {
        self.stop.within(work)
    }

    /// The present work, the amount done, and the total.
    #[must_use]
    pub fn progress(&self) -> Option<(String, u64, u64)> {
        let bar = self.bar.lock().unwrap_or_else(PoisonError::into_inner);
        bar.as_ref().map(|bar| (bar.message(), bar.position(), bar.length().unwrap_or(0)))
    }

    /// Shows a bar to the caller in place of the terminal.
    fn watch(&self, bar: &ProgressBar) {
        bar.set_draw_target(ProgressDrawTarget::hidden());
        *self.bar.lock().unwrap_or_else(PoisonError::into_inner) = Some(bar.clone());
    }
}

/// Shows a run to the caller, who may end it.
#[derive(Debug)]
pub struct ShownToCaller<'a> {
    bar: ProgressBar,
    caller: &'a Caller,
}

impl<'a> ShownToCaller<'a> {
    /// Shows a run of `steps` steps under the name `label`.
    #[must_use]
    pub fn new(caller: &'a Caller, label: &str, steps: u64) -> Self {
        let bar = ProgressBar::hidden().with_message(label.to_owned());
        bar.set_length(steps);
        caller.watch(&bar);
        Self { bar, caller }
    }
}

impl Progress for ShownToCaller<'_> {
    fn advance(&mut self, steps: u64) {
        self.bar.inc(steps);
    }

    fn expect(&mut self, steps: u64) {
        self.bar.inc_length(steps);
    }

    fn stops(&self) -> bool {
        self.caller.stops()
    }
}

/// The result of a command that a program called.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CommandOutput {
    /// The exit code: 0 done, 1 the computation failed, 2 the request was wrong, 130 ended by the caller.
    pub code: u8,
    /// What the program writes to standard output.
    pub out: String,
    /// What the program writes to standard error.
    pub err: String,
    /// Whether the request was wrong for now only: another process writes the same output.
    pub busy: bool,
}

/// The caller of a command, with the output so far.
struct Session {
    caller: Caller,
    output: CommandOutput,
}

thread_local! {
    /// A command runs on one thread, and so does all that it prints.
    static SESSION: RefCell<Option<Session>> = const { RefCell::new(None) };
}

/// Makes a command, whose arguments follow the name of the program, on this thread; its output goes to the caller, not to the terminal.
///
/// A command called from within a command ends the output of the outer one; no command does so.
pub fn call(arguments: impl IntoIterator<Item = OsString>, caller: &Caller) -> CommandOutput {
    SESSION.set(Some(Session { caller: caller.clone(), output: CommandOutput::default() }));
    let code = crate::obey(std::iter::once(OsString::from("noslip")).chain(arguments));
    let output = SESSION.take().map(|session| session.output).unwrap_or_default();
    CommandOutput { code, ..output }
}

/// Hands a text of standard output to the caller; returns false if there is no caller.
pub(crate) fn keep_out(text: &str) -> bool {
    with(|session| session.output.out.push_str(text)).is_some()
}

/// Hands a text of standard error to the caller; returns false if there is no caller.
pub(crate) fn keep_err(text: &str) -> bool {
    with(|session| session.output.err.push_str(text)).is_some()
}

/// Tells the caller, if there is one, whether another process writes the output.
pub(crate) fn note_busy(busy: bool) {
    with(|session| session.output.busy = busy);
}

/// The program that called this command, if one did.
pub(crate) fn caller() -> Option<Caller> {
    with(|session| session.caller.clone())
}

/// Shows a bar to the caller, if there is one.
pub(crate) fn watch(bar: &ProgressBar) {
    with(|session| session.caller.watch(bar));
}

fn with<T>(action: impl FnOnce(&mut Session) -> T) -> Option<T> {
    SESSION.with_borrow_mut(|session| session.as_mut().map(action))
}
