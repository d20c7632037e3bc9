//! Writes the reference of all case keys as Markdown.

use crate::observables::Observable;
use crate::preset::preset_table;
use crate::schema::{Dimension, Group, Key, Kind, Presence, ROOT, Range, Table};
use crate::unit;
use crate::words::{Word, Words};
use std::fmt::Write;

/// Width of the page's lines, characters.
const WIDTH: usize = 120;

/// The reference of the case file, Markdown with lines of 120 characters at most: it follows from the schema alone.
pub fn reference() -> String {
    let mut page = Page::default();
    page.line("# Keys of the case file\n");
    page.paragraph(
        "This page lists all keys of a case; `bsmpm keys` prints it. A number without a unit is in SI units, an angle in \
         degrees. A string may have another unit: `\"30 MPa\"`. Each key has its meaning and the allowed values, \
         and where they exist its symbol, its default and an example.",
    );
    page.units();
    let mut described: Vec<&Table> = Vec::new();
    for table in ROOT.all() {
        // Shapes stand in several tables.
        if !described.iter().any(|known| std::ptr::eq(*known, table)) {
            described.push(table);
            page.table(table);
        }
    }
    page.line("## Rows from a file\n");
    page.paragraph(
        "Instead of rows, `{ file = \"record.csv\" }` names a text file in the folder of the case. Each line is a row. \
         Commas, semicolons, tabs or spaces separate its values, and `#` begins a comment. A heading may give units as \
         `t [s], ux [mm]`, `t (s), ux (mm)` or `t / s, ux / mm`. A column without a unit in its heading is in SI units. \
         With `along = \"x\"` (or \"y\", in 3-D \"z\") the file has two columns: a time and a component along this axis. The \
         other components are zero. `run.json` stores the rows, so that a restart does not need the file. `--set` and \
         the parameters of a sweep accept rows, but no file.",
    );
    page.presets();
    page.shared_words();
    page.histories();
    page.text
}

/// A page as it grows.
#[derive(Default)]
struct Page {
    text: String,
}

impl Page {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// Words put into lines, the first after `bullet`, the others as far in.
    fn wrapped(&mut self, bullet: &str, text: &str) {
        let mut line = bullet.to_owned();
        let mut used = 0;
        for word in text.split_whitespace() {
            if used > 0 && line.chars().count() + 1 + word.chars().count() > WIDTH {
                self.line(&line);
                line = " ".repeat(bullet.len());
                used = 0;
            }
            if used > 0 {
                line.push(' ');
            }
            line.push_str(word);
            used += 1;
        }
        self.line(&line);
    }

    fn paragraph(&mut self, text: &str) {
        self.wrapped("", text);
        self.line("");
    }

    fn units(&mut self) {
        self.line("## Units\n");
        for dimension in unit::dimensions() {
            let units: Vec<String> = dimension.units().map(|unit| format!("`{unit}`")).collect();
            let noun = dimension.to_string();
            let noun = noun.trim_start_matches("an ").trim_start_matches("a ");
            self.wrapped("- ", &format!("{noun}: {}", units.join(", ")));
        }
        self.line("");
        self.paragraph("A number without a unit has the first unit of the line.");
    }

    fn table(&mut self, table: &Table) {
        let header = if table.header.contains(['[', '{']) {
            quoted(table)
        } else {
            "Top level".to_owned()
        };
        self.line(&format!("## {header}\n"));
        self.paragraph(table.doc);
        for key in table.keys {
            self.key(key);
        }
        self.line("");
        for group in table.exclusive.iter().filter(|group| !is_second_end(group, table)) {
            self.paragraph(&choice(group));
        }
    }

    fn key(&mut self, key: &Key) {
        if key.presence == Presence::Retired {
            let text = format!(
                "**`{}`**: This key has no effect any more, because {}. Delete it.",
                key.name, key.doc
            );
            return self.wrapped("- ", &text);
        }
        let symbol = if key.symbol.is_empty() {
            String::new()
        } else {
            format!(" ({})", key.symbol)
        };
        let mut text = format!("**`{}`**{symbol}: {}", key.name, key.doc);
        if !matches!(key.kind, Kind::Open) {
            let _ = write!(text, " {}.", capitalised(&takes(key)));
        }
        if key.presence != Presence::Optional || !says_presence(key.doc) {
            let _ = write!(text, " {}{}.", presence(key.presence), unless_preset(key.has_preset));
        }
        if let Some(value) = key.example_value() {
            let _ = write!(text, " Example: `{} = {value}`.", key.name);
        }
        self.wrapped("- ", &text);
        if let Kind::Choice(words) | Kind::ChoiceOr(words, _) | Kind::Choices(words) = key.kind {
            self.words_of(words);
        }
    }

