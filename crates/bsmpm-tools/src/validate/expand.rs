//! Expands an entry of the validation matrix that has a table `each`: one entry per combination of the listed values.

use toml::{Table, Value};

/// Entries of a study that may have `each`.
const REPEATED: [&str; 3] = ["run", "row", "plot"];

/// Writes out what has `each = { word = [values], .. }`: a copy for every choice of values; of words by the alphabet
/// the last's change the fastest.
///
/// In its strings "{word}" becomes the value's text; a string that is nothing but "{word}" becomes the value itself.
///
/// # Errors
/// An `each` that is no table of lists, or a word of it that the entry does not contain.
pub(super) fn expand(matrix: &mut Table) -> Result<(), String> {
    let studies = matrix
        .get_mut("study")
        .and_then(Value::as_array_mut)
        .into_iter()
        .flatten();
    for study in studies.filter_map(Value::as_table_mut) {
        for kind in REPEATED {
            if let Some(Value::Array(entries)) = study.get_mut(kind) {
                let copies: Result<Vec<_>, _> = entries.drain(..).map(copies).collect();
                *entries = copies?.concat();
            }
        }
    }
    Ok(())
}

fn copies(mut entry: Value) -> Result<Vec<Value>, String> {
    let Some(each) = entry.as_table_mut().and_then(|table| table.remove("each")) else {
        return Ok(vec![entry]);
    };
    let words = each
        .as_table()
        .ok_or_else(|| format!("each = {each}: not a table of lists"))?;
    let mut copies = vec![entry];
    for (word, values) in words {
        let values = values
            .as_array()
            .ok_or_else(|| format!("each.{word} = {values}: not a list"))?;
        let key = format!("{{{word}}}");
        if !copies[0].to_string().contains(&key) {
            return Err(format!("each.{word}: no {key} in {}", copies[0]));
        }
        let mut filled_copies = Vec::new();
        for copy in &copies {
            filled_copies.extend(values.iter().map(|value| filled(copy, &key, value)));
        }
        copies = filled_copies;
    }
    Ok(copies)
}

/// The entry with a value in place of its word.
fn filled(entry: &Value, key: &str, value: &Value) -> Value {
    match entry {
        Value::String(text) if text == key => value.clone(),
        Value::String(text) => {
            let word = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            Value::String(text.replace(key, &word))
        }
        Value::Array(list) => Value::Array(list.iter().map(|item| filled(item, key, value)).collect()),
        Value::Table(table) => Value::Table(
            table
                .iter()
                .map(|(name, item)| (name.clone(), filled(item, key, value)))
                .collect(),
        ),
        other => other.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::expand;

    fn expanded(text: &str) -> Result<toml::Table, String> {
        let mut matrix: toml::Table = text.parse().unwrap();
        expand(&mut matrix).map(|()| matrix)
    }

    #[test]
    fn every_choice_of_the_words_is_an_entry() {
        let each = "each = { method = [\"none\", \"f-bar\"], at = [0.1, 0.25] }";
        let row = format!(
            "row = [{{ {each}, quantity = \"z {{at}}, {{method}}\", at = \"{{at}}\", max = 1.0 }}, {{ max = 2.0 }}]"
        );
        let matrix = expanded(&format!("[[study]]\ntitle = \"{{method}}\"\n{row}")).unwrap();
        let study = &matrix["study"][0];
        assert_eq!(study["title"].as_str(), Some("{method}"), "only entries are filled");
        let rows = study["row"].as_array().unwrap();
        assert_eq!(rows.len(), 5);
        let known: Vec<_> = rows[..4]
            .iter()
            .map(|row| (row["quantity"].as_str().unwrap(), row["at"].as_float().unwrap()))
            .collect();
        assert_eq!(
            known,
            [
                ("z 0.1, none", 0.1),
                ("z 0.1, f-bar", 0.1),
                ("z 0.25, none", 0.25),
                ("z 0.25, f-bar", 0.25)
            ]
        );
        assert!(rows[0].get("each").is_none() && rows[4]["max"].as_float() == Some(2.0));
    }

    #[test]
    fn a_word_that_is_not_used_is_an_error() {
        let error = expanded("[[study]]\nrun = [{ each = { method = [\"none\"] }, name = \"{metod}\" }]").unwrap_err();
        assert!(error.contains("no {method} in"), "{error}");
        assert!(expanded("[[study]]\nrun = [{ each = { method = \"none\" }, name = \"{method}\" }]").is_err());
        assert!(expanded("[[study]]\nrun = [{ each = 3, name = \"a\" }]").is_err());
    }
}
