//! Tests that wrong keys and values in a case never cause a panic.
//!
//! With `scripts/test --full` each value is put in each place. Otherwise each value is put in one place of each key and
//! form of value, and the overrides of a key take turns.

mod bases;
mod slips;
mod written;

use bases::{FULL, all as bases};
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm_scene::schema::{Kind, Presence, ROOT, Table};
use bsmpm_scene::{Case, Error, Geometry, Place, seed};
use std::collections::HashSet;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use written::{STRESS, Written};

/// Values that a key may be given by mistake.
const VALUES: [&str; 22] = [
    "nan",
    "+nan",
    "inf",
    "-inf",
    "-0.0",
    "0",
    "-1",
    "0.5",
    "1e308",
    "-1e308",
    "5e-324",
    "9223372036854775807",
    "-9223372036854775808",
    "99999999999999999999999",
    "true",
    "\"\"",
    "\"abc\"",
    STRESS,
    "[]",
    "[1, 2, 3]",
    "{}",
    "1979-05-27",
];

/// Suffixes of the path of an override.
const SUFFIXES: [&str; 5] = ["", ".0", ".x", ".5.y", ".."];

/// Returns whether all combinations are tested.
fn is_full() -> bool {
    std::env::var_os("BSMPM_TESTS").is_some_and(|tests| tests == "full")
}

/// The case, if it is one: then it can be counted and its points made. Errors must have a place, but for tables that
/// are missing altogether.
fn read(text: &str) -> Result<Case, Vec<Error>> {
    let case = Case::from_text("case.toml", text, &[]).inspect_err(|errors| {
        assert!(!errors.is_empty());
        for error in errors {
            assert!(!error.message.is_empty() && !format!("{error:#}").is_empty());
            let is_whole = error.place == Place::File && (error.key.is_empty() || ROOT.key(&error.key).is_some());
            assert!(is_whole || matches!(error.place, Place::Line { .. }), "{error}");
        }
    })?;
    let counted: u64 = case.points_by_column().iter().sum();
    assert!(case.estimate(1).points == case.points() && case.points() == counted && counted > 0);
    match case.geometry {
        Geometry::Solid => seeded::<Solid, 3>(&case),
        _ => seeded::<PlaneStrain, 2>(&case),
    }
    Ok(case)
}

fn seeded<K: Kinematics<D>, const D: usize>(case: &Case) {
    for point in seed::<K, D>(case, 0..case.grid.axes[0].cells()).take(20) {
        assert!(point.volume > 0.0 && point.mass >= 0.0 && (point.x.norm() + point.v.norm() + point.mass).is_finite());
    }
}

fn line(text: &str, at: usize) -> usize {
    1 + text[..at].matches('\n').count()
}

/// An error about this key or an item of it, in this line.
#[track_caller]
fn refuses(text: &str, path: &str, says: &str, line: Option<usize>) {
    let errors = read(text).err().unwrap_or_default();
    let fits = |error: &Error| {
        let placed = line.is_none_or(|line| matches!(error.place, Place::Line { line: found, .. } if found == line));
        let about = error.key == path || error.key.strip_prefix(path).is_some_and(|item| item.starts_with('.'));
        placed && about && error.message.contains(says)
    };
    let reported: Vec<String> = errors.iter().map(ToString::to_string).collect();
    assert!(
        errors.iter().any(fits),
        "{path}, line {line:?}: ..{says}.. is not among {reported:#?}"
    );
}

/// The first letter of a value that is a string, list or table; 0 for other values.
fn form(value: &str) -> char {
    value
        .chars()
        .next()
        .filter(|first| "\"[{".contains(*first))
        .unwrap_or('0')
}

/// The text without an entry, and without the comma that it leaves in an inline table.
fn without(text: &str, written: &Written) -> String {
    let start = written.name.as_ref().unwrap().start;
    let end = written.value.end;
    let before = &text[..start];
    let after = &text[end..];
    match (after.strip_prefix(','), before.trim_end().strip_suffix(',')) {
        (Some(after), _) => format!("{before}{after}"),
        (None, Some(before)) => format!("{before}{after}"),
        (None, None) => format!("{before}{after}"),
    }
}

