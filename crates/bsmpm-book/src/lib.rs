//! The manual of bsmpm. Its chapters are the Markdown files in this folder, in the order of `SUMMARY.md`.
//! `scripts/book` builds the manual with mdBook. This library parses the chapters for the tests, for the build
//! (`main.rs`) and for `examples/walk.rs`, which executes all commands of the manual.
//!
//! # Fenced blocks
//!
//! The words after an opening fence, separated by commas, say what the block contains.
//!
//! | fence | meaning |
//! | --- | --- |
//! | `toml,file=NAME`, `python,file=NAME` | The file NAME, which the reader writes. A `toml` file is a complete case. |
//! | `toml,append=NAME` | Text that the reader appends to NAME, which remains a complete case. |
//! | `toml,wrong` | A case with an intended error; also has `file=` or `append=`. |
//! | `toml,coarse=KEY:VALUE` | A fast check uses `KEY = VALUE` in this block. May be repeated. |
//! | `sh` | Commands of the reader, which end with code 0. |
//! | `sh,exit=N` | Commands that end with code N. |
//! | `sh,not-run` | Commands that a check lists but cannot execute. |
//! | `text,output` | Lines that the preceding commands print, among others; `...` matches any text within a line. |
//! | `text,output,full` | As `text,output`, but not compared in a fast check. |
//! | `rust` | Compiled and executed as a doctest of this crate. |
//!
//! The fast check is `scripts/book --check`; `scripts/book --full` uses the cases as printed. Each tutorial begins in
//! an empty directory with the repository's `cases/`. All other chapters share one such directory.
//!
//! # Links and pictures
//!
//! A link is the path of a file relative to the page, so that it works where the repository is browsed. In the HTML
//! manual, a link to a file of the repository leads to a page with a copy of this file.
//!
//! After a picture that commands of the chapter draw, a comment names the file that they write:
//! `![caption](../pictures/tutorials/slope.png)<!-- slope.out/strain.png -->`. A fast check verifies that this file was
//! written. `scripts/book --full` also copies it to the path of the picture.
//!
//! # Equations
//!
//! `\tag{3.2}` numbers equation 2 of chapter 3 of the theory manual. Source code and other pages cite it as `(T3.2)`.
#![forbid(unsafe_code)]

mod links;

pub use links::{Link, Picture, captioned, links, pictures, relinked};

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag};
use std::ops::Range;
use std::path::{Component, Path, PathBuf};
use std::{fs, io};

#[cfg(doctest)]
#[doc = include_str!("how-to/add-a-law.md")]
pub mod add_a_law {}

/// One page of the manual.
#[derive(Clone, Debug)]
pub struct Chapter {
    /// Path of its file, relative to [`source`].
    pub file: String,
    /// Markdown.
    pub text: String,
}

impl Chapter {
    /// Whether this is a tutorial: its commands run in a directory that no other chapter uses.
    pub fn is_tutorial(&self) -> bool {
        self.file.starts_with("tutorials/")
    }

    /// Folder that its links are relative to.
    pub fn folder(&self) -> PathBuf {
        let path = source().join(&self.file);
        path.parent().map_or_else(source, Path::to_path_buf)
    }
}

/// A fenced block of a chapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// Line of its fence in the chapter, from 1.
    pub line: usize,
    /// Bytes of the chapter from its first fence to its last.
    pub range: Range<usize>,
    /// First word after the fence; empty without one.
    pub language: String,
    /// The other words after the fence.
    pub attributes: Vec<String>,
    /// Text between the fences.
    pub text: String,
}

impl Block {
    /// Whether it has this attribute.
    pub fn is(&self, attribute: &str) -> bool {
        self.attributes.iter().any(|present| present == attribute)
    }

    /// The text after `NAME=` in its attributes.
    pub fn value(&self, name: &str) -> Option<&str> {
        self.values(name).next()
    }

    /// The text after each `NAME=` in its attributes.
    pub fn values(&self, name: &str) -> impl Iterator<Item = &str> {
        self.attributes
            .iter()
            .filter_map(move |attribute| attribute.strip_prefix(name)?.strip_prefix('='))
    }

    /// Its text in a coarse run: every `coarse=KEY:VALUE` replaces one line.
    ///
    /// # Errors
    /// A sentence, if an attribute has no colon, or if the block has not exactly one line with its key.
    pub fn coarse_text(&self) -> Result<String, String> {
        let mut lines: Vec<String> = self.text.lines().map(str::to_owned).collect();
        for replacement in self.values("coarse") {
            let (key, value) = replacement
                .split_once(':')
                .ok_or(format!("coarse={replacement} has no colon"))?;
            let mut same_key = lines.iter_mut().filter(|line| is_line_of(line, key));
            let line = same_key
                .next()
                .ok_or(format!("coarse={replacement}: no line begins with `{key} =`"))?;
            if same_key.next().is_some() {
                return Err(format!("coarse={replacement}: two lines begin with `{key} =`"));
            }
            *line = format!("{key} = {value}");
        }
        Ok(lines.iter().map(|line| format!("{line}\n")).collect())
    }
}

