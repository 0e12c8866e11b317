//! Functions of time.

use crate::error::SceneError;
use crate::points;
use crate::quantity::KeyQuantity;
use crate::table::{TomlTable, as_f64};
use sleigh::{Formula, Ramp, SleighError, Table, TimeFunction};
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
        let linear = table.is_linear()?;
        let (times, values) = match form[0] {
            "file" => table.points_of_file(quantity)?,
            _ => (table.listed(&TIMES)?, table.listed(&quantity.named("values"))?),
        };
        let function = match linear {
            true => Ramp::new(times, values).map(TimeFunction::Ramp),
            false => Table::new(times, values).map(TimeFunction::Table),
        };
        function.map(Some).map_err(|error| table.wrong(form[0], &error.to_string(), accepted(quantity)))
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
