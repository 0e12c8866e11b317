//! What varies of a scene: the tables `[grid]` and `[random]` of a sweep.

use crate::draw::{self, Draw};
use crate::error::SceneError;
use crate::fault::Fault;
use crate::keys::abridged;
use crate::suggest;
use crate::table::{TomlTable, as_f64};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// What is said of a key that names no number.
pub(crate) const UNKNOWN: &str = "is not a number of the scene";

/// A key of the scene in a sweep, with what the sweep gives it.
pub(crate) struct VariedScene<'s, T> {
    pub(crate) key: String,
    pub(crate) values: T,
    value: &'s Spanned<DeValue<'s>>,
    /// Where the key is.
    span: Range<usize>,
}

impl<T> VariedScene<'_, T> {
    /// An error of the key.
    pub(crate) fn fail(&self, root: &TomlTable<'_>, problem: &str, accepted: &str) -> SceneError {
        fail(root, &self.key, &self.span, None, problem, accepted)
    }
}

/// The keys of `[grid]` with their values, and the keys of `[random]` with their distributions, in alphabetical order.
type SweepVariation<'s> = (Vec<VariedScene<'s, Vec<f64>>>, Vec<VariedScene<'s, Draw>>);

/// Reads both tables; a key that comes twice in them is refused.
pub(crate) fn read<'s>(root: &TomlTable<'s>) -> Result<SweepVariation<'s>, SceneError> {
    let (grid, random) = (leaves(root, "grid", &[])?, leaves(root, "random", &["count", "seed", "common"])?);
    let mut seen: Vec<&VariedScene<'_, ()>> = grid.iter().chain(&random).collect();
    seen.sort_by(|a, b| (&a.key, a.span.start).cmp(&(&b.key, b.span.start)));
    if let Some([first, second]) = seen.windows(2).find(|pair| pair[0].key == pair[1].key) {
        let problem = format!("varies already, at line {}", root.document.line(first.span.start));
        return Err(second.fail(root, &problem, "each key once in `[grid]` and `[random]` together"));
    }
    let grid = grid.into_iter().map(|leaf| {
        let values = values(root, &leaf)?;
        Ok(VariedScene { key: leaf.key, values, value: leaf.value, span: leaf.span })
    });
    let random = random.into_iter().map(|leaf| {
        let draw = Draw::read(leaf.value.get_ref());
        let values = draw.map_err(|problem| {
            let span = leaf.value.span();
            fail(root, &leaf.key, &span, found(root, &span), problem, draw::ACCEPTED)
        })?;
        Ok(VariedScene { key: leaf.key, values, value: leaf.value, span: leaf.span })
    });
    Ok((grid.collect::<Result<_, _>>()?, random.collect::<Result<_, _>>()?))
}

/// The keys below a table, dotted: a table that says how a number varies has no table in it.
fn leaves<'s>(
    root: &TomlTable<'s>,
    section: &'static str,
    own: &[&str],
) -> Result<Vec<VariedScene<'s, ()>>, SceneError> {
    let Some(value) = root.get(section) else { return Ok(Vec::new()) };
    let DeValue::Table(table) = value.get_ref() else {
        return Err(root.wrong_type(section, value, format!("the table `[{section}]`, with keys of the scene")));
    };
    let mut found = Vec::new();
    collect(table, "", &mut found);
    found.retain(|leaf| !own.contains(&leaf.key.as_str()));
    found.sort_by(|a, b| a.key.cmp(&b.key));
    Ok(found)
}

fn collect<'s>(table: &'s DeTable<'s>, path: &str, found: &mut Vec<VariedScene<'s, ()>>) {
    for (key, value) in table {
        // `effects.00` is `effects.0`.
        let part = |part: &str| part.parse::<usize>().map_or_else(|_| part.to_owned(), |index| index.to_string());
        let written: &str = key.get_ref();
        let written = written.split('.').map(part).collect::<Vec<_>>().join(".");
        let path = if path.is_empty() { written } else { format!("{path}.{written}") };
        match value.get_ref() {
            DeValue::Table(inner)
                if !["from", "to", "uniform", "normal", "log_uniform"].iter().any(|key| inner.contains_key(*key)) =>
            {
                collect(inner, &path, found);
            }
            _ => found.push(VariedScene { key: path, values: (), value, span: key.span() }),
        }
    }
}

