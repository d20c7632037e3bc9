//! Tests that uncommitted or damaged checkpoints do not count.

use bsmpm_io::Error;
use bsmpm_io::checkpoint::{self, ArrayNumber, Facts, FoundCheckpoint, Phase, RecordedArray, Store};
use std::cell::Cell;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::Command;

const ROWS: u64 = 500;
/// Bytes of what stands in for a checkpoint, and more.
const ROOM: u64 = 1 << 15;

fn arrays() -> Vec<RecordedArray> {
    vec![RecordedArray {
        name: "x".into(),
        number: ArrayNumber::F64,
        rows: ROWS,
        width: 2,
    }]
}

fn facts(step: u64) -> Facts {
    Facts {
        version: "0.1.0".into(),
        case: "c0ffee".into(),
        ranks: 2,
        step,
        time: 0.1 * step as f64,
    }
}

/// What stands in for the arrays' file of a step.
fn content(step: u64) -> Vec<u8> {
    (0..16 * ROWS + 100).map(|at| (at * 31 + step * 17) as u8).collect()
}

fn write(store: &Store, step: u64, at: &dyn Fn(Phase)) -> Result<FoundCheckpoint, Error> {
    let pending = store.begin(step, ROOM)?;
    fs::write(pending.path(), content(step)).unwrap();
    store.commit(pending, &facts(step), arrays(), at)
}

fn store(directory: &Path, keep: usize) -> Store {
    Store::open(directory, keep).unwrap()
}

/// One checkpoint, of step 7, in a directory that goes with it.
fn one() -> (tempfile::TempDir, PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    let found = write(&store(directory.path(), 2), 7, &|_| ()).unwrap();
    (directory, found.path)
}

#[track_caller]
fn refused(path: &Path, damage: &str) {
    let error = checkpoint::named(path).expect_err(damage);
    assert_eq!(error.exit_code(), 76, "{damage}: {error}");
    assert!(
        error.to_string().contains(path.file_stem().unwrap().to_str().unwrap()),
        "{damage}: {error}"
    );
}

#[test]
fn a_checkpoint_is_found_again_as_it_was_written_and_the_newest_few_are_kept() {
    let directory = tempfile::tempdir().unwrap();
    let store = store(directory.path(), 2);
    assert_eq!(checkpoint::newest(store.folder()).unwrap().0, None);
    let written: Vec<FoundCheckpoint> = [3, 12, 1_000_000_007]
        .map(|step| write(&store, step, &|_| ()).unwrap())
        .into();
    assert_eq!(written[2].record.time().to_bits(), (0.1 * 1_000_000_007_f64).to_bits());
    let (found, damaged) = checkpoint::newest(store.folder()).unwrap();
    assert_eq!((found.as_ref(), damaged.len()), (Some(&written[2]), 0));
    assert_eq!(
        checkpoint::named(&written[1].path.with_extension("json")).unwrap(),
        written[1]
    );
    let names = [
        "step_000000012.h5",
        "step_000000012.json",
        "step_1000000007.h5",
        "step_1000000007.json",
    ];
    assert_eq!(super::listing(store.folder()), names);
    assert_eq!(store.existing(&facts(12)).unwrap().as_ref(), Some(&written[1]));
}

#[test]
fn a_truncated_file_is_refused_at_every_length_and_the_one_before_it_found() {
    let directory = tempfile::tempdir().unwrap();
    let store = store(directory.path(), 2);
    let before = write(&store, 6, &|_| ()).unwrap();
    let path = write(&store, 7, &|_| ()).unwrap().path;
    for path in [path.clone(), path.with_extension("json")] {
        let whole = fs::read(&path).unwrap();
        let lengths = [0, 1, 511, 512, whole.len() - 1]
            .into_iter()
            .chain((1..36).map(|part| whole.len() * part / 36));
        for length in lengths.map(|length| length.min(whole.len() - 1)) {
            fs::write(&path, &whole[..length]).unwrap();
            refused(&path, &format!("{length} bytes"));
            let (found, damaged) = checkpoint::newest(store.folder()).unwrap();
            assert_eq!((found.as_ref(), damaged.len()), (Some(&before), 1));
        }
        fs::write(&path, [&whole[..], b"\n"].concat()).unwrap();
        refused(&path, "a byte more");
        fs::write(&path, whole).unwrap();
    }
    assert_eq!(checkpoint::newest(store.folder()).unwrap().0.unwrap().record.step, 7);
}

