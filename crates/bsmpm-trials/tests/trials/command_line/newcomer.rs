//! Tests mistakes of new users that need a run.

use crate::support::Scratch;
use crate::support::cases::changed;

const SLOPE: &str = include_str!("../../../../bsmpm-scene/tests/newcomer/slope.toml");

#[test]
fn a_step_that_fails_repeats_the_warning_of_a_probable_slip() {
    let slips = [
        (
            "\"10 kPa\"",
            "10.0",
            "W0102: material.soil.cohesion: a strength of 10 Pa (0.01 kPa)",
        ),
        (
            "friction_angle = 20.0",
            "friction_angle = 0.349",
            "W0103: material.soil.friction_angle: an angle of 0.349 degrees",
        ),
        (
            "[0.0, -9.81]",
            "[0.0, 9.81]",
            "W0104: gravity.acceleration: gravity of [0.0, 9.81] m/s2 points upwards",
        ),
        (
            "[0.0, -9.81]",
            "[9.81, 0.0]",
            "W0104: gravity.acceleration: gravity of [9.81, 0.0] m/s2 points sideways",
        ),
    ];
    for (part, by, warning) in slips {
        // With enough iterations, whether the slope that fails finds an equilibrium depends on round-off, and so on the
        // vector instructions of the processor.
        let output = Scratch::with_case(&changed(SLOPE, part, by))
            .direct(&["case.toml", "--set", "solver.max_iterations=30"])
            .expect(80);
        output.says_once(&format!("warning {warning}"));
        let [code, key] = [0, 1].map(|part| warning.split(": ").nth(part).unwrap_or_default());
        output.says_once(&format!("First check warning {code} ({key})."));
    }
}

#[test]
fn a_slope_without_cohesion_that_fails_says_so() {
    let steep = changed(SLOPE, "\"10 kPa\"", "0.0");
    let output = Scratch::with_case(&steep).direct(&["case.toml"]).expect(80);
    output.says_once("warning W0111: body.0: the slope of 26.6 degrees is steeper than the friction angle");
    output.says_once("First check warning W0111 (body.0).");
    let cut = changed(&steep, "[32.0, 0.0], [12.0, 10.0]", "[12.0, 0.0], [12.0, 10.0]");
    Scratch::with_case(&cut)
        .direct(&["case.toml"])
        .expect(80)
        .says_once("material.soil has no cohesion");
}

#[test]
fn a_record_of_peer_ends_with_65_and_the_way_to_convert_it() {
    let shaken = changed(SLOPE, "\"quasi-static\"", "\"dynamic\", end = 1.0");
    let scratch = Scratch::with_case(&format!(
        "{shaken}\n[shaking]\nacceleration = {{ file = \"rec.at2\", along = \"x\" }}\n"
    ));
    let record = "PEER STRONG MOTION DATABASE RECORD\nIMPERIAL VALLEY\nACCELERATION TIME SERIES IN UNITS OF G\n\
                  NPTS=  8, DT= .0200 SEC\n  .1E-03  .2E-03 .3E-03 .1E-02\n";
    scratch.write("rec.at2", record);
    scratch
        .direct(&["case.toml"])
        .expect(65)
        .says_once("error E0049: rec.at2: ");
}

/// Row 44: what is no case.
#[test]
fn a_file_that_is_no_case_is_refused_with_what_it_is() {
    let scratch = Scratch::new();
    std::fs::create_dir(scratch.path("folder.toml")).expect("a folder");
    std::fs::write(scratch.path("binary.toml"), b"\x7fELF\x02\x01\x01\0\0").expect("a binary file");
    std::fs::write(scratch.path("large.toml"), vec![b'#'; (16 << 20) + 1]).expect("a large file");
    scratch.write("empty.toml", "");
    scratch.write("text.toml", "Dear colleague, this is my slope.\n");
    let rows = [
        (
            "empty.toml",
            65,
            "error E0003: the file is empty or has only comments. Check the name of the file.",
        ),
        (
            "text.toml",
            65,
            "text.toml:1:6: error E0005: the line does not follow the TOML format",
        ),
        (
            "binary.toml",
            65,
            "error E0002: the file is not plain text: line 1 has a zero byte",
        ),
        (
            "large.toml",
            65,
            "error E0004: the file is larger than 16 MiB, the limit for a case file.",
        ),
        (
            "folder.toml",
            66,
            "error E0001: the file cannot be read: it is a directory, pipe or device.",
        ),
    ];
    for (name, code, says) in rows {
        scratch.direct(&[name]).expect(code).says_once(says);
    }
}

/// Row 45: a full disk is among the tests of `fault_matrix`.
#[test]
fn an_output_directory_that_cannot_be_made_is_named_with_the_remedy() {
    let scratch = Scratch::with_case(SLOPE);
    scratch.write("file", "");
    for directory in ["file/below", "/proc/run"] {
        let output = scratch.direct(&["case.toml", "-o", directory]).expect(73);
        output.says_once(&format!(
            "error E0767: the operating system cannot create the output directory `{directory}`"
        ));
        output.says_once("Choose another directory with `-o`.");
    }
}

/// Row 48.
#[test]
fn a_restart_with_another_value_names_the_value_and_both_ways_out() {
    let scratch = Scratch::with_case(SLOPE);
    scratch.direct(&["case.toml", "--max-steps", "2"]).expect(75);
    let output = scratch
        .direct(&["case.toml", "--restart", "auto", "--set", "material.soil.young=3e7"])
        .expect(76);
    output.says_once("error E0721: the case has changed since the run in the output directory: ");
    output.says_once("material.soil.young was 100000000.0, and is 30000000.0");
    output.says_once("Restore the old values, or start again with `--force`.");
}
