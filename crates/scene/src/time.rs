//! Functions of time.

use crate::error::SceneError;
use crate::points;
use crate::quantity::KeyQuantity;
use crate::table::{TomlTable, as_f64};
use sleigh::{Formula, Ramp, SleighError, Table, TimeFunction};
use std::fmt::Write as _;
use toml::de::DeValue;

const FREQUENCY: KeyQuantity = KeyQuantity::finite("frequency", "rad/s");
const PHASE: KeyQuantity = KeyQuantity::finite("phase", "rad");
const TIMES: KeyQuantity = KeyQuantity::finite("times", "s");

/// The forms of a function that is no number and no text: the keys of each, the first of which tells it.
const FORMS: [&[&str]; 3] = [
    &["times", "values", "interpolation"],
    &["file", "columns", "interpolation"],
    &["amplitude", "frequency", "phase"],
];

impl TomlTable<'_> {
    /// A function of time: a number, a formula, a sine, or points in the scene or in a file; if the table has it.
    pub(crate) fn time_function(&self, quantity: &KeyQuantity) -> Result<Option<TimeFunction>, SceneError> {
        let Some(value) = self.get(quantity.key) else { return Ok(None) };
        if as_f64(value.get_ref()).is_some() {
            return Ok(self.number(quantity)?.map(TimeFunction::Constant));
        }
        if let DeValue::String(text) = value.get_ref() {
            let formula = Formula::new(text);
            let formula = formula.map_err(|error| self.wrong(quantity.key, &said(&error), accepted(quantity)))?;
            return Ok(Some(TimeFunction::Formula(formula)));
        }
        let known = ["amplitude", "frequency", "phase", "times", "values", "file", "columns", "interpolation"];
        let Some(table) = self.nested(quantity.key, &known, || accepted(quantity))? else { return Ok(None) };
        // A key that another form has is told apart from one that is missing.
        let given = |keys: &&&[&str]| keys[..2].iter().any(|key| table.get(key).is_some());
        let form = FORMS.iter().find(given).unwrap_or(&FORMS[2]);
        if let Some(key) = known.into_iter().find(|key| table.get(key).is_some() && !form.contains(key)) {
            let problem = format!("does not go with `{}` and `{}`", form[0], form[1]);
            return Err(table.wrong(key, &problem, accepted(quantity)));
        }
        if form[0] == "amplitude" {
            return Ok(Some(TimeFunction::Sine {
                amplitude: table.required(&quantity.named("amplitude"))?,
                frequency: table.required(&FREQUENCY)?,
                phase: table.number(&PHASE)?.unwrap_or(0.0),
            }));
        }
        table.points(form[0], quantity, &accepted(quantity)).map(Some)
    }

    /// A function of time by the points of this table, in the form that begins with the key `form`.
    fn points(&self, form: &'static str, quantity: &KeyQuantity, accepted: &str) -> Result<TimeFunction, SceneError> {
        let linear = self.is_linear()?;
        let (times, values) = match form {
            "file" => self.points_of_file(quantity)?,
            _ => (self.listed(&TIMES)?, self.listed(&quantity.named("values"))?),
        };
        let function = match linear {
            true => Ramp::new(times, values).map(TimeFunction::Ramp),
            false => Table::new(times, values).map(TimeFunction::Table),
        };
        function.map_err(|error| self.wrong(form, &error.to_string(), accepted.to_owned()))
    }

    /// The formula in `t` of the points of this table, for a system of text: ramps as sums of `max(0, t - ..)`, steps as sums of `step(t - ..)`.
    pub(crate) fn formula_of_points(&self) -> Result<String, SceneError> {
        /// A formula is evaluated as a whole.
        const MOST: usize = 1000;
        let form = if self.get("file").is_some() { "file" } else { "times" };
        let values = KeyQuantity::finite("values", "the unit of the formulas that use it");
        let accepted =
            format!("`{{times, values, interpolation}}` or `{{file, columns, interpolation}}`, at most {MOST} points");
        let function = self.points(form, &values, &accepted)?;
        let (times, values) = match &function {
            TimeFunction::Ramp(ramp) => (ramp.times(), ramp.values()),
            TimeFunction::Table(table) => (table.times(), table.values()),
            _ => (&[][..], &[][..]),
        };
        if times.len() > MOST {
            return Err(self.wrong(form, &format!("has {} points", times.len()), accepted));
        }
        let mut formula = format!("{:?}", values.first().copied().unwrap_or(0.0));
        let mut add = |change: f64, part: &str, time: f64| {
            if change != 0.0 {
                let _ = write!(formula, " + {change:?}*{part}t - {time:?})");
            }
        };
        if matches!(function, TimeFunction::Ramp(_)) {
            let mut before = 0.0;
            for (t, v) in times.windows(2).zip(values.windows(2)) {
                let slope = (v[1] - v[0]) / (t[1] - t[0]);
                add(slope - before, "max(0, ", t[0]);
                before = slope;
            }
            add(-before, "max(0, ", times.last().copied().unwrap_or(0.0));
        } else {
            for (time, v) in times.iter().skip(1).zip(values.windows(2)) {
                add(v[1] - v[0], "step(", *time);
            }
        }
        Ok(formula)
    }

    /// A function of time.
    pub(crate) fn required_function(&self, quantity: &KeyQuantity) -> Result<TimeFunction, SceneError> {
        self.time_function(quantity)?.ok_or_else(|| self.missing(quantity.key, accepted(quantity)))
    }

    /// Whether straight lines join the points of a table; where the table does not say it, steps do.
    fn is_linear(&self) -> Result<bool, SceneError> {
        let names = || "`\"steps\"` or `\"linear\"`".to_owned();
        match self.text("interpolation", &names())? {
            None | Some("steps") => Ok(false),
            Some("linear") => Ok(true),
            Some(_) => Err(self.wrong("interpolation", "is not a known interpolation", names())),
        }
    }

    fn listed(&self, quantity: &KeyQuantity) -> Result<Vec<f64>, SceneError> {
        let list = self.numbers(quantity)?;
        list.ok_or_else(|| self.missing(quantity.key, "a list of numbers".to_owned()))
    }

    /// The points of a file of numbers, which lies where the scene says, seen from the folder of the scene.
    fn points_of_file(&self, quantity: &KeyQuantity) -> Result<(Vec<f64>, Vec<f64>), SceneError> {
        let accepted = || {
            format!("the path of a file of comma-separated values with a column of times and one in {}", quantity.unit)
        };
        let path = self.text("file", &accepted())?.ok_or_else(|| self.missing("file", accepted()))?;
        let pair = || "a list of two names, the column of the times first".to_owned();
        let Some(value) = self.get("columns") else { return Err(self.missing("columns", pair())) };
        let names: Option<Vec<&str>> =
            value.get_ref().as_array().and_then(|list| list.iter().map(|name| name.get_ref().as_str()).collect());
        let names: Option<[&str; 2]> = names.and_then(|names| names.try_into().ok());
        let names = names.ok_or_else(|| self.wrong_type("columns", value, pair()))?;
        points::read(self.document.origin, path, names).map_err(|fault| match fault {
            points::Fault::File(problem) => self.wrong("file", &problem, accepted()),
            points::Fault::Column { problem, known } => self.wrong("columns", &problem, known),
        })
    }
}

/// The words of an error whose beginning the message has already.
fn said(error: &SleighError) -> String {
    match error {
        SleighError::Formula { problem } => format!("is not a function of the time `t`: {problem}"),
        other => other.to_string(),
    }
}

fn accepted(quantity: &KeyQuantity) -> String {
    format!(
        "a function of time in {}: a number, a formula in `t` in quotes, `{{amplitude, frequency, phase}}`, \
         `{{times, values, interpolation}}` or `{{file, columns, interpolation}}`",
        quantity.unit
    )
}
