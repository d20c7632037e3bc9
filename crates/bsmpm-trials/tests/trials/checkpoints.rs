//! Tests of checkpoints that several ranks write together, and of killed ranks.

use crate::support::processes::{self, Output};
use crate::support::{Scratch, entries, example};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Points enough for several chunks, the last of them not full.
const MANY: &str = "40000";
const FEW: &str = "50";

fn run(ranks: usize, arguments: &[&str]) -> Output {
    let mut launcher = Command::new("mpirun");
    launcher
        .args(["-q", "--oversubscribe", "-n", &ranks.to_string()])
        .arg(example("checkpoints"))
        .args(arguments);
    processes::run(launcher, &[], true, Duration::from_secs(120))
}

/// The path of a scratch directory's entry as an argument.
fn at(scratch: &Scratch, name: &str) -> String {
    scratch.path(name).to_str().unwrap().to_owned()
}

#[test]
fn a_checkpoint_is_read_to_the_bit_on_any_number_of_ranks() {
    for (points, writers) in [(MANY, [1, 2, 3, 4]), (FEW, [4, 3, 2, 1])] {
        for writers in writers {
            let scratch = Scratch::new();
            run(writers, &["write", &at(&scratch, ""), points, "12"]).expect(0);
            for readers in [1, 2, 3, 4] {
                let output = run(readers, &["newest", &at(&scratch, "checkpoint"), points]).expect(0);
                output.says_once(&format!("good: step 12 of {writers} ranks"));
            }
        }
    }
}

#[test]
fn a_checkpoint_without_points_is_one_too() {
    let scratch = Scratch::new();
    run(2, &["write", &at(&scratch, ""), "0", "1"]).expect(0);
    run(3, &["newest", &at(&scratch, "checkpoint"), "0"])
        .expect(0)
        .says_once("good: step 1");
}

#[test]
fn equal_checkpoints_are_equal_files() {
    let file = |ranks: usize| {
        let scratch = Scratch::new();
        run(ranks, &["write", &at(&scratch, ""), FEW, "3"]).expect(0);
        std::fs::read(scratch.path("checkpoint/step_000000003.h5")).unwrap()
    };
    assert!(file(1) == file(1) && file(2) == file(2));
}

#[test]
fn an_aborted_writer_leaves_the_checkpoint_before_or_the_new_one() {
    let phases = [
        "Opened",
        "Midway",
        "Written",
        "Closed",
        "Synced",
        "Recorded",
        "Named",
        "Committed",
        "Kept",
    ];
    for phase in phases {
        let scratch = Scratch::new();
        let directory = at(&scratch, "");
        run(2, &["write", &directory, FEW, "1"]).expect(0);
        let output = run(2, &["write", &directory, FEW, "2", phase]);
        assert_ne!(output.code, Some(0), "{phase}");
        let step = if ["Committed", "Kept"].contains(&phase) { 2 } else { 1 };
        let output = run(2, &["newest", &at(&scratch, "checkpoint"), FEW]).expect(0);
        output.says_once(&format!("good: step {step}"));
        assert_eq!(output.count("passed over"), 0, "{phase}: {output:#?}");
        run(2, &["write", &directory, FEW, "2"]).expect(0);
        run(1, &["newest", &at(&scratch, "checkpoint"), FEW])
            .expect(0)
            .says_once("good: step 2");
        assert!(
            entries(&scratch.path("checkpoint"))
                .iter()
                .all(|name| !name.starts_with('.')),
            "{phase}"
        );
    }
}

/// Kills a writer at random instants; `BSMPM_STORM` sets how often (30 by default).
#[test]
fn a_killed_writer_always_leaves_a_good_checkpoint() {
    let times = std::env::var("BSMPM_STORM").map_or(30, |times| times.parse().unwrap());
    let scratch = Scratch::new();
    let directory = at(&scratch, "");
    run(1, &["write", &directory, MANY, "1"]).expect(0);
    for time in 0..times {
        let mut command = Command::new(example("checkpoints"));
        command
            .args(["storm", &directory, MANY])
            .env("OMP_NUM_THREADS", "1")
            .stdin(Stdio::null());
        // Killed processes leave MPI's files; other runs must not stumble over them.
        command.env("TMPDIR", scratch.path(""));
        let mut writer = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        // Multiples of the golden section fill the interval evenly.
        let instant = Duration::from_secs_f64(0.1 + 0.9 * (f64::from(time) * 0.618_034).fract());
        let started = Instant::now();
        while started.elapsed() < instant {
            std::thread::sleep(Duration::from_millis(1));
        }
        assert_eq!(writer.try_wait().unwrap(), None, "the writer gave up");
        writer.kill().and_then(|()| writer.wait()).unwrap();
        let (found, damaged) = bsmpm_io::checkpoint::newest(&scratch.path("checkpoint")).unwrap();
        assert!(found.is_some() && damaged.is_empty(), "kill {time}: {damaged:?}");
    }
    run(2, &["newest", &at(&scratch, "checkpoint"), MANY])
        .expect(0)
        .says_once("good: step");
}

