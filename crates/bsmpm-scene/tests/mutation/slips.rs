//! Tests that one slip gives one error.

use super::written::{self, Fits};
use super::{bases, without};
use bsmpm_scene::schema::Kind;
use bsmpm_scene::{Case, Error};
use std::collections::BTreeMap;

/// What an author did, and what came of it.
struct Slip {
    kind: &'static str,
    text: String,
    path: String,
}

fn errors(text: &str) -> Vec<Error> {
    Case::from_text("case.toml", text, &[]).err().unwrap_or_default()
}

/// The word with its two middle letters exchanged; with a letter more where these are equal.
fn misspelt(word: &str) -> String {
    let mut letters: Vec<char> = word.chars().collect();
    let middle = letters.len() / 2;
    if letters.len() < 2 || letters[middle - 1] == letters[middle] {
        letters.push('s');
    } else {
        letters.swap(middle - 1, middle);
    }
    letters.into_iter().collect()
}

/// Every key of a case removed and misspelt, every word misspelt, every value of another type.
fn slips(base: &str) -> Vec<Slip> {
    let mut slips = Vec::new();
    for written in written::all(base) {
        let Some(name) = &written.name else { continue };
        let path = &written.path;
        let value = &written.value;
        let mut slip = |kind, text: String| {
            slips.push(Slip {
                kind,
                text,
                path: path.clone(),
            })
        };
        slip(
            "key misspelt",
            format!(
                "{}{}{}",
                &base[..name.start],
                misspelt(&base[name.clone()]),
                &base[name.end..]
            ),
        );
        if !written.is_entry {
            continue;
        }
        slip("key removed", without(base, &written));
        slip(
            "value of another type",
            format!("{}1979-05-27{}", &base[..value.start], &base[value.end..]),
        );
        let is_word = matches!(written.fits, Fits::Kind(Kind::Choice(_) | Kind::ChoiceOr(..)));
        if let Some(word) = base[value.clone()]
            .strip_prefix('"')
            .and_then(|word| word.strip_suffix('"'))
            && is_word
        {
            let word = misspelt(word);
            slip(
                "word misspelt",
                format!("{}\"{word}\"{}", &base[..value.start], &base[value.end..]),
            );
        }
    }
    slips
}

/// Headers with one pair of brackets for two, and with two for one.
fn brackets(base: &str) -> Vec<Slip> {
    let change = |(number, line): (usize, &str)| {
        let (kind, header) = match line.strip_prefix("[[").and_then(|line| line.strip_suffix("]]")) {
            Some(name) => ("[x] for [[x]]", format!("[{name}]")),
            None => (
                "[[x]] for [x]",
                format!("[{}]", line.strip_prefix('[').filter(|_| line.ends_with(']'))?.trim()),
            ),
        };
        let mut lines: Vec<&str> = base.lines().collect();
        lines[number] = &header;
        Some(Slip {
            kind,
            text: lines.join("\n"),
            path: line.to_owned(),
        })
    };
    base.lines().enumerate().filter_map(change).collect()
}

/// Kinds of slips whose error names them. What a removed key leaves without effect is named instead of it, and TOML
/// itself fails at what follows two pairs of brackets.
const NAMED: [&str; 4] = [
    "[x] for [[x]]",
    "key misspelt",
    "value of another type",
    "word misspelt",
];

/// Whether an error names the key, table or value of a slip, or stands in its table.
fn names(error: &Error, slip: &Slip) -> bool {
    let name = slip
        .path
        .rsplit('.')
        .next()
        .unwrap_or(&slip.path)
        .trim_matches(['[', ']']);
    let table_of = |path: &str| {
        path.rsplit_once('.')
            .map_or(String::new(), |(table, _)| table.to_owned())
    };
    let table = table_of(&slip.path);
    error.key == table || table_of(&error.key) == table || error.to_string().contains(name)
}

/// Kinds of slips, and how many of them at most may give more than one error: without `geometry` it is not known which
/// keys are needed, and a key that is removed may leave several others without effect.
const MOST_WITH_SEVERAL: [(&str, usize); 6] = [
    ("[x] for [[x]]", 0),
    ("[[x]] for [x]", 0),
    ("key misspelt", 8),
    ("key removed", 36),
    ("value of another type", 11),
    ("word misspelt", 10),
];

#[test]
fn one_slip_gives_one_error() {
    let mut counts: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    let mut several = Vec::new();
    let mut elsewhere = Vec::new();
    for base in bases() {
        for slip in slips(&base).into_iter().chain(brackets(&base)) {
            let errors = errors(&slip.text);
            if let [error] = &errors[..]
                && NAMED.contains(&slip.kind)
                && !names(error, &slip)
            {
                elsewhere.push(format!("{}: {}\n   {error}", slip.kind, slip.path));
            }
            counts.entry(slip.kind).or_default()[errors.len().min(2)] += 1;
            if errors.len() > 1 {
                let reported: String = errors.iter().map(|error| format!("\n   {error}")).collect();
                several.push(format!("{}: {}{reported}", slip.kind, slip.path));
            }
        }
    }
    for (kind, [none, one, more]) in &counts {
        println!("{kind}: {none} without error, {one} with one, {more} with more");
    }
    several.sort();
    several.dedup();
    println!("{}", several.join("\n"));
    elsewhere.sort();
    elsewhere.dedup();
    assert!(
        elsewhere.is_empty(),
        "errors that do not name the slip:\n{}",
        elsewhere.join("\n")
    );
    for (kind, most) in MOST_WITH_SEVERAL {
        let [none, one, more] = counts[kind];
        assert!(
            one > 100 && more <= most,
            "{kind}: {more} of {} give more than one error",
            none + one + more
        );
    }
}
