//! Writes a setting of a sweep as a case file, with the original comments.

use bsmpm_scene::schema::{Kind, ROOT, Table as Schema};
use toml_edit::{DocumentMut, Item, Table, TableLike, Value};

/// All items of a list, or all names.
const EACH: &str = "*";

/// The text of a case with overrides `KEY=VALUE` in it.
///
/// # Errors
/// Says in words what could not be set, or that the text is no TOML.
pub(super) fn text(original: &str, set: &[String]) -> Result<String, String> {
    let mut document: DocumentMut = original
        .parse()
        .map_err(|error: toml_edit::TomlError| error.to_string())?;
    for set in set {
        let (key, value) = set.split_once('=').ok_or_else(|| format!("{set} has no `=`"))?;
        let parts: Vec<&str> = key.split('.').map(str::trim).collect();
        let value = parsed(value.trim());
        in_table(document.as_table_mut(), Some(ROOT), &parts, &value).map_err(|why| format!("{set}: {why}"))?;
    }
    Ok(document.to_string())
}

/// As `--set` reads it: TOML, or else a string.
fn parsed(text: &str) -> Value {
    text.parse().unwrap_or_else(|_| Value::from(text))
}

fn in_table(
    table: &mut dyn TableLike,
    schema: Option<&'static Schema>,
    parts: &[&str],
    value: &Value,
) -> Result<(), String> {
    let (name, rest) = parts.split_first().ok_or("a key is missing")?;
    let name = schema.map_or(*name, |schema| name_in(table, schema, name));
    if let Some(schema) = schema {
        schema.rivals(name).for_each(|rival| _ = table.remove(rival));
    }
    let kind = schema.and_then(|schema| schema.key(name)).map(|key| &key.kind);
    if rest.is_empty() {
        match table.get_mut(name).and_then(Item::as_value_mut) {
            Some(old) => replace(old, value),
            None => _ = table.insert(name, Item::Value(value.clone())),
        }
        return Ok(());
    }
    if table.get(name).is_none() {
        let mut made = Table::new();
        // Only what is in it shows that it is there.
        made.set_implicit(true);
        table.insert(name, Item::Table(made));
    }
    let item = table.get_mut(name).ok_or("a table is missing")?;
    match (kind, item.as_table_like_mut()) {
        (Some(Kind::Named(below)), Some(named)) => in_named(named, below, rest, value),
        _ => in_item(item, kind.and_then(Kind::table), rest, value),
    }
}

/// The name that a table has of a key, which may be an earlier one; that of now if it does not have the key.
fn name_in<'a>(table: &dyn TableLike, schema: &'static Schema, name: &'a str) -> &'a str {
    let Some(key) = schema.key(name).or_else(|| schema.renamed(name)) else {
        return name;
    };
    let earlier = key.earlier.iter().find(|earlier| table.contains_key(earlier));
    earlier.copied().unwrap_or(key.name)
}

/// In a table whose keys are names of the author's choice.
fn in_named(named: &mut dyn TableLike, schema: &'static Schema, parts: &[&str], value: &Value) -> Result<(), String> {
    let (name, rest) = parts.split_first().ok_or("a name is missing")?;
    if *name == EACH {
        return named
            .iter_mut()
            .try_for_each(|(_, item)| in_item(item, Some(schema), rest, value));
    }
    match named.get_mut(name) {
        Some(item) if !rest.is_empty() => in_item(item, Some(schema), rest, value),
        _ => in_table(named, None, parts, value),
    }
}