    /// The words of a key, or where they are.
    fn words_of(&mut self, words: Words) {
        if words.words().eq(Observable::WORDS.words()) {
            return self.wrapped(
                "  - ",
                "The words are [at the end of the page](#quantities-of-a-history).",
            );
        }
        if is_shared(words) {
            return self.wrapped("  - ", "The words are [those of several keys](#words-of-several-keys).");
        }
        self.words("  - ", words);
    }

    fn words(&mut self, bullet: &str, words: Words) {
        for (word, doc) in words.all() {
            self.wrapped(bullet, &format!("`\"{word}\"`: {}", doc));
        }
        for word in words.later {
            self.wrapped(bullet, &format!("`\"{word}\"`: Not available yet."));
        }
    }

    fn presets(&mut self) {
        self.line("## Presets of `accuracy`\n");
        let [introduction, table] = preset_table();
        self.paragraph(&introduction);
        self.line(&format!("{table}\n"));
    }

    /// The words that several keys have, once.
    fn shared_words(&mut self) {
        self.line("## Words of several keys\n");
        let mut printed: Vec<Words> = Vec::new();
        for (_, words) in all_words() {
            if !is_shared(words) || printed.iter().any(|other| are_same(*other, words)) {
                continue;
            }
            printed.push(words);
            let mut keys: Vec<String> = all_words()
                .filter(|(_, of)| are_same(*of, words))
                .map(|(key, _)| key)
                .collect();
            keys.sort();
            keys.dedup();
            self.paragraph(&format!("Words of {}:", keys.join(", ")));
            self.words("- ", words);
            self.line("");
        }
    }

    fn histories(&mut self) {
        self.line("## Quantities of a history\n");
        self.paragraph(
            "Words of `quantity` in `[[history]]`, with their unit in plane strain, where extensive quantities are per metre \
             of thickness. A quantity with several values has a column for each, whose name ends as listed here. The \
             examples are items of the list `history`; below a heading `[[history]]`, each key has its own line.",
        );
        for (word, doc) in Observable::WORDS.all() {
            let Some(measured) = Observable::of(word) else {
                continue;
            };
            let example = measured.example();
            let text = format!("**`{word}`** ({}): {doc} Example: `{example}`.", measured.unit());
            self.wrapped("- ", &text);
            for (suffix, part) in measured.columns_in(2).iter().filter(|(suffix, _)| !suffix.is_empty()) {
                self.wrapped("  - ", &format!("`{suffix}`: {part}"));
            }
            for (suffix, part) in measured
                .columns_in(3)
                .iter()
                .filter(|column| !measured.columns_in(2).contains(column))
            {
                self.wrapped("  - ", &format!("`{suffix}`: in 3-D, {part}"));
            }
        }
    }
}

/// Every key that takes words, quoted, and its words.
fn all_words() -> impl Iterator<Item = (String, Words)> {
    let keys = ROOT.all().into_iter().flat_map(|table| table.keys);
    keys.filter(|key| key.presence != Presence::Retired)
        .filter_map(|key| match key.kind {
            Kind::Choice(words) | Kind::ChoiceOr(words, _) | Kind::Choices(words) => {
                Some((format!("`{}`", key.name), words))
            }
            _ => None,
        })
}

/// Whether two keys have the same words.
fn are_same(one: Words, other: Words) -> bool {
    one.all().eq(other.all())
}

/// Whether several keys have these words.
fn is_shared(words: Words) -> bool {
    all_words().filter(|(_, other)| are_same(words, *other)).count() > 1
}

/// A table's header, what is TOML in it as code.
fn quoted(table: &Table) -> String {
    match table.header.split_once("} ") {
        Some((code, words)) => format!("`{code}}}` {words}"),
        None => format!("`{}`", table.header),
    }
}

