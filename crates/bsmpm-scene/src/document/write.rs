//! Writes a document as TOML text.

use super::{DocumentTable, Node, Value};
use crate::key_path::join;
use std::fmt::Write;

impl DocumentTable {
    /// TOML text with the same content; comments are lost.
    pub(crate) fn to_toml(&self) -> String {
        let mut text = String::new();
        self.write(&mut text, "");
        text
    }

    fn write(&self, text: &mut String, path: &str) {
        let mut tables = Vec::new();
        let mut arrays = Vec::new();
        for entry in &self.entries {
            let key = quoted_key(&entry.key);
            match &entry.node.value {
                Value::Table(table) => tables.push((key, table)),
                Value::List(list) if has_only_tables(list) => arrays.push((key, list)),
                value => _ = writeln!(text, "{key} = {}", inline(value)),
            }
        }
        for (key, table) in tables {
            let path = join(path, &key);
            _ = writeln!(text, "\n[{path}]");
            table.write(text, &path);
        }
        for (key, list) in arrays {
            let path = join(path, &key);
            for item in list {
                let Value::Table(table) = &item.value else { continue };
                _ = writeln!(text, "\n[[{path}]]");
                table.write(text, &path);
            }
        }
    }
}

/// Whether a list has items, and all of them are tables.
fn has_only_tables(list: &[Node]) -> bool {
    !list.is_empty() && list.iter().all(|item| matches!(item.value, Value::Table(_)))
}

fn inline(value: &Value) -> String {
    match value {
        Value::Text(text) => quoted(text),
        Value::Integer(text) | Value::Float(text) | Value::Date(text) => text.clone(),
        Value::Flag(flag) => flag.to_string(),
        Value::List(list) => {
            let items: Vec<String> = list.iter().map(|item| inline(&item.value)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Table(table) => {
            let entries = table.entries.iter();
            let entries = entries.map(|entry| format!("{} = {}", quoted_key(&entry.key), inline(&entry.node.value)));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
    }
}

fn quoted_key(key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare { key.to_owned() } else { quoted(key) }
}

fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => _ = write!(quoted, "\\u{:04X}", u32::from(c)),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}
