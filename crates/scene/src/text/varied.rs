//! Members of sweeps of systems of text: scenes with other parameters and starts.

use super::{Given, TextScene};
use crate::variation::UNKNOWN;
use ::text::{TextError, TextModel};
use std::sync::Arc;

/// What a sweep may give such a scene.
pub(crate) const NUMBERS: &str = "parameters.NAME of the system's parameters, and start.NAME of its coordinates and rates, like \
                                  parameters.m, start.x, \"start.x'\"";

/// A key and its problem.
pub(crate) type Wrong = (String, String);

impl TextScene {
    /// Whether a sweep may vary that key.
    pub(crate) fn varies(&self, key: &str) -> bool {
        let mut given = self.given.clone();
        self.parameter(key).is_some() || self.started(&mut given, key).is_some()
    }

    /// The place of a parameter by its key.
    fn parameter(&self, key: &str) -> Option<usize> {
        let key = key.strip_prefix("system.").unwrap_or(key);
        let name = key.strip_prefix("parameters.")?;
        self.words.parameters.iter().position(|(known, _)| known == name)
    }

    /// The number of a start by its key.
    fn started<'a>(&self, given: &'a mut Given, key: &str) -> Option<&'a mut Option<f64>> {
        given.named(key.strip_prefix("start.")?, &self.model)
    }

    /// The scene without its forces.
    ///
    /// # Errors
    /// [`TextError`] as of its texts, which were right.
    pub fn without_forces(&self) -> Result<Self, TextError> {
        let mut scene = self.clone();
        scene.words.forces.clear();
        scene.model = Arc::new(TextModel::new(&scene.words)?);
        Ok(scene)
    }

    /// The scene with other numbers.
    ///
    /// # Errors
    /// The key whose value makes no scene, and why.
    pub(crate) fn with_values(&self, values: &[(String, f64)]) -> Result<Self, Wrong> {
        let mut scene = self.clone();
        let mut parameters = None;
        for (key, value) in values {
            if !value.is_finite() {
                return Err((key.clone(), format!("is {value}, and not finite")));
            }
            if let Some(k) = self.parameter(key) {
                scene.words.parameters[k].1 = *value;
                parameters = Some(key);
            } else {
                let place = self.started(&mut scene.given, key).ok_or_else(|| (key.clone(), UNKNOWN.to_owned()))?;
                *place = Some(*value);
            }
        }
        if let Some(key) = parameters {
            let model = TextModel::new(&scene.words).map_err(|error| {
                (
                    key.clone(),
                    format!(
                        "does not give a system: \
                {error}"
                    ),
                )
            })?;
            scene.model = Arc::new(model);
        }
        let Given { q, v } = &scene.given;
        let start = scene.model.start(q, v);
        scene.start = start.map_err(|error| ("start".to_owned(), format!("does not give a start: {error}")))?;
        Ok(scene)
    }
}
