//! Reports slips in a case, such as misspelt keys. Each slip is corrected, so that it does not cause further errors.

use crate::document::{DocumentEntry, DocumentTable, Node, Value};
use crate::key_path::join;
use crate::nearest::nearest;
use crate::report::{Report, shortened};
use crate::schema::{Kind, Presence, Table, answer};
use bsmpm_messages::code_of;

/// Unknown keys of a table that are reported at most.
const MOST_UNKNOWN: usize = 50;

/// Reports the slips of the whole document and puts right what is meant.
pub(crate) fn mend(root: &'static Table, document: &mut DocumentTable, report: &mut Report<'_>) {
    Mender { root, report }.in_table(document, root, "");
}

/// Goes through the document.
struct Mender<'a, 'b> {
    root: &'static Table,
    report: &'a mut Report<'b>,
}

impl Mender<'_, '_> {
    fn in_table(&mut self, written: &mut DocumentTable, table: &'static Table, path: &str) {
        self.rename_misspelt(written, table, path);
        for entry in &mut written.entries {
            if let Some(key) = table.key(&entry.key) {
                self.in_value(&mut entry.node, &key.kind, &join(path, &entry.key));
            }
        }
    }

    /// Gives misspelt keys the name that is meant, if neither it nor a rival of it is given.
    fn rename_misspelt(&mut self, written: &mut DocumentTable, table: &'static Table, path: &str) {
        let mut given: Vec<String> = written.entries.iter().map(|entry| entry.key.clone()).collect();
        for entry in written
            .entries
            .iter_mut()
            .filter(|entry| table.key(&entry.key).is_none())
            .take(MOST_UNKNOWN)
        {
            let Some(meant) = meant(table, &entry.key) else {
                continue;
            };
            let mut names = std::iter::once(meant).chain(table.rivals(meant));
            if names.any(|name| given.iter().any(|other| other == name)) {
                continue;
            }
            let assumed = join(path, meant);
            self.report.slip(
                entry.origin,
                &join(path, &entry.key),
                unknown_key(self.root, table, &entry.key),
                &assumed,
            );
            given.push(meant.to_owned());
            meant.clone_into(&mut entry.key);
        }
    }

    fn in_value(&mut self, node: &mut Node, kind: &'static Kind, path: &str) {
        match kind {
            Kind::Tables(table) => {
                self.list_single_table(node, table, path);
                let Value::List(items) = &mut node.value else { return };
                for (number, item) in items.iter_mut().enumerate() {
                    if let Value::Table(written) = &mut item.value {
                        self.in_table(written, table, &join(path, &number.to_string()));
                    }
                }
            }
            Kind::Named(table) => {
                self.name_single_table(node, table, path);
                let Value::Table(named) = &mut node.value else { return };
                for entry in &mut named.entries {
                    let path = join(path, &entry.key);
                    self.take_only_table(&mut entry.node, table, &path);
                    if let Value::Table(written) = &mut entry.node.value {
                        self.in_table(written, table, &path);
                    }
                }
            }
            Kind::Table(table) => {
                self.take_only_table(node, table, path);
                if let Value::Table(written) = &mut node.value {
                    self.in_table(written, table, path);
                }
            }
            _ => {
                if let (Some(table), Value::Table(written)) = (kind.table(), &mut node.value) {
                    self.in_table(written, table, path);
                }
            }
        }
    }

    /// `[body]` for `[[body]]`: the one table becomes a list.
    fn list_single_table(&mut self, node: &mut Node, table: &Table, path: &str) {
        let Value::Table(written) = &mut node.value else { return };
        let name = path.rsplit('.').next().unwrap_or(path);
        let message = format!(
            "E0047: expected a list of tables, {}, found a single table. Write two pairs of brackets, [[{}]], even for \
             one table.",
            table.header,
            if table.header.starts_with("[[") {
                table.header.trim_matches(['[', ']'])
            } else {
                name
            }
        );
        self.report.error(node.origin, path, message);
        let item = Node {
            origin: node.origin,
            value: Value::Table(std::mem::take(written)),
        };
        node.value = Value::List(vec![item]);
    }

