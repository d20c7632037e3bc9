//! Tests the JSON Schema of the case file with the shipped cases, and with cases that it refuses.

use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// A case of TOML as JSON.
fn to_json(table: &DeTable<'_>) -> Value {
    let entries = table.iter();
    entries
        .map(|(key, value)| (key.get_ref().to_string(), value_to_json(value.get_ref())))
        .collect::<serde_json::Map<_, _>>()
        .into()
}

fn value_to_json(value: &DeValue<'_>) -> Value {
    match value {
        DeValue::String(text) => json!(text),
        DeValue::Integer(number) => json!(number.as_str().parse::<i64>().unwrap()),
        DeValue::Float(number) => json!(number.as_str().parse::<f64>().unwrap()),
        DeValue::Boolean(flag) => json!(flag),
        DeValue::Datetime(date) => json!(date.to_string()),
        DeValue::Array(items) => items.iter().map(|item| value_to_json(item.get_ref())).collect(),
        DeValue::Table(table) => to_json(table),
    }
}

/// The schema, of which this reads the keywords that it uses.
struct Validator {
    schema: Value,
}

impl Validator {
    fn new() -> Self {
        let schema = serde_json::from_str(&bsmpm_tools::keys::json_schema()).unwrap();
        Self { schema }
    }

    /// What is wrong with a case.
    fn fault(&self, text: &str) -> Option<String> {
        let table = DeTable::parse(text).unwrap();
        self.refusal(&self.schema, &to_json(table.get_ref()), "")
    }

    /// Why a schema refuses the value at a path.
    fn refusal(&self, schema: &Value, value: &Value, path: &str) -> Option<String> {
        let keywords = schema.as_object().unwrap().iter();
        keywords
            .filter_map(|(keyword, of)| self.refusal_by(keyword, of, schema, value, path))
            .next()
    }

    /// Why a keyword of a schema refuses the value: because of a part of it, or of the whole.
    fn refusal_by(&self, keyword: &str, of: &Value, schema: &Value, value: &Value, path: &str) -> Option<String> {
        let keys = value.as_object();
        let below = |key: &str| format!("{path}.{key}");
        match keyword {
            "$ref" => {
                let place = of.as_str().unwrap().trim_start_matches('#');
                self.refusal(self.schema.pointer(place).unwrap(), value, path)
            }
            "allOf" => {
                let mut all = of.as_array().unwrap().iter();
                all.find_map(|one| self.refusal(one, value, path))
            }
            "properties" => keys?.iter().find_map(|(key, value)| {
                let schema = of.get(key)?;
                self.refusal(schema, value, &below(key))
            }),
            "additionalProperties" => keys?.iter().find_map(|(key, value)| {
                let is_known = schema.get("properties").is_some_and(|known| known.get(key).is_some());
                match of {
                    _ if is_known => None,
                    Value::Bool(false) => Some(format!("{}: additionalProperties", below(key))),
                    of => self.refusal(of, value, &below(key)),
                }
            }),
            "items" => value.as_array()?.iter().enumerate().find_map(|(k, item)| {
                let schema = of.as_array().map_or(of, |of| &of[k.min(of.len() - 1)]);
                self.refusal(schema, item, &below(&k.to_string()))
            }),
            "dependencies" => of.as_object().unwrap().iter().find_map(|(key, schema)| {
                keys?.get(key)?;
                self.refusal(schema, value, path)
            }),
            _ => (!self.accepts(keyword, of, value, path)).then(|| format!("{path}: {keyword} {of}")),
        }
    }

    /// Whether a keyword accepts the whole value.
    fn accepts(&self, keyword: &str, of: &Value, value: &Value, path: &str) -> bool {
        let number = value.as_f64();
        let length = value.as_array().map(Vec::len);
        let keys = value.as_object();
        let bound = of.as_f64().unwrap_or(0.0);
        let is_valid = |schema: &Value| self.refusal(schema, value, path).is_none();
        match keyword {
            "anyOf" => of.as_array().unwrap().iter().any(is_valid),
            "not" => !is_valid(of),
            "required" => {
                let mut required = of.as_array().unwrap().iter();
                required.all(|key| keys.is_none_or(|keys| keys.contains_key(key.as_str().unwrap())))
            }
            "enum" => of.as_array().unwrap().contains(value),
            "type" => is_of_type(value, of.as_str().unwrap()),
            "minimum" => number.is_none_or(|number| number >= bound),
            "maximum" => number.is_none_or(|number| number <= bound),
            "exclusiveMinimum" => number.is_none_or(|number| number > bound),
            "exclusiveMaximum" => number.is_none_or(|number| number < bound),
            "minItems" => length.is_none_or(|length| length as f64 >= bound),
            "maxItems" => length.is_none_or(|length| length as f64 <= bound),
            "uniqueItems" => value
                .as_array()
                .is_none_or(|items| (1..items.len()).all(|k| !items[..k].contains(&items[k]))),
            "maxLength" => value.as_str().is_none_or(|text| text.chars().count() as f64 <= bound),
            "pattern" => value.as_str().is_none_or(|text| matches(of.as_str().unwrap(), text)),
            "$schema" | "title" | "description" | "definitions" | "default" | "examples" | "deprecated" | "x-taplo" => {
                true
            }
            other => panic!("the test does not read the keyword {other}"),
        }
    }
}