/// Whether a line of a case file sets this key.
fn is_line_of(line: &str, key: &str) -> bool {
    line.split_once('=').is_some_and(|(name, _)| name.trim() == key)
}

/// Folder of the chapters.
pub fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Root of the repository.
pub fn repository() -> PathBuf {
    normalised(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."))
}

/// The path without `.` and `..`, for paths without symbolic links.
pub fn normalised(path: &Path) -> PathBuf {
    let mut found = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                found.pop();
            }
            other => found.push(other),
        }
    }
    found
}

/// The chapters in the order of `SUMMARY.md`.
///
/// # Errors
/// If the summary, or a chapter that it names, cannot be read.
pub fn chapters() -> io::Result<Vec<Chapter>> {
    let summary = fs::read_to_string(source().join("SUMMARY.md"))?;
    let mut chapters = Vec::new();
    for file in files_of_summary(&summary) {
        let text = fs::read_to_string(source().join(&file))
            .map_err(|error| io::Error::new(error.kind(), format!("{file} of SUMMARY.md: {error}")))?;
        chapters.push(Chapter { file, text });
    }
    Ok(chapters)
}

/// The files that a `SUMMARY.md` lists, at any depth. Headings of parts, and chapters without a file, are left out.
pub fn files_of_summary(summary: &str) -> Vec<String> {
    let targets = links(summary).into_iter().map(|link| link.target);
    targets.filter(|target| !target.is_empty()).collect()
}

/// The parts of a Markdown text, each with its range of bytes.
pub fn events(text: &str) -> impl Iterator<Item = (Event<'_>, Range<usize>)> {
    Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter()
}

/// Line of a byte of a text, from 1.
fn line_at(text: &str, byte: usize) -> usize {
    text[..byte].matches('\n').count() + 1
}

/// The fenced blocks of a chapter in order.
pub fn blocks(text: &str) -> Vec<Block> {
    let mut found = Vec::new();
    let mut events = events(text);
    while let Some((event, range)) = events.next() {
        let Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(words))) = event else {
            continue;
        };
        let mut words = separated(&words).into_iter();
        let language = words.next().unwrap_or_default();
        let attributes = words.collect();
        let inside = events.by_ref().take_while(|(event, _)| matches!(event, Event::Text(_)));
        let lines = inside.map(|(_, range)| &text[range]).collect();
        found.push(Block {
            line: line_at(text, range.start),
            range,
            language,
            attributes,
            text: lines,
        });
    }
    found
}

/// The words between commas. A comma within quotes or brackets does not separate.
fn separated(words: &str) -> Vec<String> {
    let mut found = vec![String::new()];
    let mut depth = 0;
    let mut is_quoted = false;
    for letter in words.chars() {
        match letter {
            '"' => is_quoted = !is_quoted,
            '[' | '{' if !is_quoted => depth += 1,
            ']' | '}' if !is_quoted => depth -= 1,
            _ => {}
        }
        match found.last_mut() {
            Some(word) if letter != ',' || is_quoted || depth > 0 => word.push(letter),
            _ => found.push(String::new()),
        }
    }
    found.iter().map(|word| word.trim().to_owned()).collect()
}

/// The text with an empty line for each fenced block.
pub fn prose(text: &str) -> String {
    let mut prose = text.to_owned();
    for block in blocks(text).into_iter().rev() {
        prose.replace_range(block.range, "\n");
    }
    prose
}

/// Numbers of the equations of a chapter, as its `\tag{...}` give them.
pub fn tags(text: &str) -> Vec<String> {
    let tags = text.split("\\tag{").skip(1);
    tags.filter_map(|rest| Some(rest.split_once('}')?.0.to_owned()))
        .collect()
}

/// Numbers of the equations of the theory manual that a text cites: `3.2` for each `(T3.2)`.
pub fn cited_equations(text: &str) -> Vec<String> {
    let cited = text.split("(T").skip(1).filter_map(|rest| rest.split_once(')'));
    cited
        .map(|(number, _)| number.to_owned())
        .filter(|number| is_equation_number(number))
        .collect()
}

/// Whether this is two numbers with a full stop between them.
fn is_equation_number(text: &str) -> bool {
    let parts: Vec<&str> = text.split('.').collect();
    let mut bytes = parts.iter().flat_map(|part| part.bytes());
    parts.len() == 2 && !parts.contains(&"") && bytes.all(|byte| byte.is_ascii_digit())
}

