//! What of the book can be judged without the solver: its cases, its links, and whether its reference is current.

use bsmpm_book::{blocks, chapters, links, source};
use bsmpm_scene::Case;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Languages of blocks, so that none is passed over by a slip.
const LANGUAGES: [&str; 5] = ["toml", "sh", "python", "text", "rust"];

#[test]
fn every_case_is_valid() {
    let mut cases = 0;
    let mut files: BTreeMap<String, String> = BTreeMap::new();
    for chapter in chapters().unwrap() {
        for block in blocks(&chapter.text).into_iter().filter(|block| block.language == "toml") {
            let place = format!("{}:{}", chapter.file, block.line);
            let name = block.value("file").or(block.value("append")).unwrap_or_else(|| panic!("{place}: file=NAME"));
            let file = files.entry(name.to_owned()).or_default();
            assert_eq!(
                file.is_empty(),
                block.value("file").is_some(),
                "{place}: appended to nothing, or written twice"
            );
            file.push_str(&block.text);
            match (Case::from_text(name, file, &[]), block.is("wrong")) {
                (Ok(_), false) | (Err(_), true) => cases += 1,
                (Ok(_), true) => panic!("{place}: a valid case is called wrong"),
                (Err(errors), false) => panic!("{place}: {}", errors[0]),
            }
        }
    }
    assert!(cases > 0, "the book has no case");
}

#[test]
fn every_block_says_what_it_is() {
    for chapter in chapters().unwrap() {
        for block in blocks(&chapter.text) {
            let place = format!("{}:{}", chapter.file, block.line);
            assert!(LANGUAGES.contains(&block.language.as_str()), "{place}: language \"{}\"", block.language);
            for attribute in &block.attributes {
                let name = attribute.split('=').next().unwrap_or_default();
                assert!(
                    ["file", "append", "exit", "not-run", "output", "wrong"].contains(&name),
                    "{place}: {attribute}"
                );
            }
        }
    }
}

#[test]
fn the_reference_is_current() {
    let committed = fs::read_to_string(source().join("reference.md")).unwrap();
    let renew = "renew it: target/release/bsmpm keys > crates/bsmpm-book/src/reference.md";
    assert!(committed == bsmpm_scene::reference(), "the schema has changed since reference.md was made; {renew}");
}

#[test]
fn the_catalogue_of_messages_is_current() {
    let committed = fs::read_to_string(source().join("messages.md")).unwrap();
    let renew = "renew it: target/release/bsmpm explain --all > crates/bsmpm-book/src/messages.md";
    assert!(committed == bsmpm_messages::catalogue(), "messages have changed since messages.md was made; {renew}");
}

#[test]
fn every_link_leads_somewhere() {
    let mut wrong = Vec::new();
    for chapter in chapters().unwrap() {
        for (line, target) in links(&chapter.text).into_iter().filter(|(_, target)| !target.contains("://")) {
            let (file, anchor) = target.split_once('#').unwrap_or((&target, ""));
            let path = if file.is_empty() { source().join(&chapter.file) } else { source().join(file) };
            let there = path.exists() && (anchor.is_empty() || anchors(&path).contains(anchor));
            if !there {
                wrong.push(format!("{}:{line}: {target}", chapter.file));
            }
        }
    }
    assert!(wrong.is_empty(), "broken links:\n{}", wrong.join("\n"));
}

/// What headings of a file may be reached by.
fn anchors(path: &Path) -> BTreeSet<String> {
    let text = fs::read_to_string(path).unwrap();
    let headings = text.lines().filter(|line| line.starts_with('#'));
    let kept = |c: char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
    let slug = |line: &str| -> String {
        let heading = line.trim_start_matches('#').trim().to_lowercase();
        heading.chars().filter(|c| kept(*c)).map(|c| if c == ' ' { '-' } else { c }).collect()
    };
    headings.map(slug).collect()
}

#[test]
fn every_chapter_is_in_the_summary() {
    let listed: BTreeSet<String> = chapters().unwrap().into_iter().map(|chapter| chapter.file).collect();
    let files = fs::read_dir(source()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let chapters: BTreeSet<String> = files.filter(|name| name.ends_with(".md") && name != "SUMMARY.md").collect();
    assert_eq!(listed, chapters);
}
