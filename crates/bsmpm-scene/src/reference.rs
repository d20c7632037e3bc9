//! The case language as a page of Markdown: every table, key, unit, range and default, and every quantity of a history.

use crate::schema::{Dimension, Group, Key, Kind, Presence, ROOT, Range, Table};
use crate::unit;
use crate::words::{Measurement, Word};
use std::fmt::Write;

/// Width of the page's lines, characters.
const WIDTH: usize = 120;

/// The reference of the case file, Markdown with lines of 120 characters at most: it follows from the schema alone.
pub fn reference() -> String {
    let mut page = Page::default();
    page.line("# Case reference\n");
    page.paragraph(
        "This page is printed by `bsmpm keys` from the schema that reads case files. A number is in SI units (angles \
         in degrees); a string carries a unit. A table that is absent means that the thing does not exist in the scene.",
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
        "Where rows are given, `{ file = \"record.csv\" }` takes them from a text file beside the case: a line for each, \
         cells between commas, semicolons, tabs or blanks, `#` before a comment. A heading may give units, as in `t [s], \
         ux [mm]`. With `along = \"x\"` (or `\"y\"`) the file has two columns, a time and a number, and the other \
         component is zero. The rows become part of the case: `run.json` keeps them, and a restart needs no file. `--set` \
         and the parameters of a sweep take rows only.",
    );
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
        self.paragraph("The first of each is that of a number without a unit.");
    }

    fn table(&mut self, table: &Table) {
        let header = if table.header.contains(['[', '{']) { quoted(table) } else { "Top level".to_owned() };
        self.line(&format!("## {header}\n"));
        self.paragraph(&format!("{}.", table.doc));
        for key in table.keys {
            self.key(key);
        }
        self.line("");
        for group in table.exclusive {
            self.paragraph(&choice(group));
        }
    }

    fn key(&mut self, key: &Key) {
        if key.presence == Presence::Retired {
            let text = format!("**`{}`**: this key has no effect any more, as {}. Delete it.", key.name, key.doc);
            return self.wrapped("- ", &text);
        }
        let mut text = format!("**`{}`**: {}.", key.name, key.doc);
        if !matches!(key.kind, Kind::Open) {
            let _ = write!(text, " {}.", capitalised(&takes(key)));
        }
        let _ = write!(text, " {}.", presence(key.presence));
        self.wrapped("- ", &text);
        if let Kind::Choice(words) | Kind::ChoiceOr(words, _) | Kind::Choices(words) = key.kind {
            if words.words().eq(Measurement::WORDS.words()) {
                return self.wrapped("  - ", "its words are [at the end of the page](#quantities-of-a-history)");
            }
            for (word, doc) in words.all() {
                self.wrapped("  - ", &format!("`\"{word}\"`: {}", doc.trim_end_matches('.')));
            }
            for word in words.later {
                self.wrapped("  - ", &format!("`\"{word}\"`: not available yet"));
            }
        }
    }

    fn histories(&mut self) {
        self.line("## Quantities of a history\n");
        self.paragraph(
            "Words of `quantity` in `[[history]]`, with the unit of the numbers. A quantity of several numbers has a \
             column for each, whose name has what is reported here appended.",
        );
        for (word, doc) in Measurement::WORDS.all() {
            let Some(measured) = Measurement::of(word) else { continue };
            self.wrapped("- ", &format!("**`{word}`** ({}): {doc}", measured.unit()));
            for (suffix, part) in measured.columns().iter().filter(|(suffix, _)| !suffix.is_empty()) {
                self.wrapped("  - ", &format!("`{suffix}`: {part}"));
            }
            for (suffix, part) in measured.columns_in(3).iter().filter(|column| !measured.columns().contains(column)) {
                self.wrapped("  - ", &format!("`{suffix}`: in 3-D, {part}"));
            }
        }
    }
}

/// A table's header, what is TOML in it as code.
fn quoted(table: &Table) -> String {
    match table.header.split_once("} ") {
        Some((code, words)) => format!("`{code}}}` {words}"),
        None => format!("`{}`", table.header),
    }
}

/// Keys of which only one may be given, in words.
fn choice(group: &Group) -> String {
    let keys: Vec<String> = group.keys.iter().map(|key| format!("`{key}`")).collect();
    let how_many = if group.required { "Exactly" } else { "At most" };
    format!("{how_many} one of {} may be given.", keys.join(", "))
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
        Kind::PairProfile(of, range, table) => {
            ranged(format!("`[x, y]`, in 3-D `[x, y, z]`, each {of}, or {}", quoted(table)), range)
        }
        Kind::Either(of, range) => ranged(format!("{of}, or `[x, y]`, in 3-D `[x, y, z]`"), range),
        Kind::List(of, range) => ranged(format!("a list, each {of}"), range),
        Kind::Rows(columns) => {
            let columns: Vec<String> = columns.iter().map(|(of, range)| column(*of, range)).collect();
            format!("a list of rows, each `[{}]`, or a [file](#rows-from-a-file)", columns.join(", "))
        }
        Kind::Course(of) => format!(
            "a list of rows, each `[t, x, y]`, in 3-D `[t, x, y, z]`, a time and {of}, or a [file](#rows-from-a-file)"
        ),
        Kind::Gradient(of) => format!("{of} per metre of depth, e.g. `\"2 {}/m\"`", of.units().next().unwrap_or("")),
        Kind::GradientVector(of) => format!(
            "`[x, y]`, in 3-D `[x, y, z]`, each {of} per metre of depth, e.g. `\"2 {}/m\"`",
            of.units().next().unwrap_or("")
        ),
        Kind::Choice(_) => "one of these words".to_owned(),
        Kind::Choices(_) => "a list of these words".to_owned(),
        Kind::ChoiceOr(_, table) => format!("one of these words, or a table, `{}`", table.header),
        Kind::Table(table) | Kind::Named(table) | Kind::Tables(table) => match key.kind {
            Kind::Named(_) => format!("tables with names, `{}`", table.header),
            Kind::Tables(_) => format!("any number of `{}`", table.header),
            _ => format!("a table, `{}`", table.header),
        },
        Kind::Measure | Kind::Count(..) | Kind::Text(_) | Kind::Name | Kind::Names | Kind::Flag | Kind::Open => {
            key.kind.to_string()
        }
    }
}

/// A column of a row, e.g. `a time >= 0`.
fn column(of: Dimension, range: &Range) -> String {
    let noun = of.to_string();
    if range.is_any() { noun } else { range.condition(&noun) }
}

fn range_of(name: &str, range: &Range) -> String {
    let why = if range.why.is_empty() { String::new() } else { format!(" ({})", range.why) };
    if range.is_any() { why } else { format!(", `{}`{why}", range.condition(name)) }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
