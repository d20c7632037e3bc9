//! Runs processes in turn, each in a process group.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Set in every process of a run, so that it is found whatever its group or parent.
const MARK: &str = "BSMPM_TEST_RUN";
/// What a developer's environment might hold and a run must not see.
const REMOVED: [&str; 4] = ["BSMPM_FAULT", "BSMPM_LANES", "PETSC_OPTIONS", "PETSC_OPTIONS_YAML"];

/// Two cores: runs wait for each other.
static TURN: Mutex<()> = Mutex::new(());
static RUNS: AtomicUsize = AtomicUsize::new(0);

/// What a run said and how it ended.
#[derive(Debug)]
pub struct Output {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
    pub elapsed: Duration,
}

impl Output {
    /// Both streams.
    pub fn said(&self) -> String {
        format!("{}{}", self.stdout, self.stderr)
    }

    /// How often a text was said.
    pub fn count(&self, text: &str) -> usize {
        self.said().matches(text).count()
    }

    /// Asserts the exit code, and shows what was said if it is another.
    #[track_caller]
    pub fn expect(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{self:#?}");
        self
    }

    /// Asserts that a text was said exactly once.
    #[track_caller]
    pub fn says_once(&self, text: &str) {
        assert_eq!(self.count(text), 1, "{text:?} is to be said once: {self:#?}");
    }
}

/// Where what a run says goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ears {
    /// Into its [`Output`].
    Open,
    /// To `/dev/full`: every write fails.
    Full,
    /// Into a pipe that nobody reads any more: every write fails, and raises SIGPIPE.
    Gone,
}

/// A run that goes on; it is killed with all its processes if it is dropped before its end.
pub struct Running {
    line: String,
    child: Child,
    mark: String,
    stdout: File,
    stderr: File,
    started: Instant,
    patience: Duration,
    ended: bool,
    _turn: Option<MutexGuard<'static, ()>>,
}

/// Runs a command to its end. Panics if that does not come within `patience`, or if a process outlives the run. What
/// is said goes to `/dev/full` if nobody is to hear it.
pub fn run(command: Command, variables: &[(String, String)], heard: bool, patience: Duration) -> Output {
    start(
        command,
        variables,
        if heard { Ears::Open } else { Ears::Full },
        patience,
    )
    .end()
}

/// Waits until all runs that were started in turn have ended, and holds back the next ones: for what starts runs by
/// itself.
pub fn turn() -> MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts a command when all runs that were started so before have ended.
pub fn start(command: Command, variables: &[(String, String)], ears: Ears, patience: Duration) -> Running {
    let turn = turn();
    let mut running = start_beside(command, variables, ears, patience);
    running._turn = Some(turn);
    running
}

/// Starts a command at once, beside others.
pub fn start_beside(mut command: Command, variables: &[(String, String)], ears: Ears, patience: Duration) -> Running {
    let mark = format!("{}-{}", std::process::id(), RUNS.fetch_add(1, Ordering::Relaxed));
    let stdout = tempfile::tempfile().unwrap();
    let stderr = tempfile::tempfile().unwrap();
    command.process_group(0);
    command.env("OMP_NUM_THREADS", "1").env(MARK, &mark);
    command
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    // Shared memory will do; looking for faster networks takes most of the time of a start.
    command.env("OMPI_MCA_pml", "ob1");
    // Nor does mpirun wait a second for ranks to go after one has left with an error: they have nothing left to do
    // then.
    command.env("OMPI_MCA_odls_base_sigkill_timeout", "0");
    for name in REMOVED {
        command.env_remove(name);
    }
    command.envs(variables.iter().map(|(name, value)| (name, value)));
    let stream = |file: &File| match ears {
        Ears::Open => Stdio::from(file.try_clone().unwrap()),
        Ears::Full => File::options().write(true).open("/dev/full").unwrap().into(),
        Ears::Gone => std::io::pipe().unwrap().1.into(),
    };
    command
        .stdin(Stdio::null())
        .stdout(stream(&stdout))
        .stderr(stream(&stderr));
    let started = Instant::now();
    let line = format!("{command:?}");
    let child = command.spawn().unwrap_or_else(|error| panic!("{line}: {error}"));
    Running {
        line,
        child,
        mark,
        stdout,
        stderr,
        started,
        patience,
        ended: false,
        _turn: None,
    }
}