/// Keys of which only one may be given, in words; the ends of a segment are given together.
fn choice(group: &Group) -> String {
    let keys: Vec<String> = group.keys.iter().map(|key| format!("`{key}`")).collect();
    let keys = keys.join(", ").replace("`from`", "`from` with `to`");
    let how_many = if group.required { "Give one" } else { "Give at most one" };
    format!("{how_many} of {keys}{}.", unless_preset(group.has_preset))
}

/// What is appended to a requirement where a preset meets it.
fn unless_preset(has_preset: bool) -> &'static str {
    if has_preset {
        ", unless `accuracy` chooses it"
    } else {
        ""
    }
}

/// Whether a group is that of the second end of a segment, whose first end has the same group.
fn is_second_end(group: &Group, table: &Table) -> bool {
    let mut groups = table.exclusive.iter();
    group.keys.contains(&"to")
        && groups.any(|other| other.keys.contains(&"from") && other.keys.last() == group.keys.last())
}

/// Whether a text says when its key is required, or what happens without the key.
fn says_presence(text: &str) -> bool {
    ["Required", "Default:", "Without this"]
        .iter()
        .any(|phrase| text.contains(phrase))
}

fn presence(presence: Presence) -> String {
    match presence {
        Presence::Required => "Required".to_owned(),
        Presence::Optional => "Optional".to_owned(),
        Presence::Default(value) => format!("Default: `{value}`"),
        Presence::Later => "Not available yet".to_owned(),
        Presence::Retired => "Without effect".to_owned(),
    }
}

/// What a key takes, with its range.
fn takes(key: &Key) -> String {
    let ranged = |what: String, range: &Range| format!("{what}{}", range_of(key.name, range));
    match &key.kind {
        Kind::Quantity(of, range) => ranged(of.to_string(), range),
        Kind::Profile(of, range, table) => ranged(format!("{of}, or {}", quoted(table)), range),
        Kind::Pair(of, range) => ranged(format!("`[x, y]`, each {of}"), range),
        Kind::Vector(of, range) => ranged(format!("`[x, y]`, in 3-D `[x, y, z]`, each {of}"), range),
        Kind::PairProfile(of, range, table) => ranged(
            format!("`[x, y]`, in 3-D `[x, y, z]`, each {of}, or {}", quoted(table)),
            range,
        ),
        Kind::Either(of, range) => ranged(format!("{of}, or `[x, y]`, in 3-D `[x, y, z]`"), range),
        Kind::List(of, range) => ranged(format!("a list, each {of}"), range),
        Kind::Rows(columns) => {
            let columns: Vec<String> = columns.iter().map(|(of, range)| column(*of, range)).collect();
            format!(
                "a list of rows, each `[{}]`, or a [file](#rows-from-a-file)",
                columns.join(", ")
            )
        }
        Kind::Course(of) => format!(
            "a list of rows, each `[t, x, y]`, in 3-D `[t, x, y, z]`, a time and {of}, or a [file](#rows-from-a-file)"
        ),
        Kind::Gradient(of) => format!(
            "{of} per metre of depth, e.g. `\"2 {}/m\"`",
            of.units().next().unwrap_or("")
        ),
        Kind::GradientVector(of) => format!(
            "`[x, y]`, in 3-D `[x, y, z]`, each {of} per metre of depth, e.g. `\"2 {}/m\"`",
            of.units().next().unwrap_or("")
        ),
        Kind::Choice(_) => "one of these words".to_owned(),
        Kind::Choices(_) => "a list of these words".to_owned(),
        Kind::ChoiceOr(_, table) => format!("one of these words, or a table, `{}`", header_of(key, table)),
        Kind::Table(table) | Kind::Named(table) | Kind::Tables(table) => match key.kind {
            Kind::Named(_) => format!("tables with names, `{}`", table.header),
            Kind::Tables(_) => format!("any number of `{}`", table.header),
            _ => format!("a table, `{}`", header_of(key, table)),
        },
        Kind::Measure | Kind::Count(..) | Kind::Text(_) | Kind::Name | Kind::Names | Kind::Flag | Kind::Open => {
            key.kind.to_string()
        }
    }
}

/// The header of a table with the key in it: several keys may have tables of one shape.
fn header_of(key: &Key, table: &Table) -> String {
    match table.header.split_once(" = {") {
        Some((_, keys)) => format!("{} = {{{keys}", key.name),
        None => table.header.to_owned(),
    }
}

