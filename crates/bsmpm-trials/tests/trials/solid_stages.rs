//! Tests stages, shaking, outflow and spinning bodies in 3-D.

use crate::solid::{PLANE, slice};
use crate::stages::{SWITCHED, repeats};
use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{at, history, manifest};
use bsmpm_io::table::Columns;

fn run(case: &str) -> Columns {
    let scratch = Scratch::with_case(case);
    scratch.direct(&["case.toml", "-q", "-o", "whole"]).expect(0);
    history(&scratch.path("whole"))
}

/// The column of the plane's stages, one cell thick between rollers; once the load is gone a gate opens, too.
fn switched() -> [String; 2] {
    let plane = changed(
        SWITCHED,
        "deactivate = [\"load\"]",
        "deactivate = [\"load\"]\nboundary = { left = \"free\" }",
    );
    let plane = changed(
        &plane,
        "tolerance = 1e-14\nforce_tolerance = 1e-9",
        "tolerance = 1e-20\nforce_tolerance = 1e-13",
    );
    // As many points as a strip has in a cell: across the slice both have the same weights.
    let plane = changed(&plane, "points_per_cell = 3", "points_per_cell = 4");
    let mut solid = plane.clone();
    for (of_plane, of_solid) in [
        ("geometry = \"plane-strain\"", "geometry = \"3d\""),
        (
            "lower = [0, 0]\nupper = [2, 10]",
            "lower = [0, 0, 0]\nupper = [2, 0.5, 10]",
        ),
        (
            "{ lower = [0, 0], upper = [2, 8] }",
            "{ lower = [0, 0, 0], upper = [2, 0.5, 8] }",
        ),
        (
            "right = \"roller\"",
            "right = \"roller\"\nfront = \"roller\"\nback = \"roller\"",
        ),
        (
            "from = [0, 8]\nto = [2, 8]\nstress = [0, \"-10 kPa\"]",
            "rectangle = { lower = [0, 0, 8], upper = [2, 0.5, 8] }\nstress = [0, 0, \"-10 kPa\"]",
        ),
        (
            "from = [0, 8]\nto = [2, 8]\ndisplacement = [0, 0]",
            "rectangle = { lower = [0, 0, 8], upper = [2, 0.5, 8] }\ndisplacement = [0, 0, 0]",
        ),
        ("at = [1, 8]", "at = [1, 0.25, 8]"),
        ("at = [1, 4]", "at = [1, 0.25, 4]"),
    ] {
        solid = changed(&solid, of_plane, of_solid);
    }
    [plane, solid]
}

#[test]
fn stages_of_a_slice_are_those_of_plane_strain_and_go_on_to_the_bit() {
    let [plane, solid] = switched();
    let plane = run(&plane);
    let scratch = Scratch::with_case(&solid);
    scratch.direct(&["case.toml", "-q", "-o", "whole"]).expect(0);
    let found = history(&scratch.path("whole"));
    let pairs = [
        ("top-y", "top-z"),
        ("top-x", "top-x"),
        ("stress-yy", "stress-zz"),
        ("stress-zz", "stress-yy"),
    ];
    for (of_plane, of_solid) in pairs {
        let [expected, found] = [plane.get(of_plane), found.get(of_solid)].map(|column| column.expect("a column"));
        let largest = expected.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let off = expected
            .iter()
            .zip(found)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(
            off < 1e-9 * largest && largest > 0.0,
            "{of_solid} is off by {off:.1e} of {largest:e}"
        );
    }
    assert_eq!(manifest(&scratch.path("whole")).stages.len(), 4);
    repeats(&scratch, &["top-x", "top-z", "stress-zz"], &["3", "4", "8", "9"]);
}

/// Sand on ground that shakes along and up, some of which leaves through a face.
#[test]
fn a_shaken_slice_that_loses_sand_is_plane_strain() {
    let shaken = |case: &str, grid: [&str; 2], rows: &str| {
        // What is followed stays.
        let narrow = changed(&changed(case, grid[0], grid[1]), "at = [1, ", "at = [0.5, ");
        let open = changed(&narrow, "bottom = \"fixed\"", "bottom = \"fixed\"\nright = \"outflow\"");
        open + &format!("[shaking]\nacceleration = [{rows}]\n[[history]]\nquantity = \"outflow\"\n")
    };
    let plane = shaken(
        PLANE,
        ["upper = [4, 2]", "upper = [1, 2]"],
        "[0.1, -6, 1], [0.2, 3, -1], [0.3, 0, 0]",
    );
    let grid = ["upper = [4, 0.25, 2]", "upper = [1, 0.25, 2]"];
    let solid = shaken(&slice(), grid, "[0.1, -6, 0, 1], [0.2, 3, 0, -1], [0.3, 0, 0, 0]");
    let plane = run(&plane);
    let solid = run(&solid);
    let pairs = [
        ("displacement-x", "displacement-x", 1.0),
        ("displacement-y", "displacement-z", 1.0),
    ];
    for (of_plane, of_solid, share) in pairs.into_iter().chain([("outflow", "outflow", 0.25)]) {
        let [expected, found] = [share * at(&plane, of_plane, 0.3), at(&solid, of_solid, 0.3)];
        assert!(
            (found / expected - 1.0).abs() < 1e-9,
            "{of_solid}: {found} for {expected}"
        );
    }
    assert!(at(&solid, "outflow", 0.3) > 0.0);
}

/// kg, m, rad/s: a cube that spins about an axis oblique to the grid.
const SPINNING: &str = r#"
geometry = "3d"
[analysis]
type = "dynamic"
end = 0.1
dt = 0.01
mass = "consistent"
[grid]
lower = [-1, -1, -1]
upper = [1, 1, 1]
cell = 0.25
degree = "quadratic"
[material.rubber]
model = "elastic"
young = "10 MPa"
poisson = 0.3
density = 1000
[[body]]
material = "rubber"
box = { lower = [-0.5, -0.5, -0.5], upper = [0.5, 0.5, 0.5] }
points_per_cell = 2
spin = { rate = 3, about = [0, 0, 0], axis = [1, 2, 2] }
[[history]]
quantity = "angular-momentum"
[[history]]
quantity = "energy"
"#;

/// Points at places of a lattice have (1 - 1/n2) of a cube's moment of inertia m a2/6.
#[test]
fn a_cube_keeps_the_angular_momentum_of_its_spin() {
    let found = run(SPINNING);
    let inertia = 1000.0 / 6.0 * (1.0 - 1.0 / 64.0);
    for (column, share) in [("x", 1.0 / 3.0), ("y", 2.0 / 3.0), ("z", 2.0 / 3.0)] {
        let momentum = found.get(&format!("angular-momentum-{column}")).expect("a column");
        let first = momentum[0];
        let last = momentum[momentum.len() - 1];
        assert!(
            (first / (share * 3.0 * inertia) - 1.0).abs() < 1e-12,
            "{column}: {first}"
        );
        // 1.4e-3 of it goes between points and nodes.
        assert!((last / first - 1.0).abs() < 3e-3, "{column}: {first} to {last}");
    }
}
