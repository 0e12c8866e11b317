/// The tables of a scene, by path, and the keys of each; the path of the document itself is empty.
pub(crate) const TABLES: &[(&str, &[&str])] = &[
    ("", &["title", "sleigh", "start", "run", "effects"]),
    ("sleigh", &["mass", "inertia", "offset"]),
    ("start", &["x", "y", "heading", "speed", "turn_rate"]),
    ("run", &["method", "alpha", "step", "duration"]),
];

/// The keys of the table of that path.
pub(crate) fn of(path: &str) -> &'static [&'static str] {
    TABLES.iter().find(|(table, _)| *table == path).map_or(&[], |(_, keys)| keys)
}

/// The other table that has this key.
pub(crate) fn home(key: &str) -> Option<&'static str> {
    TABLES.iter().find(|(_, keys)| keys.contains(&key)).map(|(table, _)| *table)
}

/// `key` of the table `path`, as messages name it.
pub(crate) fn path(table: &str, key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
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
