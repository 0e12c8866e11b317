//! The sections of `docs/stability.md`, and the row in each of them of who passes the case.

/// A text without its line breaks.
pub(crate) fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What stands under the heading of a case.
pub(crate) fn section<'a>(page: &'a str, case: &str) -> Option<&'a str> {
    let (_, rest) = page.split_once(&format!("\n## {case}\n"))?;
    rest.split("\n## ").next()
}

fn is_row(line: &str) -> bool {
    line.starts_with("| pass | ")
}

/// The row of who passes.
pub(crate) fn listed(section: &str) -> Option<&str> {
    section.lines().find(|line| is_row(line))
}

/// Who passes a case, from every method and whether it passes: the shorter of the names that pass and of those that refuse.
pub(crate) fn row(of_it: Vec<(&str, bool)>) -> String {
    let all = of_it.len();
    let (pass, refuse): (Vec<_>, Vec<_>) = of_it.into_iter().partition(|(_, passes)| *passes);
    let named = |methods: &[(&str, bool)]| {
        methods.iter().map(|(method, _)| format!("`{method}`")).collect::<Vec<_>>().join(", ")
    };
    let who = match (pass.len(), refuse.len()) {
        (_, 0) => format!("all {all}"),
        (0, _) => format!("none: all {all} refuse"),
        (some, rest) if some <= rest => format!("{} ({some} of {all})", named(&pass)),
        (some, _) => format!("all but {} ({some} of {all})", named(&refuse)),
    };
    format!("| pass | {who} |")
}

/// The page with another row in a section.
pub(crate) fn with_row(page: &str, case: &str, row: &str) -> String {
    let Some(old) = section(page, case) else { return page.to_owned() };
    let lines: Vec<_> = old.lines().map(|line| if is_row(line) { row } else { line }).collect();
    let new = lines.join("\n") + if old.ends_with('\n') { "\n" } else { "" };
    page.replacen(&format!("\n## {case}\n{old}"), &format!("\n## {case}\n{new}"), 1)
}
