//! Tests material interfaces that have left their grid lines.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{at, history, manifest};

/// Two layers whose upper one is soft, 1:4, under their weight.
const LAYERS: &str = r#"
geometry = "plane-strain"
analysis = { type = "quasi-static", steps = 8 }
gravity  = { acceleration = [0.0, -9.81], ramp = 1.0 }
boundary = { bottom = "fixed", left = "roller", right = "roller" }
grid     = { lower = [0.0, 0.0], upper = [3.0, 13.0], cell = 1.0, degree = "quadratic" }
[material.soft]
model = "elastic"
young = YOUNG
poisson = 0.25
unit_weight = "18 kN/m3"
[material.stiff]
model = "elastic"
young = 4 YOUNG
poisson = 0.25
unit_weight = "18 kN/m3"
[[body]]
material = "stiff"
box = { lower = [0.0, 0.0], upper = [3.0, 6.0] }
points_per_cell = 3
[[body]]
material = "soft"
box = { lower = [0.0, 6.0], upper = [3.0, 12.0] }
points_per_cell = 3
[solver]
quadrature = "points"
[stabilisation]
method = "consistent-f-bar"
[[history]]
quantity = "displacement"
at = [1.5, 6.0]
name = "interface"
[[history]]
quantity = "stress"
at = [1.5, 6.17]
name = "above"
"#;

fn layers(young: f64) -> String {
    let text = LAYERS.replace("4 YOUNG", &format!("{:?}", 4.0 * young));
    text.replace("YOUNG", &format!("{young:?}"))
}

#[test]
fn an_interface_that_leaves_its_line_is_reported_with_its_distance() {
    let scratch = Scratch::new();
    // Stiff ground hardly moves; the softer one has a stress of -45.8 kPa for -104.9 above the interface.
    for (young, is_unusual) in [(0.8e8, false), (0.8e6, true)] {
        scratch.write("case.toml", layers(young));
        for ranks in [1, 3] {
            // A quarter of a cell is beyond the limit of 0.1.
            let code = if is_unusual { 82 } else { 0 };
            let output = scratch
                .mpirun(ranks, &["case.toml", "-o", "out", "--force"])
                .expect(code);
            let indicator = &manifest(&scratch.path("out")).indicators["interface-shift"];
            let history = history(&scratch.path("out"));
            let settled = -at(&history, "interface-y", 1.0);
            println!(
                "E = {young:e} Pa, {ranks} ranks: {:.4} cells, settlement {settled:.4} m",
                indicator.value
            );
            assert_eq!(indicator.unusual, is_unusual);
            // The points nearest to the interface lie a sixth of a cell above and below it.
            assert!(
                (indicator.value / settled - 1.0).abs() < 0.1,
                "{} {settled}",
                indicator.value
            );
            if is_unusual {
                output.says_once("output.accept = [\"interface-shift\"]");
                let stress = at(&history, "above-yy", 1.0);
                assert!(stress > -60e3, "{stress}");
            }
        }
    }
    let fitted = [
        "case.toml",
        "-q",
        "-o",
        "out",
        "--force",
        "--set",
        "solver.quadrature=fitted",
    ];
    scratch.direct(&fitted).expect(0);
    let indicator = &manifest(&scratch.path("out")).indicators["interface-shift"];
    assert!(
        indicator.usual[1] == 0.2 && indicator.unusual && !indicator.advice.contains("\"fitted\""),
        "{indicator:?}"
    );
}

/// A layer of low permeability, 1:PART, two cells thick, in ground under a load.
const LEAK: &str = r#"
geometry = "plane-strain"
analysis = { type = "consolidation", end = "600 d", dt = "200 s", growth = 1.25 }
boundary = { bottom = "fixed", left = "roller", right = "roller" }
grid     = { lower = [0.0, 0.0], upper = [1.0, 6.5], cell = 0.5, degree = "quadratic" }
material.sand = { model = "elastic", young = "3 MPa", poisson = 0.0, porosity = 0.4, permeability = "1e-6 m/s" }
material.silt = { model = "elastic", young = "3 MPa", poisson = 0.0, porosity = 0.4, permeability = "SILT m/s" }
body = [
    { material = "sand", box = { lower = [0.0, 0.0], upper = [1.0, 3.0] }, points_per_cell = 3 },
    { material = "silt", box = { lower = [0.0, 3.0], upper = [1.0, 4.0] }, points_per_cell = 3 },
    { material = "sand", box = { lower = [0.0, 4.0], upper = [1.0, 6.0] }, points_per_cell = 3 },
]
drain    = [{ from = [0.0, 6.0], to = [1.0, 6.0] }, { face = "bottom", pressure = "12 kPa" }]
traction = [{ from = [0.0, 6.0], to = [1.0, 6.0], stress = [0.0, "-150 kPa"], ramp = "1 d" }]
[water]
drainage = "coupled"
[stabilisation]
method = "consistent-f-bar"
"#;

#[test]
fn a_layer_of_low_permeability_that_leaves_its_lines_is_reported() {
    let scratch = Scratch::new();
    for (silt, is_reported) in [("2e-8", true), ("5e-7", false)] {
        scratch.write("case.toml", changed(LEAK, "SILT", silt));
        let code = if is_reported { 82 } else { 0 };
        scratch
            .direct(&["case.toml", "-q", "-o", "out", "--force"])
            .expect(code);
        let indicators = manifest(&scratch.path("out")).indicators;
        let found = indicators.get("permeability-shift");
        println!("{silt}: {found:?}");
        // Its faces settle by 0.26 and 0.35 of a cell, and the flow is 1.60 times the right one. Of 1:2 nothing is
        // reported.
        let is_right = found.is_some_and(|found| found.unusual && (0.33..0.38).contains(&found.value));
        assert_eq!((is_right, found.is_some()), (is_reported, is_reported));
    }
}
