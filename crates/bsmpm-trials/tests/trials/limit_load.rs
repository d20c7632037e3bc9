//! Compares `bsmpm limit-load` with exact limit loads.

use crate::support::cases::EXACT;
use crate::support::results::{agree, manifest};
use crate::support::{Scratch, program, shipped};
use bsmpm_tools::limit_load;
use clap::Parser;
use serde_json::Value;

#[derive(Parser)]
struct LimitLoad {
    #[command(flatten)]
    arguments: limit_load::LimitLoadArguments,
}

/// The text and `limit-load.json` of a shipped case with settings.
fn limit_load(scratch: &Scratch, case: &str, settings: &[&str]) -> (String, Value) {
    let output = scratch.path("out");
    let case = shipped(&format!("limit_load/{case}.toml"));
    let mut words = vec![
        "limit-load",
        case.to_str().expect("a path"),
        "-o",
        output.to_str().expect("a path"),
        "--force",
    ];
    settings.iter().for_each(|setting| words.extend(["--set", setting]));
    let arguments = LimitLoad::parse_from([&words[..], &["--", program()]].concat()).arguments;
    let found = limit_load::run(&arguments, |_| ()).expect("a limit load");
    let text = found.text;
    assert!(
        found.is_reached && found.files.iter().all(|file| file.is_file()),
        "{text}"
    );
    let json = std::fs::read_to_string(output.join("limit-load.json")).expect("limit-load.json");
    (text, serde_json::from_str(&json).expect("JSON"))
}

/// Errors with 16 cells and extrapolated, relative to an exact load; the extrapolated band contains that.
fn errors(found: &Value, exact: f64) -> [f64; 2] {
    let number = |value: &Value| value.as_f64().expect("a number");
    let fine = number(&found["grids"][1]["load"]);
    let [load, band] = ["load", "band"].map(|key| number(&found["loads"][0][key]));
    assert!((load - exact).abs() <= band, "{load} +- {band}, exact {exact}");
    assert!((number(&found["grids"][1]["cells"]) - 16.0).abs() < 1e-9, "{found}");
    [fine / exact - 1.0, load / exact - 1.0]
}

/// A strip, a strip at a slope's crest and a rigid punch on clay that does not drain: (2 + pi - 2 beta) c.
#[test]
fn undrained_limit_loads_are_within_5_per_cent_and_extrapolated_within_2() {
    let scratch = Scratch::new();
    let level = 2.0 + std::f64::consts::PI;
    let crest = level - std::f64::consts::FRAC_PI_3;
    for (case, exact) in [
        ("strip_on_clay", level),
        ("strip_at_crest", crest),
        ("punch_on_clay", 1e4 * level),
    ] {
        let (text, found) = limit_load(&scratch, case, &[]);
        let [fine, extrapolated] = errors(&found, exact);
        println!("{case}: {fine:+.4}, {extrapolated:+.4}");
        // +1.0, +4.4 and +0.9 %; +0.1, -0.3 and 0.0 % were found.
        assert!(
            (0.0..0.05).contains(&fine) && extrapolated.abs() < 0.02,
            "{case}: {fine} {extrapolated}"
        );
        assert!(
            text.contains("too high (the unsafe side)") && !text.contains("warning"),
            "{text}"
        );
    }
}

/// Prandtl (1920), Reissner (1924) and Martin (2005), at the friction angle of the files.
#[test]
fn limit_loads_of_soil_with_friction_are_too_high_and_extrapolated_near_the_exact_ones() {
    let scratch = Scratch::new();
    let cases = [
        ("strip_on_soil", 20.721, [0.06, 0.01]),
        ("strip_with_surcharge", 10.869, [0.06, 0.01]),
        ("strip_on_sand", 14.754, [0.2, 0.05]),
    ];
    for (case, exact, bounds) in cases {
        let (_, found) = limit_load(&scratch, case, &[]);
        let [fine, extrapolated] = errors(&found, exact);
        println!("{case}: {fine:+.4}, {extrapolated:+.4}");
        assert!(
            (0.0..bounds[0]).contains(&fine) && extrapolated.abs() < bounds[1],
            "{case}: {fine} {extrapolated}"
        );
        assert_eq!(found["grids"][0]["cuts"], 0, "{case}");
    }
}

/// gamma B/80: 14 % of the load of a smooth strip, friction angle 30 degrees, by two runs of another grid.
#[test]
fn the_part_of_a_small_cohesion_is_measured() {
    let scratch = Scratch::new();
    let settings = ["material.sand.cohesion=\"0.5 kPa\"", "footing.interface=smooth"];
    let (text, found) = limit_load(&scratch, "strip_on_sand", &settings);
    let part = found["loads"][0]["of_cohesion"].as_f64().expect("a part");
    // 12.2 % on the grid of 8 cells.
    assert!((0.10..0.14).contains(&part), "{part}");
    assert!(text.contains("The small cohesion carries"), "{text}");
}

#[test]
fn a_limit_load_is_the_same_on_any_number_of_ranks_and_over_restarts() {
    let scratch =
        Scratch::with_case(&std::fs::read_to_string(shipped("limit_load/strip_on_clay.toml")).expect("a case"));
    let text = |name: &str| std::fs::read_to_string(scratch.path(name).join("history.csv")).expect("a history");
    let set = ["case.toml", "-q"];
    for ranks in 1..=4 {
        let whole = format!("whole{ranks}");
        scratch
            .mpirun(ranks, &[&set[..], &["-o", &whole], &EXACT].concat())
            .expect(0);
        assert!(text("whole1") == text(&whole), "{ranks} ranks");
        assert_eq!(
            manifest(&scratch.path("whole1")).limit_loads,
            manifest(&scratch.path(&whole)).limit_loads
        );
    }
    let on = [&set[..], &["-o", "part", "--restart", "auto"]].concat();
    scratch
        .mpirun(2, &[&on[..], &["--max-steps", "15"], &EXACT].concat())
        .expect(75);
    scratch.mpirun(3, &[&on[..], &EXACT].concat()).expect(0);
    agree(&scratch.path("part"), &scratch.path("whole1"));
    let loads = manifest(&scratch.path("part")).limit_loads;
    assert_eq!(loads, manifest(&scratch.path("whole1")).limit_loads);
    assert!(
        (loads[0].value / 5.2432 - 1.0).abs() < 0.01 && loads[0].change.abs() < 1e-3,
        "{loads:?}"
    );
}

#[test]
fn a_load_that_still_grows_is_reported() {
    let scratch = Scratch::new();
    let case = shipped("limit_load/strip_on_clay.toml");
    let short = "footing.displacement=[0.0, -0.01]";
    let case = case.to_str().expect("a path");
    let output = scratch.direct(&[case, "-o", "out", "--set", short]).expect(0);
    output.says_once("warning W0727: ");
    output.says_once("Increase the prescribed displacement");
    let words = ["limit-load", case, "-o", "found", "--set", short, "--", program()];
    let directory = scratch.path("found");
    let mut arguments = LimitLoad::parse_from(words).arguments;
    arguments.options.output = Some(directory);
    let found = limit_load::run(&arguments, |_| ()).expect("a table");
    assert!(
        !found.is_reached && !found.text.contains("extrapolated"),
        "{}",
        found.text
    );
}