#[test]
fn the_bases_hold_every_key_of_the_schema() {
    let mut held = HashSet::new();
    for base in bases() {
        read(&base).unwrap_or_else(|errors| panic!("{errors:#?}"));
        held.extend(written::all(&base).iter().map(|written| written.of));
    }
    for table in ROOT.all() {
        for key in table.keys.iter().filter(|key| key.presence != Presence::Later) {
            assert!(
                held.contains(&(table.header, key.name)),
                "no base has {} of {}",
                key.name,
                table.header
            );
        }
    }
}

#[test]
fn every_key_renamed_is_unknown_and_every_key_removed_is_missed_if_it_must_be_there() {
    let mut known = HashSet::new();
    for base in bases() {
        for written in written::all(&base) {
            let Some(name) = &written.name else { continue };
            if known.insert(written.of) || is_full() {
                let renamed = format!("{}qqq{}", &base[..name.end], &base[name.end..]);
                refuses(
                    &renamed,
                    &format!("{}qqq", written.path),
                    "is not a known key of",
                    Some(line(&base, name.start)),
                );
            }
            if !written.is_entry {
                continue;
            }
            let removed = without(&base, &written);
            let fills = ["\naccuracy = ", "purpose = "].iter().any(|key| base.contains(key));
            let is_filled = fills && ["points_per_cell", "degree", "method"].contains(&written.of.1);
            match written.presence {
                Presence::Required if !is_filled => refuses(&removed, &written.path, "missing", None),
                Presence::Required => {
                    _ = read(&removed).unwrap_or_else(|errors| panic!("{}: {errors:?}", written.path))
                }
                _ => _ = read(&removed),
            }
        }
    }
}

#[test]
fn i02_i07_every_value_that_the_schema_refuses_is_refused_at_its_place() {
    let bases = bases();
    let mut seen = HashSet::new();
    let mut entries = Vec::new();
    for base in &bases {
        for written in written::all(base).into_iter().filter(|written| written.is_entry) {
            let own = &base[written.value.clone()];
            // What an earlier base has word for word is not changed once more.
            let place = if is_full() {
                format!("{} {own}", written.path)
            } else {
                format!("{:?} {} {}", written.of, written.name.is_some(), form(own))
            };
            if seen.insert((base.contains("\"3d\""), place)) {
                entries.push((base, written));
            }
        }
    }
    // On all cores: it is the longest of these tests.
    let next = AtomicUsize::new(0);
    let accepted = AtomicUsize::new(0);
    let refused = AtomicUsize::new(0);
    let change = || {
        while let Some((base, written)) = entries.get(next.fetch_add(1, Relaxed)) {
            let span = &written.value;
            let own = &base[span.clone()];
            let negated = own
                .strip_prefix('"')
                .map_or(format!("-{own}"), |quoted| format!("\"-{quoted}"));
            for put in VALUES.iter().copied().chain([negated.as_str()]) {
                let text = format!("{}{put}{}", &base[..span.start], &base[span.end..]);
                if VALUES.contains(&put) && written.fits.refuses(put) {
                    refuses(&text, &written.path, "", Some(line(base, span.start)));
                    refused.fetch_add(1, Relaxed);
                } else {
                    accepted.fetch_add(usize::from(read(&text).is_ok()), Relaxed);
                }
            }
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(change))));
    let [accepted, refused] = [accepted, refused].map(AtomicUsize::into_inner);
    let least = if is_full() { 20_000 } else { 12_000 };
    assert!(
        refused > least && accepted > 300,
        "{accepted} accepted, {refused} refused"
    );
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
    paths(ROOT, "", &mut found);
    assert!(found.len() > 80, "{found:?}");
    for (number, path) in found.iter().enumerate() {
        let values = VALUES.iter().chain(&["5 mm", "free", "a.b=c", "", "[", "\"", "'x"]);
        for (turn, value) in values.enumerate() {
            for (place, suffix) in SUFFIXES.iter().enumerate() {
                if is_full() || (number + turn) % SUFFIXES.len() == place {
                    _ = Case::from_text("case.toml", FULL, &[format!("{path}{suffix}={value}")]);
                }
            }
        }
    }
}

#[test]
fn the_schema_is_sound() {
    for table in ROOT.all() {
        for key in table.keys {
            assert!(!key.doc.is_empty() && table.key(key.name).is_some_and(|first| std::ptr::eq(first, key)));
            assert_eq!(
                key.presence == Presence::Later,
                matches!(key.kind, Kind::Open),
                "{}",
                key.name
            );
        }
        for group in table.exclusive {
            assert!(
                group.keys.iter().all(|key| table.key(key).is_some()),
                "{:?}",
                group.keys
            );
        }
    }
}
