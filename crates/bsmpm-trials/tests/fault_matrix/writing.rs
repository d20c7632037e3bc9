//! Tests of faults while a checkpoint is written: full disks, slow disks and killed ranks.

use crate::ground::{Ground, INTERVAL, RUN, Trial, results, same, same_but_for_frames, spread};
use crate::support::results::manifest;
use crate::support::{Ears, Scratch, entries, example, processes, program};
use crate::table::{Tried, trials};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Points of the writer that is killed: 14 MB a checkpoint.
const POINTS: &str = "40000";

/// Kills a writer of checkpoints at any instant.
pub fn storm(_: &Ground, count: usize) -> Tried {
    let scratch = Scratch::new();
    let directory = scratch.path("").to_str().unwrap().to_owned();
    let mut first = Command::new(example("checkpoints"));
    first.args(["write", &directory, POINTS, "1"]);
    processes::start_beside(first, &[], Ears::Open, Duration::from_secs(60))
        .end()
        .expect(0);
    let tried = trials(count, |index| {
        let mut command = Command::new(example("checkpoints"));
        command
            .args(["storm", &directory, POINTS])
            .env("OMP_NUM_THREADS", "1")
            .stdin(Stdio::null());
        // Killed processes leave MPI's files; other runs must not stumble over them.
        command.env("TMPDIR", &directory);
        let mut writer = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let begun = Instant::now();
        let instant = Duration::from_secs_f64(0.1 + 0.9 * spread(index, 12));
        while begun.elapsed() < instant {
            std::thread::sleep(Duration::from_millis(1));
        }
        assert_eq!(writer.try_wait().unwrap(), None, "the writer gave up");
        writer.kill().and_then(|()| writer.wait()).unwrap();
        let (found, damaged) = bsmpm_io::checkpoint::newest(&scratch.path("checkpoint")).unwrap();
        assert!(found.is_some() && damaged.is_empty(), "{damaged:?}");
        0.0
    });
    tried.figure(|_| "a good one each time, no bad one".into())
}

/// A disk of its own in a directory, as long as this lives; none where that is not allowed.
struct Disk(PathBuf);

impl Disk {
    fn new(path: PathBuf, bytes: u64) -> Option<Self> {
        std::fs::create_dir_all(&path).unwrap();
        let disk = Self(path);
        disk.mount(&format!("size={bytes}")).then_some(disk)
    }

    fn mount(&self, options: &str) -> bool {
        let mut mount = Command::new("mount");
        mount
            .args(["-t", "tmpfs", "-o", options, "none"])
            .arg(&self.0)
            .stderr(Stdio::null());
        mount.status().is_ok_and(|status| status.success())
    }

    /// Gives it all the room that is needed.
    fn grow(&self) {
        assert!(self.mount("remount,size=1g"), "a larger disk");
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).stderr(Stdio::null()).status();
    }
}

fn size(path: &Path) -> u64 {
    std::fs::metadata(path).unwrap().len()
}

/// Bytes of a run's first frame, and of its last checkpoint with its record.
fn sizes(ground: &Ground) -> (u64, u64) {
    let run = ground.whole(2).scratch.path(RUN);
    let checkpoint = run.join(manifest(&run).checkpoint.unwrap());
    (
        size(&run.join("frames/step_000000000.vtu")),
        size(&checkpoint) + size(&checkpoint.with_extension("json")),
    )
}

/// What must be there after a checkpoint that found no room.
fn has_stopped(trial: &Trial, words: &str, output: &crate::support::Output) {
    output.says_once(words);
    trial.is_clean();
    let folder = trial.checkpoint("");
    if folder.exists() {
        let (_, damaged) = bsmpm_io::checkpoint::newest(&folder).unwrap();
        assert!(damaged.is_empty(), "{damaged:?}");
    }
}

