//! Output places: permissions, other runs, locks, hosts.

use crate::ground::{Ground, RUN, results, same};
use crate::support::cases::{SLIDING_BLOCK, changed};
use crate::support::results::manifest;
use crate::support::{Ears, Scratch, processes, program, shipped};
use crate::table::{Tried, trials};
use std::fs::{Permissions, set_permissions};
use std::os::unix::fs::PermissionsExt;
use std::process::Command;
use std::time::Duration;

/// The user and group that own nothing.
const NOBODY: &str = "65534";

fn allow(scratch: &Scratch, name: &str, mode: u32) {
    set_permissions(scratch.path(name), Permissions::from_mode(mode)).unwrap();
}

/// Output directories that cannot be written to, as a user who is not root.
pub fn no_permission(ground: &Ground, _: usize) -> Tried {
    let ways = [
        "read-only directory",
        "forbidden parent",
        "file in its place",
        "file in the place of its parent",
    ];
    let tried = trials(ways.len(), |index| {
        let trial = ground.trial(1);
        let scratch = &trial.scratch;
        allow(scratch, "", 0o755);
        let path = match ways[index] {
            "read-only directory" => {
                std::fs::create_dir(scratch.path("there")).unwrap();
                allow(scratch, "there", 0o555);
                "there"
            }
            "forbidden parent" => {
                std::fs::create_dir(scratch.path("parent")).unwrap();
                allow(scratch, "parent", 0o555);
                "parent/there"
            }
            "file in its place" => {
                scratch.write("there", "");
                "there"
            }
            _ => {
                scratch.write("parent", "");
                "parent/there"
            }
        };
        let mut command = Command::new("setpriv");
        command.args([
            "--reuid",
            NOBODY,
            "--regid",
            NOBODY,
            "--clear-groups",
            program(),
            "case.toml",
            "-q",
            "-o",
            path,
        ]);
        command
            .current_dir(scratch.path(""))
            .env("TMPDIR", "/tmp")
            .env("HOME", "/");
        let output = processes::start_beside(command, &[], Ears::Open, Duration::from_secs(30))
            .end()
            .expect(73);
        assert!(output.said().contains(path.split('/').next().unwrap()), "{output:?}");
        output.elapsed.as_secs_f64()
    });
    tried.figure(|seconds| format!("73 after {seconds} s at most"))
}

/// A second run in the same directory while the first goes on.
pub fn second_run(ground: &Ground, count: usize) -> Tried {
    let whole = ground.whole(2);
    let tried = trials(count, |_| {
        let trial = ground.trial(2);
        let running = trial.under_way(2, 0.0, &[]);
        let second = trial.job(&[]).start_beside().end().expect(73);
        second.says_once("is in use by");
        running.end().expect(0);
        same(&results(&trial.directory()), &whole.results);
        second.elapsed.as_secs_f64()
    });
    tried
        .figure(|seconds| format!("73 after {seconds} s at most; the first: B"))
        .remark("twenty at once: tests/trials/lock.rs")
}

/// The lock of a run that was killed on another host.
pub fn stale_lock(ground: &Ground, count: usize) -> Tried {
    let whole = ground.whole(2);
    let tried = trials(count, |_| {
        let trial = ground.trial(2);
        let running = trial.under_way(7, 0.0, &[]);
        running.kill();
        running.end();
        let lock = trial.directory().join(".lock");
        let mut holder: serde_json::Value = serde_json::from_slice(&std::fs::read(&lock).unwrap()).unwrap();
        holder["host"] = "elsewhere".into();
        std::fs::write(&lock, holder.to_string()).unwrap();
        trial.start(&[], &[]).end().expect(73).says_once("--break-lock");
        trial.start(&["--break-lock"], &[]).end().expect(0);
        trial.becomes(&whole) as f64
    });
    tried
        .figure(|_| "73 with the advice; --break-lock: B".into())
        .remark("of this host: every row that kills all")
}

/// More ranks than there is material, or columns of cells.
pub fn idle_ranks(_: &Ground, _: usize) -> Tried {
    let tried = trials(2, |index| {
        if index == 0 {
            let scratch = Scratch::with_case(&changed(SLIDING_BLOCK, "upper = [0.5, 0.2]", "upper = [0.2, 0.2]"));
            let run = |name: &str, further: &[&str], code: i32| {
                let arguments = [&["case.toml", "-q", "-o", name, "--restart", "auto"], further].concat();
                scratch.mpirun(4, &arguments).expect(code);
            };
            let end = ["--set", "output.checkpoint={every_steps=10}"];
            run("whole", &end, 0);
            run("part", &["--max-steps", "20"], 75);
            run("part", &end, 0);
            same(&results(&scratch.path("part")), &results(&scratch.path("whole")));
        } else {
            let scratch = Scratch::new();
            let case = shipped("short/self_weight_column.toml");
            let output = scratch.mpirun(11, &[case.to_str().unwrap()]).expect(65);
            assert!(output.said().contains("ranks"), "{output:?}");
        }
        0.0
    });
    tried.figure(|_| "ranks without points: B; too many ranks: 65".into())
}

