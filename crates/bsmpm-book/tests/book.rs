//! Tests of the manual that need no solver: cases, fenced blocks, links, equation numbers and generated pages.

use bsmpm_book::{
    Block, Chapter, Link, anchor, blocks, chapters, cited_equations, links, normalised, pictures, prose, repository,
    source, tags,
};
use bsmpm_scene::Case;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// Languages of blocks.
const LANGUAGES: [&str; 5] = ["toml", "sh", "python", "text", "rust"];

/// Other words after a fence.
const ATTRIBUTES: [&str; 8] = ["file", "append", "coarse", "exit", "not-run", "output", "full", "wrong"];

/// Chapter and line of a fault.
fn place(chapter: &Chapter, line: usize) -> String {
    format!("{}:{line}", chapter.file)
}

/// The files with this extension in a folder and the folders below it, except build results and hidden folders.
fn files_below(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && !path.is_symlink() && name != "target" && !name.starts_with('.') {
            found.extend(files_below(&path, extension));
        } else if path.extension().is_some_and(|found| found == extension) {
            found.push(path);
        }
    }
    found
}

#[test]
fn every_case_is_valid_as_printed() {
    assert_cases_are_valid(|block| Ok(block.text.clone()));
}

#[test]
fn every_case_is_valid_in_a_coarse_run() {
    assert_cases_are_valid(Block::coarse_text);
}

/// Reads every case of the manual, with the text of a block as given.
fn assert_cases_are_valid(text_of: impl Fn(&Block) -> Result<String, String>) {
    let mut cases = 0;
    let mut shared: BTreeMap<String, String> = BTreeMap::new();
    for chapter in chapters().unwrap() {
        let mut alone = BTreeMap::new();
        let files = if chapter.is_tutorial() { &mut alone } else { &mut shared };
        for block in blocks(&chapter.text)
            .into_iter()
            .filter(|block| block.language == "toml")
        {
            let place = place(&chapter, block.line);
            let name = block
                .value("file")
                .or(block.value("append"))
                .unwrap_or_else(|| panic!("{place}: file=NAME"));
            let file = files.entry(name.to_owned()).or_default();
            assert_eq!(
                file.is_empty(),
                block.value("file").is_some(),
                "{place}: appended to nothing, or written twice"
            );
            file.push_str(&text_of(&block).unwrap_or_else(|fault| panic!("{place}: {fault}")));
            // Commands of the chapter make its data files.
            if file.contains("{ file = ") {
                continue;
            }
            let has_tests = file.contains("[element.");
            let read = if has_tests {
                Case::of_element_tests
            } else {
                Case::from_bytes
            };
            match (read(name, file.as_bytes(), &[]), block.is("wrong")) {
                (Ok(_), false) | (Err(_), true) => cases += 1,
                (Ok(_), true) => panic!("{place}: a valid case is called wrong"),
                (Err(errors), false) => panic!("{place}: {}", errors[0]),
            }
        }
    }
    assert!(cases > 0, "the manual has no case");
}

#[test]
fn every_fence_is_known() {
    for chapter in chapters().unwrap() {
        for block in blocks(&chapter.text) {
            let place = place(&chapter, block.line);
            assert!(
                LANGUAGES.contains(&block.language.as_str()),
                "{place}: language \"{}\"",
                block.language
            );
            for attribute in &block.attributes {
                let name = attribute.split('=').next().unwrap_or_default();
                assert!(ATTRIBUTES.contains(&name), "{place}: {attribute}");
            }
        }
    }
}

#[test]
fn rust_code_is_a_doctest() {
    let library = fs::read_to_string(source().join("lib.rs")).unwrap();
    for chapter in chapters().unwrap() {
        let has_rust = blocks(&chapter.text).iter().any(|block| block.language == "rust");
        let include = format!("include_str!(\"{}\")", chapter.file);
        assert!(
            !has_rust || library.contains(&include),
            "{} has Rust code, lib.rs has no {include}",
            chapter.file
        );
    }
}

#[test]
fn the_reference_of_keys_is_current() {
    assert_is_current("reference/keys.md", &bsmpm_scene::reference(), "keys");
}

#[test]
fn the_catalogue_of_messages_is_current() {
    assert_is_current("reference/messages.md", &bsmpm_messages::catalogue(), "explain --all");
}

