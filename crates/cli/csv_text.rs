//! Fields of comma-separated values (RFC 4180).

/// The header of a file with columns of these headings.
pub(crate) fn header(headings: impl IntoIterator<Item = String>) -> String {
    headings.into_iter().map(|heading| quoted(&heading)).collect::<Vec<_>>().join(",")
}

/// A text field. It is quoted if it contains a separator, a quote or a line break, or if a spreadsheet would read it as a formula.
pub(crate) fn quoted(text: &str) -> String {
    let formula = text.starts_with(['=', '+', '-', '@']) && text.parse::<f64>().is_err();
    if formula || text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
