//! Tests that malicious or huge input is refused or has no effect.

use crate::support::Scratch;
use crate::support::cases::{COLUMN, changed};
use std::ffi::OsStr;
use std::os::unix::ffi::{OsStrExt, OsStringExt};

/// kB  of private memory that a refusal may map, its threads' stacks (1 MB) included; a page more and it fails. Its
/// whole resident memory was 39 MB, of which most are libraries; 50 MB are allowed.
const REFUSAL: &str = "-s 1024 && ulimit -d 40000";

/// Names of files that a shell, a parser or a terminal could take for something else.
const HOSTILE: [&[u8]; 30] = [
    b"$(touch pwned)",
    b"`touch pwned`",
    b";rm -rf x",
    b"& touch pwned &",
    b"| touch pwned",
    b"> pwned",
    b"a b",
    b" ",
    b"tab\there",
    b"line\nbreak",
    b"return\rhere",
    b"\x1b[31mred",
    b"bell\x07",
    b"'",
    b"\"",
    b"\\",
    b"it's \"quoted\"",
    b"--help",
    b"-o",
    b"~",
    b"*",
    b"?[a-z]{x,y}",
    b"#comment",
    b"%s%n",
    b"..evil",
    b"...",
    "\u{202e}lmot".as_bytes(),
    "\u{200b}".as_bytes(),
    b"\xff\xfe",
    &[b'x'; 240],
];

#[test]
fn i19_a_run_is_not_both_continued_and_replaced() {
    let scratch = Scratch::with_case(COLUMN);
    for restart in ["auto", "step.h5"] {
        let output = scratch
            .mpirun(2, &["case.toml", "--force", "--restart", restart])
            .expect(2);
        assert_eq!(output.count("error:"), 1, "{output:#?}");
        assert!(
            output.stderr.contains("--force") && output.stderr.contains("--restart"),
            "{output:#?}"
        );
    }
    assert_eq!(scratch.entries(), ["case.toml"]);
}

#[test]
fn i20_hostile_sizes_are_refused_at_once_in_little_memory() {
    let rows = [
        (
            &["grid.cell=[4e-6, 5e-6]"][..],
            "grid.cell: ",
            "2000008000008 unknowns (at most 2147483647",
        ),
        (
            &["grid.upper=[9223372036854775807, 5]"],
            "grid.upper: ",
            "error E0010: ",
        ),
        (
            &["grid.upper=[9223372036854775808, 5]"],
            "grid.upper: ",
            "error E0010: ",
        ),
        (
            &["grid.cell=1e-4"],
            "grid.cell: ",
            "2000000000 cells and 4000360008 unknowns",
        ),
        (
            &["grid.cell=5e-4", "body.0.points_per_cell=100"],
            "body: ",
            "640000000000 material points (at most",
        ),
        (
            &["body.0.points_per_cell=9223372036854775807"],
            "body.0.points_per_cell: ",
            "error E0010: ",
        ),
        (&["analysis.steps=1000000000000"], "analysis.steps: ", "error E0010: "),
    ];
    for (set, key, says) in rows {
        let scratch = Scratch::with_case(COLUMN);
        let arguments: Vec<&str> = ["case.toml"]
            .into_iter()
            .chain(set.iter().flat_map(|set| ["--set", set]))
            .collect();
        let output = scratch
            .job(Some(2), &arguments)
            .limited(REFUSAL)
            .within(30)
            .run()
            .expect(65);
        let reported: Vec<&str> = output.stderr.lines().filter(|line| line.contains(says)).collect();
        assert!(
            reported.len() == 1 && reported[0].contains(key),
            "{key}, {says}: {output:#?}"
        );
        output.says_once("nothing was run or written");
        assert_eq!(scratch.entries(), ["case.toml"]);
    }
    // The limit is one: with a fortieth of it not even the libraries start.
    let scratch = Scratch::with_case(COLUMN);
    let output = scratch
        .job(None, &["case.toml", "--check"])
        .limited("-s 1024 && ulimit -d 1000")
        .within(30)
        .run();
    assert_ne!(output.code, Some(0), "{output:#?}");
}

/// Within all bounds, and yet too large for any host: some 2 TB.
const VAST: [&str; 4] = ["--set", "grid.cell=\"0.2 mm\"", "--set", "body.0.points_per_cell=2"];

