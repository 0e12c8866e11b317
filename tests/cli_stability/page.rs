//! The sections of `docs/stability.md`, and the lists in them of who passes a case and who refuses it.

/// A text without its line breaks.
pub(crate) fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What stands under the heading of a case.
pub(crate) fn section<'a>(page: &'a str, case: &str) -> Option<&'a str> {
    let (_, rest) = page.split_once(&format!("\n## {case}\n"))?;
    rest.split("\n## ").next()
}

fn is_list(paragraph: &str) -> bool {
    let all = paragraph.starts_with("All ") && paragraph.ends_with(" methods pass.");
    all || ["Pass (", "Refused ("].iter().any(|start| paragraph.starts_with(start))
}

/// The paragraphs of a section that are lists, each without its line breaks.
pub(crate) fn listed(section: &str) -> Vec<String> {
    section.split("\n\n").map(str::trim).filter(|paragraph| is_list(paragraph)).map(words).collect()
}

/// The lists of a case, from every method and whether it passes.
pub(crate) fn lists(of_it: Vec<(&str, bool)>) -> Vec<String> {
    let all = of_it.len();
    let (pass, refuse): (Vec<_>, Vec<_>) = of_it.into_iter().partition(|(_, passes)| *passes);
    if refuse.is_empty() {
        return vec![format!("All {all} methods pass.")];
    }
    [("Pass", pass), ("Refused", refuse)]
        .into_iter()
        .filter(|(_, methods)| !methods.is_empty())
        .map(|(outcome, methods)| {
            let names: Vec<_> = methods.iter().map(|(method, _)| format!("`{method}`")).collect();
            format!("{outcome} ({}): {}.", names.len(), names.join(", "))
        })
        .collect()
}

/// The page with other lists in a section: where these were, or behind its command.
pub(crate) fn with_lists(page: &str, case: &str, lists: &[String]) -> String {
    let Some(old) = section(page, case) else { return page.to_owned() };
    let mut paragraphs: Vec<_> = old.split("\n\n").map(str::to_owned).collect();
    let behind = paragraphs.iter().position(|paragraph| paragraph.trim_end().ends_with("```")).map_or(0, |at| at + 1);
    let at = paragraphs.iter().position(|paragraph| is_list(paragraph.trim())).unwrap_or(behind);
    paragraphs.retain(|paragraph| !is_list(paragraph.trim()));
    let at = at.min(paragraphs.len());
    paragraphs.splice(at..at, lists.iter().map(|list| broken(list)));
    let new = format!("{}\n", paragraphs.join("\n\n").trim_end());
    page.replacen(&format!("\n## {case}\n{old}"), &format!("\n## {case}\n{new}"), 1)
}

/// In lines of the page's width.
fn broken(text: &str) -> String {
    const WIDTH: usize = 118;
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line = lines.last_mut().unwrap();
        if line.is_empty() {
            line.push_str(word);
        } else if line.len() + 1 + word.len() <= WIDTH {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines.join("\n")
}
