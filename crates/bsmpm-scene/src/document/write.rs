//! Writes a document as TOML text.

use super::{DocumentTable, Node, Value};
use std::fmt::Write;

impl DocumentTable {
    /// TOML text with the same content; comments are lost.
    pub(crate) fn to_toml(&self) -> String {
        let mut text = String::new();
        self.write(&mut text, "");
        text
    }

    fn write(&self, text: &mut String, path: &str) {
        let of_tables =
            |list: &[Node]| !list.is_empty() && list.iter().all(|item| matches!(item.value, Value::Table(_)));
        let (mut tables, mut arrays) = (Vec::new(), Vec::new());
        for entry in &self.entries {
            let key = quoted_key(&entry.key);
            match &entry.node.value {
                Value::Table(table) => tables.push((key, table)),
                Value::List(list) if of_tables(list) => arrays.push((key, list)),
                value => _ = writeln!(text, "{key} = {}", inline(value)),
            }
        }
        let below = |key: &str| {
            if path.is_empty() {
                key.to_owned()
            } else {
                format!("{path}.{key}")
            }
        };
        for (key, table) in tables {
            let path = below(&key);
            _ = writeln!(text, "\n[{path}]");
            table.write(text, &path);
        }
        for (key, list) in arrays {
            let path = below(&key);
            for item in list {
                let Value::Table(table) = &item.value else { continue };
                _ = writeln!(text, "\n[[{path}]]");
                table.write(text, &path);
            }
        }
    }
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
            let entry =
                |entry: &super::DocumentEntry| format!("{} = {}", quoted_key(&entry.key), inline(&entry.node.value));
            let entries: Vec<String> = table.entries.iter().map(entry).collect();
            format!("{{ {} }}", entries.join(", "))
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
