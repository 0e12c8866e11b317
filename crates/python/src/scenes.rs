use crate::errors::{RequestError, raised};
use crate::sensitivities::{SensitivityRequest, full_key, sensitivities};
use crate::supervise::{Supervised, supervised};
use cli::{RunRequest, RunResult};
use harness::METHODS;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scene::{AnyScene, Overrides, Setting, bundled as scenes, bundled_texts, with_settings};

fn names() -> Vec<&'static str> {
    METHODS.iter().map(|info| info.name).collect()
}

/// The bundled scenes: name and text.
#[pyfunction]
pub(crate) fn bundled() -> Vec<(&'static str, &'static str)> {
    scenes().iter().chain(bundled_texts()).map(|scene| (scene.name, scene.text)).collect()
}

/// The methods: name, order, what each keeps to round-off, and what it is.
#[pyfunction]
pub(crate) fn methods() -> Vec<(&'static str, u32, &'static str, &'static str)> {
    METHODS.iter().map(|info| (info.name, info.order, info.keeps, info.summary)).collect()
}

/// A scene, checked: a system, its start and how to run it.
#[pyclass(frozen)]
pub(crate) struct Scene {
    scene: AnyScene,
}

/// What a run gave: the columns with their numbers, their units, the object of `noslip run --json` as text, why the run failed, and the
/// exception that ended it.
type Made<'py> = (Bound<'py, PyDict>, Vec<(String, String)>, String, Option<String>, Option<Py<PyAny>>);

/// Derivatives of a run: the columns, the times, the numbers, and a row for each number; or the exception that ended it.
type Derived<'py> = (Vec<String>, Vec<f64>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>);

#[pymethods]
impl Scene {
    /// Reads a scene from its text; messages show `origin`, and the scene is named after it.
    #[new]
    fn new(text: &str, origin: &str) -> PyResult<Self> {
        let scene = AnyScene::parse(text, origin, &names());
        Ok(Self { scene: scene.map_err(|error| RequestError::new_err(error.to_string()))? })
    }

    /// The scene with other settings of its run, where they are given.
    fn with_settings(
        &self,
        method: Option<&str>,
        step: Option<f64>,
        duration: Option<f64>,
        alpha: Option<f64>,
    ) -> PyResult<Self> {
        let scene = self.scene.clone().with_overrides(&Overrides { method, step, duration, alpha }, &names());
        Ok(Self { scene: scene.map_err(|error| RequestError::new_err(error.to_string()))? })
    }

    /// The name.
    #[getter]
    fn name(&self) -> &str {
        self.scene.name()
    }

    /// The title; the name where there is none.
    #[getter]
    fn title(&self) -> &str {
        self.scene.title()
    }

    /// The method of the run.
    #[getter]
    fn method(&self) -> &str {
        &self.scene.run().method
    }

    /// The largest step (s).
    #[getter]
    fn step(&self) -> f64 {
        self.scene.run().step
    }

    /// The duration (s).
    #[getter]
    fn duration(&self) -> f64 {
        self.scene.run().duration
    }

    /// Which numbers of the start the constraints did not admit: name, number given, number taken.
    #[getter]
    fn moved(&self) -> Vec<(String, f64, f64)> {
        match &self.scene {
            AnyScene::Sleigh(_) => Vec::new(),
            AnyScene::Text(scene) => {
                scene.start.moved.iter().map(|moved| (moved.name.clone(), moved.from, moved.to)).collect()
            }
        }
    }

    /// Makes the run, and keeps every `every`-th node, or the motion at `times`.
    #[allow(clippy::too_many_arguments, reason = "the arguments of Python are the fields of a request")]
    #[pyo3(signature = (every, times, tolerance, substep, events, until, backward, progress))]
    fn run<'py>(
        &self,
        py: Python<'py>,
        every: u64,
        times: Vec<f64>,
        tolerance: Option<f64>,
        substep: bool,
        events: Vec<String>,
        until: Vec<String>,
        backward: bool,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Made<'py>> {
        let request = RunRequest { every, times, tolerance, substep, events, until, backward };
        let Supervised { value, ended } = supervised(py, progress, |caller| cli::run(&self.scene, &request, caller))?;
        let RunResult { columns, numbers, object, failure, .. } = match (value, ended.as_ref()) {
            // What was ended before there was anything has no reason of its own.
            (Err(_), Some(ended)) => return Err(ended.clone_ref(py)),
            (value, _) => value.map_err(raised)?,
        };
        let arrays = PyDict::new(py);
        for (column, numbers) in columns.iter().zip(numbers) {
            arrays.set_item(&column.name, PyArray1::from_vec(py, numbers))?;
        }
        let units = columns.into_iter().map(|column| (column.name, column.unit)).collect();
        let ended = ended.map(|error| error.into_value(py).into_any());
        Ok((arrays, units, object.to_string(), failure, ended))
    }

    /// The text of the scene with other numbers, by their keys.
    fn varied(&self, text: &str, origin: &str, values: Vec<(String, f64)>) -> PyResult<String> {
        let setting = |(key, value): (String, f64)| format!("{}={value:?}", full_key(&self.scene, &key)).parse();
        let settings: Result<Vec<Setting>, String> = values.into_iter().map(setting).collect();
        let settings = settings.map_err(RequestError::new_err)?;
        with_settings(text, origin, &settings).map_err(|error| RequestError::new_err(error.to_string()))
    }

    /// Derivatives of columns of the run in the numbers of the scene with these keys, at times or at its end.
    fn sensitivities<'py>(
        &self,
        py: Python<'py>,
        keys: Vec<String>,
        columns: Vec<String>,
        times: Vec<f64>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Derived<'py>> {
        let count = keys.len();
        let request = SensitivityRequest { keys, columns, times };
        let Supervised { value, ended } =
            supervised(py, progress, |caller| sensitivities(&self.scene, &request, caller))?;
        if let Some(ended) = ended {
            return Err(ended);
        }
        let made = value.map_err(raised)?;
        let rows = made.values.len();
        let jacobian = PyArray1::from_vec(py, made.jacobian).reshape([rows, count])?;
        Ok((made.columns, made.times, PyArray1::from_vec(py, made.values), jacobian))
    }
}