impl Running {
    /// Waits until something holds. Panics if the run ends before, or if it takes longer than the run's patience.
    #[track_caller]
    pub fn until(&mut self, what: &str, mut holds: impl FnMut() -> bool) {
        let started = Instant::now();
        while !holds() {
            let ended = self.child.try_wait().unwrap();
            assert!(
                ended.is_none(),
                "ended before {what}: {}: {}",
                self.line,
                text(&mut self.stderr)
            );
            assert!(
                started.elapsed() < self.patience,
                "waits in vain for {what}: {}",
                self.line
            );
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Whether it has not ended yet.
    pub fn goes_on(&mut self) -> bool {
        self.child.try_wait().unwrap().is_none()
    }

    /// Sends a signal, e.g. `USR1`, to the command that was started.
    pub fn signal(&self, name: &str) {
        signal(name, &self.child.id().to_string());
    }

    /// Sends a signal to the process of one rank.
    #[track_caller]
    pub fn signal_rank(&self, name: &str, rank: usize) {
        let process = rank_of(&self.mark, rank).unwrap_or_else(|| panic!("no rank {rank}: {}", self.line));
        signal(name, &process);
    }

    /// Kills all of its processes at once.
    pub fn kill(&self) {
        marked(&mark_of(&self.mark))
            .iter()
            .for_each(|process| signal("KILL", process));
    }

    /// Waits for the end. Panics if that does not come in time, or if a process outlives the run.
    #[track_caller]
    pub fn end(mut self) -> Output {
        let status = wait(&mut self.child, self.patience);
        let elapsed = self.started.elapsed();
        let left = self.clear(status.is_none());
        let output = Output {
            code: status.and_then(|status| status.code()),
            stdout: text(&mut self.stdout),
            stderr: text(&mut self.stderr),
            elapsed,
        };
        assert!(status.is_some(), "hangs: {}: {output:#?}", self.line);
        assert!(
            left.is_empty(),
            "processes {left:?} outlive their run: {}: {output:#?}",
            self.line
        );
        output
    }

    /// Leaves no process; those that had outlived the command.
    fn clear(&mut self, hangs: bool) -> Vec<String> {
        self.ended = true;
        if hangs {
            end_group(&mut self.child);
        }
        let left = survivors(&self.mark);
        left.iter().for_each(|process| signal("KILL", process));
        left
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if !self.ended {
            self.clear(true);
        }
    }
}

fn wait(child: &mut Child, patience: Duration) -> Option<ExitStatus> {
    let started = Instant::now();
    while started.elapsed() < patience {
        if let Some(status) = child.try_wait().unwrap() {
            return Some(status);
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    None
}

/// mpirun ends its ranks when it is asked to end; the group is killed in any case.
fn end_group(child: &mut Child) {
    signal("TERM", &child.id().to_string());
    wait(child, Duration::from_secs(5));
    signal("KILL", &format!("-{}", child.id()));
    wait(child, Duration::from_secs(5));
}

fn signal(name: &str, process: &str) {
    let line = format!("kill -s {name} -- {process}");
    // It may be gone by now.
    let _ = Command::new("sh").args(["-c", &line]).stderr(Stdio::null()).status();
}

/// Processes of the run that are still there, after the moment that the system needs to take them away.
fn survivors(mark: &str) -> Vec<String> {
    let mark = mark_of(mark);
    let started = Instant::now();
    loop {
        let left = marked(&mark);
        if left.is_empty() || started.elapsed() > Duration::from_secs(3) {
            return left;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// What stands in the environment of a run's processes.
fn mark_of(mark: &str) -> Vec<u8> {
    format!("{MARK}={mark}\0").into_bytes()
}

/// Number of the process of one rank; without a launcher there is rank 0 only.
fn rank_of(mark: &str, rank: usize) -> Option<String> {
    let processes = marked(&mark_of(mark));
    let is_rank = |process: &&String| {
        let environment = std::fs::read(format!("/proc/{process}/environ")).unwrap_or_default();
        let reported = environment
            .split(|&byte| byte == 0)
            .find_map(|entry| entry.strip_prefix(b"OMPI_COMM_WORLD_RANK="));
        let name = std::fs::read_to_string(format!("/proc/{process}/comm")).unwrap_or_default();
        name.trim() == "bsmpm-par" && reported.unwrap_or(b"0") == rank.to_string().as_bytes()
    };
    processes.iter().find(is_rank).cloned()
}

/// Numbers of the living processes whose environment holds `mark`; a zombie has none.
fn marked(mark: &[u8]) -> Vec<String> {
    let processes = std::fs::read_dir("/proc")
        .unwrap()
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let numbers = processes.filter(|name| name.bytes().all(|byte| byte.is_ascii_digit()));
    let holds = |number: &String| {
        let environment = std::fs::read(format!("/proc/{number}/environ")).unwrap_or_default();
        environment.windows(mark.len()).any(|part| part == mark)
    };
    numbers.filter(holds).collect()
}

fn text(file: &mut File) -> String {
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(0))
        .and_then(|_| file.read_to_end(&mut bytes))
        .unwrap();
    String::from_utf8_lossy(&bytes).into_owned()
}
