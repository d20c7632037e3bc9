//! Writes the keys of the case file as a JSON Schema (draft 7), with which editors complete and check a case.

use bsmpm_scene::schema::{Dimension, Group, Key, Kind, Presence, ROOT, Range, Table};
use bsmpm_scene::words::Words;
use serde_json::{Map, Value, json};
use std::ops::Bound;

/// A number as a string begins with.
const NUMBER: &str = "[+-]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][+-]?[0-9]+)?";

/// The JSON Schema of a case file: it follows from the declarations of the keys alone.
///
/// It has each key's type, words, range of plain numbers and groups of alternatives. It does not have the units of
/// strings, and no rule between tables: `bsmpm-par --check` reports these.
pub fn json_schema() -> String {
    let mut definitions = Map::new();
    for table in ROOT.all().into_iter().skip(1) {
        definitions.entry(name_of(table)).or_insert_with(|| of_table(table));
    }
    let mut schema = of_table(ROOT);
    let head = [
        ("$schema", json!("http://json-schema.org/draft-07/schema#")),
        ("title", json!("Case file of bsmpm")),
        ("definitions", Value::Object(definitions)),
    ];
    for (key, value) in head {
        schema[key] = value;
    }
    format!("{schema:#}\n")
}

/// The name of a table among the definitions.
fn name_of(table: &Table) -> String {
    let words = table.header.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join("-")
}

/// A reference to the definition of a table.
fn reference(table: &Table) -> Value {
    json!({ "$ref": format!("#/definitions/{}", name_of(table)) })
}

fn of_table(table: &Table) -> Value {
    let mut properties = Map::new();
    for key in table.keys.iter().filter(|key| key.presence != Presence::Later) {
        for earlier in key.earlier {
            let description = format!("Earlier name of `{}`. {}", key.name, key.doc);
            let schema = described(of_kind(&key.kind), description, true);
            properties.insert((*earlier).to_owned(), schema);
        }
        properties.insert(key.name.to_owned(), of_key(key));
    }
    let mut needed: Vec<&str> = Vec::new();
    let mut conditions: Vec<Value> = Vec::new();
    let required = table.keys.iter().filter(|key| key.presence == Presence::Required);
    for key in required.filter(|key| !key.has_preset) {
        match key.earlier {
            [] => needed.push(key.name),
            _ => conditions.push(one_given(&names(table, &[key.name]))),
        }
    }
    for group in table
        .exclusive
        .iter()
        .filter(|group| group.required && !group.has_preset)
    {
        conditions.push(one_given(&names(table, group.keys)));
    }
    let mut schema = json!({
        "type": "object",
        "description": table.doc,
        "properties": properties,
        "additionalProperties": false,
    });
    let mut dependencies = dependencies(table);
    // Taplo completes no keys of a table with conditions beside its properties. As dependencies of a required key they
    // mean the same.
    match needed.first() {
        Some(first) if !conditions.is_empty() => {
            conditions.extend(dependencies.remove(*first));
            dependencies.insert((*first).to_owned(), json!({ "allOf": conditions }));
        }
        None if !conditions.is_empty() => schema["allOf"] = conditions.into(),
        _ => {}
    }
    if !needed.is_empty() {
        schema["required"] = needed.into();
    }
    if !dependencies.is_empty() {
        schema["dependencies"] = Value::Object(dependencies);
    }
    schema
}

