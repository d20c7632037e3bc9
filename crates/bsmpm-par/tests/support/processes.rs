//! One run at a time, in a process group of its own, which never outlives its test.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Set in every process of a run, so that it is found whatever its group or parent.
const MARK: &str = "BSMPM_TEST_RUN";
/// What a developer's environment might hold and a run must not see.
const REMOVED: [&str; 3] = ["BSMPM_FAULT", "PETSC_OPTIONS", "PETSC_OPTIONS_YAML"];

/// Two cores: runs of one test program wait for each other.
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

/// Runs a command to its end. Panics if that does not come within `patience`, or if a process outlives the run. What
/// is said goes to `/dev/full` if nobody is to hear it.
pub fn run(mut command: Command, variables: &[(String, String)], heard: bool, patience: Duration) -> Output {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let mark = format!("{}-{}", std::process::id(), RUNS.fetch_add(1, Ordering::Relaxed));
    let (mut stdout, mut stderr) = (tempfile::tempfile().unwrap(), tempfile::tempfile().unwrap());
    command.process_group(0);
    command.env("OMP_NUM_THREADS", "1").env(MARK, &mark);
    command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    // Shared memory will do; looking for faster networks takes most of the time of a start.
    command.env("OMPI_MCA_pml", "ob1");
    // Nor does mpirun wait a second for ranks to go after one has left with an error: they have nothing left to do then.
    command.env("OMPI_MCA_odls_base_sigkill_timeout", "0");
    for name in REMOVED {
        command.env_remove(name);
    }
    command.envs(variables.iter().map(|(name, value)| (name, value)));
    let stream = |file: &File| if heard { file.try_clone() } else { File::options().write(true).open("/dev/full") };
    command.stdin(Stdio::null()).stdout(stream(&stdout).unwrap()).stderr(stream(&stderr).unwrap());
    let started = Instant::now();
    let mut child = command.spawn().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let status = wait(&mut child, patience);
    let elapsed = started.elapsed();
    if status.is_none() {
        end_group(&mut child);
    }
    let left = survivors(&mark);
    left.iter().for_each(|process| signal("KILL", process));
    let output = Output {
        code: status.and_then(|status| status.code()),
        stdout: text(&mut stdout),
        stderr: text(&mut stderr),
        elapsed,
    };
    assert!(status.is_some(), "hangs: {command:?}: {output:#?}");
    assert!(left.is_empty(), "processes {left:?} outlive their run: {command:?}: {output:#?}");
    output
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
    let mark = format!("{MARK}={mark}\0");
    let started = Instant::now();
    loop {
        let left = marked(mark.as_bytes());
        if left.is_empty() || started.elapsed() > Duration::from_secs(3) {
            return left;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Numbers of the living processes whose environment holds `mark`; a zombie has none.
fn marked(mark: &[u8]) -> Vec<String> {
    let processes = std::fs::read_dir("/proc").unwrap().filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let numbers = processes.filter(|name| name.bytes().all(|byte| byte.is_ascii_digit()));
    let holds = |number: &String| {
        let environment = std::fs::read(format!("/proc/{number}/environ")).unwrap_or_default();
        environment.windows(mark.len()).any(|part| part == mark)
    };
    numbers.filter(holds).collect()
}

fn text(file: &mut File) -> String {
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(0)).and_then(|_| file.read_to_end(&mut bytes)).unwrap();
    String::from_utf8_lossy(&bytes).into_owned()
}