/// Compares a chapter with what `bsmpm COMMAND` prints; with `BSMPM_RENEW=1` writes the chapter.
fn assert_is_current(file: &str, generated: &str, command: &str) {
    let path = source().join(file);
    if env::var_os("BSMPM_RENEW").is_some() {
        fs::write(&path, generated).unwrap();
    }
    let committed = fs::read_to_string(path).unwrap();
    assert!(
        committed == generated,
        "{file} is not what `bsmpm {command}` prints; renew it: BSMPM_RENEW=1 cargo test -p bsmpm-book"
    );
}

#[test]
fn every_link_leads_somewhere() {
    let tracked = tracked_files();
    let mut wrong = Vec::new();
    for page in tracked
        .iter()
        .filter(|file| file.extension().is_some_and(|extension| extension == "md"))
    {
        let text = fs::read_to_string(page).unwrap();
        for link in links(&text).into_iter().filter(|link| !link.is_external()) {
            if !leads_somewhere(page, &link, &tracked) {
                wrong.push(format!("{}:{}: {}", page.display(), link.line, link.target));
            }
        }
    }
    assert!(wrong.is_empty(), "broken links:\n{}", wrong.join("\n"));
}

/// The files that git tracks, which are those of a clean clone.
fn tracked_files() -> BTreeSet<PathBuf> {
    let mut list = Command::new("git");
    let list = list
        .args(["ls-files", "-z"])
        .current_dir(repository())
        .output()
        .unwrap();
    assert!(list.status.success(), "git: {}", String::from_utf8_lossy(&list.stderr));
    let names = String::from_utf8(list.stdout).unwrap();
    let files = names.split('\0').filter(|name| !name.is_empty());
    files.map(|name| normalised(&repository().join(name))).collect()
}

/// Whether a clean clone has the file or folder of a link, and the file has its anchor.
fn leads_somewhere(page: &Path, link: &Link, tracked: &BTreeSet<PathBuf>) -> bool {
    let path = match link.path() {
        "" => page.to_owned(),
        path => normalised(&page.parent().unwrap().join(path)),
    };
    let is_there = tracked.iter().any(|file| file.starts_with(&path));
    is_there && (link.anchor().is_empty() || anchors(&path).contains(link.anchor()))
}

/// Anchors of the headings of a file.
fn anchors(path: &Path) -> BTreeSet<String> {
    let text = fs::read_to_string(path).unwrap();
    prose(&text)
        .lines()
        .filter(|line| line.starts_with('#'))
        .map(anchor)
        .collect()
}

#[test]
fn drawn_pictures_have_a_place_in_the_manual() {
    for chapter in chapters().unwrap() {
        for picture in pictures(&chapter.text) {
            let path = normalised(&chapter.folder().join(&picture.target));
            let place = place(&chapter, picture.line);
            assert!(
                path.starts_with(source().join("pictures")),
                "{place}: a full run would write {}",
                path.display()
            );
            assert!(
                !picture.drawn.starts_with(['/', '.']),
                "{place}: {} is not in the directory",
                picture.drawn
            );
        }
    }
}

#[test]
fn every_chapter_is_in_the_summary() {
    let listed: Vec<String> = chapters().unwrap().into_iter().map(|chapter| chapter.file).collect();
    let files = files_below(&source(), "md").into_iter();
    let relative = files.map(|path| path.strip_prefix(source()).unwrap().to_string_lossy().into_owned());
    let unlisted: Vec<String> = relative
        .filter(|file| file != "SUMMARY.md" && !listed.contains(file))
        .collect();
    assert!(unlisted.is_empty(), "not in SUMMARY.md: {unlisted:?}");
    let different: BTreeSet<&String> = listed.iter().collect();
    assert_eq!(listed.len(), different.len(), "SUMMARY.md lists a chapter twice");
}

#[test]
fn every_chapter_has_one_title() {
    for chapter in chapters().unwrap() {
        let titles = prose(&chapter.text)
            .lines()
            .filter(|line| line.starts_with("# "))
            .count();
        // A page that a program writes says so first.
        let text = chapter.text.trim_start_matches(|c| c != '#');
        let is_first = chapter.text.starts_with("# ") || chapter.text.starts_with("<!--") && text.starts_with("# ");
        assert!(titles == 1 && is_first, "{} begins with its only title", chapter.file);
    }
}