    /// `[material]` for `[material.NAME]`: the table gets the name `soil`, so that its values are checked as well.
    fn name_single_table(&mut self, node: &mut Node, table: &Table, path: &str) {
        let Value::Table(written) = &mut node.value else { return };
        let has_only_keys = written
            .entries
            .iter()
            .all(|entry| !matches!(entry.node.value, Value::Table(_)) && table.key(&entry.key).is_some());
        if written.entries.is_empty() || !has_only_keys {
            return;
        }
        let message = format!(
            "E0051: this table has no name, but its heading must have the form {}. Add the name, \
             such as [{path}.soil].",
            table.header
        );
        self.report.error(node.origin, path, message);
        let only = Node {
            origin: node.origin,
            value: Value::Table(std::mem::take(written)),
        };
        written.entries.push(DocumentEntry {
            key: "soil".to_owned(),
            origin: node.origin,
            node: only,
        });
    }

    /// `[[grid]]` for `[grid]`: the only table of the list is the one that is meant.
    fn take_only_table(&mut self, node: &mut Node, table: &Table, path: &str) {
        let Value::List(items) = &mut node.value else { return };
        let [
            Node {
                value: Value::Table(written),
                ..
            },
        ] = &mut items[..]
        else {
            return;
        };
        let message = format!(
            "E0048: expected one table, {}, found a list of tables. Write one pair of brackets in place of two.",
            table.header
        );
        self.report.error(node.origin, path, message);
        node.value = Value::Table(std::mem::take(written));
    }
}

/// The key of a table that an unknown name most likely means; of the symbols and names of other programs those that
/// stand for a value.
fn meant(table: &'static Table, name: &str) -> Option<&'static str> {
    if answer(table, name).is_some() {
        return answered(table, name).into_iter().find(|name| {
            let kind = table.key(name).map(|key| &key.kind);
            kind.is_some_and(|kind| !matches!(kind, Kind::Table(_) | Kind::Named(_) | Kind::Tables(_)))
        });
    }
    nearest(name, names(table))
}

/// Keys of a table that the answer to an unknown name mentions.
pub(crate) fn answered(table: &'static Table, name: &str) -> Vec<&'static str> {
    let text = answer(table, name).unwrap_or_default();
    let quoted = text.split('`').skip(1).step_by(2);
    let bare = quoted.map(|word| word.trim_matches(['[', ']']).split('.').next().unwrap_or(word));
    bare.filter(|word| table.key(word).is_some()).collect()
}

/// Names of a table's keys that may be written.
fn names(table: &'static Table) -> impl Iterator<Item = &'static str> {
    table
        .keys
        .iter()
        .filter(|key| key.presence != Presence::Retired)
        .map(|key| key.name)
}

/// Reports the keys of a table that it does not have.
pub(crate) fn report_unknown(
    root: &'static Table,
    table: &'static Table,
    written: &DocumentTable,
    path: &str,
    report: &mut Report<'_>,
) {
    let mut unknown = written.entries.iter().filter(|entry| table.key(&entry.key).is_none());
    for entry in unknown.by_ref().take(MOST_UNKNOWN) {
        let near = nearest(&entry.key, names(table));
        let meant = answered(table, &entry.key)
            .into_iter()
            .chain(near)
            .map(|name| join(path, name))
            .collect();
        report.about(
            entry.origin,
            &join(path, &entry.key),
            unknown_key(root, table, &entry.key),
            meant,
        );
    }
    if let Some(entry) = unknown.next() {
        let message = format!(
            "E0009: the table has {} more unknown keys, which are not listed. Correct the unknown keys above first.",
            unknown.count() + 1
        );
        report.error(entry.origin, path, message);
    }
}

/// What is wrong with an unknown key, and what is meant.
fn unknown_key(root: &'static Table, table: &'static Table, key: &str) -> String {
    if let Some(answer) = answer(table, key) {
        return match code_of(answer) {
            Some(_) => answer.to_owned(),
            None => format!(
                "E0011: the name `{}` is not a known key of {}. {answer}",
                shortened(key),
                table.header
            ),
        };
    }
    let name = shortened(key);
    let header = table.header;
    if let Some(meant) = nearest(key, names(table)) {
        return format!("E0011: the name `{name}` is not a known key of {header}; did you mean `{meant}`?");
    }
    let elsewhere = root.all().into_iter().find(|other| other.key(key).is_some());
    let hint = elsewhere.map_or(String::new(), |other| format!("; it belongs to {}", other.header));
    let known: Vec<&str> = names(table).collect();
    format!(
        "E0011: the name `{name}` is not a known key of {header}{hint}. Known keys: {}.",
        known.join(", ")
    )
}
