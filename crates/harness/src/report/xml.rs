//! Text as HTML and SVG take it.

/// The text with the characters that mean something to HTML and XML escaped, and those that XML forbids replaced.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars().map(allowed) {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            c => escaped.push(c),
        }
    }
    escaped
}

/// A label for a picture: one line, allowed characters only, cut to `most` characters.
pub(super) fn label(text: &str, most: usize) -> String {
    let mut label: String =
        text.chars().map(|c| if c.is_whitespace() { ' ' } else { allowed(c) }).take(most + 1).collect();
    if label.chars().count() > most {
        label = label.chars().take(most.saturating_sub(1)).collect();
        label.push('…');
    }
    label
}

fn allowed(c: char) -> char {
    match c {
        '\t' | '\n' | '\r' => c,
        c if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') => '\u{FFFD}',
        c => c,
    }
}
