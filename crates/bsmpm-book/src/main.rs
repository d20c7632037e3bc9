//! Writes the sources from which mdBook makes the HTML manual: `bsmpm-book DIRECTORY`. `scripts/book` starts this
//! program.
//!
//! The chapters are copied. Each file of the repository that a chapter links to gets a copy in the HTML manual, so that
//! the link works without the repository:
//!
//! | file | copy |
//! | --- | --- |
//! | Markdown | a formatted page in `files/`; its links work if their targets have pages, too |
//! | other text | a page in `files/` with the unchanged text |
//! | folder | the page of its `README.md`, or else a list of its files |
//! | picture or other binary file | `files/PATH`; for pictures of the manual, their path in the manual |
//!
//! A link of a chapter to a file that does not exist is an error.
#![forbid(unsafe_code)]

use bsmpm_book::{Chapter, Link, anchor, captioned, chapters, events, links, normalised, relinked, repository, source};
use pulldown_cmark::{CowStr, Event, Tag, TagEnd, html};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{env, fs, io};

/// Styles of the pages with files.
const STYLE: &str = include_str!("../theme/file.css");

fn main() -> ExitCode {
    let Some(directory) = env::args_os().nth(1) else {
        eprintln!("usage: bsmpm-book DIRECTORY");
        return ExitCode::from(2);
    };
    match write_sources(&Path::new(&directory).join("src")) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("bsmpm-book: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Writes the sources of the built manual.
fn write_sources(destination: &Path) -> io::Result<()> {
    let manual = Manual::read(chapters()?)?;
    manual.write_chapters(destination)?;
    manual.write_files(destination)
}

/// The manual and the files that it needs. All paths begin at the root of the repository.
struct Manual {
    repository: PathBuf,
    /// Folder of the chapters.
    source: PathBuf,
    chapters: Vec<Chapter>,
    /// Files outside of the manual that a chapter links to.
    files: BTreeSet<PathBuf>,
    /// Pictures, and other files that are no text, that a chapter or a Markdown file shows.
    binaries: BTreeSet<PathBuf>,
}

impl Manual {
    /// Collects what the chapters link to.
    fn read(chapters: Vec<Chapter>) -> io::Result<Manual> {
        let repository = repository();
        let source = source()
            .strip_prefix(&repository)
            .map_err(io::Error::other)?
            .to_path_buf();
        let mut manual = Manual {
            repository,
            source,
            chapters,
            files: BTreeSet::new(),
            binaries: BTreeSet::new(),
        };
        for chapter in manual.chapters.clone() {
            let page = manual.source.join(&chapter.file);
            manual.collect_files(&page, &chapter.text)?;
        }
        for file in manual.files.clone().iter().filter(|file| is_markdown(file)) {
            let text = fs::read_to_string(manual.repository.join(file))?;
            manual.collect_pictures(file, &text);
        }
        Ok(manual)
    }

    /// Collects the files that a chapter links to.
    fn collect_files(&mut self, page: &Path, text: &str) -> io::Result<()> {
        for link in internal_links(text) {
            let path = self.linked_file(page, &link);
            if !self.repository.join(&path).exists() {
                return Err(io::Error::other(format!(
                    "{}:{}: no file {}",
                    page.display(),
                    link.line,
                    link.target
                )));
            } else if self.is_binary(&path) {
                self.binaries.insert(path);
            } else if !self.is_chapter(&path) {
                self.files.insert(path);
            }
        }
        Ok(())
    }

    /// Collects the pictures of a Markdown file outside of the manual.
    fn collect_pictures(&mut self, page: &Path, text: &str) {
        for link in internal_links(text) {
            let path = self.linked_file(page, &link);
            if path.extension().is_some_and(|extension| extension == "png") && self.is_binary(&path) {
                self.binaries.insert(path);
            }
        }
    }

    /// The file that a page links to: of a folder its `README.md`, if there is one.
    fn linked_file(&self, page: &Path, link: &Link) -> PathBuf {
        let path = normalised(&page.parent().unwrap_or(page).join(link.path()));
        let readme = path.join("README.md");
        if self.repository.join(&readme).is_file() {
            readme
        } else {
            path
        }
    }

    fn is_chapter(&self, path: &Path) -> bool {
        self.chapters
            .iter()
            .any(|chapter| self.source.join(&chapter.file) == path)
    }

    /// Whether this is a file that is no text.
    fn is_binary(&self, path: &Path) -> bool {
        let path = self.repository.join(path);
        path.is_file() && fs::read_to_string(path).is_err()
    }

    /// Place of a file in the built manual, or of a chapter in the sources of it; none if it has no place.
    fn place(&self, path: &Path) -> Option<PathBuf> {
        let files = Path::new("files");
        if self.is_chapter(path) {
            path.strip_prefix(&self.source).ok().map(Path::to_path_buf)
        } else if self.binaries.contains(path) {
            Some(
                path.strip_prefix(&self.source)
                    .map_or_else(|_| files.join(path), Path::to_path_buf),
            )
        } else {
            self.files.contains(path).then(|| files.join(page_name(path)))
        }
    }

    /// Writes the chapters and the summary for mdBook.
    fn write_chapters(&self, destination: &Path) -> io::Result<()> {
        write(
            &destination.join("SUMMARY.md"),
            &fs::read_to_string(source().join("SUMMARY.md"))?,
        )?;
        for chapter in &self.chapters {
            let page = self.source.join(&chapter.file);
            let text = relinked(&chapter.text, |link| self.target(&page, link).unwrap_or_default());
            write(&destination.join(&chapter.file), &captioned(&text))?;
        }
        Ok(())
    }

    /// Writes the pages with files and copies the pictures.
    fn write_files(&self, destination: &Path) -> io::Result<()> {
        for path in &self.files {
            let Some(place) = self.place(path) else { continue };
            let content = self.content(path)?;
            write(&destination.join(&place), &file_page(path, &place, &content))?;
        }
        for path in &self.binaries {
            let Some(place) = self.place(path) else { continue };
            let copy = destination.join(place);
            fs::create_dir_all(copy.parent().unwrap_or(&copy))?;
            fs::copy(self.repository.join(path), copy)?;
        }
        Ok(())
    }

    /// A file as HTML.
    fn content(&self, path: &Path) -> io::Result<String> {
        let full_path = self.repository.join(path);
        if full_path.is_dir() {
            return Ok(preformatted(&list_of_files(&full_path)?));
        }
        let text = fs::read_to_string(full_path)?;
        Ok(if is_markdown(path) {
            self.formatted(path, &text)
        } else {
            preformatted(&text)
        })
    }

    /// A Markdown file as HTML. Headings get their anchors; links to a file without a place become text.
    fn formatted(&self, path: &Path, markdown: &str) -> String {
        let mut shown = Vec::new();
        let mut is_dropped = false;
        for (mut event, range) in events(markdown) {
            match &mut event {
                Event::Start(Tag::Heading { id, .. }) => *id = Some(CowStr::from(anchor(&markdown[range]))),
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                    let target = self.target(path, &Link::at(markdown, range.start, dest_url));
                    *dest_url = CowStr::from(target.unwrap_or_default());
                }
                _ => {}
            }
            if let Event::Start(Tag::Link { dest_url, .. }) = &event {
                is_dropped = dest_url.is_empty();
            }
            let is_link = matches!(event, Event::Start(Tag::Link { .. }) | Event::End(TagEnd::Link));
            if !(is_link && is_dropped) {
                shown.push(event);
            }
        }
        let mut page = String::new();
        html::push_html(&mut page, shown.into_iter());
        page
    }

    /// Target of a page's link in the built manual; none if the linked file has no place there.
    fn target(&self, page: &Path, link: &Link) -> Option<String> {
        if link.is_external() || link.path().is_empty() {
            return Some(link.target.clone());
        }
        let linked = self.linked_file(page, link);
        let mut place = self.place(&linked)?;
        // Of a chapter, mdBook makes a page, and it changes the links of chapters itself.
        if self.is_chapter(&linked) && !self.is_chapter(page) {
            place.set_extension("html");
        }
        let depth = self.place(page)?.components().count() - 1;
        let anchor = if link.anchor().is_empty() {
            String::new()
        } else {
            format!("#{}", link.anchor())
        };
        Some(format!("{}{}{anchor}", "../".repeat(depth), place.display()))
    }
}

/// Name of the page with a file: `solve.html` for `solve.md`, `solve.rs.html` for `solve.rs`.
fn page_name(path: &Path) -> PathBuf {
    // mdBook would shorten a link to `solve.md.html` in its page with all chapters.
    if is_markdown(path) {
        path.with_extension("html")
    } else {
        PathBuf::from(format!("{}.html", path.display()))
    }
}

/// Links of a text to files.
fn internal_links(text: &str) -> impl Iterator<Item = Link> {
    links(text)
        .into_iter()
        .filter(|link| !link.is_external() && !link.path().is_empty())
}

fn is_markdown(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "md")
}