/// The key whose values are names of methods.
pub(crate) const METHOD: &str = "run.method";

/// The names in the list of the key [`METHOD`], each of which is to be a known one; its values are their places.
pub(crate) fn method_names(
    root: &TomlTable<'_>,
    leaf: &VariedScene<'_, Vec<f64>>,
    methods: &[&str],
) -> Result<Vec<String>, SceneError> {
    let name = |value: &Spanned<DeValue<'_>>| {
        let known = value.get_ref().as_str().filter(|name| methods.contains(name));
        known.map(ToOwned::to_owned).ok_or_else(|| {
            let accepted = format!("a list of names of methods: {}", suggest::list(methods));
            fail(root, METHOD, &value.span(), found(root, &value.span()), "names no known method", &accepted)
        })
    };
    leaf.value.get_ref().as_array().into_iter().flatten().map(name).collect()
}

/// The values of a key of the grid.
fn values(root: &TomlTable<'_>, leaf: &VariedScene<'_, ()>) -> Result<Vec<f64>, SceneError> {
    const ACCEPTED: &str = "a list of finite numbers, or { from, to, count }";
    let wrong = |span: Range<usize>, problem: &str, accepted: &str| {
        fail(root, &leaf.key, &span, found(root, &span), problem, accepted)
    };
    let finite = |value: &Spanned<DeValue<'_>>| {
        let number = as_f64(value.get_ref()).filter(|number| number.is_finite());
        number.ok_or_else(|| wrong(value.span(), "has a value that is not a finite number", ACCEPTED))
    };
    match leaf.value.get_ref() {
        DeValue::Array(list) if list.is_empty() => Err(wrong(leaf.value.span(), "has no values", ACCEPTED)),
        // Of names their places.
        DeValue::Array(list) if leaf.key == METHOD => Ok((0..list.len()).map(|place| place as f64).collect()),
        DeValue::Array(list) => list.iter().map(finite).collect(),
        DeValue::Table(range) => {
            let known = ["from", "to", "count"];
            if let Some(key) = range.keys().find(|key| !known.contains(&key.get_ref().as_ref())) {
                let problem = format!("has no key `{}`", abridged(key.get_ref()));
                return Err(wrong(key.span(), &problem, &suggest::list(&known)));
            }
            let of = |key: &str| {
                let missing = || wrong(leaf.value.span(), &format!("lacks `{key}`"), "{ from, to, count }, all three");
                range.get(key).ok_or_else(missing)
            };
            let (from, to, count) = (finite(of("from")?)?, finite(of("to")?)?, of("count")?);
            let whole = count.get_ref().as_integer().and_then(|n| u32::from_str_radix(n.as_str(), n.radix()).ok());
            let whole = whole.filter(|count| *count > 0).ok_or_else(|| {
                let accepted = "a whole number from 1 to 4294967295, without a point or an exponent";
                wrong(count.span(), "has a `count` that is not a whole number from 1 on", accepted)
            })?;
            let part = |i: u32| f64::from(i) / f64::from(whole.max(2) - 1);
            Ok((0..whole).map(|i| (1.0 - part(i)) * from + part(i) * to).collect())
        }
        _ => Err(wrong(leaf.value.span(), "is neither a list of numbers nor { from, to, count }", ACCEPTED)),
    }
}

/// What the text has at a place.
fn found(root: &TomlTable<'_>, span: &Range<usize>) -> Option<String> {
    Some(abridged(&root.document.text[span.clone()]))
}

fn fail(
    root: &TomlTable<'_>,
    key: &str,
    span: &Range<usize>,
    found: Option<String>,
    problem: &str,
    accepted: &str,
) -> SceneError {
    let (problem, accepted) = (problem, accepted.to_owned());
    let fault = Fault::new(SceneError::OutOfRange, "", problem, accepted).found(found);
    root.document.fail(span, Some(key.to_owned()), fault)
}
