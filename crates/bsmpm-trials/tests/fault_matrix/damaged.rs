//! Tests that the program refuses a damaged checkpoint, or one of another case, if the user names it, and that
//! `--restart auto` skips it.

use crate::ground::{Ground, Trial, spread};
use crate::support::{example, processes};
use crate::table::{Tried, trials};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// s  within which a file is refused, launching included
const SOON: f64 = 10.0;

const NEWEST: &str = "step_000000010.h5";

/// Asserts that the program refuses a checkpoint that is named, soon, with those words; the seconds.
fn refused(trial: &Trial, file: &Path, words: &str) -> f64 {
    let arguments = ["case.toml", "-q", "-o", "other", "--restart", file.to_str().unwrap()];
    let output = trial.scratch.direct(&arguments);
    let seconds = output.elapsed.as_secs_f64();
    assert!(
        [Some(76), Some(66)].contains(&output.code),
        "{}: {output:?}",
        file.display()
    );
    assert!(output.said().contains(words), "{words:?}: {output:?}");
    assert!(!trial.scratch.path("other").exists(), "something was written");
    assert!(seconds < SOON, "{seconds} s");
    seconds
}

/// Lengths from 0 to all but one of a file's bytes; 0, 1, 511, 512 and the last among them.
fn lengths(bytes: usize, count: usize) -> Vec<usize> {
    let special = [0, 1, 511, 512, bytes - 1];
    let others = (special.len()..count.max(special.len())).map(|index| (spread(index, 10) * bytes as f64) as usize);
    special.into_iter().chain(others).collect()
}

/// Cut short: by name 76 every time; `auto` goes back to the one before, to the bit.
pub fn truncated(ground: &Ground, count: usize) -> Tried {
    let stopped = ground.stopped(1, 10);
    let file = stopped.checkpoint(NEWEST);
    let bytes = std::fs::read(&file).unwrap();
    let lengths = lengths(bytes.len(), count);
    let named = trials(lengths.len(), |index| {
        std::fs::write(&file, &bytes[..lengths[index]]).unwrap();
        let (found, passed_over) = bsmpm_io::checkpoint::newest(&stopped.checkpoint("")).unwrap();
        assert_eq!((found.unwrap().record.step, passed_over.len()), (5, 1));
        refused(&stopped, &file, NEWEST)
    });
    let whole = ground.whole(1);
    let auto = trials(2, |index| {
        std::fs::write(&file, &bytes[..lengths[2 + index]]).unwrap();
        let trial = stopped.copy();
        trial.finish();
        trial.has_warned("The run continues from an older checkpoint");
        assert_eq!(trial.resumed_from(), 5);
        trial.becomes(&whole);
        0.0
    });
    named
        .and(auto)
        .figure(|seconds| format!("76 after {seconds} s at most; auto: B"))
}

/// One bit of the file or its record, as the program's own check sees it.
pub fn flipped(ground: &Ground, count: usize) -> Tried {
    flips(ground, count, |file| {
        assert!(bsmpm_io::checkpoint::named(file).is_err(), "is accepted");
    })
}

/// The same through the whole program.
pub fn flipped_in_full(ground: &Ground, count: usize) -> Tried {
    let trial = ground.stopped(1, 10);
    flips(ground, count, |file| {
        refused(&trial, file, "cannot be used");
    })
}

fn flips(ground: &Ground, count: usize, refuses: impl Fn(&Path)) -> Tried {
    let trial = ground.stopped(1, 10);
    let file = trial.checkpoint(NEWEST);
    let parts = [file.clone(), file.with_extension("json")];
    let whole = parts.clone().map(|part| std::fs::read(part).unwrap());
    let tried = trials(count, |index| {
        // The record is small: every fifth flip is its.
        let part = usize::from(index % 5 == 4);
        let mut bytes = whole[part].clone();
        let bit = (spread(index, 11) * (8 * bytes.len()) as f64) as usize;
        bytes[bit / 8] ^= 1 << (bit % 8);
        std::fs::write(&parts[part], bytes).unwrap();
        refuses(&file);
        std::fs::write(&parts[part], &whole[part]).unwrap();
        0.0
    });
    bsmpm_io::checkpoint::named(&file).expect("undamaged, it is good");
    tried.figure(|_| "none accepted".into())
}