#[test]
fn i20_what_does_not_fit_into_the_memory_of_the_host_is_refused_once_with_71() {
    let scratch = Scratch::with_case(COLUMN);
    let run = |more: &[&str]| {
        scratch
            .job(Some(2), &[&["case.toml"], &VAST[..], more].concat())
            .limited(REFUSAL)
            .within(30)
            .run()
    };
    let output = run(&[]).expect(71);
    output.says_once("error E0702: the case needs too much memory: about ");
    output.says_once(" GiB on this computer (2 rank(s)), where ");
    output.says_once("Increase `grid.cell`, reduce `body.points_per_cell`, or use more computers.");
    run(&["--max-memory", "16GiB"])
        .expect(71)
        .says_once("and --max-memory allows 16.0 GiB");
    // It may be meant for another host.
    let output = run(&["--check"]).expect(0);
    output.says_once("warning W0724: the case needs too much memory: about ");
    output.says_once("unknowns         at most");
    run(&["--check", "--max-memory", "16GiB"]).expect(71);
    assert_eq!(scratch.entries(), ["case.toml"]);
}

/// A BLAS that gets no memory for its buffers may ask for it for ever: that must not be reached.
#[test]
fn f37_what_does_not_fit_into_the_limits_of_a_process_is_refused_once_with_71() {
    let scratch = Scratch::with_case(COLUMN);
    let large = [
        "case.toml",
        "--set",
        "grid.cell=\"20 mm\"",
        "--set",
        "body.0.points_per_cell=2",
    ];
    let rows: [(&[&str], &str); 3] = [
        (&large, "-v 600000"),
        (&["case.toml"], "-d 100000"),
        (&["case.toml", "--max-memory", "1GiB"], "-d 100000"),
    ];
    for (arguments, limit) in rows {
        for ranks in [None, Some(2)] {
            let output = scratch.job(ranks, arguments).limited(limit).within(30).run().expect(71);
            output.says_once("and `ulimit` allows 0.");
            assert_eq!(scratch.entries(), ["case.toml"]);
        }
    }
}

#[test]
fn i22_a_case_that_is_no_file_is_refused_once_with_66_and_not_waited_for() {
    let scratch = Scratch::new();
    let made = std::process::Command::new("mkfifo")
        .arg(scratch.path("fifo.toml"))
        .status()
        .unwrap();
    assert!(made.success());
    std::os::unix::fs::symlink("loop.toml", scratch.path("loop.toml")).unwrap();
    std::os::unix::fs::symlink("nowhere", scratch.path("dangling.toml")).unwrap();
    std::fs::create_dir(scratch.path("folder.toml")).unwrap();
    let before = scratch.entries();
    for name in [
        "fifo.toml",
        "loop.toml",
        "dangling.toml",
        "folder.toml",
        "/dev/stdin",
        "/dev/null",
        "../no/such.toml",
    ] {
        let output = scratch.job(Some(2), &[name]).within(30).run().expect(66);
        output.says_once(name);
    }
    assert_eq!(scratch.entries(), before);
}

#[test]
fn i23_more_ranks_than_slabs_and_their_parts_are_refused_once_with_65() {
    let scratch = Scratch::with_case(COLUMN);
    let output = scratch.mpirun(7, &["case.toml"]).expect(65);
    output.says_once("the grid has 4 columns of 5 cells, too few for 7 ranks. Use at most 4 ranks");
    assert_eq!(scratch.entries(), ["case.toml"]);
}

#[test]
fn s1_hostile_names_of_files_are_names_like_any_other() {
    for (number, name) in HOSTILE.into_iter().enumerate() {
        let scratch = Scratch::new();
        let file = |ending: &[u8]| OsStr::from_bytes(&[name, ending].concat()).to_owned();
        std::fs::write(scratch.path("").join(file(b".toml")), COLUMN).unwrap();
        let path = [b"./", name, b".toml"].concat();
        let job = scratch
            .job(None, &["-q", "--max-steps", "1"])
            .argument(&path)
            .within(30);
        // Every other one names the output itself.
        let given = number % 2 == 1;
        let output = [b"-o./", name, b".mine"].concat();
        let output = if given { job.argument(&output) } else { job }.run();
        assert_eq!(output.code, Some(75), "{name:?}: {output:#?}");
        let entries = std::fs::read_dir(scratch.path(""))
            .unwrap()
            .map(|entry| entry.unwrap().file_name());
        let mut entries: Vec<Vec<u8>> = entries.map(|entry| entry.into_vec()).collect();
        entries.sort();
        let ending: &[u8] = if given { b".mine" } else { b".out" };
        let mut expected = [file(b".toml"), file(ending)].map(|name| name.into_vec());
        expected.sort();
        assert_eq!(entries, expected, "{output:#?}");
        assert!(scratch.path("").join(file(ending)).join("run.json").is_file());
    }
}

