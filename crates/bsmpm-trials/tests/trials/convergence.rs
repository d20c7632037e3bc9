//! Tests convergence criteria, and reports of failed steps.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{at, history, manifest};

/// Sand at rest behind a smooth wall that moves away from it.
const WALL: &str = r#"title    = "Rankine active, smooth wall"
geometry = "plane-strain"
[analysis]
type  = "quasi-static"
steps = 40
[grid]
lower = [0.0, 0.0]
upper = [6.5, 4.5]
cell  = 0.5
degree = "quadratic"
[material.sand]
model       = "mohr-coulomb"
young       = "20 MPa"
poisson     = 0.3
cohesion    = "0 kPa"
friction_angle    = 30.0
dilation_angle    = 0.0
unit_weight = "18 kN/m3"
[[body]]
material = "sand"
box = { lower = [0.0, 0.0], upper = [6.0, 4.0] }
points_per_cell = 3
[initial]
k0 = 0.5
[gravity]
acceleration = [0.0, -9.81]
[boundary]
bottom = "roller"
left   = "roller"
[[prescribed]]
from = [6.0, 0.0]
to = [6.0, 4.0]
displacement = [0.04, 0.0]
components = "normal"
[stabilisation]
method = "f-bar"
[[history]]
quantity = "reaction"
face     = "left"
"#;

/// A slope near failure in a single step, and a block beside it, without contact.
const BESIDE: &str = r#"title    = "A slope, and a heavy block beside it"
geometry = "plane-strain"
[analysis]
type  = "quasi-static"
end   = 1.0
steps = 1
[grid]
lower = [0.0, 0.0]
upper = [48.0, 12.0]
cell  = "1 m"
degree = "quadratic"
[material.soil]
model       = "mohr-coulomb"
young       = "100 MPa"
poisson     = 0.3
cohesion    = "10 kPa"
friction_angle    = 20.0
dilation_angle    = 0.0
unit_weight = "20 kN/m3"
[material.block]
model       = "elastic"
young       = "1e5 MPa"
poisson     = 0.3
density     = "2e3 kg/m3"
[[body]]
material = "soil"
polygon = [[0.0, 0.0], [32.0, 0.0], [12.0, 10.0], [0.0, 10.0]]
points_per_cell = 3
[[body]]
material = "block"
box = { lower = [40.0, 0.0], upper = [44.0, 2.0] }
points_per_cell = 3
[strength_reduction]
factor = 1.3
[gravity]
acceleration = [0.0, -9.81]
ramp = 1.0
[boundary]
bottom = "fixed"
left   = "roller"
[stabilisation]
method = "consistent-f-bar"
[solver]
tolerance       = 1e-6
force_tolerance = 1e-3
max_iterations  = 1000
[[history]]
quantity = "displacement"
at = [12.0, 10.0]
name = "crest"
"#;

fn value(scratch: &Scratch, column: &str) -> f64 {
    at(&history(&scratch.path("case.out")), column, 1.0)
}

/// The steps in which the whole wedge yields begin so nearly balanced that no later energy is small beside their first
/// one: they ended with 80 at 0.84 and 0.10 of the wall's way although the forces balanced a hundred times better than
/// asked.
#[test]
fn a_wall_that_moves_away_has_rankines_active_thrust() {
    let weight = 18.0e3 * 4.0_f64.powi(2) / 2.0;
    for cohesion in [0.0, 2.0e3] {
        let thrust = weight / 3.0 - 2.0 * cohesion * 4.0 / 3.0_f64.sqrt();
        let scratch = Scratch::with_case(WALL);
        let cohesion = format!("material.sand.cohesion={cohesion:?}");
        scratch.mpirun(1, &["case.toml", "--set", &cohesion]).expect(0);
        let found = value(&scratch, "reaction-x");
        assert!((found / thrust - 1.0).abs() < 0.02, "{cohesion}: {found} {thrust}");
        let summary = manifest(&scratch.path("case.out")).summary;
        // What settled is reported, and is not what steps are made of.
        assert!(summary.settled_steps * 2 < summary.steps, "{summary:?}");
    }
}

/// One scale for all forces let the block excuse what was out of balance in the slope: its crest sank 15 % too little.
#[test]
fn a_heavy_block_does_not_hide_what_is_out_of_balance_in_the_slope_beside_it() {
    let mut crest = Vec::new();
    for density in ["2e3", "2e8"] {
        let scratch = Scratch::with_case(BESIDE);
        scratch
            .mpirun(1, &["case.toml", "--set", &format!("material.block.density={density}")])
            .expect(0);
        crest.push(value(&scratch, "crest-y"));
    }
    assert!((crest[1] / crest[0] - 1.0).abs() < 0.015, "{crest:?}");
}

#[test]
fn a_failure_names_both_measures_their_tolerances_and_what_to_try() {
    let scratch = Scratch::with_case(&changed(BESIDE, "factor = 1.3", "factor = 3.0"));
    let few = ["--set", "solver.max_iterations=4", "--set", "solver.nonlinear=broyden"];
    let output = scratch.mpirun(1, &[&["case.toml"], &few[..]].concat()).expect(80);
    output.says_once("Increase `solver.max_iterations` (now 4)");
    let failure = std::fs::read(scratch.path("case.out/failure.json")).unwrap();
    let failure: bsmpm_io::failure::FailureReport = serde_json::from_slice(&failure).unwrap();
    let reason = failure.attempts.last().unwrap();
    assert!(
        reason.starts_with("E0747: no convergence after 4 iterations (the limit). Final residuals: energy residual"),
        "{reason}"
    );
    assert!(
        reason.contains("tolerance 1e-6), force residual") && reason.contains("tolerance 1e-3)"),
        "{reason}"
    );
    let tolerances = failure.tolerances.unwrap();
    assert_eq!((tolerances.energy, tolerances.force), (Some(1e-6), Some(1e-3)));
    let (energy, force) = failure
        .history
        .last()
        .map(|last| (last.energy.unwrap(), last.force.unwrap()))
        .unwrap();
    assert!(energy >= 1e-6 || force >= 1e-3, "{energy} {force}");
    assert!(
        failure
            .advice
            .iter()
            .any(|advice| advice.contains("max_iterations` (now 4)")),
        "{:?}",
        failure.advice
    );
}
