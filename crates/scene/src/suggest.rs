/// The candidate that `word` is a likely misspelling of, if there is one: the nearest by insertions, deletions,
/// replacements and swaps of neighbours, one for every three letters, case aside.
#[must_use]
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    candidates
        .into_iter()
        .filter_map(|candidate| {
            let letters = candidate.chars().count();
            let limit = letters.div_ceil(3);
            // The length bounds the distance from below, and keeps a key of a million letters from costing its square.
            if word.chars().count().abs_diff(letters) > limit {
                return None;
            }
            let distance = strsim::osa_distance(&word, &candidate.to_lowercase());
            // A word of one letter has nothing in common with another.
            (distance <= limit && distance < letters).then_some((distance, candidate))
        })
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// The names as a list in a sentence, each in quotes.
pub(crate) fn list(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// The words of a suggestion.
pub(crate) fn did_you_mean(name: &str) -> String {
    format!("did you mean `{name}`?")
}
