//! The pages of the book, and the blocks on them.

use std::fs;
use std::path::{Path, PathBuf};

/// A page, by its path from the root of the repository.
#[derive(Debug)]
pub(super) struct Page {
    pub(super) path: String,
    pub(super) text: String,
}

/// A fenced block: what stands behind the fence, and its lines.
#[derive(Debug)]
pub(super) struct Block<'a> {
    pub(super) language: &'a str,
    pub(super) lines: Vec<&'a str>,
}

pub(super) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

impl Page {
    pub(super) fn read(path: &str) -> Self {
        let text = fs::read_to_string(root().join(path));
        assert!(text.is_ok(), "{path}: {text:?}");
        Self { path: path.to_owned(), text: text.unwrap() }
    }

    pub(super) fn blocks(&self) -> Vec<Block<'_>> {
        let (mut blocks, mut open) = (Vec::new(), None::<Block<'_>>);
        for line in self.text.lines() {
            match (line.strip_prefix("```"), &mut open) {
                (Some(language), None) => open = Some(Block { language, lines: Vec::new() }),
                (Some(_), Some(_)) => blocks.extend(open.take()),
                (None, Some(block)) => block.lines.push(line),
                (None, None) => {}
            }
        }
        assert!(open.is_none(), "{}: a block is not closed", self.path);
        blocks
    }

    /// Its lines outside of blocks.
    pub(super) fn prose(&self) -> impl Iterator<Item = &str> {
        let mut fenced = false;
        self.text.lines().filter(move |line| {
            let fence = line.starts_with("```");
            fenced ^= fence;
            !fenced && !fence
        })
    }

    /// The targets of its links and pictures.
    pub(super) fn links(&self) -> Vec<&str> {
        let targets = self.prose().flat_map(|line| line.split("](").skip(1));
        targets.filter_map(|rest| rest.split(')').next()).collect()
    }

    /// The folder that its links start from.
    pub(super) fn folder(&self) -> PathBuf {
        root().join(&self.path).parent().unwrap().to_path_buf()
    }
}

/// The chapters of the book, in the order of its summary.
pub(super) fn chapters() -> Vec<Page> {
    let summary = Page::read("docs/SUMMARY.md");
    summary.links().iter().map(|path| Page::read(&format!("docs/{path}"))).collect()
}

/// The chapters, and the page that a visitor of the repository sees first.
pub(super) fn pages() -> Vec<Page> {
    chapters().into_iter().chain([Page::read("README.md")]).collect()
}

/// Every file below a folder of the repository, by its path from the root.
pub(super) fn files(folder: &str) -> Vec<String> {
    let mut files = Vec::new();
    for entry in fs::read_dir(root().join(folder)).unwrap() {
        let entry = entry.unwrap();
        let path = format!("{folder}/{}", entry.file_name().into_string().unwrap());
        if entry.file_type().unwrap().is_dir() {
            files.extend(self::files(&path));
        } else {
            files.push(path);
        }
    }
    files
}
