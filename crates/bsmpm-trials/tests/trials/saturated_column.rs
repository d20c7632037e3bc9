//! Tests that waves in a saturated column agree with the telegraph equation.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{at, history};

/// A column 1 m high of M = 1 MPa and 1000 kg/m3 under 10 Pa at once: H sqrt(rho/M) = 0.031623 s, gamma_w H/(k sqrt(M
/// rho)) = 1.
const COLUMN: &str = r#"
geometry = "plane-strain"
[analysis]
type = "dynamic"
end = 0.12649110640673517
steps = 200
mass = "consistent"
[grid]
lower = [0, 0]
upper = [0.4, 1.0]
cell = [0.1, 0.05]
degree = "quadratic"
[material.soil]
model = "elastic"
young = "1 MPa"
poisson = 0.0
density = "1000 kg/m3"
drainage = "coupled"
porosity = 0.5
permeability = 0.31021543919277
[[body]]
material = "soil"
box = { lower = [0, 0], upper = [0.4, 1.0] }
points_per_cell = 3
[boundary]
bottom = "fixed"
left = "roller"
right = "roller"
[[drain]]
face = "top"
[[traction]]
from = [0, 1.0]
to = [0.4, 1.0]
stress = [0, "-10 Pa"]
[solver]
tolerance = 1e-12
force_tolerance = 1e-8
[[history]]
quantity = "displacement"
at = [0.2, 1.0]
[[history]]
quantity = "energy"
"#;

/// t sqrt(M/rho)/H, s M/(q H) of b = 1, of b = 10.
const TELEGRAPH: [(f64, [f64; 2]); 4] = [
    (0.5, [0.444565, 0.238316]),
    (1.0, [0.801456, 0.347513]),
    (2.0, [1.347154, 0.498192]),
    (4.0, [0.882610, 0.697688]),
];
/// m  settlement at rest
const FINAL: f64 = 1e-5;
/// s
const UNIT: f64 = 0.031_622_776_601_683_79;

#[test]
fn telegraph_equation_on_ranks_and_in_two_parts() {
    for (number, permeability) in ["0.31021543919277", "0.031021543919277"].into_iter().enumerate() {
        let scratch = Scratch::with_case(&changed(COLUMN, "0.31021543919277", permeability));
        for (ranks, name) in [(1, "one"), (2, "two")] {
            scratch.mpirun(ranks, &["case.toml", "-q", "-o", name]).expect(0);
        }
        let [one, two] = ["one", "two"].map(|name| history(&scratch.path(name)));
        for (time, expected) in TELEGRAPH {
            let [one, two] = [&one, &two].map(|table| at(table, "displacement-y", time * UNIT));
            assert!((-one / FINAL - expected[number]).abs() < 0.02, "{time}: {one}");
            assert!((two - one).abs() < 1e-8 * FINAL, "{time}: {one} {two}");
        }
        let part = ["case.toml", "-q", "-o", "part", "--restart", "auto"];
        scratch
            .mpirun(1, &[&part[..], &["--max-steps", "50"]].concat())
            .expect(75);
        scratch.mpirun(1, &part).expect(0);
        let text = |name: &str| std::fs::read_to_string(scratch.path(name).join("history.csv")).unwrap();
        assert!(text("one") == text("part"));
    }
}
