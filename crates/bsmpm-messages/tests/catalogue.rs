//! Tests that each message has a catalogue page, and follows the rules for message texts.

use bsmpm_messages::{Kind, Page, code_of, pages, without_code};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Parts that each page has, in this order.
const PARTS: [&str; 4] = [
    "**What it means.**",
    "**Why it matters.**",
    "**What to do.**",
    "**Example.**",
];
/// Characters that a text may have, a name or number counted as [`PLACEHOLDER`].
const LONGEST: usize = 200;
/// Characters that a name or number in a text has on average.
const PLACEHOLDER: usize = 8;
/// Characters below which a text is no sentence: its words must stand behind the code, not in a variable.
const SHORTEST: usize = 20;
/// Codes of texts that end with a placeholder for a full stop or for `; did you mean ...?`.
const ENDED_BY_A_HINT: [&str; 3] = ["E0017", "E0020", "E0518"];

fn crates() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("a crate lies in the workspace")
        .to_owned()
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
    let mut text = String::new();
    let mut characters = source.chars().peekable();
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

/// Whether a text ends with a full stop, a question mark, or a placeholder that is a sentence, a list or a command.
fn is_ended(text: &str) -> bool {
    let without_last = text.strip_suffix('…').map(|rest| rest.trim_end_matches(['…', ' ']));
    let is_ended_before = without_last.is_some_and(|rest| rest.ends_with(['.', '?', ':']));
    let has_hint = text.ends_with('…') && ENDED_BY_A_HINT.iter().any(|code| text.starts_with(code));
    text.ends_with(['.', '?']) || is_ended_before || has_hint
}

/// Whether a number has no digit before its decimal point.
fn has_bare_point(text: &str) -> bool {
    text.match_indices('.').any(|(at, _)| {
        let is_of_name = |before: char| before.is_alphanumeric() || "…._)]".contains(before);
        text[at + 1..].starts_with(|after: char| after.is_ascii_digit()) && !text[..at].ends_with(is_of_name)
    })
}

/// Every code that a text names.
fn codes_in(text: &str) -> impl Iterator<Item = &str> {
    let is_code = |word: &&str| word.len() == 5 && Kind::of(word).is_some() && word[1..].parse::<u16>().is_ok();
    text.split(|character: char| !character.is_ascii_alphanumeric())
        .filter(is_code)
}

/// The codes of a row of `retired.txt`: those from the first to the last that it names.
fn codes_without_message(row: &str) -> Vec<String> {
    let named: Vec<&str> = codes_in(row.split(' ').next().unwrap_or_default()).collect();
    let (Some(first), Some(last)) = (named.first(), named.last()) else {
        panic!("no code at the beginning of {row}")
    };
    (number_of(first)..=number_of(last))
        .map(|number| format!("{}{number:04}", &first[..1]))
        .collect()
}

fn number_of(code: &str) -> u16 {
    code[1..].parse().expect("a code has four digits")
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
        if characters > LONGEST {
            faults.push(format!("{characters} characters: {text}"));
        }
        if letters < SHORTEST {
            faults.push(format!("no words: {text}"));
        }
        if !is_ended(&text) || has_bare_point(words) {
            faults.push(format!("no sentence, or a number without a leading zero: {text}"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn texts_without_an_end_and_numbers_without_a_leading_zero_are_found() {
    for text in [
        "E0001: no `key`",
        "E0001: no key (of two)",
        "E0001: no …",
        "E0001: Use …",
    ] {
        assert!(!is_ended(text), "{text}");
    }
    for text in [
        "E0001: no key.",
        "E0001: no key. …",
        "E0001: failed: …",
        "E0001: no keys:  …",
        "E0017: found ……",
    ] {
        assert!(is_ended(text), "{text}");
    }
    assert!(["is .5", "(.5)", "-.5", "k=.5"].iter().all(|text| has_bare_point(text)));
    assert!(
        !["0.5", "body.0", "stage.….0", "body.….1", "1...2"]
            .iter()
            .any(|text| has_bare_point(text))
    );
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
    assert!(
        without_text.is_empty(),
        "pages without a text in the sources: {without_text:?}"
    );
}

#[test]
fn each_number_of_an_area_is_used_or_listed_as_retired_or_reserved() {
    let rows = include_str!("../src/retired.txt")
        .lines()
        .filter(|row| !row.starts_with('#'));
    let listed: BTreeSet<String> = rows.flat_map(codes_without_message).collect();
    let used: BTreeSet<String> = pages().iter().map(|page| page.code.to_owned()).collect();
    let used_again: Vec<_> = listed.intersection(&used).collect();
    assert!(
        used_again.is_empty(),
        "retired or reserved codes are used: {used_again:?}"
    );
    let mut last = BTreeMap::new();
    for code in &used | &listed {
        let area = code[..3].to_owned();
        let number = number_of(&code);
        let previous = last.insert(area, number);
        assert!(
            previous.is_none_or(|previous| previous + 1 == number),
            "the number before {code} is not listed"
        );
    }
}

#[test]
fn codes_in_readmes_and_in_this_crate_have_pages() {
    let explained: BTreeSet<&str> = pages().iter().map(|page| page.code).collect();
    let mut files = vec![crates().with_file_name("README.md")];
    rust_files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut files);
    let of_crates = fs::read_dir(crates()).expect("crates can be listed");
    files.extend(of_crates.map(|of_crate| of_crate.expect("crates can be listed").path().join("README.md")));
    for file in files.iter().filter(|file| file.exists()) {
        let text = fs::read_to_string(file).expect("readmes and sources can be read");
        let unknown: Vec<_> = codes_in(&text).filter(|code| !explained.contains(code)).collect();
        assert!(
            unknown.is_empty(),
            "{} names {unknown:?}, which have no page",
            file.display()
        );
    }
}

#[test]
fn each_page_has_a_cause_and_four_parts() {
    for Page { code, title, text } in pages() {
        assert!(Kind::of(code).is_some() && code.len() == 5, "{code}: no code");
        assert!(
            !title.is_empty() && !title.ends_with('.'),
            "{code}: the heading is `## {code}: CAUSE`"
        );
        let places: Vec<_> = PARTS.iter().map(|part| text.find(part)).collect();
        assert!(
            places.is_sorted() && places.iter().all(Option::is_some),
            "{code}: the parts are {PARTS:?}"
        );
    }
}

#[test]
fn pages_of_an_area_are_in_the_order_of_their_numbers() {
    let mut last = BTreeMap::new();
    for Page { code, .. } in pages() {
        let area = &code[..3];
        let previous = last.insert(area, code);
        assert!(
            previous.is_none_or(|previous| previous < code),
            "{code} stands after {previous:?}"
        );
    }
}