/// A disk with room for two checkpoints and a part of the third, or files that may not grow as large as one.
pub fn full_disk(ground: &Ground, count: usize) -> Tried {
    let whole = ground.whole(2);
    let (frame, checkpoint) = sizes(ground);
    let few_frames = ["--set", "output.every_steps=1000"];
    if Disk::new(Scratch::new().path("disk"), 1 << 20).is_none() {
        return Tried::not("no right to mount a disk");
    }
    let tried = trials(count, |index| {
        let trial = ground.trial(2);
        let parts = 2.05 + 0.9 * spread(index, 13);
        let room = frame + (parts * checkpoint as f64) as u64 + (160 << 10);
        let disk = Disk::new(trial.directory(), room).expect("a disk");
        let output = trial.start(&few_frames, &[]).end().expect(74);
        has_stopped(&trial, "was not written: the file needs", &output);
        assert_eq!(entries(&trial.checkpoint("")).len(), 4, "two checkpoints");
        disk.grow();
        trial.start(&few_frames, &[]).end().expect(0);
        assert_eq!(trial.resumed_from(), 2 * INTERVAL);
        same_but_for_frames(&results(&trial.directory()), &whole.results);
        parts
    });
    tried.figure(|_| "74 with bytes needed and left; then B".into())
}

/// A disk that is seen to be too small before the first step; what is reported that the run may need, over what it
/// takes.
pub fn foreseen(ground: &Ground, _: usize) -> Tried {
    let whole = ground.whole(2);
    let (frame, checkpoint) = sizes(ground);
    let frames = whole.results.keys().filter(|name| name.ends_with(".vtu")).count() as u64;
    let takes = frames * frame + 3 * checkpoint;
    if Disk::new(Scratch::new().path("disk"), 1 << 20).is_none() {
        return Tried::not("no right to mount a disk");
    }
    let reported = "the run may write ";
    let tried = trials(3, |index| {
        let trial = ground.trial(2);
        let room = if index == 2 { 2 * takes } else { takes - checkpoint };
        let disk = Disk::new(trial.directory(), room).expect("a disk");
        let short = ["--max-steps", "2", "--strict-space"];
        match index {
            0 => {
                let output = trial.start(&short, &[]).end().expect(74);
                output.says_once(reported);
                assert_eq!(entries(&trial.directory()), [""; 0]);
                let mebibytes = output
                    .said()
                    .split_once(reported)
                    .unwrap()
                    .1
                    .split_once(' ')
                    .unwrap()
                    .0
                    .parse::<f64>();
                let ratio = mebibytes.unwrap() * f64::from(1 << 20) / takes as f64;
                assert!((0.95..1.5).contains(&ratio), "{ratio}");
                return ratio;
            }
            1 => {
                trial.start(&short[..2], &[]).end().expect(75);
                trial.has_warned(reported);
            }
            _ => {
                trial.start(&short, &[]).end().expect(75);
                assert!(
                    !manifest(&trial.directory())
                        .warnings
                        .iter()
                        .any(|warning| warning.contains(reported))
                );
            }
        }
        drop(disk);
        0.0
    });
    tried.figure(|ratio| format!("warned; --strict-space: 74; estimate {ratio} of what it takes"))
}

/// Files that must not grow as large as a checkpoint.
pub fn small_files(ground: &Ground, count: usize) -> Tried {
    let whole = ground.whole(2);
    let (frame, checkpoint) = sizes(ground);
    let tried = trials(count, |index| {
        let trial = ground.trial(2);
        let limit = (frame + (spread(index, 14) * 0.9 * (checkpoint - frame) as f64) as u64) / 1024 + 1;
        let line = format!(
            "ulimit -f {limit}; exec {} case.toml -q -o {RUN} --restart auto",
            program()
        );
        let mut command = Command::new("bash");
        command.args(["-c", &line]).current_dir(trial.scratch.path(""));
        let output = processes::start_beside(command, &[], Ears::Open, Duration::from_secs(60))
            .end()
            .expect(74);
        has_stopped(&trial, "was not written: the file needs", &output);
        trial.becomes(&whole);
        0.0
    });
    tried.figure(|_| "74; then B".into())
}

/// A full disk under the frames only.
pub fn full_frames(ground: &Ground, count: usize) -> Tried {
    let whole = ground.whole(2);
    let (frame, _) = sizes(ground);
    if Disk::new(Scratch::new().path("disk"), 1 << 20).is_none() {
        return Tried::not("no right to mount a disk");
    }
    let tried = trials(count, |index| {
        let trial = ground.trial(2);
        let room = ((2.1 + 1.8 * spread(index, 15)) * frame as f64) as u64;
        let disk = Disk::new(trial.directory().join("frames"), room).expect("a disk");
        let output = trial.start(&[], &[]).end().expect(74);
        assert!(output.said().contains("frames/"), "{output:?}");
        assert_eq!(
            manifest(&trial.directory()).exit_code,
            Some(74),
            "run.json reports how it ended"
        );
        let frames = entries(&trial.directory().join("frames"));
        assert!(
            frames.iter().all(|name| size(&disk.0.join(name)) > 100_000),
            "half a frame: {frames:?}"
        );
        disk.grow();
        trial.becomes(&whole) as f64
    });
    tried.figure(|lost| format!("74, {lost} steps are lost at most; then B"))
}