#[test]
fn every_flipped_bit_is_noticed() {
    let (_directory, path) = one();
    // A generator of Knuth's, so that every run makes the same flips.
    let mut seed = 1_u64;
    let mut random = |below: usize| {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % below
    };
    let record = path.with_extension("json");
    let bits = |path: &Path| 8 * fs::read(path).unwrap().len();
    for path in (0..500).flat_map(|_| [&path, &record]) {
        let bit = random(bits(path));
        let mut bytes = fs::read(path).unwrap();
        bytes[bit / 8] ^= 1 << (bit % 8);
        fs::write(path, &bytes).unwrap();
        refused(path, &format!("bit {bit}"));
        bytes[bit / 8] ^= 1 << (bit % 8);
        fs::write(path, &bytes).unwrap();
    }
    checkpoint::named(&path).unwrap();
}

#[test]
fn foreign_files_are_refused_without_waiting_for_them() {
    for ending in ["h5", "json"] {
        let (directory, path) = one();
        let path = path.with_extension(ending);
        let swap = |make: &dyn Fn(&Path)| {
            let _ = fs::remove_file(&path).or_else(|_| fs::remove_dir(&path));
            make(&path);
            refused(&path, ending);
        };
        let link = |to: &'static str| move |path: &Path| std::os::unix::fs::symlink(to, path).unwrap();
        swap(&|path| fs::write(path, "# a text\n").unwrap());
        swap(&|path| fs::write(path, b"\x89HDF\r\n\x1a\n").unwrap());
        swap(&|path| fs::write(path, "").unwrap());
        swap(&|path| fs::create_dir(path).unwrap());
        swap(&|path| assert!(Command::new("mkfifo").arg(path).status().unwrap().success()));
        swap(&link("/dev/zero"));
        swap(&link("/no/such/file"));
        swap(&|path| std::os::unix::fs::symlink(path, path).unwrap());
        swap(&|_| ());
        let (found, damaged) = checkpoint::newest(&directory.path().join("checkpoint")).unwrap();
        assert_eq!((found, damaged.len()), (None, usize::from(ending == "h5")));
    }
}

/// Writes a record with a right hash whatever it says.
fn forge(path: &Path, change: impl Fn(&mut serde_json::Value)) {
    let text = fs::read_to_string(path.with_extension("json")).unwrap();
    let mut whole: serde_json::Value = serde_json::from_str(&text).unwrap();
    change(&mut whole["record"]);
    let body = whole["record"].to_string();
    let hash = blake3::hash(body.as_bytes());
    fs::write(
        path.with_extension("json"),
        format!("{{\"blake3\":\"{hash}\",\"record\":{body}}}\n"),
    )
    .unwrap();
}