#[test]
fn a_damaged_checkpoint_is_passed_over_with_a_warning_but_refused_by_name() {
    let scratch = Scratch::new();
    for step in ["1", "2"] {
        run(2, &["write", &at(&scratch, ""), FEW, step]).expect(0);
    }
    let path = scratch.path("checkpoint/step_000000002.h5");
    let mut bytes = std::fs::read(&path).unwrap();
    bytes[5000] ^= 4;
    std::fs::write(&path, bytes).unwrap();
    let output = run(3, &["newest", &at(&scratch, "checkpoint"), FEW]).expect(0);
    output.says_once("good: step 1");
    output.says_once("passed over: ");
    let output = run(3, &["named", path.to_str().unwrap(), FEW]).expect(76);
    output.says_once("step_000000002.h5` cannot be used: it is damaged");
}

#[test]
fn a_file_whose_arrays_are_not_those_of_its_record_is_refused_on_all_ranks() {
    let scratch = Scratch::new();
    let other = Scratch::new();
    run(1, &["write", &at(&scratch, ""), FEW, "2"]).expect(0);
    run(1, &["write", &at(&other, ""), "51", "2"]).expect(0);
    let path = "checkpoint/step_000000002.h5";
    let name = scratch.path(path);
    let text = std::fs::read_to_string(name.with_extension("json")).unwrap();
    let mut record: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mut forge = |bytes: &[u8]| {
        std::fs::write(&name, bytes).unwrap();
        record["record"]["bytes"] = bytes.len().into();
        record["record"]["blake3"] = blake3::hash(bytes).to_string().into();
        let body = record["record"].to_string();
        let hash = blake3::hash(body.as_bytes());
        let text = format!("{{\"blake3\":\"{hash}\",\"record\":{body}}}\n");
        std::fs::write(name.with_extension("json"), text).unwrap();
        run(2, &["named", name.to_str().unwrap(), FEW]).expect(76)
    };
    forge(&std::fs::read(other.path(path)).unwrap()).says_once("is not as its record says");
    forge(&vec![b'#'; 1 << 20]).says_once("HDF5 cannot open the file");
}

/// A small disk of its own, as long as this lives; none where that is not allowed.
struct Disk(PathBuf);

impl Disk {
    fn new(path: PathBuf, size: &str) -> Option<Self> {
        std::fs::create_dir(&path).unwrap();
        let mut mount = Command::new("mount");
        mount
            .args(["-t", "tmpfs", "-o", &format!("size={size}"), "none"])
            .arg(&path)
            .stderr(Stdio::null());
        mount
            .status()
            .is_ok_and(|status| status.success())
            .then_some(Self(path))
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}

/// Needs the right to mount a disk, and says so where it has not.
#[test]
fn on_a_full_disk_nothing_is_written_and_the_older_checkpoint_stays() {
    let scratch = Scratch::new();
    let Some(disk) = Disk::new(scratch.path("disk"), "20m") else {
        eprintln!("not tried: no right to mount a disk");
        return;
    };
    let directory = disk.0.to_str().unwrap();
    run(2, &["write", directory, MANY, "1"]).expect(0);
    for _ in 0..3 {
        let output = run(2, &["write", directory, MANY, "2"]).expect(74);
        output.says_once("E0766: ");
        assert!(output.said().contains("bytes, but "), "{output:#?}");
        assert_eq!(
            entries(&disk.0.join("checkpoint")),
            ["step_000000001.h5", "step_000000001.json"]
        );
    }
    run(2, &["newest", disk.0.join("checkpoint").to_str().unwrap(), MANY])
        .expect(0)
        .says_once("good: step 1");
}

#[test]
fn where_files_must_not_grow_nothing_is_written_and_the_older_checkpoint_stays() {
    let scratch = Scratch::new();
    run(2, &["write", &at(&scratch, ""), FEW, "1"]).expect(0);
    let limited = format!(
        "ulimit -f 12000; exec {} write {} {MANY} 2",
        example("checkpoints").display(),
        at(&scratch, "")
    );
    let mut alone = Command::new("bash");
    alone.args(["-c", &limited]);
    let output = processes::run(alone, &[], true, Duration::from_secs(60)).expect(74);
    output.says_once("was not written: the file needs");
    assert_eq!(
        entries(&scratch.path("checkpoint")),
        ["step_000000001.h5", "step_000000001.json"]
    );
    run(2, &["newest", &at(&scratch, "checkpoint"), FEW])
        .expect(0)
        .says_once("good: step 1");
}