/// The names of keys, those of earlier versions among them.
fn names(table: &Table, keys: &[&'static str]) -> Vec<&'static str> {
    let mut names = Vec::new();
    for key in keys {
        names.push(*key);
        names.extend(table.key(key).map_or(&[][..], |key| key.earlier));
    }
    names
}

/// The condition that one of several keys is given.
fn one_given(names: &[&str]) -> Value {
    match names {
        [name] => json!({ "required": [name] }),
        names => {
            let each: Vec<Value> = names.iter().map(|name| json!({ "required": [name] })).collect();
            json!({ "anyOf": each })
        }
    }
}

/// For each key the condition that none is given of which only one is allowed.
fn dependencies(table: &Table) -> Map<String, Value> {
    let mut dependencies = Map::new();
    for key in table.exclusive.iter().flat_map(|group: &Group| group.keys) {
        let rivals: Vec<&str> = table.rivals(key).collect();
        let schema = json!({ "not": one_given(&names(table, &rivals)) });
        dependencies.insert((*key).to_owned(), schema);
    }
    dependencies
}

fn of_key(key: &Key) -> Value {
    let mut description = match key.presence {
        Presence::Retired => format!("This key has no effect any more, because {}.", key.doc),
        _ => key.doc.to_owned(),
    };
    if !key.symbol.is_empty() {
        description = format!("{description} Symbol: {}.", key.symbol);
    }
    let mut schema = described(of_kind(&key.kind), description, key.presence == Presence::Retired);
    if let Presence::Default(text) = key.presence
        && let Ok(default) = serde_json::from_str::<Value>(text)
    {
        schema["default"] = default;
    }
    if let Some(text) = key.example_value()
        && let Ok(example) = serde_json::from_str::<Value>(&text)
    {
        schema["examples"] = json!([example]);
    }
    schema
}

/// A schema with a description. What stands beside a reference has no effect, so that one is wrapped.
fn described(schema: Value, description: String, is_deprecated: bool) -> Value {
    let mut schema = match schema.get("$ref") {
        Some(_) => json!({ "allOf": [schema] }),
        None => schema,
    };
    schema["description"] = description.into();
    if is_deprecated {
        schema["deprecated"] = true.into();
    }
    schema
}

fn of_kind(kind: &Kind) -> Value {
    match kind {
        Kind::Quantity(dimension, range) => quantity(*dimension, range),
        Kind::Gradient(_) | Kind::Measure => json!({ "anyOf": [{ "type": "number" }, number_with_unit()] }),
        Kind::Profile(dimension, range, table) => either(quantity(*dimension, range), reference(table)),
        Kind::GradientVector(_) => vector(json!({ "anyOf": [{ "type": "number" }, number_with_unit()] }), 2, 3),
        Kind::Pair(dimension, range) => vector(quantity(*dimension, range), 2, 2),
        Kind::Vector(dimension, range) => vector(quantity(*dimension, range), 2, 3),
        Kind::PairProfile(dimension, range, table) => {
            either(vector(quantity(*dimension, range), 2, 3), reference(table))
        }
        Kind::Either(dimension, range) => {
            let one = quantity(*dimension, range);
            either(one.clone(), vector(one, 2, 3))
        }
        Kind::List(dimension, range) => json!({ "type": "array", "items": quantity(*dimension, range) }),
        Kind::Rows(columns) => {
            let cells: Vec<Value> = columns.iter().map(|(of, range)| quantity(*of, range)).collect();
            rows(json!({ "type": "array", "minItems": cells.len(), "maxItems": cells.len(), "items": cells }))
        }
        Kind::Course(dimension) => rows(vector(quantity(*dimension, &Range::ANY), 3, 4)),
        Kind::Count(least, most) => json!({ "type": "integer", "minimum": least, "maximum": most }),
        Kind::Choice(words) => of_words(words),
        Kind::ChoiceOr(words, table) => either(of_words(words), reference(table)),
        Kind::Choices(words) => json!({ "type": "array", "items": of_words(words), "uniqueItems": true }),
        Kind::Text(most) => json!({ "type": "string", "maxLength": most }),
        Kind::Name => name(),
        Kind::Names => json!({ "type": "array", "items": name() }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Table(table) => reference(table),
        Kind::Named(table) => json!({ "type": "object", "additionalProperties": reference(table) }),
        Kind::Tables(table) => json!({ "type": "array", "items": reference(table) }),
        Kind::Open => json!({}),
    }
}

fn either(one: Value, other: Value) -> Value {
    json!({ "anyOf": [one, other] })
}

fn vector(item: Value, least: usize, most: usize) -> Value {
    json!({ "type": "array", "items": item, "minItems": least, "maxItems": most })
}

/// Rows, or the file that contains them.
fn rows(row: Value) -> Value {
    let file = json!({
        "type": "object",
        "description": "A data file in the folder of the case.",
        "properties": { "file": { "type": "string" }, "along": { "enum": ["x", "y", "z"] } },
        "required": ["file"],
        "additionalProperties": false,
    });
    either(json!({ "type": "array", "items": row }), file)
}

/// A number in SI within a range, or a string with a unit, of which the schema checks the form only.
fn quantity(dimension: Dimension, range: &Range) -> Value {
    let mut number = json!({ "type": "number" });
    match range.lower {
        Bound::Included(lower) => number["minimum"] = lower.into(),
        Bound::Excluded(lower) => number["exclusiveMinimum"] = lower.into(),
        Bound::Unbounded => {}
    }
    match range.upper {
        Bound::Included(upper) => number["maximum"] = upper.into(),
        Bound::Excluded(upper) => number["exclusiveMaximum"] = upper.into(),
        Bound::Unbounded => {}
    }
    match dimension.units().next() {
        Some(_) => either(number, number_with_unit()),
        None => number,
    }
}

fn number_with_unit() -> Value {
    json!({ "type": "string", "pattern": format!("^\\s*{NUMBER}\\s*[^\\s0-9].*$") })
}

fn name() -> Value {
    json!({ "type": "string", "pattern": "^[A-Za-z0-9_-]{1,64}$" })
}

/// The words of a key, with their meaning for the editor, and those of earlier versions.
fn of_words(words: &Words) -> Value {
    let now: Vec<&str> = words.words().collect();
    let meanings: Vec<&str> = words.all().map(|(_, doc)| doc).collect();
    let now = json!({ "enum": now, "x-taplo": { "docs": { "enumValues": meanings } } });
    if words.earlier.is_empty() {
        return now;
    }
    let earlier: Vec<&str> = words.earlier.iter().map(|(word, _)| *word).collect();
    either(now, json!({ "enum": earlier, "deprecated": true }))
}