/// A column of a row, e.g. `a time >= 0`.
fn column(of: Dimension, range: &Range) -> String {
    let noun = of.to_string();
    if range.is_any() { noun } else { range.condition(&noun) }
}

fn range_of(name: &str, range: &Range) -> String {
    let why = if range.why.is_empty() {
        String::new()
    } else {
        format!(" ({})", range.why)
    };
    if range.is_any() {
        why
    } else {
        format!(", `{}`{why}", range.condition(name))
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Report;
    use crate::source::Source;
    use crate::{Case, document, record};

    /// Geometries and analyses in which a key may have its meaning.
    const SETTINGS: [[&str; 2]; 4] = [
        ["plane-strain", "dynamic"],
        ["plane-strain", "quasi-static"],
        ["3d", "dynamic"],
        ["3d", "quasi-static"],
    ];

    /// Errors about `key` in a file with a table that has no other key.
    fn errors_of(key: &'static Key, value: &str, [geometry, analysis]: [&str; 2]) -> Vec<String> {
        let table: &'static Table = Box::leak(Box::new(Table {
            header: "[example]",
            doc: "An example.",
            keys: std::slice::from_ref(key),
            exclusive: &[],
        }));
        let text = format!("{} = {value}\n", key.name);
        let setting = format!("geometry = \"{geometry}\"\nanalysis = {{ type = \"{analysis}\" }}\n");
        let text = if ["geometry", "analysis"].contains(&key.name) {
            text
        } else {
            setting + &text
        };
        let source = Source::new("example.toml", &text);
        let mut report = Report::new(&source, &[]);
        let parsed = document::parse(&source, &mut report);
        record::read(table, &parsed, &mut report);
        let errors = report.into_errors();
        let of_key = errors
            .into_iter()
            .filter(|error| error.key.starts_with(key.name) || error.key.is_empty());
        of_key.map(|error| error.message).collect()
    }

    #[test]
    fn every_key_has_an_example_that_it_accepts() {
        for table in ROOT.all() {
            for key in table.keys.iter().filter(|key| key.presence != Presence::Retired) {
                let place = format!("{} in {}", key.name, table.header);
                let value = key.example_value().unwrap_or_else(|| panic!("{place}: no example"));
                // A file is read before the table.
                if value.contains("file = ") {
                    continue;
                }
                let tried = SETTINGS.map(|setting| errors_of(key, &value, setting));
                assert!(tried.iter().any(Vec::is_empty), "{place} = {value}: {tried:?}");
            }
        }
    }

    /// Cases with a footing and a rigid body; with frictional contact; with pore-water flow; with an outflow boundary.
    fn cases() -> [String; 4] {
        let outflow =
            include_str!("../tests/bad_cases/static.toml").replace("[boundary]", "[boundary]\nright = \"outflow\"");
        [
            include_str!("../tests/full.toml").to_owned(),
            include_str!("../tests/bad_cases/rubbing.toml").to_owned(),
            include_str!("../tests/bad_cases/seeping.toml").to_owned(),
            outflow,
        ]
    }

    #[test]
    fn every_history_quantity_has_an_example_that_a_case_accepts() {
        for (word, _) in Observable::WORDS.all() {
            let keys = Observable::of(word)
                .map_or(&[][..], |observable| observable.definition().example)
                .join("\n");
            let history = format!("\n[[history]]\nname = \"example\"\nquantity = \"{word}\"\n{keys}\n");
            let tried = cases().map(|case| Case::from_text("case.toml", &format!("{case}{history}"), &[]));
            assert!(tried.iter().any(Result::is_ok), "{history}: {tried:#?}");
        }
    }

    #[test]
    fn every_text_is_a_sentence() {
        let is_sentence = |text: &str| text.ends_with('.') && !text.starts_with(|c: char| c.is_lowercase());
        for table in ROOT.all() {
            assert!(is_sentence(table.doc), "{}: {}", table.header, table.doc);
            for key in table.keys.iter().filter(|key| key.presence != Presence::Retired) {
                assert!(is_sentence(key.doc), "{} in {}: {}", key.name, table.header, key.doc);
            }
        }
        for (_, words) in all_words() {
            for (word, doc) in words.all() {
                assert!(is_sentence(doc), "{word}: {doc}");
            }
        }
    }
}
