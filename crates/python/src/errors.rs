use pyo3::create_exception;
use pyo3::exceptions::PyException;

create_exception!(noslip, NoslipError, PyException, "Why noslip did not do what it was asked.");
create_exception!(
    noslip,
    RequestError,
    NoslipError,
    "The request was wrong: a scene, a method or a value that is not accepted."
);
create_exception!(noslip, ComputationError, NoslipError, "The computation failed, or no step meets a tolerance.");
