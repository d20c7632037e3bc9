//! The catalogue is complete, and the texts in the sources follow the pattern of a message.

use bsmpm_messages::{Kind, Page, code_of, pages, without_code};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Parts that each page has, in this order.
const PARTS: [&str; 4] = ["**What it means.**", "**Why it matters.**", "**What to do.**", "**Example.**"];
/// Characters that a text may have, a name or number counted as [`PLACEHOLDER`].
const LONGEST: usize = 200;
/// Characters that a name or number in a text has on average.
const PLACEHOLDER: usize = 8;
/// Characters below which a text is no sentence: its words must stand behind the code, not in a variable.
const SHORTEST: usize = 20;

fn crates() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a crate lies in the workspace").to_owned()
}

/// All Rust files below `directory`.
fn rust_files(directory: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(directory).expect("sources can be read") {
        let path = entry.expect("sources can be read").path();
        match path.is_dir() {
            true => rust_files(&path, files),
            false if path.extension().is_some_and(|ending| ending == "rs") => files.push(path),
            false => {}
        }
    }
}

/// The string literal that `source` begins with, behind its opening quote: with `…` for what is formatted into it,
/// and without line breaks.
fn literal(source: &str) -> String {
    let (mut text, mut characters) = (String::new(), source.chars().peekable());
    while let Some(character) = characters.next() {
        match character {
            '"' => break,
            '\\' => match characters.next() {
                Some('\n') => while characters.next_if(|next| next.is_whitespace()).is_some() {},
                Some('n') => text.push(' '),
                Some(escaped) => text.push(escaped),
                None => break,
            },
            '{' if characters.next_if_eq(&'{').is_some() => text.push('{'),
            '}' if characters.next_if_eq(&'}').is_some() => text.push('}'),
            '{' => {
                while characters.next_if(|next| *next != '}').is_some() {}
                characters.next();
                text.push('…');
            }
            other => text.push(other),
        }
    }
    text
}

/// The texts with a code in the sources of the programs, without their tests, in order.
fn texts_in_sources() -> BTreeSet<String> {
    let mut files = Vec::new();
    for of_crate in fs::read_dir(crates()).expect("sources can be read") {
        let sources = of_crate.expect("sources can be read").path().join("src");
        if sources.is_dir() && !sources.starts_with(env!("CARGO_MANIFEST_DIR")) {
            rust_files(&sources, &mut files);
        }
    }
    let mut texts = BTreeSet::new();
    for file in files.iter().filter(|file| !file.ends_with("tests.rs")) {
        let source = fs::read_to_string(file).expect("sources can be read");
        let program = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        let literals = program.match_indices('"').map(|(at, _)| &program[at + 1..]);
        texts.extend(literals.filter(|rest| code_of(rest).is_some()).map(literal));
    }
    texts
}

fn number_of_characters(text: &str) -> usize {
    let of = |character: char| if character == '…' { PLACEHOLDER } else { 1 };
    without_code(text).chars().map(of).sum()
}

#[test]
fn the_list_of_texts_is_that_of_the_sources() {
    let texts: String = texts_in_sources().iter().map(|text| format!("{text}\n")).collect();
    let list = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/texts.txt");
    if std::env::var_os("BSMPM_RENEW").is_some() {
        fs::write(&list, &texts).expect("the list can be written");
    }
    let known = fs::read_to_string(&list).expect("the list can be read");
    assert!(
        known == texts,
        "messages have changed: BSMPM_RENEW=1 cargo test -p bsmpm-messages, and read the difference"
    );
}

#[test]
fn each_text_is_short_and_says_what_is_wrong_in_sentences() {
    let mut faults = Vec::new();
    for text in texts_in_sources() {
        let words = without_code(&text);
        let characters = number_of_characters(&text);
        let letters = words.chars().filter(|character| character.is_alphabetic()).count();
        let is_ended = words.ends_with(['.', '?', '…', ')', '`']);
        let has_bare_point = words.split_whitespace().any(|word| word.starts_with('.') && word.len() > 1);
        if characters > LONGEST {
            faults.push(format!("{characters} characters: {text}"));
        }
        if letters < SHORTEST {
            faults.push(format!("no words: {text}"));
        }
        if !is_ended || has_bare_point {
            faults.push(format!("no sentence, or a number without a leading zero: {text}"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn each_code_has_one_page_and_each_page_a_text() {
    let texts = texts_in_sources();
    let used: BTreeSet<&str> = texts.iter().filter_map(|text| code_of(text)).collect();
    let explained: Vec<&str> = pages().iter().map(|page| page.code).collect();
    let once: BTreeSet<&str> = explained.iter().copied().collect();
    assert_eq!(explained.len(), once.len(), "a code has two pages");
    let without_page: Vec<_> = used.difference(&once).collect();
    let without_text: Vec<_> = once.difference(&used).collect();
    assert!(without_page.is_empty(), "codes without a page: {without_page:?}");
    assert!(without_text.is_empty(), "pages without a text in the sources: {without_text:?}");
    let retired: BTreeSet<&str> = include_str!("../src/retired.txt").lines().collect();
    assert_eq!(retired.intersection(&used).count(), 0, "a retired code is used again");
}

#[test]
fn each_page_has_a_cause_and_four_parts() {
    for Page { code, title, text } in pages() {
        assert!(Kind::of(code).is_some() && code.len() == 5, "{code}: no code");
        assert!(!title.is_empty() && !title.ends_with('.'), "{code}: the heading is `## {code}: CAUSE`");
        let places: Vec<_> = PARTS.iter().map(|part| text.find(part)).collect();
        assert!(places.is_sorted() && places.iter().all(Option::is_some), "{code}: the parts are {PARTS:?}");
    }
}

#[test]
fn pages_of_an_area_are_in_the_order_of_their_numbers() {
    let mut last = BTreeMap::new();
    for Page { code, .. } in pages() {
        let area = &code[..3];
        let previous = last.insert(area, code);
        assert!(previous.is_none_or(|previous| previous < code), "{code} stands after {previous:?}");
    }
}
