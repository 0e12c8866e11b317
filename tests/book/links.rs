//! What a page names is there, in the repository and in the built book.

use super::pages::{Page, chapters, files, pages, root};
use std::fs;

/// Nothing but chapters becomes a page of the built book, and nothing outside `docs` is in it.
#[test]
fn every_link_resolves() {
    let chapters: Vec<_> = chapters().iter().map(|page| root().join(&page.path).canonicalize().unwrap()).collect();
    let docs = root().join("docs").canonicalize().unwrap();
    let mut seen = 0;
    for page in pages() {
        for link in page.links().into_iter().filter(|link| !link.contains("://") && !link.starts_with('#')) {
            let file = page.folder().join(link.split('#').next().unwrap());
            let found = file.canonicalize().unwrap_or_else(|_| panic!("{}: no file {link}", page.path));
            seen += 1;
            if page.path != "README.md" {
                assert!(found.starts_with(&docs), "{}: {link} is outside the book: name it in code font", page.path);
                assert!(found.is_file(), "{}: {link} is a folder, which is no page", page.path);
                let chapter = found.extension().is_none_or(|ending| ending != "md") || chapters.contains(&found);
                assert!(chapter, "{}: {link} is not in docs/SUMMARY.md", page.path);
            }
        }
    }
    assert!(seen > 100, "only {seen} links were found");
    // The address of the repository stands in Cargo.toml alone: links into it are relative.
    let repository = env!("CARGO_PKG_REPOSITORY");
    for page in pages() {
        assert!(!page.text.contains(repository), "{}: a link to {repository}: name the file", page.path);
    }
}

#[test]
fn every_page_is_a_chapter_once() {
    let mut chapters: Vec<String> = chapters().into_iter().map(|page| page.path).collect();
    let mut pages = files("docs");
    pages.retain(|path| path.ends_with(".md") && path != "docs/SUMMARY.md");
    chapters.sort();
    pages.sort();
    assert_eq!(chapters, pages, "docs/SUMMARY.md on the left, the pages in docs on the right");
}

/// Blocks of Rust are tests of the facade's documentation.
#[test]
fn every_block_of_rust_is_compiled() {
    let facade = fs::read_to_string(root().join("crates/noslip/src/lib.rs")).unwrap();
    let mut tested = 0;
    for page in pages() {
        let languages: Vec<_> = page.blocks().iter().map(|block| block.language.to_owned()).collect();
        let rust: Vec<_> = languages.iter().filter(|language| language.starts_with("rust")).collect();
        for language in &rust {
            assert_eq!(*language, "rust", "{}: a block that is not run", page.path);
        }
        let included = facade.contains(&format!("include_str!(\"../../../{}\")", page.path));
        assert!(rust.is_empty() || included, "{} is not in crates/noslip/src/lib.rs", page.path);
        tested += rust.len();
    }
    assert!(tested >= 5, "only {tested} blocks");
}

/// A page that shows a picture has the command that makes it, and the script of all pictures knows it.
#[test]
fn every_picture_is_shown_and_can_be_made() {
    let pages = pages();
    let script = fs::read_to_string(root().join("docs/pictures/make.sh")).unwrap();
    let drawn = fs::read_to_string(root().join("docs/examples/hard_cases.rs")).unwrap();
    let shows =
        |page: &&Page, name: &str| page.text.contains(&format!("pictures/{name}")) || page.links().contains(&name);
    for file in files("docs/pictures") {
        let name = file.rsplit('/').next().unwrap();
        if ["make.sh", "README.md"].contains(&name) {
            continue;
        }
        let by: Vec<&Page> = pages.iter().filter(|page| shows(page, name)).collect();
        assert!(!by.is_empty(), "no page shows {name}");
        let made = by.iter().any(|page| page.blocks().iter().any(|block| block.language == "sh"));
        assert!(made, "{name}: no page that shows it has a command");
        // The script takes the commands of scenes from the pages of the gallery, and from the scenes of the hard cases; the
        // other cases are drawn by an example.
        let there = |file: String| root().join(file).is_file();
        let scene = name.strip_suffix("-path.svg").is_some_and(|scene| there(format!("docs/gallery/{scene}.md")));
        let case = name.strip_prefix("stability-").and_then(|name| name.strip_suffix(".svg"));
        let scene = scene || case.is_some_and(|case| there(format!("docs/stability/{case}.toml")));
        let scene = scene || case.is_some_and(|case| drawn.contains(&format!("(\"{case}\", ")));
        assert!(scene || script.contains(name), "docs/pictures/make.sh does not make {name}");
    }
}