/// System calls on a checkpoint's files, in order: the shortest form of each line that strace reports.
fn calls(trace: &str) -> Vec<String> {
    let reports = |line: &str| -> Option<String> {
        let name = line.split('(').next()?.split_whitespace().last()?.to_owned();
        let what = [
            "fsync",
            "fdatasync",
            "rename",
            "renameat",
            "renameat2",
            "unlink",
            "unlinkat",
        ];
        if !what.contains(&name.as_str()) || !line.contains("/checkpoint") || line.contains("= -1") {
            return None;
        }
        let kind = if name.ends_with("sync") {
            "sync"
        } else if name.starts_with("rename") {
            "rename"
        } else {
            "unlink"
        };
        let file = ["json", "h5"]
            .into_iter()
            .find(|ending| line.contains(&format!(".{ending}")));
        Some(format!("{kind} {}", file.unwrap_or("folder")))
    };
    trace.lines().filter_map(reports).collect()
}

/// A run under strace; none where that is not there or not allowed.
fn traced(trial: &Trial, options: &[&str]) -> Option<String> {
    let trace = trial.scratch.path("trace");
    let may = Command::new("strace")
        .args(["-o", "/dev/null", "true"])
        .status()
        .is_ok_and(|status| status.success());
    if !may {
        return None;
    }
    let mut command = Command::new("strace");
    command.args(["-f", "-y", "-o", trace.to_str().unwrap()]).args(options);
    command.args([program(), "case.toml", "-q", "-o", RUN, "--restart", "auto"]);
    command.current_dir(trial.scratch.path(""));
    processes::start_beside(command, &[], Ears::Open, Duration::from_secs(300))
        .end()
        .expect(0);
    Some(std::fs::read_to_string(trace).unwrap())
}

/// What is not synced is lost with the power: the order in which files are synced, named and removed.
pub fn order(ground: &Ground, _: usize) -> Tried {
    let trial = ground.trial(1);
    let filter = ["-e", "trace=fsync,fdatasync,rename,renameat,renameat2,unlink,unlinkat"];
    let Some(trace) = traced(&trial, &filter) else {
        return Tried::not("no strace");
    };
    let calls = calls(&trace);
    let commits: Vec<usize> = calls
        .iter()
        .enumerate()
        .filter(|(_, call)| *call == "rename json")
        .map(|(at, _)| at)
        .collect();
    let tried = trials(commits.len(), |index| {
        let at = commits[index];
        let before = ["sync h5", "sync json", "rename h5"];
        assert!(
            at >= 3 && calls[at - 3..at] == before,
            "{:?}",
            &calls[at.saturating_sub(4)..=at]
        );
        assert_eq!(calls[at + 1], "sync folder");
        // Whatever is removed later, the new one is on the disk.
        let removed = calls[at + 2..]
            .iter()
            .take_while(|call| !call.starts_with("sync h5"))
            .collect::<Vec<_>>();
        assert!(
            removed
                .iter()
                .all(|call| ["unlink json", "unlink h5", "sync folder"].contains(&call.as_str())),
            "{removed:?}"
        );
        0.0
    });
    assert!(!commits.is_empty(), "no checkpoint is seen");
    tried.figure(|_| "file, record, names, folder synced in this order".into())
}

/// A disk that takes a twentieth of a second for each sync.
pub fn slow(ground: &Ground, _: usize) -> Tried {
    let whole = ground.whole(1);
    let trial = ground.trial(1);
    let slow = [
        "-e",
        "trace=fsync,fdatasync",
        "-e",
        "inject=fsync,fdatasync:delay_exit=50000",
    ];
    if traced(&trial, &slow).is_none() {
        return Tried::not("no strace");
    }
    let tried = trials(1, |_| {
        same(&results(&trial.directory()), &whole.results);
        let timers = manifest(&trial.directory()).timers;
        let share = timers.get("checkpoints").copied().unwrap_or_default();
        assert!(share > 1.0, "run.json reports {share} s of checkpoints");
        share
    });
    tried.figure(|seconds| format!("run.json reports {seconds} s of checkpoints"))
}