/// A case that needs more memory than it may have.
pub fn memory(ground: &Ground, _: usize) -> Tried {
    let tried = trials(2, |index| {
        let trial = ground.trial(1);
        let output = if index == 0 {
            trial.scratch.direct(&["case.toml", "-q", "--max-memory", "5MB"])
        } else {
            // 2.9 million points, some GB, for a process that may have 1.5 GB.
            let line = format!(
                "ulimit -v 1500000; exec {} case.toml -q --set body.0.points_per_cell=60",
                program()
            );
            let mut command = Command::new("bash");
            command.args(["-c", &line]).current_dir(trial.scratch.path(""));
            processes::start_beside(command, &[], Ears::Open, Duration::from_secs(60)).end()
        };
        let seconds = output.elapsed.as_secs_f64();
        output.expect(71);
        assert_eq!(trial.scratch.entries(), ["case.toml"]);
        seconds
    });
    tried
        .figure(|seconds| format!("71 after {seconds} s at most"))
        .remark("the estimate: bsmpm-scene/tests/shipped.rs")
}

/// Streams that take nothing any more.
pub fn unheard(ground: &Ground, _: usize) -> Tried {
    let whole = ground.whole(2);
    let tried = trials(2, |index| {
        let trial = ground.trial(2);
        let job = trial.job(&[]);
        let job = if index == 0 { job.unheard() } else { job.abandoned() };
        job.run().expect(0);
        same(&results(&trial.directory()), &whole.results);
        0.0
    });
    tried.figure(|_| "a full disk, a reader that is gone: B".into())
}

/// A library whose clocks, those that people set, are a day ahead or behind, and change that all the time.
const SET_CLOCKS: &str = r#"#define _GNU_SOURCE
#include <dlfcn.h>
#include <sys/time.h>
#include <time.h>
static long jump(void) { static unsigned calls; return ++calls / 20 % 2 ? 86400 : -86400; }
int clock_gettime(clockid_t id, struct timespec *t) {
    int (*real)(clockid_t, struct timespec *) = (int (*)(clockid_t, struct timespec *))dlsym(RTLD_NEXT, "clock_gettime");
    int code = real(id, t);
    if (id == CLOCK_REALTIME || id == CLOCK_REALTIME_COARSE) t->tv_sec += jump();
    return code;
}
int gettimeofday(struct timeval *t, void *zone) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    t->tv_sec = now.tv_sec, t->tv_usec = now.tv_nsec / 1000;
    return 0;
}
time_t time(time_t *t) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    if (t) *t = now.tv_sec;
    return now.tv_sec;
}
"#;

/// The clock that limits a run is not one that people set.
pub fn clock(ground: &Ground, _: usize) -> Tried {
    let trial = ground.trial(1);
    let library = trial.scratch.path("clocks.so");
    trial.scratch.write("clocks.c", SET_CLOCKS);
    let mut compiler = Command::new("cc");
    compiler
        .args(["-shared", "-fPIC", "clocks.c", "-o", "clocks.so", "-ldl"])
        .current_dir(trial.scratch.path(""));
    if !compiler.status().is_ok_and(|status| status.success()) {
        return Tried::not("no C compiler");
    }
    let whole = ground.whole(1);
    let tried = trials(1, |_| {
        let mut command = Command::new(program());
        command.args([
            "case.toml",
            "-q",
            "-o",
            RUN,
            "--restart",
            "auto",
            "--max-wall",
            "00:10:00",
        ]);
        command.current_dir(trial.scratch.path("")).env("LD_PRELOAD", &library);
        let output = processes::start_beside(command, &[], Ears::Open, Duration::from_secs(120))
            .end()
            .expect(0);
        same(&results(&trial.directory()), &whole.results);
        let found = manifest(&trial.directory());
        let today = bsmpm_io::utc::now();
        assert_ne!(found.start[..10], today[..10], "the clock was set");
        let wall = found.timers["wall"];
        let elapsed = output.elapsed.as_secs_f64();
        assert!(
            (0.0..=elapsed).contains(&wall),
            "run.json reports {wall} s of {elapsed}"
        );
        0.0
    });
    tried.figure(|_| "days ahead and behind: no limit reached, B".into())
}

/// Material that leaves the grid: 81 with a checkpoint, from which it leaves again.
pub fn left(_: &Ground, _: usize) -> Tried {
    let open = changed(SLIDING_BLOCK, "right  = \"roller\"\n", "");
    let near = "lower = [0.75, 0.0], upper = [0.95, 0.2]";
    let case = changed(&open, "lower = [0.1, 0.0], upper = [0.5, 0.2]", near);
    let tried = trials(1, |_| {
        let scratch = Scratch::with_case(&case);
        let run = ["case.toml", "-q", "-o", RUN, "--restart", "auto"];
        scratch.mpirun(2, &run).expect(81);
        let before = std::fs::read(scratch.path(RUN).join("history.csv")).unwrap();
        for _ in 0..3 {
            scratch.mpirun(2, &run).expect(81);
            assert!(
                std::fs::read(scratch.path(RUN).join("history.csv")).unwrap() == before,
                "other steps"
            );
        }
        scratch.mpirun(2, &run).expect(72).says_once("restarts in a row");
        0.0
    });
    tried.figure(|_| "81 thrice more, to the bit; then 72: no loop".into())
}
