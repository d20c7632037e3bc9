//! Tests `bsmpm slurm` without Slurm.

use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const CASE: &str = include_str!("../../../cases/short/strip_footing.toml");

/// Names that a shell, a launcher or an option parser could take for something else.
const HOSTILE: [&[u8]; 12] = [
    b"$(touch pwned).toml",
    b"`touch pwned`.toml",
    b";touch pwned;.toml",
    b"a b\tc.toml",
    b"line\n#SBATCH --uid=0\ntouch pwned\n.toml",
    b"it's \"quoted\".toml",
    b"back\\slash\\.toml",
    b"-n 8.toml",
    b"--help.toml",
    b"*?[a-z]{x,y}~.toml",
    b"|&<>#!%j.toml",
    b"\xff\xfe no UTF-8.toml",
];

struct Scratch(tempfile::TempDir);

impl Scratch {
    fn new() -> Self {
        let scratch = Self(tempfile::tempdir().unwrap());
        std::fs::create_dir(scratch.path("bin")).unwrap();
        // Both tell what they were called with, every word ended by a NUL.
        scratch.program("srun", "printf '%s\\0' \"$@\" >>srun.arguments\nexit \"$(cat code)\"");
        scratch.program(
            "scontrol",
            "printf '%s\\0' \"$@\" >>scontrol.arguments\nexit \"$(cat requeued)\"",
        );
        std::fs::write(scratch.path("case.toml"), CASE).unwrap();
        scratch
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn program(&self, name: &str, lines: &str) {
        let path = self.path("bin").join(name);
        std::fs::write(&path, format!("#!/bin/sh\n{lines}\n")).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    }

    fn bsmpm(&self, arguments: &[&OsStr]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bsmpm"));
        command
            .arg("slurm")
            .args(arguments)
            .current_dir(self.0.path())
            .output()
            .unwrap()
    }

    /// The script for these words of a command line.
    fn script(&self, arguments: &[&str]) -> String {
        let output = self.bsmpm(&arguments.iter().map(OsStr::new).collect::<Vec<_>>());
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs a script as a job whose run ends with `code`; its own code, and what srun and scontrol were given.
    fn job(&self, script: &[u8], code: u8, requeued: u8) -> (Option<i32>, Vec<Vec<u8>>, Vec<Vec<u8>>) {
        std::fs::write(self.path("job.sh"), script).unwrap();
        std::fs::write(self.path("code"), code.to_string()).unwrap();
        std::fs::write(self.path("requeued"), requeued.to_string()).unwrap();
        let path = format!("{}:/usr/bin:/bin", self.path("bin").display());
        let mut command = Command::new("bash");
        command
            .arg("job.sh")
            .env("PATH", path)
            .env("SLURM_JOB_ID", "4711")
            .current_dir(self.0.path());
        let output = command.output().unwrap();
        let arguments = |name: &str| {
            let bytes = std::fs::read(self.path(name)).unwrap_or_default();
            _ = std::fs::remove_file(self.path(name));
            let mut words: Vec<Vec<u8>> = bytes.split(|byte| *byte == 0).map(<[u8]>::to_vec).collect();
            words.pop();
            words
        };
        (
            output.status.code(),
            arguments("srun.arguments"),
            arguments("scontrol.arguments"),
        )
    }
}

/// Without a fault that bash or, where it is, shellcheck knows of.
#[track_caller]
fn sound(scratch: &Scratch, script: &[u8]) {
    let path = scratch.path("checked.sh");
    std::fs::write(&path, script).unwrap();
    let check = |program: &str, options: &[&str]| Command::new(program).args(options).arg(&path).output();
    let output = check("bash", &["-n"]).unwrap();
    assert!(output.status.success(), "{output:?}");
    // That nothing expands in quotes (SC2016) is what is wanted; and only UTF-8 is read.
    let lint = check("shellcheck", &["--shell=bash", "--exclude=SC2016"]);
    if let (Ok(output), Ok(_)) = (lint, std::str::from_utf8(script)) {
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    }
}

#[test]
fn the_script_is_as_the_documentation_says() {
    let scratch = Scratch::new();
    let script = scratch.script(&["case.toml", "-n", "8", "-t", "24:00:00"]);
    let expected = "#!/bin/bash\n\
                    #SBATCH --job-name=case\n\
                    #SBATCH --ntasks=8\n\
                    #SBATCH --time=24:00:00\n\
                    #SBATCH --requeue\n\
                    #SBATCH --open-mode=append\n\
                    #SBATCH --signal=USR1@300\n\n\
                    export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1\n\
                    srun bsmpm-par case.toml -o case.out --restart auto --max-wall 23:50:00\n\
                    rc=$?\n\
                    # 75: stopped in time, with a good checkpoint. Every other end is the job's own.\n\
                    if [ \"$rc\" -eq 75 ]; then\n    scontrol requeue \"$SLURM_JOB_ID\" && exit 0\nfi\n\
                    exit \"$rc\"\n";
    assert_eq!(script, expected);
    sound(&scratch, script.as_bytes());
}

#[test]
fn only_75_is_queued_again() {
    let scratch = Scratch::new();
    let script = scratch.script(&["case.toml", "-n", "8", "-t", "24:00:00"]);
    let requeue = ["requeue", "4711"].map(|word| word.as_bytes().to_vec()).to_vec();
    assert_eq!(scratch.job(script.as_bytes(), 75, 0).0, Some(0));
    assert_eq!(scratch.job(script.as_bytes(), 75, 0).2, requeue, "once");
    assert_eq!(
        scratch.job(script.as_bytes(), 75, 1).0,
        Some(75),
        "where Slurm does not take it back, that is reported"
    );
    for code in [0, 1, 2, 65, 70, 71, 73, 74, 76, 77, 80, 81, 137] {
        let (own, _, requeued) = scratch.job(script.as_bytes(), code, 0);
        assert_eq!((own, requeued.len()), (Some(code.into()), 0));
    }
}

#[test]
fn options_arrive_in_the_job() {
    let scratch = Scratch::new();
    let arguments = [
        "case.toml",
        "-n",
        "4",
        "-t",
        "1-00:10:00",
        "-o",
        "my run",
        "--name",
        "a b/$c",
        "--set",
        "grid.cell=0.25 m",
    ];
    let script = scratch.script(&[&arguments[..], &["--", "srun", "--mpi=pmix", "/opt/x y/bsmpm-par"]].concat());
    for line in [
        "--job-name=a_b__c",
        "--ntasks=4",
        "--time=24:10:00",
        "--signal=USR1@300",
    ] {
        assert!(script.contains(&format!("#SBATCH {line}\n")), "{script}");
    }
    sound(&scratch, script.as_bytes());
    let (_, arguments, _) = scratch.job(script.as_bytes(), 0, 0);
    let arguments: Vec<String> = arguments
        .into_iter()
        .map(|word| String::from_utf8(word).unwrap())
        .collect();
    let expected = [
        "--mpi=pmix",
        "/opt/x y/bsmpm-par",
        "case.toml",
        "-o",
        "my run",
        "--restart",
        "auto",
        "--max-wall",
        "24:00:00",
    ];
    assert_eq!(arguments, [&expected[..], &["--set=grid.cell=0.25 m"]].concat());
}

#[test]
fn short_jobs_stop_in_time_too() {
    let scratch = Scratch::new();
    for (time, notice, wall) in [
        ("00:20:00", 300, "00:10:00"),
        ("00:10:00", 150, "00:05:00"),
        ("00:02:00", 30, "00:01:00"),
    ] {
        let script = scratch.script(&["case.toml", "-n", "4", "-t", time]);
        assert!(
            script.contains(&format!("USR1@{notice}\n")) && script.contains(&format!("--max-wall {wall}\n")),
            "{script}"
        );
    }
}

#[test]
fn s2_hostile_names_are_words_and_nothing_else() {
    let scratch = Scratch::new();
    for name in HOSTILE {
        let name = OsStr::from_bytes(name);
        std::fs::write(scratch.0.path().join(name), CASE).unwrap();
        let path = Path::new(".").join(name);
        let output = scratch.bsmpm(
            &["-n", "2", "-t", "01:00:00", "-o", "$(touch pwned)", "--"].map(OsStr::new)[..6]
                .iter()
                .copied()
                .chain([path.as_os_str()])
                .collect::<Vec<_>>(),
        );
        assert!(output.status.success(), "{output:?}");
        let script = output.stdout;
        sound(&scratch, &script);
        // Lines of Slurm's own before the first command: the same as for any other name.
        let head = script
            .split(|byte| *byte == b'\n')
            .take_while(|line| !line.starts_with(b"export"));
        assert_eq!(
            head.filter(|line| line.starts_with(b"#SBATCH --")).count(),
            6,
            "{name:?}"
        );
        let job_name = script
            .split(|byte| *byte == b'\n')
            .nth(1)
            .unwrap()
            .strip_prefix(b"#SBATCH --job-name=")
            .unwrap();
        let is_plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"._-".contains(byte);
        assert!(
            !job_name.is_empty() && job_name.iter().all(is_plain) && job_name[0] != b'-',
            "{job_name:?}"
        );
        let (code, arguments, _) = scratch.job(&script, 0, 0);
        assert_eq!(code, Some(0));
        assert_eq!(
            OsString::from_vec(arguments[1].clone()),
            path.as_os_str(),
            "byte for byte"
        );
        assert_eq!(arguments[3], b"$(touch pwned)");
        assert!(!scratch.path("pwned").exists());
    }
}

#[test]
fn a_name_that_looks_like_an_option_is_a_file() {
    let scratch = Scratch::new();
    std::fs::write(scratch.path("-q.toml"), CASE).unwrap();
    let script = scratch.script(&["./-q.toml", "-n", "2", "-t", "01:00:00", "--output=-v"]);
    assert!(script.contains("bsmpm-par ./-q.toml -o ./-v --restart"), "{script}");
    assert!(script.contains("--job-name=q\n"), "{script}");
}

#[test]
fn a_wrong_case_or_command_line_writes_nothing() {
    let scratch = Scratch::new();
    std::fs::write(scratch.path("bad.toml"), CASE.replace("[grid]", "[gird]")).unwrap();
    let rows: [(&[&str], i32, &str); 8] = [
        (&["bad.toml", "-n", "2", "-t", "01:00:00"], 65, "did you mean `grid`?"),
        (
            &["case.toml", "-n", "2", "-t", "01:00:00", "--set", "grid.cell=0"],
            65,
            "error E0010: grid.cell",
        ),
        (&["none.toml", "-n", "2", "-t", "01:00:00"], 66, "none.toml"),
        (&["case.toml", "-n", "0", "-t", "01:00:00"], 2, "0"),
        (&["case.toml", "-n", "2", "-t", "90"], 2, "Use HH:MM:SS or D-HH:MM:SS"),
        (&["case.toml", "-n", "2", "-t", "00:61:00"], 2, "Use HH:MM:SS"),
        (&["case.toml", "-n", "2", "-t", "00:00:30"], 2, "too short"),
        (&["case.toml", "-n", "2"], 2, "--time"),
    ];
    for (arguments, code, says) in rows {
        let script = scratch.path("job.sh");
        let all: Vec<&OsStr> = arguments
            .iter()
            .map(OsStr::new)
            .chain([OsStr::new("--script"), script.as_os_str()])
            .collect();
        let output = scratch.bsmpm(&all);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
        assert!(
            said.contains(says) && output.stdout.is_empty() && !script.exists(),
            "{arguments:?}: {said}"
        );
    }
}

#[test]
fn a_script_that_is_there_is_not_written_over() {
    let scratch = Scratch::new();
    let arguments = ["case.toml", "-n", "2", "-t", "01:00:00", "--script", "job.sh"].map(OsStr::new);
    let output = scratch.bsmpm(&arguments);
    assert!(output.status.success() && output.stdout.is_empty(), "{output:?}");
    let script = std::fs::read(scratch.path("job.sh")).unwrap();
    sound(&scratch, &script);
    std::fs::write(scratch.path("job.sh"), "mine").unwrap();
    assert_eq!(scratch.bsmpm(&arguments).status.code(), Some(74));
    assert_eq!(std::fs::read(scratch.path("job.sh")).unwrap(), b"mine");
}

#[test]
fn more_ranks_than_the_case_has_use_for_are_warned_of() {
    let scratch = Scratch::new();
    let warned = |ranks: &str| {
        let output = scratch.bsmpm(&["case.toml", "-n", ranks, "-t", "01:00:00"].map(OsStr::new));
        assert!(output.status.success() && !output.stdout.is_empty(), "{output:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    assert_eq!(warned("1"), "");
    assert!(
        warned("8").contains("W0856: the run is not faster on 8 ranks than on about 1"),
        "{}",
        warned("8")
    );
    assert!(
        warned("67").contains("W0855") && warned("67").contains("at most 11 ranks"),
        "{}",
        warned("67")
    );
}