fn pipe(path: &Path) {
    assert!(
        Command::new("mkfifo").arg(path).status().unwrap().success(),
        "a pipe can be made"
    );
}

/// What is no checkpoint of ours.
const FOREIGN: [&str; 10] = [
    "HDF5 without a record",
    "text",
    "directory",
    "nothing",
    "pipe",
    "pipe for a record",
    "device",
    "device for a record",
    "circle of links",
    "record of another file",
];

/// Something of that kind, beside the good checkpoint of a run.
fn stranger(trial: &Trial, kind: &str) -> PathBuf {
    let good = trial.checkpoint(NEWEST);
    let file = trial.scratch.path(&format!("{}.h5", kind.replace(' ', "-")));
    let record = file.with_extension("json");
    let copy = |from: &Path, to: &Path| {
        std::fs::copy(from, to).unwrap();
    };
    match kind {
        "nothing" => {}
        "text" => std::fs::write(&file, "0 1 2\n").unwrap(),
        "directory" => std::fs::create_dir(&file).unwrap(),
        "pipe" => pipe(&file),
        "device" => symlink("/dev/zero", &file).unwrap(),
        "circle of links" => symlink(&file, &file).unwrap(),
        "record of another file" => copy(&trial.checkpoint("step_000000005.h5"), &file),
        _ => copy(&good, &file),
    }
    match kind {
        "nothing" | "HDF5 without a record" => {}
        "pipe for a record" => pipe(&record),
        "device for a record" => symlink("/dev/zero", &record).unwrap(),
        // What stands in the place of the arrays has the good one's record.
        _ => copy(&good.with_extension("json"), &record),
    }
    file
}

/// Each of them, by name.
pub fn foreign(ground: &Ground, _: usize) -> Tried {
    let trial = ground.stopped(1, 10);
    let tried = trials(FOREIGN.len(), |index| {
        refused(&trial, &stranger(&trial, FOREIGN[index]), "cannot be used")
    });
    tried.figure(|seconds| format!("76 after {seconds} s at most"))
}

/// Writes a record with true hashes for a file, after `change` has been at it.
fn record(file: &Path, change: impl Fn(&mut serde_json::Value)) {
    let text = std::fs::read_to_string(file.with_extension("json")).unwrap();
    let mut whole: serde_json::Value = serde_json::from_str(&text).unwrap();
    let bytes = std::fs::read(file).unwrap();
    let record = &mut whole["record"];
    record["bytes"] = bytes.len().into();
    record["blake3"] = blake3::hash(&bytes).to_string().into();
    change(record);
    let body = record.to_string();
    let text = format!(
        "{{\"blake3\":\"{}\",\"record\":{body}}}\n",
        blake3::hash(body.as_bytes())
    );
    std::fs::write(file.with_extension("json"), text).unwrap();
}

/// A checkpoint of a form that is to come, and one without a step.
pub fn other_form(ground: &Ground, _: usize) -> Tried {
    let stopped = ground.stopped(1, 10);
    let tried = trials(2, |index| {
        let trial = stopped.copy();
        let file = trial.checkpoint(NEWEST);
        record(&file, |record| {
            record["schema"] = if index == 0 { 5.into() } else { 0.into() }
        });
        refused(&trial, &file, "this program reads format 1")
    });
    tried.figure(|_| "76, with both numbers".into())
}

