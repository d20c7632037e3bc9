//! The book of bsmpm, an mdBook: its chapters are the Markdown files beside this one, in the order of `SUMMARY.md`.
//! `scripts/book` builds the HTML, `scripts/book --check` runs every command.
//!
//! What a fenced block is, its attributes say, separated by commas:
//!
//! | fence | meaning |
//! | --- | --- |
//! | `toml,file=NAME`, `python,file=NAME` | the file NAME of the reader's directory; a `toml` one is a complete case |
//! | `toml,append=NAME` | is appended to NAME, which stays a complete case |
//! | `sh` | commands of the reader, run in the order of the book in one directory; `sh,exit=N`: they end with code N |
//! | `sh,not-run` | commands that cannot run in a check; they are counted and listed |
//! | `text,output` | what the commands before it print among other lines; `...` stands for anything within a line |
//! | `rust` | is compiled and run as a doctest of this crate |
//!
//! Links out of the book are relative paths of the repository, so that they work where its files are browsed; in the
//! built HTML they lead to the files of the clone that it was built from. Pictures of `cases/pictures` are copied.
#![forbid(unsafe_code)]

use std::path::{Path, PathBuf};
use std::{fs, io};

#[doc = include_str!("adding-a-law.md")]
pub mod adding_a_law {}

/// A chapter.
#[derive(Clone, Debug)]
pub struct Chapter {
    /// Name of its file in [`source`].
    pub file: String,
    /// Its Markdown.
    pub text: String,
}

/// A fenced block of a chapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// Line of its fence, from 1.
    pub line: usize,
    /// Its language; empty without one.
    pub language: String,
    /// Its other attributes as written.
    pub attributes: Vec<String>,
    /// What is between the fences.
    pub text: String,
}

impl Block {
    /// Whether it has this attribute.
    pub fn is(&self, attribute: &str) -> bool {
        self.attributes.iter().any(|own| own == attribute)
    }

    /// What follows `NAME=` in its attributes.
    pub fn value(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find_map(|own| own.strip_prefix(name)?.strip_prefix('='))
    }
}

/// Folder of the chapters.
pub fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// The chapters in the order of `SUMMARY.md`.
///
/// # Errors
/// When the summary or a chapter that it names cannot be read.
pub fn chapters() -> io::Result<Vec<Chapter>> {
    let summary = fs::read_to_string(source().join("SUMMARY.md"))?;
    let files = links(&summary).into_iter().map(|(_, file)| file);
    files.map(|file| Ok(Chapter { text: fs::read_to_string(source().join(&file))?, file })).collect()
}

/// The fenced blocks of a chapter in order.
pub fn blocks(text: &str) -> Vec<Block> {
    let (mut found, mut open): (Vec<Block>, Option<Block>) = (Vec::new(), None);
    for (number, line) in text.lines().enumerate() {
        match (line.strip_prefix("```"), &mut open) {
            (Some(_), Some(_)) => found.extend(open.take()),
            (None, Some(block)) => {
                block.text.push_str(line);
                block.text.push('\n');
            }
            (Some(info), None) => {
                let mut words = info.split(',').map(|word| word.trim().to_owned());
                let language = words.next().unwrap_or_default();
                open = Some(Block { line: number + 1, language, attributes: words.collect(), text: String::new() });
            }
            (None, None) => {}
        }
    }
    found
}

/// Links and pictures outside of fenced blocks: line, from 1, and target.
pub fn links(text: &str) -> Vec<(usize, String)> {
    let (mut found, mut fenced) = (Vec::new(), false);
    for (number, line) in text.lines().enumerate() {
        fenced ^= line.starts_with("```");
        if !fenced {
            let targets = line.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
            found.extend(targets.map(|(target, _)| (number + 1, target.to_owned())));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_and_links_are_found() {
        let text = "[a](b.md#c)\n```toml,file=x.toml\nk = \"[no](link)\"\n```\n\n```\nplain\n```\n![p](q.png)\n";
        let found = blocks(text);
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].line, found[0].value("file")), (2, Some("x.toml")));
        assert_eq!((found[1].language.as_str(), found[1].text.as_str()), ("", "plain\n"));
        assert_eq!(links(text), [(1, "b.md#c".to_owned()), (9, "q.png".to_owned())]);
    }
}