#[test]
fn records_that_make_no_sense_are_refused_before_anything_is_read() {
    type Change = (&'static str, fn(&mut serde_json::Value));
    let changes: [Change; 9] = [
        ("format 5", |record| record["schema"] = 5.into()),
        ("cannot be in a file", |record| {
            record["arrays"][0]["rows"] = (1_u64 << 40).into()
        }),
        ("cannot be in a file", |record| {
            record["arrays"][0]["rows"] = u64::MAX.into()
        }),
        ("cannot be in a file", |record| {
            record["arrays"][0]["width"] = (1_u64 << 62).into()
        }),
        ("hold nothing", |record| record["arrays"][0]["width"] = 0.into()),
        ("invalid value", |record| record["arrays"][0]["rows"] = (-1).into()),
        ("twice", |record| {
            record["arrays"] = [&record["arrays"][0], &record["arrays"][0]]
                .into_iter()
                .cloned()
                .collect()
        }),
        ("time", |record| record["time_bits"] = f64::NAN.to_bits().into()),
        ("unknown field", |record| record["more"] = 1.into()),
    ];
    for (reason, change) in changes {
        let (_directory, path) = one();
        forge(&path, |_| ());
        checkpoint::named(&path).unwrap();
        forge(&path, change);
        let error = checkpoint::named(&path).expect_err(reason);
        assert!(
            error.exit_code() == 76 && error.to_string().contains(reason),
            "{reason}: {error}"
        );
    }
}

#[test]
fn a_writer_that_stops_in_any_phase_leaves_a_good_checkpoint_and_its_remains_go() {
    for phase in &Phase::ALL[3..] {
        let directory = tempfile::tempdir().unwrap();
        let first = store(directory.path(), 1);
        write(&first, 1, &|_| ()).unwrap();
        // The files as they are in that phase: what the process would do afterwards is undone.
        let image = tempfile::tempdir().unwrap();
        let copied = Cell::new(false);
        let copy = |now: Phase| {
            if now == *phase {
                fs::create_dir(image.path().join("checkpoint")).unwrap();
                for name in super::listing(first.folder()) {
                    fs::copy(first.folder().join(&name), image.path().join("checkpoint").join(&name)).unwrap();
                }
                copied.set(true);
            }
        };
        write(&first, 2, &copy).unwrap();
        assert!(copied.get());
        let after = store(image.path(), 1);
        let (found, damaged) = checkpoint::newest(after.folder()).unwrap();
        let step = if [Phase::Committed, Phase::Kept].contains(phase) {
            2
        } else {
            1
        };
        assert_eq!((found.unwrap().record.step, damaged.len()), (step, 0), "{phase:?}");
        write(&after, 2, &|_| ()).unwrap();
        write(&after, 3, &|_| ()).unwrap();
        assert_eq!(
            super::listing(after.folder()),
            ["step_000000003.h5", "step_000000003.json"],
            "{phase:?}"
        );
    }
}

#[test]
fn a_writer_that_gives_up_leaves_nothing() {
    let (directory, path) = one();
    let store = store(directory.path(), 2);
    let before = super::listing(store.folder());
    drop(store.begin(8, ROOM).unwrap());
    assert_eq!(super::listing(store.folder()), before);
    let struck = AssertUnwindSafe(|| write(&store, 8, &|phase| assert_ne!(phase, Phase::Recorded)));
    assert!(catch_unwind(struck).is_err());
    assert_eq!(super::listing(store.folder()), before);
    checkpoint::named(&path).unwrap();
}

#[test]
fn a_checkpoint_that_no_disk_has_room_for_is_refused_and_leaves_nothing() {
    let (directory, _) = one();
    let store = store(directory.path(), 2);
    let before = super::listing(store.folder());
    let error = store.begin(8, 1 << 60).unwrap_err();
    assert!(
        matches!(error, Error::Space { needed, .. } if needed == 1 << 60),
        "{error}"
    );
    assert_eq!(error.exit_code(), 74);
    assert_eq!(super::listing(store.folder()), before);
}

#[test]
fn a_damaged_checkpoint_of_the_same_step_makes_way() {
    let (directory, path) = one();
    let store = store(directory.path(), 2);
    fs::write(&path, "damaged").unwrap();
    assert_eq!(store.existing(&facts(7)).unwrap(), None);
    let found = write(&store, 7, &|_| ()).unwrap();
    assert_eq!(checkpoint::newest(store.folder()).unwrap().0, Some(found));
}

#[test]
fn a_checkpoint_of_another_case_or_of_other_ranks_makes_way_too() {
    for other in [
        Facts {
            case: "bad".into(),
            ..facts(7)
        },
        Facts { ranks: 3, ..facts(7) },
    ] {
        let (directory, _path) = one();
        assert_eq!(store(directory.path(), 2).existing(&other).unwrap(), None);
        assert_eq!(
            checkpoint::newest(&directory.path().join("checkpoint")).unwrap().0,
            None
        );
    }
}

#[test]
fn what_is_later_than_a_step_is_forgotten() {
    let directory = tempfile::tempdir().unwrap();
    let store = store(directory.path(), 10);
    let written: Vec<FoundCheckpoint> = [3, 12, 20].map(|step| write(&store, step, &|_| ()).unwrap()).into();
    fs::write(&written[2].path, "damaged").unwrap();
    checkpoint::forget_beyond(directory.path(), 3).unwrap();
    assert_eq!(
        super::listing(store.folder()),
        ["step_000000003.h5", "step_000000003.json"]
    );
}
