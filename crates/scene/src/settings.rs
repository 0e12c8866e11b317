//! Settings of the command line: values in place of those of a scene's text, or beside them.

use crate::error::SceneError;
use crate::fault::Fault;
use crate::finding::Excerpt;
use std::fmt;
use std::ops::Range;
use std::str::FromStr;
use toml::de::{DeArray, DeTable, DeValue};
use toml::{Spanned, Table, Value};

/// A key of a scene, dotted as in sweeps, and its value: `sleigh.offset=0.3`, `effects.0.stiffness=[0.2, 0.2]`, `run.method=rk4`.
///
/// The value is TOML; any other text counts as a string. A key `parameters.NAME` means `system.parameters.NAME` in a scene with a table
/// `[system]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setting {
    key: String,
    /// The value in TOML.
    value: String,
    /// The setting as it was written.
    written: String,
}

impl FromStr for Setting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
        let Some((key, value)) = parts.filter(|(key, _)| key.split('.').all(|part| !part.is_empty())) else {
            return Err("accepted is KEY=VALUE, a dotted key of the scene and its value, for example \
                    sleigh.offset=0.3"
                .to_owned());
        };
        // More lines than one could be more keys than one.
        let toml = format!("value = {value}").parse::<Table>().is_ok_and(|table| table.len() == 1);
        let value = if toml { value.to_owned() } else { Value::String(value.to_owned()).to_string() };
        Ok(Self { key: key.to_owned(), value, written: text.trim().to_owned() })
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.written)
    }
}

impl Setting {
    /// The text of a scene with the value in it; everything else stays as it is. An error says why the key has no place there.
    fn put(&self, text: &str, scene: &DeTable<'_>) -> Result<String, String> {
        let inside = self.key.starts_with("parameters.") && scene.contains_key("system");
        let path = if inside { format!("system.{}", self.key) } else { self.key.clone() };
        let parts: Vec<&str> = path.split('.').collect();
        let mut place: Option<&Spanned<DeValue<'_>>> = None;
        for (depth, part) in parts.iter().enumerate() {
            let next = match place.map(Spanned::get_ref) {
                None => scene.get(*part),
                Some(DeValue::Table(table)) => table.get(*part),
                Some(DeValue::Array(list)) => Some(item(list, part)?),
                Some(_) => return Err("leads into a value that has no parts".to_owned()),
            };
            match next {
                Some(value) => place = Some(value),
                None => return self.added(text, place.map(Spanned::span), &parts[depth..]),
            }
        }
        let span = place.map(Spanned::span).unwrap_or_default();
        let headed = |value: &Spanned<DeValue<'_>>| value.get_ref().is_table() && text[value.span()].starts_with('[');
        let whole = place.is_some_and(|value| match value.get_ref() {
            DeValue::Array(list) => list.iter().any(headed),
            _ => headed(value),
        });
        if whole {
            return Err("is a table; accepted are keys in it".to_owned());
        }
        Ok(format!("{}{}{}", &text[..span.start], self.value, &text[span.end..]))
    }

    /// Adds the missing rest of the key to the table at this span, or to the scene itself.
    fn added(&self, text: &str, table: Option<Range<usize>>, rest: &[&str]) -> Result<String, String> {
        let dotted = |parts: &[&str]| parts.iter().map(|part| quoted(part)).collect::<Vec<_>>().join(".");
        let line = format!("{} = {}", dotted(rest), self.value);
        let Some(span) = table else {
            return Ok(match rest {
                [.., last] if rest.len() > 1 => {
                    let home = dotted(&rest[..rest.len() - 1]);
                    format!("{text}\n[{home}]\n{} = {}\n", quoted(last), self.value)
                }
                _ => format!("{line}\n{text}"),
            });
        };
        let inserted = |at: usize, new: String| Ok(format!("{}{new}{}", &text[..at], &text[at..]));
        match text[span.clone()].chars().next() {
            Some('[') => {
                let end = text[span.end..].find('\n').map_or(text.len(), |line| span.end + line);
                inserted(end, format!("\n{line}"))
            }
            Some('{') => {
                let empty = text[span.start + 1..].trim_start().starts_with('}');
                inserted(span.start + 1, format!("{line}{}", if empty { "" } else { ", " }))
            }
            _ => Err("has no place: the scene has no heading of this table".to_owned()),
        }
    }
}

/// A part of a key as TOML takes it.
fn quoted(part: &str) -> String {
    let bare = part.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-'));
    if bare { part.to_owned() } else { Value::String(part.to_owned()).to_string() }
}

/// Item `number` of a list.
fn item<'v, 'd>(list: &'v DeArray<'d>, number: &str) -> Result<&'v Spanned<DeValue<'d>>, String> {
    let found = number.parse::<usize>().ok().and_then(|number| list.get(number));
    found.ok_or_else(|| match list.len() {
        0 => format!("leads to item {number} of a list without items"),
        count => format!("leads to item {number} of a list with the items 0 to {}", count - 1),
    })
}

/// Parses a text with settings. An error of the text itself shows its line; one of the settings, the settings.
pub(crate) fn parse_with<T>(
    text: &str,
    origin: &str,
    settings: &[Setting],
    parse: impl Fn(&str, &str) -> Result<T, SceneError>,
) -> Result<T, SceneError> {
    if settings.is_empty() || DeTable::parse(text).is_err() {
        return parse(text, origin);
    }
    let set = with_settings(text, origin, settings)?;
    parse(&set, origin).map_err(|error| match parse(text, origin) {
        Err(own) => own,
        Ok(_) => error.of_settings(settings, origin),
    })
}

/// The text of a scene with other values in it; what it says besides stays as it is.
///
/// # Errors
/// [`SceneError`] where a setting has no place in it. Whether the values make a scene is not looked at.
pub fn with_settings(text: &str, origin: &str, settings: &[Setting]) -> Result<String, SceneError> {
    let mut set = text.to_owned();
    for setting in settings {
        // What a setting has made of a valid text is one, or it had no place.
        let put = DeTable::parse(&set).map_err(|_| "has no place".to_owned());
        let put = put.and_then(|scene| setting.put(&set, scene.get_ref()));
        set = put.map_err(|problem| no_place(setting, origin, problem))?;
    }
    Ok(set)
}

fn no_place(setting: &Setting, origin: &str, problem: String) -> SceneError {
    let fault = Fault::new(
        SceneError::UnknownKey,
        "",
        problem,
        format!("keys of the scene {origin}, like start.speed, sleigh.offset, effects.0.stiffness.1"),
    );
    fault.at("--set", None, Some(setting.key.clone()), Excerpt::default())
}

impl SceneError {
    /// The error of a text that settings have changed: it has no line that anybody wrote.
    fn of_settings(mut self, settings: &[Setting], origin: &str) -> Self {
        if let Some(finding) = self.finding_mut() {
            let all = settings.iter().map(|setting| format!(" --set {setting}"));
            finding.origin = format!("{origin}{}", all.collect::<String>());
            // A setting numbers effects, where there is one too.
            if let Some(rest) = finding.field.as_ref().and_then(|field| field.strip_prefix("effects.")) {
                finding.field = Some(format!("effects[0].{rest}"));
            }
            finding.place = None;
            finding.excerpt = Excerpt::default();
        }
        self
    }
}
