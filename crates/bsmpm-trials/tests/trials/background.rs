//! Tests indicators of the artificial stiffness.

use crate::support::cases::{changed, slope};
use crate::support::results::manifest;
use crate::support::{Scratch, shipped};
use bsmpm_io::manifest::Indicator;

/// A strip footing on sand without cohesion, with associated flow: material does no work at failure, so that the
/// internal forces' works sum to nearly zero.
const SAND: &str = r#"
geometry = "plane-strain"
accuracy = "draft"
analysis = { type = "quasi-static" }
gravity = { acceleration = [0.0, -9.81] }
boundary = { bottom = "fixed", left = "roller", right = "roller" }
initial = { k0 = 0.5 }
grid = { lower = [0.0, 0.0], upper = [10.0, 5.0] }
[material.sand]
model = "mohr-coulomb"
young = "1 GPa"
poisson = 0.3
cohesion = 0.0
friction_angle = 30.0
dilation_angle = 30.0
unit_weight = "20 kN/m3"
[[body]]
material = "sand"
box = { lower = [0.0, 0.0], upper = [10.0, 4.0] }
[footing]
from = [0.0, 4.0]
to = [1.0, 4.0]
displacement = [0.0, -0.01]
interface = "smooth"
"#;

/// An indicator of a run, and how far it moved the ground, m.
#[track_caller]
fn found(scratch: &Scratch, name: &str, set: &[&str]) -> Option<Indicator> {
    let set: Vec<&str> = set.iter().flat_map(|set| ["--set", set]).collect();
    scratch
        .direct(&[&["case.toml", "-q", "--force"][..], &set].concat())
        .expect(0);
    manifest(&scratch.path("case.out")).indicators.get(name).cloned()
}

/// Without ties the toe of the slope creeps: its displacement is 7.64 mm in 10 steps, which is right, 10.2 in 20, 15.5
/// in 40 and 25.3 in 100. With ties it is 7.63 mm in any number of steps.
#[test]
fn a_function_that_creeps_is_reported_and_no_other() {
    let scratch = Scratch::with_case(&slope(0.0));
    let share = |set: &[&str]| found(&scratch, "background-load-share", set).expect("a load that is dead");
    for (extension, steps, is_wrong) in [
        ("linear", "10", false),
        ("linear", "100", false),
        ("off", "10", false),
        ("off", "20", true),
        ("off", "100", true),
    ] {
        let remedy = if extension == "off" {
            "solver.extension"
        } else {
            "points_per_cell"
        };
        let [extension, steps] = [
            format!("solver.extension={extension}"),
            format!("analysis.steps={steps}"),
        ];
        let indicator = share(&[&extension, &steps]);
        println!("{extension}, {steps}: {}", indicator.value);
        assert!(
            indicator.unusual == is_wrong && indicator.advice.contains(remedy),
            "{indicator:?}"
        );
    }
    // An embankment whose displacement is the same in 10 to 80 steps.
    let embankment = Scratch::with_case(&std::fs::read_to_string(shipped("validation/embankment.toml")).unwrap());
    let indicator = found(&embankment, "background-load-share", &["analysis.steps=40"]).unwrap();
    assert!(!indicator.unusual, "{indicator:?}");
}

/// A background resists only changes of steady motion, and a footing on sand that is right had 0.27.
#[test]
fn a_load_is_judged_where_nothing_moves_as_prescribed() {
    let scratch = Scratch::with_case(SAND);
    assert_eq!(found(&scratch, "background-load-share", &[]), None);
    // It comes to rest, and gravity acts on.
    let text = changed(
        SAND,
        "displacement = [0.0, -0.01]\n",
        "path = [[0.5, 0.0, -0.001], [1.0, 0.0, -0.001]]\n",
    );
    assert!(found(&Scratch::with_case(&text), "background-load-share", &[]).is_some());
}

/// It was 0.33, and 9.3 in the last step, where the works of all internal forces sum to -0.34 J; their magnitudes sum
/// to 424 J.
#[test]
fn works_that_cancel_do_not_make_the_background_seem_large() {
    let scratch = Scratch::with_case(SAND);
    let work = found(&scratch, "background-work", &[]).unwrap();
    println!("all steps: {}", work.value);
    assert!(work.value > 0.0 && work.value < 0.05, "{work:?}");
    let last = manifest(&scratch.path("case.out")).summary.last_background.unwrap();
    println!("last step: {}", last.work);
    assert!(last.work > 0.0 && last.work < 0.02, "{last:?}");
}

/// What stops such a footing is no matter of steps, background or cohesion (80 with each); with the purpose it finds
/// its limit load.
#[test]
fn a_footing_on_sand_that_finds_no_equilibrium_names_the_cohesion() {
    let scratch = Scratch::with_case(SAND);
    let steep = [
        "case.toml",
        "--set",
        "material.sand.friction_angle=40",
        "--set",
        "material.sand.dilation_angle=10",
    ];
    let rough = ["--set", "footing.interface=rough"];
    let failed = scratch.direct(&[&steep[..], &rough].concat()).expect(80);
    failed.says_once("Set `analysis.purpose = \"limit-load\"`");
    failed.says_once("`material.sand` has no cohesion");
    let purpose = ["--force", "-q", "--set", "analysis.purpose=limit-load"];
    scratch.direct(&[&steep[..], &rough, &purpose].concat()).expect(0);
}
