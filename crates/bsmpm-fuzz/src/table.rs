//! Fuzzes tables of numbers, and piecewise linear motions.

use bsmpm::interactions::strip::Path;
use bsmpm::tensor::Vector;
use bsmpm_io::table::{Columns, parse};

/// The text of a table.
pub fn target(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match parse(text) {
        Ok(columns) => {
            check(&columns);
            motion(&columns);
        }
        Err(reason) => assert!(!reason.is_empty()),
    }
}

/// Columns of one length, of finite numbers, that are found by their names and read back to the bit.
fn check(columns: &Columns) {
    let rows = columns.values[0].len();
    assert_eq!(columns.headings.len(), columns.values.len());
    assert!(
        columns
            .values
            .iter()
            .all(|column| column.len() == rows && column.iter().all(|value| value.is_finite()))
    );
    for heading in &columns.headings {
        let first = columns
            .headings
            .iter()
            .position(|other| other.name == heading.name)
            .expect("there");
        assert_eq!(columns.get(&heading.name), Some(&columns.values[first][..]));
        assert_eq!(columns.unit(&heading.name), Some(&*columns.headings[first].unit));
    }
    let names = line(columns.headings.iter().map(|heading| heading.name.clone()).collect());
    if names.starts_with('#') {
        return; // a name that was indented: at the beginning of a line it is a comment
    }
    let units = line(columns.headings.iter().map(|heading| heading.unit.clone()).collect());
    let mut text = format!("{names}#{units}");
    for row in 0..rows {
        let cells = columns.values.iter().map(|column| format!("{:?}", column[row]));
        text += &line(cells.collect());
    }
    let again = parse(&text).expect("what was read once");
    assert_eq!(&again, columns);
    assert_eq!(bits(&again), bits(columns));
}

fn line(cells: Vec<String>) -> String {
    cells.join(",") + "\n"
}

fn bits(columns: &Columns) -> Vec<u64> {
    let values = columns.values.iter().flatten();
    values.map(|value| value.to_bits()).collect()
}

/// A motion lies between the rows around it and meets each.
fn motion(columns: &Columns) {
    let [times, x, .., y] = &columns.values[..] else { return };
    let rows: Vec<_> = times
        .iter()
        .zip(x.iter().zip(y))
        .map(|(t, (x, y))| (*t, Vector::from([*x, *y])))
        .collect();
    let begins_after_0 = rows.first().is_some_and(|first| first.0 > 0.0);
    let increases = rows.windows(2).all(|pair| pair[0].0 < pair[1].0);
    if !begins_after_0 || !increases || rows.iter().any(|(_, moved)| moved.amax() > 1e300) {
        return; // those of a case begin after 0 and increase
    }
    let path = Path { rows };
    let mut before = (0.0, Vector::<2>::zeros());
    assert_eq!(path.at(0.0), before.1);
    for row in &path.rows {
        let lower = before.1.inf(&row.1);
        let upper = before.1.sup(&row.1);
        let slack = (upper - lower) * (4.0 * f64::EPSILON);
        for part in [0.0, 0.25, 0.5, 1.0] {
            let t = before.0 + (row.0 - before.0) * part;
            let found = path.at(t.min(row.0));
            let inside = (0..2).all(|k| (lower[k] - slack[k]..=upper[k] + slack[k]).contains(&found[k]));
            assert!(inside, "{found:?} at {t} between {before:?} and {row:?}");
        }
        before = *row;
    }
    assert_eq!(path.at(before.0.next_up()), before.1);
}
