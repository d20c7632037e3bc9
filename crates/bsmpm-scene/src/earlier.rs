//! Replaces outdated names of keys and options in old case files, and reports each replacement.

use crate::document::{DocumentEntry, DocumentTable, Node, Value};
use crate::key_path::join;
use crate::report::Report;
use crate::schema::{Kind, ROOT, Table};
use crate::words::Words;

/// Replaces earlier names of keys and words in the whole document.
pub(crate) fn replace(document: &mut DocumentTable, report: &mut Report<'_>) {
    in_table(document, ROOT, "", report);
}

/// Reads `lambda` and `kappa` of a run that was made before these were the slopes of the specific volume: they were
/// what is `lambda_star` and `kappa_star` now.
pub(crate) fn star_slopes(document: &mut DocumentTable) {
    let Some(Value::Table(materials)) = document.get_mut("material").map(|entry| &mut entry.node.value) else {
        return;
    };
    for material in &mut materials.entries {
        let Value::Table(keys) = &mut material.node.value else {
            continue;
        };
        if keys.get("void_ratio").is_some() {
            continue;
        }
        for (earlier, now) in [("lambda", "lambda_star"), ("kappa", "kappa_star")] {
            if let Some(entry) = keys.get_mut(earlier) {
                now.clone_into(&mut entry.key);
            }
        }
    }
}

fn in_table(written: &mut DocumentTable, table: &'static Table, path: &str, report: &mut Report<'_>) {
    let names: Vec<String> = written.entries.iter().map(|entry| entry.key.clone()).collect();
    written.entries.retain_mut(|entry| {
        let path = join(path, &entry.key);
        let is_kept = rename(entry, &names, table, &path, report);
        if is_kept && let Some(key) = table.key(&entry.key) {
            in_value(&mut entry.node, &key.kind, &path, report);
        }
        is_kept
    });
}

/// Gives an entry the name of now of its key. `false` after an error: it is one of the `names` of the table already.
fn rename(entry: &mut DocumentEntry, names: &[String], table: &Table, path: &str, report: &mut Report<'_>) -> bool {
    let renamed = table.renamed(&entry.key).filter(|_| table.key(&entry.key).is_none());
    let Some(key) = renamed else { return true };
    if names.iter().any(|other| other == key.name) {
        let message = format!(
            "E0016: this key is the earlier name of the key `{now}`, and the case gives both keys. Delete \
             this key, or delete `{now}`.",
            now = key.name
        );
        report.error(entry.origin, path, message);
        return false;
    }
    report.renamed(&entry.key, key.name, path);
    key.name.clone_into(&mut entry.key);
    true
}

fn in_value(node: &mut Node, kind: &Kind, path: &str, report: &mut Report<'_>) {
    match (kind, &mut node.value) {
        (Kind::Choice(words) | Kind::ChoiceOr(words, _), Value::Text(word)) => in_word(word, words, path, report),
        (Kind::Choices(words), Value::List(items)) => {
            for item in items {
                if let Value::Text(word) = &mut item.value {
                    in_word(word, words, path, report);
                }
            }
        }
        (Kind::Named(table), Value::Table(named)) => {
            for entry in &mut named.entries {
                if let Value::Table(written) = &mut entry.node.value {
                    in_table(written, table, &join(path, &entry.key), report);
                }
            }
        }
        (Kind::Tables(table), Value::List(items)) => {
            for (number, item) in items.iter_mut().enumerate() {
                if let Value::Table(written) = &mut item.value {
                    in_table(written, table, &join(path, &number.to_string()), report);
                }
            }
        }
        (kind, Value::Table(written)) => {
            if let Some(table) = kind.table() {
                in_table(written, table, path, report);
            }
        }
        _ => {}
    }
}

fn in_word(word: &mut String, words: &Words, path: &str, report: &mut Report<'_>) {
    if let Some(now) = words.renamed(word) {
        report.renamed(&format!("\"{word}\""), &format!("\"{now}\""), path);
        now.clone_into(word);
    }
}
