//! Fuzzes records of checkpoints.

use arbitrary::{Result, Unstructured};
use bsmpm_io::checkpoint::{ArrayNumber, CheckpointRecord, FoundCheckpoint, RecordedArray, SCHEMA, named, newest};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The file beside the record.
const FILE: &[u8] = b"arrays";

thread_local! {
    static FOLDER: TempDir = TempDir::new().expect("a folder for temporary files");
}

/// A byte that says what the rest is: the record's file, its body that is given the right hash, or what a record says.
pub fn target(data: &[u8]) {
    let Some((kind, data)) = data.split_first() else { return };
    match kind % 3 {
        0 => drop(try_folder(data, FILE)),
        1 => drop(try_folder(&signed(data), FILE)),
        _ => {
            let Ok(record) = record(&mut Unstructured::new(data)) else {
                return;
            };
            let text = serde_json::to_vec(&record).expect("a record is JSON");
            if let Some(found) = try_folder(&signed(&text), FILE) {
                assert_eq!(found.record, record);
            }
        }
    }
}

/// A record body with its hash before it, as it stands in a file.
fn signed(body: &[u8]) -> Vec<u8> {
    let hash = blake3::hash(body).to_hex();
    [b"{\"blake3\":\"", hash.as_bytes(), b"\",\"record\":", body, b"}\n"].concat()
}

/// A record that is right about its file in size and hash, most times.
fn record(u: &mut Unstructured<'_>) -> Result<CheckpointRecord> {
    Ok(CheckpointRecord {
        schema: if u.ratio(1, 16)? { u.arbitrary()? } else { SCHEMA },
        version: u.arbitrary()?,
        step: u.arbitrary()?,
        time_bits: u.arbitrary()?,
        case: u.arbitrary()?,
        ranks: u.arbitrary()?,
        bytes: if u.ratio(1, 16)? {
            u.arbitrary()?
        } else {
            FILE.len() as u64
        },
        blake3: blake3::hash(if u.ratio(1, 16)? { b"another file" } else { FILE })
            .to_hex()
            .to_string(),
        arrays: (0..u.int_in_range(0..=3)?).map(|_| array(u)).collect::<Result<_>>()?,
    })
}

fn array(u: &mut Unstructured<'_>) -> Result<RecordedArray> {
    let numbers = [ArrayNumber::U8, ArrayNumber::U16, ArrayNumber::U64, ArrayNumber::F64];
    Ok(RecordedArray {
        name: u.arbitrary()?,
        number: *u.choose(&numbers)?,
        rows: count(u)?,
        width: count(u)?,
    })
}

/// A small number of rows or columns, or any.
fn count(u: &mut Unstructured<'_>) -> Result<u64> {
    if u.ratio(1, 8)? {
        u.arbitrary()
    } else {
        u.int_in_range(0..=2)
    }
}

/// What is found by name is what is found as the newest, and true.
fn try_folder(record: &[u8], file: &[u8]) -> Option<FoundCheckpoint> {
    FOLDER.with(|folder| {
        let path = folder.path().join("step_000000007.json");
        fs::write(&path, record)
            .and_then(|()| fs::write(path.with_extension("h5"), file))
            .expect("room for files");
        let found = named(&path);
        let (searched, damaged) = newest(folder.path()).expect("a folder that can be read");
        assert_eq!(found.as_ref().ok(), searched.as_ref());
        assert_eq!(damaged.len(), usize::from(found.is_err()));
        match found {
            Ok(found) => {
                check(&found, file, &path);
                Some(found)
            }
            Err(error) => {
                assert!(!error.to_string().is_empty());
                None
            }
        }
    })
}

fn check(found: &FoundCheckpoint, file: &[u8], path: &Path) {
    let record = &found.record;
    assert_eq!(found.path, path.with_extension("h5"));
    assert_eq!(
        (record.bytes, &*record.blake3),
        (file.len() as u64, blake3::hash(file).to_hex().as_str())
    );
    assert!(record.schema == SCHEMA && record.time().is_finite());
    let held: u64 = record.arrays.iter().map(|array| array.bytes().expect("counted")).sum();
    assert!(held <= record.bytes);
    for array in &record.arrays {
        assert_eq!(record.array(&array.name), Some(array));
    }
}