fn in_item(item: &mut Item, schema: Option<&'static Schema>, parts: &[&str], value: &Value) -> Result<(), String> {
    let (part, rest) = parts.split_first().ok_or("an index is missing")?;
    if let Some(tables) = item.as_array_of_tables_mut() {
        let index: Option<usize> = part.parse().ok();
        for (_, table) in tables
            .iter_mut()
            .enumerate()
            .filter(|(place, _)| *part == EACH || index == Some(*place))
        {
            in_table(table, schema, rest, value)?;
        }
        return if *part == EACH || index.is_some_and(|index| index < tables.len()) {
            Ok(())
        } else {
            Err(format!("the list has no item `{part}`"))
        };
    }
    if let Some(list) = item.as_array_mut() {
        return in_list(list, schema, parts, value);
    }
    let table = item
        .as_table_like_mut()
        .ok_or_else(|| format!("`{part}` is not in a table"))?;
    in_table(table, schema, parts, value)
}

fn in_list(
    list: &mut toml_edit::Array,
    schema: Option<&'static Schema>,
    parts: &[&str],
    value: &Value,
) -> Result<(), String> {
    let (part, rest) = parts.split_first().ok_or("an index is missing")?;
    let index: Option<usize> = part.parse().ok();
    let mut found = false;
    for (_, item) in list
        .iter_mut()
        .enumerate()
        .filter(|(place, _)| *part == EACH || index == Some(*place))
    {
        found = true;
        match (rest.is_empty(), item) {
            (true, item) => replace(item, value),
            (false, Value::InlineTable(table)) => in_table(table, schema, rest, value)?,
            (false, Value::Array(inner)) => in_list(inner, schema, rest, value)?,
            _ => return Err(format!("`{part}` is not a table")),
        }
    }
    if found {
        Ok(())
    } else {
        Err(format!("the list has no item `{part}`"))
    }
}

/// The value in the place of another: spaces and comments about it stay.
fn replace(old: &mut Value, value: &Value) {
    let decor = old.decor().clone();
    *old = value.clone();
    *old.decor_mut() = decor;
}

#[cfg(test)]
mod tests {
    use bsmpm_scene::{Case, differences};

    use super::super::study::tests::COLUMN;
    use super::*;

    #[test]
    fn comments_stay_and_the_case_is_that_of_the_overrides() {
        let set = [
            "grid.cell=5 mm",
            "analysis.steps=500",
            "body.*.points_per_cell=4",
            "material.rods.cohesion=\"1 kPa\"",
            "material.*.poisson=0.2",
            "grid.upper.1=0.11",
            "stabilisation.method=none",
            "solver.tolerance=1e-6",
            "check.0.max=0.5",
            "body.0.box.upper.0=0.15",
            "history.*.scale=1.0",
        ];
        let set = set.map(str::to_owned);
        let written = text(COLUMN, &set).unwrap();
        let case = Case::from_text("case.toml", COLUMN, &set).unwrap();
        assert_eq!(differences(&case.text, &written).unwrap(), [], "{written}");
        assert!(
            written.contains("# A column of aluminium rods") && written.contains("# the paper uses \"modified-f-bar\"")
        );
        assert!(
            written.contains("cell   = \"5 mm\"\ndegree") && !written.contains("dt "),
            "{written}"
        );
    }

    #[test]
    fn earlier_names_are_set_where_they_stand() {
        let earlier = COLUMN.replace("friction_angle = 21.9", "friction = 21.9");
        assert_ne!(earlier, COLUMN);
        for text_of_case in [COLUMN, &earlier] {
            for set in ["material.rods.friction=25", "material.rods.friction_angle=25"] {
                let written = text(text_of_case, &[set.to_owned()]).unwrap();
                assert!(Case::from_text("case.toml", &written, &[]).is_ok(), "{set}: {written}");
                assert!(
                    written.contains("= 25") && !written.contains("21.9"),
                    "{set}: {written}"
                );
            }
        }
    }

    #[test]
    fn what_is_not_there_cannot_be_set() {
        for set in ["body.7.points_per_cell=3", "title.x=3", "grid.upper.x=1", "grid"] {
            assert!(text(COLUMN, &[set.to_owned()]).is_err(), "{set}");
        }
        assert!(text("= no TOML", &[]).is_err());
    }
}