#[test]
fn s1_names_in_a_case_lead_nowhere() {
    let history = "quantity = \"height\"";
    for name in [
        "../up",
        "/tmp/pwned",
        "a/b",
        "$(touch pwned)",
        "line\\nbreak",
        "\\u0000",
        "\\u001b[31m",
        "\\u202e",
        "-x y",
        "",
    ] {
        let named = format!("{history}\nname = \"{name}\"");
        let material = changed(COLUMN, "material = \"soil\"", &format!("material = \"{name}\""));
        let table = changed(&material, "[material.soil]", &format!("[material.\"{name}\"]"));
        for text in [changed(COLUMN, history, &named), table] {
            let scratch = Scratch::with_case(&text);
            let output = scratch.job(None, &["case.toml"]).within(30).run().expect(65);
            assert!(!output.said().contains(['\u{1b}', '\u{202e}', '\0']), "{output:#?}");
            assert_eq!(scratch.entries(), ["case.toml"]);
        }
    }
}

#[test]
fn s1_a_link_in_the_place_of_a_folder_of_the_run_is_refused_with_73() {
    for folder in ["frames", "checkpoint"] {
        let scratch = Scratch::with_case(COLUMN);
        std::fs::create_dir(scratch.path("elsewhere")).unwrap();
        std::fs::create_dir(scratch.path("case.out")).unwrap();
        std::os::unix::fs::symlink("../elsewhere", scratch.path("case.out").join(folder)).unwrap();
        let output = scratch.mpirun(2, &["case.toml"]).expect(73);
        assert_eq!(output.count("bsmpm-par:"), 1, "{output:#?}");
        assert_eq!(crate::support::entries(&scratch.path("elsewhere")), [""; 0]);
    }
}

/// Nothing in a case can start a program where no program is ever started.
#[test]
fn s2_the_solver_starts_no_process() {
    let crates = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let names = [
        "bsmpm",
        "bsmpm-scene",
        "bsmpm-shapes",
        "bsmpm-io",
        "bsmpm-ranks",
        "bsmpm-par",
        "petsc-rs",
        "hdf5-collective",
    ];
    let mut folders: Vec<_> = names.map(|name| crates.join(name).join("src")).into();
    let mut seen = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let text = text.split("#[cfg(test)]").next().unwrap();
            let starts = [
                "process::Command",
                "Command::new",
                "libc::system",
                "execv",
                "posix_spawn",
            ];
            assert!(!starts.iter().any(|start| text.contains(start)), "{}", path.display());
            seen += 1;
        }
    }
    assert!(seen > 100, "{seen}");
}

/// The variables and files that PETSc and HDF5 read: none may write, load or start anything.
#[test]
fn s3_what_libraries_read_by_themselves_has_no_effect() {
    let scratch = Scratch::with_case(COLUMN);
    let options =
        "-log_view :pwned\n-start_in_debugger\n-on_error_attach_debugger\n-options_file pwned\n-ksp_type bogus\n";
    for name in [".petscrc", "petscrc", ".petsc/petscrc"] {
        std::fs::create_dir_all(scratch.path(".petsc")).unwrap();
        scratch.write(name, options);
    }
    let before = scratch.entries();
    let line = options.replace('\n', " ");
    let home = scratch.path("");
    let plugins = scratch.path("plugins");
    let home = home.to_str().unwrap();
    let plugins = plugins.to_str().unwrap();
    let variables = [
        ("HOME", home),
        ("PETSC_OPTIONS", line.as_str()),
        ("PETSC_OPTIONS_YAML", "log_view: ':pwned'\nksp_type: bogus\n"),
        ("HDF5_PLUGIN_PRELOAD", plugins),
        ("HDF5_PLUGIN_PATH", plugins),
    ];
    for ranks in [None, Some(2)] {
        let job = scratch.job(ranks, &["case.toml", "-q", "--force"]).within(60);
        let output = variables
            .iter()
            .fold(job, |job, (name, value)| job.variable(name, value))
            .run()
            .expect(0);
        assert_eq!(output.said(), "");
    }
    let after: Vec<String> = scratch
        .entries()
        .into_iter()
        .filter(|name| name != "case.out")
        .collect();
    assert_eq!(after, before);
}