/// Changes of one array that no writer of ours makes, with what is reported of them; the record's hashes are true.
const FORGED: [(&str, &str, &str); 18] = [
    ("huge", "b_e", "is not as its record says"),
    ("empty", "b_e", "is not as its record says"),
    ("one-dimension", "b_e", "has not two dimensions"),
    ("three-dimensions", "b_e", "has not two dimensions"),
    ("single", "b_e", "holds other numbers than ours"),
    ("big-endian", "b_e", "holds other numbers than ours"),
    ("deflate", "b_e", "has another filter than a checksum"),
    ("no-checksum", "b_e", "has other filters than a checksum"),
    ("plain", "b_e", "is stored in another way than ours"),
    ("external-link", "b_e", "is linked, not there"),
    ("soft-link", "b_e", "is linked, not there"),
    ("cycle", "b_e", "is linked, not there"),
    ("group-cycle", "b_e", "is no array"),
    ("group", "b_e", "is no array"),
    ("external-storage", "b_e", "lies in other files"),
    ("virtual", "b_e", "is stored in another way than ours"),
    ("missing", "b_e", "arrays of its record are missing"),
    ("stranger", "b_e", "cannot be used"),
];

/// One number of an array, as 64 bits, with what is reported of it.
const NUMBERS: [(&str, usize, u64, &str); 16] = [
    ("id", 7, 8, "is there twice"),
    ("id", 7, 1 << 40, "is there twice"),
    ("id", 0, u64::MAX, "is there twice"),
    ("material", 3, 9, "its material is none of the case"),
    ("x", 11, f64::NAN.to_bits(), "x of point"),
    ("x", 10, 1e9_f64.to_bits(), "outside the grid"),
    ("x", 10, (-1.0_f64).to_bits(), "outside the grid"),
    ("sigma", 3, f64::INFINITY.to_bits(), "sigma of point"),
    (
        "sigma",
        5,
        f64::INFINITY.to_bits(),
        "sigma has components out of the plane",
    ),
    ("guess", 5, f64::NAN.to_bits(), "a nodal displacement is not finite"),
    ("mass", 2, (-1.0_f64).to_bits(), "its mass is negative"),
    ("volume", 2, 0, "its volume is not positive"),
    ("F", 0, (-1.0_f64).to_bits(), "det F is not positive"),
    ("F", 14, 1e-3_f64.to_bits(), "F has components out of the plane"),
    ("b_e", 10, f64::NAN.to_bits(), "b_e has components out of the plane"),
    ("b_e", 4, 1e-300_f64.to_bits(), "b_e has components out of the plane"),
];

/// Files that HDF5 reads but nobody of ours wrote, with records that are true.
pub fn hostile(ground: &Ground, _: usize) -> Tried {
    let stopped = ground.stopped(2, 10);
    let forge = |trial: &Trial, arguments: &[&str]| {
        let mut command = Command::new(example("foreign"));
        command
            .args([arguments[0], trial.checkpoint(NEWEST).to_str().unwrap()])
            .args(&arguments[1..]);
        let ears = crate::support::Ears::Open;
        processes::start_beside(command, &[], ears, Duration::from_secs(60))
            .end()
            .expect(0);
        record(&trial.checkpoint(NEWEST), |_| ());
    };
    let tried = trials(FORGED.len() + NUMBERS.len() + 1, |index| {
        let trial = stopped.copy();
        let words = if let Some((kind, array, words)) = FORGED.get(index) {
            forge(&trial, &[kind, array]);
            words
        } else if let Some((array, at, bits, words)) = NUMBERS.get(index - FORGED.len()) {
            forge(&trial, &["set", array, &at.to_string(), &format!("{bits:x}")]);
            words
        } else {
            let file = trial.checkpoint(NEWEST);
            record(&file, |record| record["arrays"][0]["rows"] = (1_u64 << 40).into());
            "its arrays cannot be in a file"
        };
        let seconds = refused(&trial, &trial.checkpoint(NEWEST), words);
        // Two ranks agree on it.
        if index % 5 == 0 {
            let file = trial.checkpoint(NEWEST);
            let named = ["case.toml", "-q", "-o", "other", "--restart", file.to_str().unwrap()];
            trial.scratch.mpirun(2, &named).expect(76);
        }
        seconds
    });
    tried.figure(|seconds| format!("76 after {seconds} s at most"))
}
