//! Reads an output directory.

use bsmpm_io::frame::{FieldValues, Frame};
use bsmpm_io::manifest::Manifest;
use bsmpm_io::table::Columns;
use bsmpm_io::{frames, table, vtu};
use std::path::Path;

pub fn manifest(directory: &Path) -> Manifest {
    Manifest::read(directory).unwrap()
}

pub fn history(directory: &Path) -> Columns {
    table::read(&directory.join("history.csv")).unwrap()
}

pub fn steps(directory: &Path) -> Columns {
    table::read(&directory.join("steps.csv")).unwrap()
}

/// All frames that `frames.pvd` lists.
pub fn all_frames(directory: &Path) -> Vec<Frame> {
    let entries = frames::read_collection(directory).unwrap();
    entries
        .iter()
        .map(|entry| vtu::read(&directory.join(&entry.file)).unwrap())
        .collect()
}

/// The frame that `frames.pvd` lists last.
pub fn last_frame(directory: &Path) -> Frame {
    let entries = frames::read_collection(directory).unwrap();
    vtu::read(&directory.join(&entries.last().expect("a frame").file)).unwrap()
}

pub fn ids(frame: &Frame) -> Vec<u64> {
    let field = frame
        .fields
        .iter()
        .find(|field| field.name == "id")
        .expect("a field id");
    match &field.values {
        FieldValues::U64(ids) => ids.clone(),
        other => panic!("ids are {other:?}"),
    }
}

/// The value of a column in the row of a time.
#[track_caller]
pub fn at(columns: &Columns, name: &str, time: f64) -> f64 {
    let times = columns.get("time").expect("a column time");
    let row = times
        .iter()
        .position(|row| (row - time).abs() < 1e-12)
        .unwrap_or_else(|| panic!("no row at {time}"));
    columns.get(name).unwrap_or_else(|| panic!("no column {name}"))[row]
}

/// Largest difference of each real field and of the positions, relative to the field's largest number in `expected`;
/// points are compared by id.
#[track_caller]
pub fn differences(found: &Frame, expected: &Frame) -> Vec<(String, f64)> {
    assert_eq!((found.step, found.time), (expected.step, expected.time));
    assert_eq!(ids(found), ids(expected));
    let position = (
        "position".to_owned(),
        relative(found.position.as_flattened(), expected.position.as_flattened()),
    );
    let real = expected
        .fields
        .iter()
        .filter(|field| matches!(field.values, FieldValues::F64(_)));
    let fields = real.map(|field| {
        let part = |frame: &Frame| {
            frame
                .real(&field.name, field.components)
                .expect("the same fields")
                .to_vec()
        };
        (field.name.clone(), relative(&part(found), &part(expected)))
    });
    std::iter::once(position).chain(fields).collect()
}

/// Asserts that the last frames of two directories agree to 1e-8 of the largest number of each field.
#[track_caller]
pub fn agree(found: &Path, expected: &Path) {
    for (field, difference) in differences(&last_frame(found), &last_frame(expected)) {
        assert!(
            difference < 1e-8,
            "{field} of {} differs by {difference:.1e}",
            found.display()
        );
    }
}

fn relative(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let difference = found
        .iter()
        .zip(expected)
        .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    if difference == 0.0 { 0.0 } else { difference / largest }
}

/// Asserts that no number in the run's files is infinite or none, by their text and by their readers.
#[track_caller]
pub fn all_finite(directory: &Path) {
    for name in ["history.csv", "steps.csv", "run.json"] {
        let text = std::fs::read_to_string(directory.join(name)).unwrap().to_lowercase();
        let words = text.split(|c: char| !c.is_ascii_alphanumeric());
        assert_eq!(
            words.filter(|word| ["nan", "inf", "infinity"].contains(word)).count(),
            0,
            "{name}: {text}"
        );
    }
    let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
    for columns in [history(directory), steps(directory)] {
        assert!(columns.values.iter().all(|column| finite(column)));
    }
    for frame in all_frames(directory) {
        assert!(frame.time.is_finite() && finite(frame.position.as_flattened()));
        for field in &frame.fields {
            assert!(
                !matches!(&field.values, FieldValues::F64(values) if !finite(values)),
                "{}",
                field.name
            );
        }
    }
}
