//! How a run depends on its start and on parameters, exactly: for fits, optimisation and error bars.

mod motion;
mod sleigh;
mod text;

use cli::{Caller, Refusal, check_times};
use dla::Schedule;
use harness::{Method, SensitivitiesError};
use scene::{AnyScene, FREE};
use std::fmt::Display;

/// Which derivatives of a run are asked for.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct SensitivityRequest {
    /// The keys to differentiate in: numbers of the start and parameters, by their keys in the scene, as `start.speed`, `sleigh.mass`,
    /// `parameters.m`, or by their names alone.
    pub(crate) keys: Vec<String>,
    /// The columns to differentiate; if empty, coordinates and velocities.
    pub(crate) columns: Vec<String>,
    /// The times (s), in order; if empty, the end of the run.
    pub(crate) times: Vec<f64>,
}

/// Numbers of a run, with their derivatives.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sensitivities {
    /// The columns.
    pub(crate) columns: Vec<String>,
    /// The times (s).
    pub(crate) times: Vec<f64>,
    /// The numbers of all columns at the first time, then at the next.
    pub(crate) values: Vec<f64>,
    /// The derivatives of each of these numbers, in all keys.
    pub(crate) jacobian: Vec<f64>,
}

/// Number of keys in a block: as many as a number carries directions.
const BLOCK: usize = FREE;

/// The numbers of a run at some times, each with its derivatives in a block of keys.
struct SensitivityRows {
    columns: Vec<String>,
    times: Vec<f64>,
    numbers: Vec<(f64, [f64; BLOCK])>,
}

/// A request to a scene, for each block of keys.
struct Asked<'a> {
    method: &'a Method,
    schedule: Schedule,
    request: &'a SensitivityRequest,
    caller: &'a Caller,
}

/// The derivatives of a run, at its end or at some times, in numbers of its start and in parameters.
///
/// The derivatives belong to the discrete motion and are exact but for round-off. The values are the values of [`cli::run`] to the last
/// bit.
///
/// # Errors
/// [`Refusal`] if the request makes no sense for the scene, the method has no derivatives, a step fails, or the caller ends the run.
pub(crate) fn sensitivities(
    scene: &AnyScene,
    request: &SensitivityRequest,
    caller: &Caller,
) -> Result<Sensitivities, Refusal> {
    let settings = scene.run();
    let method = Method::named(&settings.method, settings.alpha).map_err(|error| refused(&error))?;
    if request.keys.is_empty() {
        return Err(refused(&"no keys are given with respect to which derivatives are to be taken"));
    }
    check_times(&request.times, settings.duration)?;
    let asked = Asked { method: &method, schedule: scene.schedule(), request, caller };
    let blocks = request.keys.chunks(BLOCK).map(|keys| match scene {
        AnyScene::Sleigh(sleigh) => sleigh::rows(sleigh, &asked, keys),
        AnyScene::Text(text) => text::rows(text, &asked, keys),
    });
    let blocks: Vec<SensitivityRows> = blocks.collect::<Result<_, _>>()?;
    let Some(SensitivityRows { columns, times, numbers }) = blocks.first() else {
        return Err(refused(&"no keys are given"));
    };
    let mut jacobian = Vec::with_capacity(numbers.len() * request.keys.len());
    for row in 0..numbers.len() {
        for (block, keys) in blocks.iter().zip(request.keys.chunks(BLOCK)) {
            jacobian.extend(&block.numbers[row].1[..keys.len()]);
        }
    }
    let values = numbers.iter().map(|(value, _)| *value).collect();
    Ok(Sensitivities { columns: columns.clone(), times: times.clone(), values, jacobian })
}

/// The key in full of a number that derivatives can be taken in, `start.speed` of `speed`; any other key as it stands.
#[must_use]
pub(crate) fn full_key(scene: &AnyScene, key: &str) -> String {
    let full = match scene {
        AnyScene::Sleigh(_) => sleigh::full_key(key),
        AnyScene::Text(scene) => text::full_key(scene, key),
    };
    full.unwrap_or_else(|| key.to_owned())
}

/// An error of the request.
fn refused(problem: &impl Display) -> Refusal {
    Refusal { message: problem.to_string(), request: true, memory: false }
}

/// Whether an error is one of the request, or of the computation.
fn failed(error: &SensitivitiesError) -> Refusal {
    let request = matches!(error, SensitivitiesError::Method { .. } | SensitivitiesError::Jump { .. });
    Refusal { message: error.to_string(), request, memory: false }
}

/// What is said of a key that derivatives cannot be taken in.
fn no_key(key: &str, known: &impl Display) -> Refusal {
    refused(&format!("no derivative with respect to `{key}` is available; the keys are {known}"))
}

/// The places of the columns that are asked for among those that have derivatives, all of the first `usual` where none are.
fn chosen(asked: &[String], known: &[String], usual: usize) -> Result<Vec<usize>, Refusal> {
    if asked.is_empty() {
        return Ok((0..usual).collect());
    }
    let place = |name: &String| {
        let unknown = || format!("no derivative of `{name}` is available; the columns are {}", known.join(", "));
        known.iter().position(|other| other == name).ok_or_else(|| refused(&unknown()))
    };
    asked.iter().map(place).collect()
}
