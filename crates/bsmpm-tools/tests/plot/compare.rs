//! Tests `bsmpm compare`.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::Picture;
use crate::quasi_static::{FOOTING, SLOPE};
use crate::still::Still;
use bsmpm_io::residuals::{Iterate, RESIDUALS, ResidualMethod};
use bsmpm_io::table::CsvTable;

fn compare(directory: &Path, arguments: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_bsmpm");
    Command::new(program)
        .env_clear()
        .current_dir(directory)
        .arg("compare")
        .args(arguments)
        .output()
        .unwrap()
}

fn printed(directory: &Path, arguments: &[&str]) -> String {
    let output = compare(directory, arguments);
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// The exit code and the message.
fn refused(directory: &Path, arguments: &[&str]) -> (i32, String) {
    let output = compare(directory, arguments);
    (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
}

/// Two whole runs and one that stopped, of three methods.
fn footings(directory: &Path) {
    let runs = [
        ("new.out", "modified-f-bar", 1.0, 40),
        ("old.out", "f-bar", 0.9, 40),
        ("plain.out", "", 0.6, 20),
    ];
    for (name, method, softness, steps) in runs {
        Still {
            method,
            softness,
            steps,
            spacing: 0.5,
            ..FOOTING
        }
        .write(&directory.join(name), &[])
        .unwrap();
    }
}

#[test]
fn curves_levels_and_points_are_drawn() {
    let dir = tempfile::tempdir().unwrap();
    footings(dir.path());
    let runs = ["new.out", "old.out", "plain.out"];
    let axes = [
        "--x",
        "penetration",
        "--x-scale",
        "0.5",
        "--x-label",
        "z/B",
        "--y",
        "p_over_c",
    ];
    let plain = [&runs[..], &axes].concat();
    assert_eq!(printed(dir.path(), &plain), "compare.png\n");
    let read = |name: &str| Picture::read(&dir.path().join(name));
    let mut last = read("compare.png");
    assert_eq!((last.width, last.rows().len()), (1600, 1000));
    fs::write(
        dir.path().join("pfem.csv"),
        "# a, b\nz,p,who\n0.1,3.5,us\n# more\n0.9,7,them\n",
    )
    .unwrap();
    let mut more = plain;
    for options in [
        &["--line", "5.1416=lower bound, (π + 2) c"][..],
        &["--line", "8.28"],
        &["--reference", "pfem.csv"],
        &["--label", "new", "--label", "old", "--label", "none"],
        &["--title", "Fig. 12"],
        &["--y-scale", "-1"],
    ] {
        more.extend(options);
        let output = ["-o", "next.png"];
        assert_eq!(printed(dir.path(), &[&more[..], &output].concat()), "next.png\n");
        let next = read("next.png");
        assert_ne!(next.pixels, last.pixels, "{options:?}");
        last = next;
    }
    // Nothing runs over the right edge.
    assert!(
        last.rows()
            .all(|row| row[1590..].iter().all(|pixel| *pixel == [255; 3]))
    );
}

#[test]
fn the_table_interpolates_as_far_as_runs_go() {
    let dir = tempfile::tempdir().unwrap();
    footings(dir.path());
    let runs = ["new.out", "plain.out", "--table"];
    let table = printed(
        dir.path(),
        &[&runs[..], &["--y", "penetration", "--at", "0,0.26,0.5, 0.75"]].concat(),
    );
    let expected = "Penetration (m)\n\
                    Pseudo-time  modified-f-bar  none\n\
                    \x20         0               0     0\n\
                    \x20      0.26            0.52  0.52\n\
                    \x20       0.5               1     1\n\
                    \x20      0.75             1.5     -\n";
    assert_eq!(table, expected);
    assert!(!dir.path().join("compare.png").exists());
    // By the quantity, whatever its column is called; of one method twice the directories are the names.
    let table = printed(
        dir.path(),
        &[
            "new.out",
            "new.out/",
            "--y",
            "footing-pressure",
            "--table",
            "-o",
            "both.png",
        ],
    );
    assert!(table.starts_with("p/c\nPseudo-time  new.out  new.out/\n"), "{table}");
    assert!(table.ends_with("both.png\n"), "{table}");
}

#[test]
fn last_rows_of_one_label_are_a_curve() {
    let dir = tempfile::tempdir().unwrap();
    let factors = [("1.4", 1.0), ("1.0", 0.2), ("1.2", 0.5)];
    let mut arguments = Vec::new();
    for (factor, softness) in factors {
        for method in ["modified-f-bar", "f-bar"] {
            let name = format!("{method}_{factor}");
            Still {
                method,
                softness,
                spacing: 1.0,
                ..SLOPE
            }
            .write(&dir.path().join(&name), &[])
            .unwrap();
            arguments.extend([name, "--x-value".to_owned(), factor.to_owned()]);
        }
    }
    let common = [
        "--last",
        "--y",
        "max-displacement",
        "--x-label",
        "SRF",
        "--table",
        "-o",
        "srf.png",
    ];
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).chain(common).collect();
    // The quantity is also recorded with a scale: the column of its name comes first.
    let table = printed(dir.path(), &arguments);
    let rows = [
        "SRF  modified-f-bar  f-bar",
        "  1             0.4    0.4",
        "1.2               1      1",
    ];
    assert!(
        table.starts_with(&format!("Max displacement (m)\n{}\n", rows.join("\n"))),
        "{table}"
    );
    let points = Picture::read(&dir.path().join("srf.png"));
    assert!(points.colours() > 20);
    let one = printed(
        dir.path(),
        &["f-bar_1.4", "--last", "--y", "E_delta_over_gamma_H2", "--table"],
    );
    assert_eq!(one, "E δ/(γ H²)\nPseudo-time  f-bar\n          1    100\n");
}

/// Step 7 of a run by Newton's method, and by secants until forces are balanced to round-off.
fn iterated(directory: &Path) {
    footings(directory);
    let newton = Some(ResidualMethod::Newton);
    let secants = Some(ResidualMethod::Multisecant);
    let courses = [
        ("new.out", [(newton, 0.1), (newton, 1e-2), (newton, 1e-4)]),
        ("old.out", [(secants, 0.1), (secants, 1e-2), (None, 1e-12)]),
    ];
    for (run, course) in courses {
        let mut table = CsvTable::create(&directory.join(run).join(RESIDUALS), &Iterate::columns("-", false)).unwrap();
        for ((method, force), iteration) in course.into_iter().zip(1..) {
            let energy = if method.is_some() { force * force } else { f64::NAN };
            let row = Iterate {
                step: 7,
                time: 0.175,
                iteration,
                method,
                energy,
                force,
                water: f64::NAN,
            };
            table.row(&row.cells(false)).unwrap();
        }
    }
}

#[test]
fn residuals_of_a_step_are_drawn_and_printed() {
    let dir = tempfile::tempdir().unwrap();
    iterated(dir.path());
    let runs = ["new.out", "old.out", "--residuals", "7"];
    let table = printed(
        dir.path(),
        &[&runs[..], &["--table", "--label", "Newton", "--label", "secants"]].concat(),
    );
    let expected = "Step 7, pseudo-time 0.175\n\
                    Newton\n\
                    iteration       method     energy      force  order\n\
                    \x20       1       newton    1.00e-2    1.00e-1      -\n\
                    \x20       2       newton    1.00e-4    1.00e-2      -\n\
                    \x20       3       newton    1.00e-8    1.00e-4   2.00\n\
                    secants\n\
                    iteration       method     energy      force  order\n\
                    \x20       1  multisecant    1.00e-2    1.00e-1      -\n\
                    \x20       2  multisecant    1.00e-4    1.00e-2      -\n\
                    \x20       3            -          -   1.00e-12  10.00\n";
    assert_eq!(table, expected);
    assert_eq!(printed(dir.path(), &runs), "compare.png\n");
    let both = Picture::read(&dir.path().join("compare.png"));
    assert!(both.width == 1600 && both.rows().len() == 1250 && both.colours() > 20);
    printed(dir.path(), &["new.out", "--residuals", "7"]);
    assert_ne!(Picture::read(&dir.path().join("compare.png")).pixels, both.pixels);

    let (code, message) = refused(dir.path(), &["new.out", "--residuals", "8"]);
    assert_eq!(
        (code, message.contains("step 8") && message.contains("step is 7")),
        (66, true),
        "{message}"
    );
    let (code, message) = refused(dir.path(), &["plain.out", "--residuals", "7"]);
    assert_eq!(
        (
            code,
            message.contains("E0806") && message.contains("output.residuals = true")
        ),
        (66, true),
        "{message}"
    );
    for option in [&["--y", "slip"][..], &["--last"], &["--line", "1"], &["--x-scale", "2"]] {
        assert_eq!(refused(dir.path(), &[&runs[..], option].concat()).0, 2, "{option:?}");
    }
}

#[test]
fn what_does_not_fit_is_said() {
    let dir = tempfile::tempdir().unwrap();
    footings(dir.path());
    let refuse = |arguments: &[&str]| refused(dir.path(), arguments);
    let (code, message) = refuse(&["new.out", "--y", "pressure"]);
    let known = "Choose one of: step, time, p_over_c, footing-force, penetration, slip, heave.";
    assert_eq!((code, message.trim_end().ends_with(known)), (66, true), "{message}");
    assert_eq!(refuse(&["new.out", "nowhere", "--y", "slip"]).0, 66);
    let (code, message) = refuse(&["new.out", "old.out", "--y", "slip", "--label", "one"]);
    assert_eq!((code, message.contains("E0805: --label")), (2, true), "{message}");
    for arguments in [
        &["new.out"][..],
        &["--y", "slip"],
        &["new.out", "--y", "slip", "--x-value", "1"],
        &["new.out", "old.out", "--y", "slip", "--last", "--x-value", "1"],
        &["new.out", "--y", "slip", "--at", "1"],
        &["new.out", "--y", "slip", "--line", "high=5"],
        &["new.out", "--y", "slip", "--x-scale", "inf"],
    ] {
        assert_eq!(refuse(arguments).0, 2, "{arguments:?}");
    }
    for (text, expected) in [("x\n1\n", 65), ("x,y\n", 65), ("x,y\n1,two\n", 65), ("", 65)] {
        fs::write(dir.path().join("bad.csv"), text).unwrap();
        assert_eq!(
            refuse(&["new.out", "--y", "slip", "--reference", "bad.csv"]).0,
            expected,
            "{text}"
        );
    }
    assert_eq!(refuse(&["new.out", "--y", "slip", "--reference", "none.csv"]).0, 66);

    // Another unit is another quantity, unless somebody says what they are together.
    let history = dir.path().join("old.out/history.csv");
    let text = fs::read_to_string(&history).unwrap();
    fs::write(&history, text.replace("scaled Pa", "Pa")).unwrap();
    let both = ["new.out", "old.out", "--y", "p_over_c"];
    let (code, message) = refuse(&both);
    assert_eq!(
        (code, message.contains("E0804") && message.contains("scaled Pa")),
        (2, true),
        "{message}"
    );
    assert_eq!(
        printed(dir.path(), &[&both[..], &["--y-label", "p/c"]].concat()),
        "compare.png\n"
    );

    // A run that did not come to its end is drawn, and said to be one.
    let output = compare(dir.path(), &["new.out", "plain.out", "--y", "slip"]);
    let note = "bsmpm: note: plain.out was stopped; its last row is at pseudo-time 0.5\n";
    assert_eq!((output.status.code(), &*output.stderr), (Some(0), note.as_bytes()));

    // A run that has just begun.
    let begin: String = text.split_inclusive('\n').take(2).collect();
    fs::write(&history, begin).unwrap();
    let (code, message) = refuse(&["old.out", "--y", "slip"]);
    assert_eq!((code, message.contains("E0803")), (66, true), "{message}");
}
