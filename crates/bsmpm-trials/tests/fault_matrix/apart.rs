//! Tests of ranks that do not see the same files.

use crate::ground::{Ground, RUN, Trial, results, same};
use crate::support::{Ears, Output, processes, program};
use crate::table::{Tried, trials};
use std::process::{Command, Stdio};
use std::time::Duration;

/// s  Within which all ranks are to have ended.
const SOON: f64 = 10.0;

/// Runs on `ranks` ranks, of which one has an empty folder in the place of `folder`.
fn start(trial: &Trial, ranks: usize, blind: usize, folder: &str, arguments: &[&str]) -> Output {
    let mut launcher = Command::new("mpirun");
    launcher
        .args(["-q", "--oversubscribe"])
        .current_dir(trial.scratch.path(""));
    for rank in 0..ranks {
        launcher
            .args(if rank == 0 { &[][..] } else { &[":"] })
            .args(["-n", "1"]);
        if rank == blind {
            let line = format!("mount -t tmpfs none {folder} && exec \"$0\" \"$@\"");
            launcher.args(["unshare", "--mount", "sh", "-c", &line]);
        }
        launcher.arg(program()).args(arguments);
    }
    processes::start_beside(launcher, &[], Ears::Open, Duration::from_secs(60)).end()
}

/// Whether a process may have a view of the file system of its own.
fn may() -> bool {
    let mut probe = Command::new("unshare");
    probe
        .args(["--mount", "mount", "-t", "tmpfs", "none", "/mnt"])
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    probe.status().is_ok_and(|status| status.success())
}

/// What one rank does not see, how many ranks there are and which one it is, the exit code, and what is said once.
const WAYS: [(&str, (usize, usize), i32, &str); 5] = [
    ("auto", (2, 1), 76, "rank 1 cannot read it"),
    ("named", (3, 1), 76, "rank 1 cannot read it"),
    ("case", (2, 0), 66, "kept/case.toml"),
    ("case", (2, 1), 75, ""),
    ("directory", (2, 1), 74, "rank 1 cannot write"),
];

/// The checkpoint, by name and by auto, the case, and the directory itself, each unreadable on one rank.
pub fn files(ground: &Ground, _: usize) -> Tried {
    if !may() {
        return Tried::not("no right to mount");
    }
    let whole = ground.whole(2);
    let tried = trials(WAYS.len(), |index| {
        let (way, ranks, code, words) = WAYS[index];
        let trial = if ["auto", "named"].contains(&way) {
            ground.stopped(2, 10)
        } else {
            ground.trial(2)
        };
        std::fs::create_dir(trial.scratch.path("kept")).unwrap();
        trial.scratch.write("kept/case.toml", ground.text());
        std::fs::create_dir_all(trial.directory()).unwrap();
        let file = trial.checkpoint("step_000000010.h5");
        let (folder, from) = match way {
            "case" => ("kept", "auto"),
            "directory" => (RUN, "auto"),
            "auto" => ("run/checkpoint", "auto"),
            _ => ("run/checkpoint", file.to_str().unwrap()),
        };
        let arguments = [
            "kept/case.toml",
            "-q",
            "-o",
            RUN,
            "--restart",
            from,
            "--max-steps",
            "12",
        ];
        let output = start(&trial, ranks.0, ranks.1, folder, &arguments).expect(code);
        let seconds = output.elapsed.as_secs_f64();
        if !words.is_empty() {
            output.says_once(words);
        }
        // Those that are refused end at once; the others make some steps.
        assert!(seconds < SOON || code == 75, "{seconds} s");
        trial.finish();
        same(&results(&trial.directory()), &whole.results);
        if code == 75 { 0.0 } else { seconds }
    });
    tried
        .figure(|seconds| format!("one error, after {seconds} s at most; then B"))
        .remark("the case is read by rank 0 only")
}
