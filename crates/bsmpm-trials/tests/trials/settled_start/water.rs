//! Tests of the initial stress of slopes in which water flows.

use super::{initial, stresses};
use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{all_frames, differences, history};

/// A slope of silt under water, which flows in it or not.
const WET: &str = r#"
geometry = "plane-strain"
[analysis]
type = "consolidation"
end = "1 d"
dt = "6 h"
[grid]
lower = [0, 0]
upper = [30, 12]
cell = "1 m"
degree = "quadratic"
[material.silt]
model = "mohr-coulomb"
young = "20 MPa"
poisson = 0.3
cohesion = "8 kPa"
friction_angle = 30
unit_weight = "18 kN/m3"
saturated_unit_weight = "20 kN/m3"
drainage = "coupled"
porosity = 0.4
permeability = "1e-6 m/s"
[[body]]
material = "silt"
polygon = [[0, 0], [30, 0], [30, 4], [20, 4], [10, 10], [0, 10]]
points_per_cell = 3
[gravity]
acceleration = [0, -9.81]
[initial]
k0 = 0.5
equilibrium = "plastic"
[water]
level = 11.0
[boundary]
bottom = "fixed"
left = "roller"
right = "roller"
[stabilisation]
method = "consistent-f-bar"
[[history]]
quantity = "max-displacement"
[[history]]
quantity = "excess-pressure"
at = [15, 3]
"#;

/// The start of a slope in which water flows is that of one in which it rests, whatever is partly saturated; nothing
/// moves, and nothing is squeezed, by more than the tolerance.
#[test]
fn a_slope_in_which_water_flows_starts_as_one_in_which_it_rests() {
    let dry = changed(
        WET,
        "drainage = \"coupled\"\nporosity = 0.4\npermeability = \"1e-6 m/s\"\n",
        "",
    );
    let dry = changed(
        &dry,
        "\"consolidation\"\nend = \"1 d\"\ndt = \"6 h\"",
        "\"quasi-static\"\nsteps = 4",
    );
    let dry = changed(&dry, "[[history]]\nquantity = \"excess-pressure\"\nat = [15, 3]\n", "");
    // Above its level water rests by suction.
    let tide = changed(WET, "level = 11.0", "level = 4.0");
    let tide = changed(
        &tide,
        "porosity = 0.4",
        "porosity = 0.4\nretention = { alpha = 1.0, n = 2.0, residual = 0.1 }",
    );
    let scratch = Scratch::with_case(WET);
    for (name, case, ranks) in [("wet", WET, 1), ("wet2", WET, 2), ("dry", &dry, 1), ("tide", &tide, 1)] {
        scratch.write("case.toml", format!("{case}[output]\nevery_steps = 4\n"));
        scratch.mpirun(ranks, &["case.toml", "-q", "-o", name]).expect(0);
        let found = initial(&scratch, name);
        assert!(
            found.settling.expect("it was led there").rounds > 0 && found.unbalance < 1e-4,
            "{name}: {found:?}"
        );
        let history = history(&scratch.path(name));
        let moved = history.get("max-displacement").unwrap().last().unwrap();
        assert!(*moved < 2e-5, "{name}: {moved}");
        if name != "dry" {
            let squeezed = history.get("excess-pressure").unwrap().last().unwrap().abs();
            assert!(squeezed < 5.0, "{name}: {squeezed} Pa");
        }
    }
    let first = |name: &str| all_frames(&scratch.path(name)).remove(0);
    let [wet, two, dry] = ["wet", "wet2", "dry"].map(first);
    for (name, difference) in differences(&two, &wet).into_iter().filter(|(name, _)| name == "stress") {
        assert!(difference < 1e-6, "{name}: {difference:e}");
    }
    let largest = stresses(&dry)
        .concat()
        .into_iter()
        .fold(0.0, |most: f64, of| most.max(of.abs()));
    let off = stresses(&wet)
        .concat()
        .into_iter()
        .zip(stresses(&dry).concat())
        .map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-9 * largest);
}
