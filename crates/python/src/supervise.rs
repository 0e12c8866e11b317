use crate::errors::NoslipError;
use cli::Caller;
use pyo3::prelude::*;
use std::any::Any;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// Interval at which Python is asked for signals and told of the progress, while work goes on without the interpreter.
const OFTEN: Duration = Duration::from_millis(10);

/// The stack of the work (bytes), as large as a program's stack: methods keep their memory there.
const STACK: usize = 8 << 20;

/// The result of supervised work.
pub(crate) struct Supervised<T> {
    /// The result; of interrupted work, the part made so far.
    pub(crate) value: T,
    /// The exception that ended the work: `KeyboardInterrupt`, or an exception of the progress callable.
    pub(crate) ended: Option<PyErr>,
}

/// Does work on another thread with the interpreter released, and looks for Ctrl-C meanwhile. `progress(label, done, of)` is called with
/// the progress of the work.
pub(crate) fn supervised<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Caller) -> T + Send,
) -> PyResult<Supervised<T>> {
    let caller = Caller::default();
    let progress = progress.map(|progress| progress.clone().unbind());
    py.detach(|| {
        std::thread::scope(|scope| {
            let (sender, receiver) = channel();
            let its = caller.clone();
            let thread = std::thread::Builder::new().stack_size(STACK);
            let worker = thread.spawn_scoped(scope, move || {
                let value = its.attend(|| work(&its));
                // The other end waits as long as this thread is there.
                let _ = sender.send(());
                value
            })?;
            let mut ended = None;
            while let Err(RecvTimeoutError::Timeout) = receiver.recv_timeout(OFTEN) {
                if ended.is_none()
                    && let Err(error) = Python::attach(|py| asked(py, progress.as_ref(), &caller))
                {
                    caller.stop();
                    ended = Some(error);
                }
            }
            match worker.join() {
                Ok(value) => Ok(Supervised { value, ended }),
                Err(panic) => {
                    Err(NoslipError::new_err(format!("a fault of the library, please report it: {}", said(&*panic))))
                }
            }
        })
    })
}

/// The message of a panic.
fn said(panic: &(dyn Any + Send)) -> &str {
    let literal = panic.downcast_ref::<&str>().copied();
    literal.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message")
}

/// Asks Python whether to go on; an error ends the work.
fn asked(py: Python<'_>, progress: Option<&Py<PyAny>>, caller: &Caller) -> PyResult<()> {
    py.check_signals()?;
    if let (Some(progress), Some(told)) = (progress, caller.progress()) {
        progress.call1(py, told)?;
    }
    Ok(())
}
