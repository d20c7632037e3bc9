//! Wrong inputs of a newcomer that need a run (the others: `bsmpm-scene/tests/newcomer`): a case that was warned of as
//! probably not meant, and then fails, says so once more.

use crate::support::Scratch;
use crate::support::cases::changed;

const SLOPE: &str = include_str!("../../../../bsmpm-scene/tests/newcomer/slope.toml");

#[test]
fn a_step_that_fails_repeats_the_warning_of_a_probable_slip() {
    let slips = [
        ("\"10 kPa\"", "10.0", "W0102: material.soil.cohesion: a strength of 10 Pa (0.01 kPa)"),
        (
            "friction_angle = 20.0",
            "friction_angle = 0.349",
            "W0103: material.soil.friction_angle: an angle of 0.349 degrees",
        ),
        ("[0.0, -9.81]", "[0.0, 9.81]", "W0104: gravity.acceleration: gravity of [0.0, 9.81] m/s2 points upwards"),
        ("[0.0, -9.81]", "[9.81, 0.0]", "W0104: gravity.acceleration: gravity of [9.81, 0.0] m/s2 points sideways"),
    ];
    for (part, by, warning) in slips {
        let output = Scratch::with_case(&changed(SLOPE, part, by)).direct(&["case.toml"]).expect(80);
        output.says_once(&format!("warning {warning}"));
        output.says_once(&format!("Check this warning first: {warning}"));
    }
}

#[test]
fn a_slope_without_cohesion_that_fails_says_so() {
    let output = Scratch::with_case(&changed(SLOPE, "\"10 kPa\"", "0.0")).direct(&["case.toml"]).expect(80);
    output.says_once("material.soil has no cohesion");
}

#[test]
fn a_record_of_peer_ends_with_65_and_the_way_to_convert_it() {
    let shaken = changed(SLOPE, "\"quasi-static\"", "\"dynamic\", end = 1.0");
    let scratch =
        Scratch::with_case(&format!("{shaken}\n[shaking]\nacceleration = {{ file = \"rec.at2\", along = \"x\" }}\n"));
    let record = "PEER STRONG MOTION DATABASE RECORD\nIMPERIAL VALLEY\nACCELERATION TIME SERIES IN UNITS OF G\n\
                  NPTS=  8, DT= .0200 SEC\n  .1E-03  .2E-03 .3E-03 .1E-02\n";
    scratch.write("rec.at2", record);
    scratch.direct(&["case.toml"]).expect(65).says_once("error E0049: rec.at2: ");
}
