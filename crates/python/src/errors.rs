use cli::Refusal;
use pyo3::PyErr;
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyMemoryError};

create_exception!(noslip, NoslipError, PyException, "Why noslip did not do what it was asked.");
create_exception!(
    noslip,
    RequestError,
    NoslipError,
    "The request was wrong: a scene, a method or a value that is not accepted."
);
create_exception!(noslip, ComputationError, NoslipError, "The computation failed, or no step meets a tolerance.");
create_exception!(noslip, BusyError, RequestError, "Another process writes the same output.");

/// The exception of what was not computed.
pub(crate) fn raised(Refusal { message, request, memory }: Refusal) -> PyErr {
    let message = in_python(&message);
    match (memory, request) {
        (true, _) => PyMemoryError::new_err(message),
        (false, true) => RequestError::new_err(message),
        (false, false) => ComputationError::new_err(message),
    }
}

/// A message whose flags are arguments: `--event-samples` is `event_samples`. What stands between backticks is a command, and stays.
pub(crate) fn in_python(message: &str) -> String {
    let part = |(k, part): (usize, &str)| if k.is_multiple_of(2) { without_dashes(part) } else { part.to_owned() };
    message.split('`').enumerate().map(part).collect::<Vec<_>>().join("`")
}

fn without_dashes(text: &str) -> String {
    let word = |word: &str| match word.trim_start_matches(['(', '"', '\'']).strip_prefix("--") {
        Some(flag) if flag.starts_with(|first: char| first.is_ascii_lowercase()) => {
            word.replacen("--", "", 1).replace('-', "_")
        }
        _ => word.to_owned(),
    };
    text.split(' ').map(word).collect::<Vec<_>>().join(" ")
}