/// Whether a value has a type of JSON Schema.
fn is_of_type(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64(),
        "number" => value.is_number(),
        other => panic!("JSON Schema has no type {other}"),
    }
}

/// Whether a text has the form that one of the two patterns of the schema describes.
fn matches(pattern: &str, text: &str) -> bool {
    if pattern.contains("{1,64}") {
        let is_of_name = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        return (1..=64).contains(&text.len()) && text.chars().all(is_of_name);
    }
    assert!(pattern.starts_with("^\\s*[+-]?"), "{pattern}");
    let text = text.trim_start();
    let number = text.trim_start_matches(['+', '-']);
    let is_of_number = |c: char| c.is_ascii_digit() || ".+-eE ".contains(c);
    number.starts_with(|c: char| c.is_ascii_digit() || c == '.') && !number.chars().all(is_of_number)
}

fn shipped() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders = vec![root.join("../../cases")];
    let mut found = vec![root.join("../bsmpm-scene/tests/full.toml")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "toml") && !path.ends_with("matrix.toml") {
                found.push(path);
            }
        }
    }
    found
}

#[test]
fn the_schema_accepts_every_shipped_case() {
    let validator = Validator::new();
    let cases = shipped();
    assert!(cases.len() > 20, "{}", cases.len());
    for path in cases {
        let text = std::fs::read_to_string(&path).unwrap();
        let fault = validator.fault(&text);
        assert!(fault.is_none(), "{}: {}", path.display(), fault.unwrap_or_default());
    }
}

const CASE: &str = r#"
    geometry = "plane-strain"
    analysis = { type = "quasi-static", steps = 10 }
    grid = { lower = [0.0, 0.0], upper = [4.0, 4.0], cell = "0.5 m" }
    material.soil = { model = "elastic", young = "10 MPa", poisson = 0.3 }
    body = [{ material = "soil", box = { lower = [0.0, 0.0], upper = [4.0, 2.0] }, points_per_cell = 2 }]
"#;

#[test]
fn the_schema_refuses_what_the_declarations_exclude() {
    let validator = Validator::new();
    assert_eq!(validator.fault(CASE), None);
    let changes = [
        ("steps = 10", "step = 10", ".analysis.step: additionalProperties"),
        ("steps = 10", "steps = 0", ".analysis.steps: minimum"),
        ("steps = 10", "steps = 10, dt = 0.1", ".analysis: not"),
        (
            "poisson = 0.3",
            "poisson = 0.5",
            ".material.soil.poisson: exclusiveMaximum",
        ),
        ("poisson = 0.3", "young_ = 0.3", ".material.soil"),
        ("\"elastic\"", "\"elastik\"", ".material.soil.model: anyOf"),
        ("\"0.5 m\"", "\"half a metre\"", ".grid.cell: anyOf"),
        ("material = \"soil\", ", "", ".body.0: required"),
        ("box = ", "circle = ", ".body.0.circle"),
        ("[4.0, 2.0]", "[4.0]", ".body.0.box.upper: minItems"),
    ];
    for (from, to, expected) in changes {
        assert!(CASE.contains(from), "{from}");
        let fault = validator.fault(&CASE.replacen(from, to, 1)).unwrap_or_default();
        assert!(fault.starts_with(expected), "{from} -> {to}: {fault}");
    }
}

#[test]
fn the_schema_accepts_earlier_names() {
    let earlier = CASE
        .replace("\"elastic\"", "\"mohr-coulomb\", cohesion = 1e4, friction = 20.0")
        .replace("cell = \"0.5 m\"", "cell = \"0.5 m\", order = \"linear\"");
    assert_eq!(Validator::new().fault(&earlier), None);
}

/// All parts of a schema that are objects.
fn parts(schema: &Value) -> Vec<&Value> {
    let below: Vec<&Value> = match schema {
        Value::Object(keys) => keys.values().collect(),
        Value::Array(items) => items.iter().collect(),
        _ => Vec::new(),
    };
    let mut parts: Vec<&Value> = below.into_iter().flat_map(parts).collect();
    parts.extend(schema.is_object().then_some(schema));
    parts
}

/// Taplo 0.9.3 completes no keys of a table with `allOf` or `anyOf` beside `properties`.
#[test]
fn tables_with_a_required_key_have_no_conditions_beside_their_properties() {
    let schema = Validator::new().schema;
    let tables: Vec<&Value> = parts(&schema)
        .into_iter()
        .filter(|part| part.get("required").is_some() && part["properties"].is_object())
        .collect();
    assert!(tables.len() > 20, "{}", tables.len());
    for table in tables {
        assert!(
            table.get("allOf").is_none() && table.get("anyOf").is_none(),
            "{}",
            table["description"]
        );
    }
}
