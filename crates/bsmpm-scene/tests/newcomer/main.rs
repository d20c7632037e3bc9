//! Tests the messages for mistakes of new users. These mistakes are found before a run starts.

mod rows;

use bsmpm_scene::{Case, load};
use rows::ROWS;
use std::fmt::Write;

const SLOPE: &str = include_str!("slope.toml");

/// A wrong input.
pub struct Row {
    number: &'static str,
    what: &'static str,
    /// Parts of the slope, and what stands in their places.
    edits: &'static [(&'static str, &'static str)],
    says: Says,
}

/// What the program says.
pub enum Says {
    /// So many errors, which contain these texts.
    Errors(usize, &'static [&'static str]),
    /// Warnings that contain these texts, and no error.
    Warning(&'static [&'static str]),
    /// Neither an error nor a warning.
    Nothing,
}

impl Row {
    fn text(&self) -> String {
        let mut text = SLOPE.to_owned();
        for (part, by) in self.edits {
            assert!(text.contains(part), "row {}: `{part}` is not in the slope", self.number);
            text = text.replacen(part, by, 1);
        }
        text
    }
}

/// Errors and warnings of a case, a line each.
struct Messages {
    errors: Vec<String>,
    warnings: Vec<String>,
}

fn messages(text: &str) -> Messages {
    match Case::from_text("case.toml", text, &[]) {
        Ok(case) => Messages {
            errors: Vec::new(),
            warnings: case.warnings,
        },
        Err(errors) => Messages {
            errors: errors.iter().map(ToString::to_string).collect(),
            warnings: Vec::new(),
        },
    }
}

/// What is not as the row has it.
fn fault(row: &Row) -> Option<String> {
    let Messages { errors, warnings } = messages(&row.text());
    let found = format!(
        "row {} ({}):\n   {}",
        row.number,
        row.what,
        [&errors[..], &warnings[..]].concat().join("\n   ")
    );
    let is_right = match row.says {
        Says::Errors(number, texts) => {
            errors.len() == number && texts.iter().all(|text| errors.iter().any(|error| error.contains(text)))
        }
        Says::Warning(texts) => {
            errors.is_empty()
                && warnings
                    .iter()
                    .any(|warning| texts.iter().all(|text| warning.contains(text)))
        }
        Says::Nothing => errors.is_empty() && warnings.is_empty(),
    };
    (!is_right).then_some(found)
}

#[test]
fn the_slope_is_right() {
    let Messages { errors, warnings } = messages(SLOPE);
    assert!(errors.is_empty() && warnings.is_empty(), "{errors:?} {warnings:?}");
}

#[test]
fn every_wrong_input_is_answered() {
    let faults: Vec<String> = ROWS.iter().filter_map(fault).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The texts as a page, so that they are reviewed as texts: `BSMPM_RENEW=1` writes it again.
#[test]
fn the_texts_are_those_of_the_page() {
    let mut page = String::from("Wrong inputs of a newcomer, and what the program says.\n");
    for row in ROWS {
        let Messages { errors, warnings } = messages(&row.text());
        let warnings = warnings
            .iter()
            .map(|warning| bsmpm_messages::headed(warning, "warning"));
        let all: Vec<String> = errors.into_iter().chain(warnings).collect();
        let all = if all.is_empty() {
            "nothing".to_owned()
        } else {
            all.join("\n")
        };
        _ = write!(page, "\n{} {}\n{all}\n", row.number, row.what);
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/newcomer/texts.txt");
    if std::env::var_os("BSMPM_RENEW").is_some() {
        std::fs::write(path, &page).expect("the page can be written");
    }
    let known = std::fs::read_to_string(path).expect("the page can be read");
    assert!(
        known == page,
        "texts have changed: BSMPM_RENEW=1 cargo test -p bsmpm-scene --test newcomer, and read them"
    );
}

/// Row 46: a record in a format that is not read says how to convert it.
#[test]
fn a_record_of_peer_is_refused_with_the_way_to_convert_it() {
    let folder = std::env::temp_dir().join(format!("newcomer-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let record = "PEER STRONG MOTION DATABASE RECORD\nIMPERIAL VALLEY\nACCELERATION TIME SERIES IN UNITS OF G\n\
                  NPTS=  8, DT= .0200 SEC\n  .1E-03  .2E-03 .3E-03 .1E-02\n  .1E-03  .2E-03 .3E-03 .1E-02\n";
    std::fs::write(folder.join("rec.at2"), record).expect("a record");
    let shaken = SLOPE.replace("\"quasi-static\"", "\"dynamic\", end = 1.0");
    let case = format!("{shaken}\n[shaking]\nacceleration = {{ file = \"rec.at2\", along = \"x\" }}\n");
    std::fs::write(folder.join("case.toml"), case).expect("a case");
    let error = load(&folder.join("case.toml")).expect_err("accepted").to_string();
    std::fs::remove_dir_all(&folder).expect("removed");
    assert!(
        error.starts_with("E0049: rec.at2: ") && error.contains("t [s], a [g]"),
        "{error}"
    );
}
