use crate::quantity::KeyQuantity;

pub(crate) const MASS: KeyQuantity = KeyQuantity::positive("mass", "kg");
pub(crate) const INERTIA: KeyQuantity = KeyQuantity::positive("inertia", "kg m^2");
pub(crate) const OFFSET: KeyQuantity = KeyQuantity::finite("offset", "m");

pub(crate) const X: KeyQuantity = KeyQuantity::finite("x", "m");
pub(crate) const Y: KeyQuantity = KeyQuantity::finite("y", "m");
pub(crate) const HEADING: KeyQuantity = KeyQuantity::finite("heading", "rad");
pub(crate) const SPEED: KeyQuantity = KeyQuantity::finite("speed", "m/s");
pub(crate) const X_DOT: KeyQuantity = KeyQuantity::finite("x_dot", "m/s");
pub(crate) const Y_DOT: KeyQuantity = KeyQuantity::finite("y_dot", "m/s");
pub(crate) const TURN_RATE: KeyQuantity = KeyQuantity::finite("turn_rate", "rad/s");

pub(crate) const ALPHA: KeyQuantity = KeyQuantity::fraction("alpha");
pub(crate) const TOLERANCE: KeyQuantity = KeyQuantity::positive("tolerance", "");
pub(crate) const STEP: KeyQuantity = KeyQuantity::positive("step", "s");
pub(crate) const DURATION: KeyQuantity = KeyQuantity::positive("duration", "s");

/// The keys that hold a number: no two tables share one.
const QUANTITIES: &[KeyQuantity] =
    &[MASS, INERTIA, OFFSET, X, Y, HEADING, SPEED, X_DOT, Y_DOT, TURN_RATE, ALPHA, TOLERANCE, STEP, DURATION];

/// The tables of a scene, by path, and the keys of each; the path of the document itself is empty.
pub(crate) const TABLES: &[(&str, &[&str])] = &[
    ("", &["title", "sleigh", "start", "run", "effects"]),
    ("sleigh", &[MASS.key, INERTIA.key, OFFSET.key]),
    ("start", &[X.key, Y.key, HEADING.key, SPEED.key, X_DOT.key, Y_DOT.key, TURN_RATE.key]),
    ("run", &["method", ALPHA.key, TOLERANCE.key, STEP.key, DURATION.key]),
];

/// The accepted values of the key with this path; `None` for tables and for unknown keys.
pub(crate) fn accepted(field: &str) -> Option<String> {
    if matches!(field, "title" | "run.method") {
        return Some("a string in quotes".to_owned());
    }
    let (table, key) = field.split_once('.')?;
    let quantity = QUANTITIES.iter().find(|quantity| quantity.key == key)?;
    of(table).contains(&key).then(|| quantity.accepted())
}

/// The keys of the table of that path.
pub(crate) fn of(path: &str) -> &'static [&'static str] {
    TABLES.iter().find(|(table, _)| *table == path).map_or(&[], |(_, keys)| keys)
}

/// The table that has this key.
pub(crate) fn home(key: &str) -> Option<&'static str> {
    TABLES.iter().find(|(_, keys)| keys.contains(&key)).map(|(table, _)| *table)
}

/// `key` of the table `path`, as messages name it.
pub(crate) fn path(table: &str, key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-'));
    let key = if bare { abridged(key) } else { format!("{:?}", abridged(key)) };
    if table.is_empty() { key } else { format!("{table}.{key}") }
}

/// The beginning of a text that a message may quote.
pub(crate) fn abridged(text: &str) -> String {
    const LONGEST: usize = 40;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}