/// Text as HTML, as it is.
fn preformatted(text: &str) -> String {
    let mut page = String::from("<pre>");
    html::push_html(&mut page, [Event::Text(CowStr::from(text))].into_iter());
    page + "</pre>\n"
}

/// Names of the files in a folder, one a line.
fn list_of_files(folder: &Path) -> io::Result<String> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        names.push(entry?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names.join("\n"))
}

/// The page with a file.
fn file_page(path: &Path, place: &Path, content: &str) -> String {
    let path = path.display();
    let manual = "../".repeat(place.components().count() - 1);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{path}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <header><a href=\"{manual}index.html\">bsmpm manual</a> Copy of <code>{path}</code></header>\n\
         <main>\n{content}</main>\n</body>\n</html>\n"
    )
}

/// Writes a file and the folders above it.
fn write(path: &Path, text: &str) -> io::Result<()> {
    fs::create_dir_all(path.parent().unwrap_or(path))?;
    fs::write(path, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_link_of_a_written_chapter_leads_to_a_written_file() {
        let directory = tempfile::tempdir().unwrap();
        write_sources(directory.path()).unwrap();
        for chapter in chapters().unwrap() {
            let page = directory.path().join(&chapter.file);
            for link in internal_links(&fs::read_to_string(&page).unwrap()) {
                let target = page.parent().unwrap().join(link.path());
                assert!(target.is_file(), "{}:{}: {}", chapter.file, link.line, link.target);
            }
        }
    }

    #[test]
    fn a_missing_file_is_an_error() {
        let chapter = Chapter {
            file: "index.md".to_owned(),
            text: "# Start\n\n[a](none.md)\n".to_owned(),
        };
        let fault = Manual::read(vec![chapter]).err().unwrap().to_string();
        assert!(fault.ends_with("index.md:3: no file none.md"), "{fault}");
    }
}
