//! Equations have numbers, and what is cited by a number is there.

use super::pages::{Page, chapters, files};
use std::collections::BTreeSet;

/// The numbers `(chapter.equation)` in a line.
fn numbers(line: &str) -> Vec<(u32, u32)> {
    let inner = line.split('(').skip(1).filter_map(|rest| rest.split_once(')')).map(|(inner, _)| inner);
    inner
        .filter_map(|inner| inner.split_once('.'))
        .filter_map(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)))
        .collect()
}

/// The numbers at the ends of the lines of its equations.
fn equations(page: &Page) -> Vec<(u32, u32)> {
    let blocks = page.blocks();
    let lines = blocks.iter().flat_map(|block| &block.lines).filter(|line| line.ends_with(')'));
    lines.filter_map(|line| numbers(&line[line.rfind('(').unwrap()..]).pop()).collect()
}

#[test]
fn numbers_are_consecutive_and_citations_exist() {
    let chapters = chapters();
    let theory: Vec<&Page> =
        chapters.iter().filter(|page| page.path.starts_with("docs/theory/") && !equations(page).is_empty()).collect();
    let mut all = BTreeSet::new();
    for (number, page) in (1..).zip(&theory) {
        let found = equations(page);
        let expected: Vec<_> = (1..=found.len() as u32).map(|equation| (number, equation)).collect();
        assert_eq!(found, expected, "{}", page.path);
        all.extend(found);
    }
    assert!(all.len() > 40, "only {} equations", all.len());
    let citing = |page: &&Page| {
        ["docs/theory/", "docs/methods/", "docs/guide/", "docs/phenomena/", "docs/notes", "docs/intro"]
            .iter()
            .any(|start| page.path.starts_with(start))
    };
    for page in chapters.iter().filter(citing) {
        for cited in page.prose().flat_map(numbers) {
            assert!(all.contains(&cited), "{}: there is no equation {cited:?}", page.path);
        }
    }
    // The documentation of the code cites "the book, (3.1)", and goes on in the next line at times.
    let mut seen = 0;
    for path in files("crates").into_iter().filter(|path| path.ends_with(".rs")) {
        let page = Page::read(&path);
        let text = page.text.replace("\n/// ", " ").to_lowercase();
        for citation in text.split("the book, (").skip(1) {
            // Up to the end of the bracket or sentence that it stands in.
            let sentence = format!("({}", citation.split(".)").next().unwrap());
            let cited = numbers(sentence.lines().next().unwrap());
            seen += cited.len();
            assert!(!cited.is_empty() && cited.iter().all(|cited| all.contains(cited)), "{path}: {cited:?}");
        }
    }
    assert!(seen >= 10, "only {seen} citations");
}
