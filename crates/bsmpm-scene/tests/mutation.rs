//! Every key of a full case removed, renamed, retyped and set to extreme values: a case or errors, never a panic.

use bsmpm_scene::Case;
use bsmpm_scene::schema::{Kind, Presence, ROOT, Table};

const FULL: &str = include_str!("full.toml");

/// Values that a key may be given by mistake.
const VALUES: [&str; 18] = [
    "nan",
    "+inf",
    "-inf",
    "-0.0",
    "0",
    "-1",
    "1e308",
    "-1e308",
    "5e-324",
    "9223372036854775807",
    "99999999999999999999999",
    "true",
    "\"\"",
    "\"1 kPa\"",
    "[]",
    "[1e308, -1e308]",
    "{}",
    "1979-05-27",
];

fn read(text: &str) -> Result<Case, usize> {
    Case::from_text("case.toml", text, &[]).map_err(|errors| {
        assert!(!errors.is_empty());
        assert!(errors.iter().all(|error| !error.to_string().is_empty() && !format!("{error:#}").is_empty()));
        errors.len()
    })
}

/// Start of the key's name and its value's range for every `key = value` line of the text.
fn keys(text: &str) -> Vec<(usize, std::ops::Range<usize>)> {
    let mut start = 0;
    let mut found = Vec::new();
    for line in text.split_inclusive('\n') {
        if let Some(equals) = line.find('=').filter(|_| !line.starts_with(['#', '['])) {
            found.push((start, start + equals + 1..start + line.trim_end().len()));
        }
        start += line.len();
    }
    found
}

#[test]
fn every_key_mutated_gives_a_case_or_errors() {
    assert!(read(FULL).is_ok());
    let (mut accepted, mut refused) = (0, 0);
    let mut count = |text: String| match read(&text) {
        Ok(case) => {
            accepted += 1;
            assert!(case.estimate().points == case.points() && case.points() > 0);
        }
        Err(_) => refused += 1,
    };
    for (start, value) in keys(FULL) {
        count(format!("{}{}", &FULL[..start], &FULL[value.end..]));
        count(format!("{}x{}", &FULL[..start], &FULL[start..]));
        for put in VALUES {
            count(format!("{} {put}{}", &FULL[..value.start], &FULL[value.end..]));
        }
    }
    assert!(refused > 800 && accepted > 20, "{accepted} accepted, {refused} refused");
}

#[test]
fn not_finite_numbers_are_refused_everywhere() {
    // The first key is the title, to which a text is as good as any other.
    for (_, value) in keys(FULL).into_iter().skip(1) {
        for put in ["nan", "inf", "-inf", "[nan, 0.0]", "[0.0, inf]", "\"nan m\""] {
            assert!(
                read(&format!("{} {put}{}", &FULL[..value.start], &FULL[value.end..])).is_err(),
                "{put} at {value:?}"
            );
        }
    }
}

#[test]
fn every_table_and_every_cut_of_the_text() {
    for header in FULL.lines().filter(|line| line.starts_with('[')) {
        _ = read(&FULL.replacen(header, "", 1));
        _ = read(&FULL.replacen(header, "[x]", 1));
        _ = read(&FULL.replacen(header, &format!("[{header}]"), 1));
        _ = read(&format!("{FULL}\n{header}\n"));
    }
    for end in (0..FULL.len()).step_by(3) {
        _ = read(&FULL[..end]);
        _ = read(&format!("{}{}", &FULL[..end], &FULL[(end + 7).min(FULL.len())..]));
    }
}

#[test]
fn overrides_of_every_key_of_the_schema() {
    fn paths(table: &'static Table, path: &str, found: &mut Vec<String>) {
        for key in table.keys {
            let path = format!("{path}{}", key.name);
            match &key.kind {
                Kind::Table(below) => paths(below, &format!("{path}."), found),
                Kind::Named(below) => paths(below, &format!("{path}.sand."), found),
                Kind::Tables(below) => paths(below, &format!("{path}.0."), found),
                _ => {}
            }
            found.push(path);
        }
    }
    let mut found = Vec::new();
    paths(&ROOT, "", &mut found);
    assert!(found.len() > 80, "{found:?}");
    for path in &found {
        for value in VALUES.iter().chain(&["5 mm", "free", "a.b=c", "", "[", "\"", "'x"]) {
            for suffix in ["", ".0", ".x", ".5.y", ".."] {
                _ = Case::from_text("case.toml", FULL, &[format!("{path}{suffix}={value}")]);
            }
        }
    }
}

#[test]
fn the_schema_is_sound() {
    for table in ROOT.all() {
        for key in table.keys {
            assert!(!key.doc.is_empty() && table.key(key.name).is_some_and(|first| std::ptr::eq(first, key)));
            assert_eq!(key.presence == Presence::Later, matches!(key.kind, Kind::Open), "{}", key.name);
        }
        for group in table.exclusive {
            assert!(group.keys.iter().all(|key| table.key(key).is_some()), "{:?}", group.keys);
        }
    }
}