/// Anchor of a heading, given its line in the Markdown.
pub fn anchor(heading: &str) -> String {
    let title = heading.trim_start_matches('#').trim().to_lowercase();
    let kept = title
        .chars()
        .filter(|letter| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_'));
    kept.map(|letter| if letter == ' ' { '-' } else { letter }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn link(line: usize, target: &str) -> Link {
        Link {
            line,
            target: target.to_owned(),
        }
    }

    #[test]
    fn blocks_and_links_are_found() {
        let text = "[a](b.md#c)\n```toml,file=x.toml\nk = \"[no](link)\"\n```\n\n```\nplain\n```\n![p](q.png)\n";
        let found = blocks(text);
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].line, found[0].value("file")), (2, Some("x.toml")));
        assert_eq!((found[1].language.as_str(), found[1].text.as_str()), ("", "plain\n"));
        assert_eq!(links(text), [link(1, "b.md#c"), link(9, "q.png")]);
        let in_list = &blocks("1. Run:\n\n   ```sh,exit=2\n   for a in b; do\n     false\n   done\n   ```\n")[0];
        assert_eq!(in_list.value("exit"), Some("2"));
        assert_eq!(in_list.text, "for a in b; do\n  false\ndone\n");
        assert_eq!((links(text)[0].path(), links(text)[0].anchor()), ("b.md", "c"));
    }

    #[test]
    fn a_summary_may_be_nested() {
        let summary = "# Summary\n\n[Start](index.md)\n\n# Tutorials\n\n- [First run](tutorials/first-run.md)\n  \
            - [Draft]()\n    - [Deep](tutorials/deep/page.md)\n\n---\n\n[End](decisions.md)\n";
        let files = files_of_summary(summary);
        assert_eq!(
            files,
            [
                "index.md",
                "tutorials/first-run.md",
                "tutorials/deep/page.md",
                "decisions.md"
            ]
        );
    }

    #[test]
    fn a_coarse_run_replaces_whole_lines() {
        let fence = "```toml,file=x.toml,coarse=accuracy:\"a, b\",coarse=cells:[4, 2]";
        let block = &blocks(&format!(
            "{fence}\naccuracy = \"fine\"\n  cells = [40, 20]  # many\nfor = 1\n```\n"
        ))[0];
        assert_eq!(block.value("file"), Some("x.toml"));
        assert_eq!(
            block.coarse_text().unwrap(),
            "accuracy = \"a, b\"\ncells = [4, 2]\nfor = 1\n"
        );
        let with = |words: &str| blocks(&format!("```toml,{words}\ndt = 1\ndtmax = 2\nh = 1\nh = 2\n```\n"))[0].clone();
        assert_eq!(
            with("coarse=dt:3").coarse_text().unwrap(),
            "dt = 3\ndtmax = 2\nh = 1\nh = 2\n"
        );
        assert!(
            with("coarse=steps:3")
                .coarse_text()
                .unwrap_err()
                .contains("no line begins with `steps =`")
        );
        assert!(with("coarse=h:3").coarse_text().unwrap_err().contains("two lines"));
        assert!(with("coarse=dt=3").coarse_text().unwrap_err().contains("no colon"));
    }

    #[test]
    fn pictures_name_the_file_that_is_drawn() {
        let text =
            "![no comment](a.png)\n\n![two lines\nof it](../b.png)<!-- x.out/b.png -->\n![c](c.png)\n<!-- c -->\n";
        let picture = |line, target: &str, drawn: &str| Picture {
            line,
            target: target.to_owned(),
            drawn: drawn.to_owned(),
        };
        assert_eq!(
            pictures(text),
            [picture(4, "../b.png", "x.out/b.png"), picture(5, "c.png", "c")]
        );
    }

    #[test]
    fn captions_follow_pictures_that_are_paragraphs() {
        let text = "![a\nb](x.png)<!-- y.png -->\n\nsee ![c](z.png)\n\n```text\n\n![d](e.png)\n\n```\n";
        let below = "\n\n<div class=\"caption\">\n\na\nb\n\n</div>\n";
        assert_eq!(
            captioned(text),
            text.replacen("y.png -->", &format!("y.png -->{below}"), 1)
        );
    }

    #[test]
    fn links_are_replaced_outside_of_blocks() {
        let text = "a [b](c) [d](e.md#f)\n```sh\n[g](h)\n```\nend\n";
        let replaced = relinked(text, |link| format!("{}:{}", link.line, link.path()));
        assert_eq!(replaced, "a [b](1:c) [d](1:e.md)\n```sh\n[g](h)\n```\nend\n");
    }

    #[test]
    fn equations_are_numbered_and_cited() {
        assert_eq!(tags("$$\nx = 1 \\tag{3.2}\n$$\n$$ y \\tag{3.10} $$"), ["3.2", "3.10"]);
        assert_eq!(
            cited_equations("F-bar (T3.2), (T3), (T x.1), (T3.x) and (T12.10)."),
            ["3.2", "12.10"]
        );
    }

    #[test]
    fn anchors_and_paths_are_normalised() {
        assert_eq!(anchor("## What `bsmpm-par` does: a_b"), "what-bsmpm-par-does-a_b");
        assert_eq!(normalised(Path::new("/a/b/../c/./d")), Path::new("/a/c/d"));
    }
}
