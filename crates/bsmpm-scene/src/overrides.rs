//! Applies `--set KEY=VALUE` to the document before validation.

use crate::document::{self, DocumentEntry, DocumentTable, Node, Value};
use crate::error::Origin;
use crate::record::UNREAD;
use crate::report::{Report, shortened};
use crate::schema::{Kind, ROOT, Table as Schema};

/// Parts of a key path at most; no key lies deeper.
const DEEPEST: usize = 7;

/// In the place of an index, or of a name: all that are there.
const EACH: &str = "*";

/// Merges the overrides into the document in their order; a later one wins.
pub(crate) fn apply(document: &mut DocumentTable, overrides: &[String], report: &mut Report<'_>) {
    for (number, text) in overrides.iter().enumerate() {
        let origin = Origin::Override(number);
        let Some((key, value)) = text.split_once('=') else {
            report.error(
                origin,
                "",
                "E0025: the argument of --set has no `=`. Write KEY=VALUE, such as grid.cell=0.5.",
            );
            continue;
        };
        let parts: Vec<&str> = key.split('.').map(str::trim).collect();
        if parts.len() > DEEPEST || parts.iter().any(|part| part.is_empty()) {
            report.error(
                origin,
                key.trim(),
                "E0025: the text before `=` is not the path of a key. Write the names of the tables and the key with \
                 dots between them, such as body.0.points_per_cell.",
            );
            continue;
        }
        match parsed(value.trim(), origin) {
            Ok(node) => {
                let mut setting = Setting {
                    parts: &parts,
                    node,
                    origin,
                    renamed: Vec::new(),
                };
                let set = setting.in_table(document, Some(ROOT), 0);
                for (earlier, now) in setting.renamed {
                    report.renamed(earlier, now, key.trim());
                }
                if let Err(message) = set {
                    report.error(origin, key.trim(), message);
                }
            }
            Err(message) => report.error(
                origin,
                key.trim(),
                format!("E0025: the value cannot be read: {message}. Check the brackets and quotes of the value."),
            ),
        }
    }
}

/// The value as TOML; what is none, like a bare word or `5 mm`, is a string.
fn parsed(text: &str, origin: Origin) -> Result<Node, String> {
    match document::parse_value(text, origin) {
        Err(message) if text.starts_with(['[', '{', '"', '\'']) => Err(message),
        Err(_) => Ok(Node {
            origin,
            value: Value::Text(text.to_owned()),
        }),
        read => read,
    }
}

struct Setting<'a> {
    parts: &'a [&'a str],
    node: Node,
    origin: Origin,
    /// earlier names in the path, with those of now
    renamed: Vec<(&'a str, &'static str)>,
}

impl<'a> Setting<'a> {
    /// The key at a depth of the path, by its name of now.
    fn name_of_now(&mut self, schema: Option<&'static Schema>, depth: usize) -> &'a str {
        let name = self.parts[depth];
        let schema = schema.filter(|schema| schema.key(name).is_none());
        let Some(key) = schema.and_then(|schema| schema.renamed(name)) else {
            return name;
        };
        self.renamed.push((name, key.name));
        key.name
    }

    fn in_table(
        &mut self,
        table: &mut DocumentTable,
        schema: Option<&'static Schema>,
        depth: usize,
    ) -> Result<(), String> {
        let name = self.name_of_now(schema, depth);
        if let Some(schema) = schema {
            table
                .entries
                .retain(|entry| schema.rivals(name).all(|rival| rival != entry.key));
        }
        let kind = schema.and_then(|schema| schema.key(name)).map(|key| &key.kind);
        if depth + 1 == self.parts.len() {
            let node = self.node.clone();
            match table.get_mut(name) {
                Some(entry) => {
                    *entry = DocumentEntry {
                        key: name.to_owned(),
                        origin: self.origin,
                        node,
                    }
                }
                None => table.entries.push(DocumentEntry {
                    key: name.to_owned(),
                    origin: self.origin,
                    node,
                }),
            }
            return Ok(());
        }
        if table.get(name).is_none() {
            let value = match kind {
                Some(Kind::Tables(_)) => Value::List(Vec::new()),
                _ => Value::Table(DocumentTable::default()),
            };
            let node = Node {
                origin: self.origin,
                value,
            };
            table.entries.push(DocumentEntry {
                key: name.to_owned(),
                origin: self.origin,
                node,
            });
        }
        let Some(entry) = table.get_mut(name) else {
            return Ok(());
        };
        if self.parts[depth + 1] == "file" && matches!(kind, Some(Kind::Rows(_) | Kind::Course(_))) {
            return Err(UNREAD.to_owned());
        }
        match (kind, &mut entry.node.value) {
            (Some(Kind::Named(below)), Value::Table(named)) => self.in_named(named, below, depth + 1),
            _ => self.in_value(&mut entry.node, kind.and_then(Kind::table), depth + 1),
        }
    }

    /// In a table whose keys are names of the author's choice.
    fn in_named(&mut self, named: &mut DocumentTable, schema: &'static Schema, depth: usize) -> Result<(), String> {
        let name = self.parts[depth];
        if depth + 1 < self.parts.len() && name == EACH {
            let mut entries = named.entries.iter_mut();
            return entries.try_for_each(|entry| self.in_value(&mut entry.node, Some(schema), depth + 1));
        }
        if depth + 1 < self.parts.len()
            && let Some(entry) = named.get_mut(name)
        {
            return self.in_value(&mut entry.node, Some(schema), depth + 1);
        }
        self.in_table(named, None, depth)
    }

    fn in_value(&mut self, node: &mut Node, schema: Option<&'static Schema>, depth: usize) -> Result<(), String> {
        let shown = node.show();
        let part = self.parts[depth];
        match &mut node.value {
            Value::Table(table) => self.in_table(table, schema, depth),
            Value::List(items) => {
                let length = items.len();
                let last = depth + 1 == self.parts.len();
                if part == EACH && length > 0 && !last {
                    return items
                        .iter_mut()
                        .try_for_each(|item| self.in_value(item, schema, depth + 1));
                }
                let index: usize = part.parse().map_err(|_| {
                    format!(
                        "E0026: `{}` is not a number, but a list needs the number of an item here. Write the number \
                         of one of the {length} items, counted from 0.",
                        shortened(part)
                    )
                })?;
                if index > length {
                    return Err(format!(
                        "E0026: the list has no item {index}. It has {length} items, and the first one is item 0. \
                         Write {length} to add an item."
                    ));
                }
                if index == length {
                    let value = if last {
                        self.node.value.clone()
                    } else {
                        Value::Table(DocumentTable::default())
                    };
                    items.push(Node {
                        origin: self.origin,
                        value,
                    });
                }
                if last {
                    items[index] = self.node.clone();
                    return Ok(());
                }
                self.in_value(&mut items[index], schema, depth + 1)
            }
            _ => Err(format!(
                "E0026: in this path `{}` follows a key that has the value {shown} and is not a table, so it has no \
                 keys of its own. Correct the path.",
                shortened(part)
            )),
        }
    }
}