/// The chapters of the theory manual, in order.
fn theory() -> Vec<Chapter> {
    chapters()
        .unwrap()
        .into_iter()
        .filter(|chapter| chapter.file.starts_with("theory/"))
        .collect()
}

#[test]
fn equations_are_numbered_by_chapter() {
    let mut known = BTreeSet::new();
    for (number, chapter) in theory().iter().enumerate() {
        for tag in tags(&chapter.text) {
            let prefix = format!("{}.", number + 1);
            assert!(
                tag.starts_with(&prefix),
                "{} is chapter {}: \\tag{{{tag}}}",
                chapter.file,
                number + 1
            );
            assert!(known.insert(tag.clone()), "{}: a second \\tag{{{tag}}}", chapter.file);
        }
    }
    for chapter in chapters()
        .unwrap()
        .iter()
        .filter(|chapter| !chapter.file.starts_with("theory/"))
    {
        assert!(
            tags(&chapter.text).is_empty(),
            "{}: only the theory manual numbers equations",
            chapter.file
        );
    }
}

#[test]
fn every_cited_equation_exists() {
    let known: BTreeSet<String> = theory().iter().flat_map(|chapter| tags(&chapter.text)).collect();
    let mut files = files_below(&repository(), "rs");
    files.extend(files_below(&repository(), "md"));
    // The example numbers of the crate that reads them.
    files.retain(|path| !path.starts_with(source()) || path.extension().is_some_and(|extension| extension == "md"));
    let mut wrong = Vec::new();
    for path in files {
        let text = fs::read_to_string(&path).unwrap();
        let unknown = cited_equations(&text)
            .into_iter()
            .filter(|number| !known.contains(number));
        wrong.extend(unknown.map(|number| format!("{}: (T{number})", path.display())));
    }
    assert!(
        wrong.is_empty(),
        "equations that the theory manual does not have:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn mathematics_is_complete() {
    for chapter in chapters().unwrap() {
        for paragraph in paragraphs_without_code(&chapter.text) {
            let dollars = paragraph.replace("\\$", "").matches('$').count();
            assert!(dollars % 2 == 0, "{}: an odd number of $ in: {paragraph}", chapter.file);
            for (number, formula) in paragraph.split('$').enumerate() {
                // Every second piece is within dollars; `$$` leaves an empty piece on each side.
                assert!(
                    number % 2 == 0 || braces_match(formula),
                    "{}: braces in: {formula}",
                    chapter.file
                );
            }
        }
    }
}

#[test]
fn the_pages_state_the_version_of_the_workspace() {
    let version = env!("CARGO_PKG_VERSION");
    let pages = [
        ("CITATION.cff", format!("version: {version}")),
        ("src/citing.md", version.to_owned()),
        (
            "src/reference/versions.md",
            format!("The present version is {version}."),
        ),
    ];
    for (file, words) in pages {
        let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap();
        assert!(
            text.split_whitespace().collect::<Vec<_>>().join(" ").contains(&words),
            "{file} does not state the version {version}"
        );
    }
}

/// The paragraphs of a text without fenced blocks and without code in lines; `$$` as `$`.
fn paragraphs_without_code(text: &str) -> Vec<String> {
    let mut paragraphs = vec![String::new()];
    let mut is_display = false;
    for line in prose(text).lines() {
        is_display ^= line.trim() == "$$";
        let outside = line.split('`').step_by(2).collect::<Vec<_>>().join(" ");
        match paragraphs.last_mut() {
            Some(paragraph) if is_display || !line.trim().is_empty() => {
                paragraph.push_str(&outside.replace("$$", "$"));
                paragraph.push('\n');
            }
            _ => paragraphs.push(String::new()),
        }
    }
    paragraphs
}

/// Whether every brace and every `\begin` of a formula is closed.
fn braces_match(formula: &str) -> bool {
    let plain = formula.replace("\\{", "").replace("\\}", "");
    let environments = formula.matches("\\begin{").count() == formula.matches("\\end{").count();
    plain.matches('{').count() == plain.matches('}').count() && environments
}
