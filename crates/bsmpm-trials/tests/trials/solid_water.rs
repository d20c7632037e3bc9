//! Tests water in 3-D.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{at, history};
use bsmpm_io::table::Columns;
use std::f64::consts::PI;

/// Sand under water that slumps while its water flows out on the left.
const PLANE: &str = r#"
geometry = "plane-strain"
[analysis]
type = "dynamic"
end = 0.3
dt = 0.02
[grid]
lower = [0, 0]
upper = [4, 2]
cell = 0.25
degree = "quadratic"
[material.sand]
model = "mohr-coulomb"
young = "1 MPa"
poisson = 0.3
density = 2000
friction_angle = 25
dilation_angle = 0
cohesion = "1 kPa"
drainage = "coupled"
porosity = 0.4
permeability = ["2e-4 m/s", "1e-4 m/s"]
permeability_law = "kozeny-carman"
[[body]]
material = "sand"
box = { lower = [0, 0], upper = [1, 1.5] }
points_per_cell = 2
[gravity]
acceleration = [0, -9.81]
[water]
level = 0.8
[[drain]]
face = "left"
[boundary]
left = "roller"
bottom = "fixed"
[solver]
background = 0
tolerance = 1e-18
force_tolerance = 1e-13
[output]
fields = ["pore-pressure", "excess-pressure", "flux", "porosity"]
[[history]]
quantity = "displacement"
at = [1, 1.5]
[[history]]
quantity = "stress"
at = [0.5, 0.25]
[[history]]
quantity = "excess-pressure"
at = [0.5, 0.25]
[[history]]
quantity = "flux"
at = [0.5, 0.25]
[[history]]
quantity = "pore-pressures"
[[history]]
quantity = "water-outflow"
[[history]]
quantity = "water-balance"
"#;

/// The same, one cell thick, between rollers.
fn slice(plane: &str) -> String {
    let mut slice = plane.to_owned();
    for (plane, solid) in [
        ("geometry = \"plane-strain\"", "geometry = \"3d\""),
        (
            "lower = [0, 0]\nupper = [4, 2]",
            "lower = [0, 0, 0]\nupper = [4, 0.25, 2]",
        ),
        (
            "box = { lower = [0, 0], upper = [1, 1.5] }",
            "box = { lower = [0, 0, 0], upper = [1, 0.25, 1.5] }",
        ),
        ("[0, -9.81]", "[0, 0, -9.81]"),
        (
            "bottom = \"fixed\"",
            "bottom = \"fixed\"\nfront = \"roller\"\nback = \"roller\"",
        ),
        ("at = [1, 1.5]", "at = [1, 0.125, 1.5]"),
    ] {
        slice = changed(&slice, plane, solid);
    }
    // Across nothing flows.
    let slice = slice.replace("\"2e-4 m/s\", \"1e-4 m/s\"", "\"2e-4 m/s\", \"5e-3 m/s\", \"1e-4 m/s\"");
    slice.replace("at = [0.5, 0.25]", "at = [0.5, 0.125, 0.25]")
}

fn run(case: &str) -> Columns {
    let scratch = Scratch::with_case(case);
    scratch.direct(&["case.toml", "-q", "-o", "out"]).expect(0);
    history(&scratch.path("out"))
}

/// Largest distance of columns at the time `t`, over their values.
fn apart(plane: &str, t: f64, columns: &[(&str, &str)]) -> f64 {
    let of_plane = run(plane);
    let of_solid = run(&slice(plane));
    let each = columns.iter().map(|(plane, solid)| {
        let [expected, found] = [at(&of_plane, plane, t), at(&of_solid, solid, t)];
        assert!(expected != 0.0, "{plane}");
        (found / expected - 1.0).abs()
    });
    let apart = each.fold(0.0, f64::max);
    println!("{apart:e}");
    apart
}

const MOVED: [(&str, &str); 5] = [
    ("displacement-x", "displacement-x"),
    ("displacement-y", "displacement-z"),
    ("stress-xx", "stress-xx"),
    ("stress-yy", "stress-zz"),
    ("stress-zz", "stress-yy"),
];
const FLOWN: [(&str, &str); 4] = [
    ("excess-pressure", "excess-pressure"),
    ("flux-x", "flux-x"),
    ("flux-y", "flux-z"),
    ("pore-pressures-mean", "pore-pressures-mean"),
];

#[test]
fn a_slice_through_which_water_flows_is_plane_strain() {
    assert!(apart(PLANE, 0.3, &[MOVED.as_slice(), &FLOWN].concat()) < 1e-9);
    let tight = changed(PLANE, "drainage = \"coupled\"", "drainage = \"undrained\"");
    let tight = changed(
        &tight,
        "permeability = [\"2e-4 m/s\", \"1e-4 m/s\"]\npermeability_law = \"kozeny-carman\"\n",
        "",
    );
    let tight = changed(&tight, "[[drain]]\nface = \"left\"\n", "").replace("\"flux\", ", "");
    let tight = changed(&tight, "[[history]]\nquantity = \"flux\"\nat = [0.5, 0.25]\n", "");
    assert!(apart(&tight, 0.3, &[MOVED.as_slice(), &FLOWN[..1]].concat()) < 1e-9);
    let silt = changed(
        PLANE,
        "type = \"dynamic\"\nend = 0.3\ndt = 0.02",
        "type = \"consolidation\"\nend = 3600\ndt = 60",
    );
    let silt = changed(
        &silt,
        "porosity = 0.4",
        "porosity = 0.4\nretention = { alpha = 1.0, n = 2.0, residual = 0.1 }",
    );
    let silt = changed(&silt, "cohesion = \"1 kPa\"", "cohesion = \"20 kPa\"");
    let silt = changed(
        &silt,
        "level = 0.8",
        "level = 0.4\nsuction = \"20 kPa\"\n[initial]\nk0 = 0.5",
    );
    let silt = changed(
        &silt,
        "face = \"left\"",
        "face = \"bottom\"\nhead_path = [[0, 0.4], [3600, 1.4]]",
    );
    assert!(apart(&silt, 3600.0, &[MOVED.as_slice(), &FLOWN].concat()) < 1e-9);
}

/// Silt into which it rains from above, and whose side lets out what seeps there.
#[test]
fn a_slice_into_which_it_rains_and_that_seeps_is_plane_strain() {
    let rain = changed(
        PLANE,
        "type = \"dynamic\"\nend = 0.3\ndt = 0.02",
        "type = \"consolidation\"\nend = 7200\ndt = 240",
    );
    let rain = changed(
        &rain,
        "porosity = 0.4",
        "porosity = 0.4\nretention = { alpha = 1.0, n = 2.0, residual = 0.1 }",
    );
    let rain = changed(&rain, "cohesion = \"1 kPa\"", "cohesion = \"20 kPa\"");
    let rain = changed(
        &rain,
        "level = 0.8",
        "level = 0.4\nsuction = \"20 kPa\"\n[initial]\nk0 = 0.5",
    );
    let rain = changed(
        &rain,
        "face = \"left\"",
        "from = [1, 0]\nto = [1, 1.5]\nseepage = true\n\
         [[inflow]]\nfrom = [0, 1.5]\nto = [1, 1.5]\nrate = \"1e-4 m/s\"\nrunoff = true",
    );
    let solid = slice(&rain);
    let solid = changed(
        &solid,
        "from = [1, 0]\nto = [1, 1.5]",
        "rectangle = { lower = [1, 0, 0], upper = [1, 0.25, 1.5] }",
    );
    let solid = changed(
        &solid,
        "from = [0, 1.5]\nto = [1, 1.5]",
        "rectangle = { lower = [0, 0, 1.5], upper = [1, 0.25, 1.5] }",
    );
    let plane = run(&rain);
    let found = run(&solid);
    for (of_plane, of_solid) in MOVED.into_iter().chain(FLOWN) {
        let [expected, found] = [at(&plane, of_plane, 7200.0), at(&found, of_solid, 7200.0)];
        println!("{of_solid}: {expected:e}, {:e}", found / expected - 1.0);
        assert!(
            (found / expected - 1.0).abs() < 1e-8,
            "{of_solid}: {found} for {expected}"
        );
    }
    let out = [
        at(&plane, "water-outflow", 7200.0),
        4.0 * at(&found, "water-outflow", 7200.0),
    ];
    println!("{out:?}");
    assert!(out[0] < 0.0 && (out[1] / out[0] - 1.0).abs() < 1e-8, "{out:?}");
}

/// A slope under a water table, at rest.
#[test]
fn a_slice_with_still_water_is_plane_strain() {
    let dry = changed(
        PLANE,
        "type = \"dynamic\"\nend = 0.3\ndt = 0.02",
        "type = \"quasi-static\"\nsteps = 3",
    );
    let dry = changed(&dry, "model = \"mohr-coulomb\"", "model = \"elastic\"");
    let dry = changed(
        &dry,
        "friction_angle = 25\ndilation_angle = 0\ncohesion = \"1 kPa\"\ndrainage = \"coupled\"\nporosity = 0.4\n",
        "",
    );
    let dry = changed(
        &dry,
        "permeability = [\"2e-4 m/s\", \"1e-4 m/s\"]\npermeability_law = \"kozeny-carman\"\n",
        "",
    );
    let dry = changed(&dry, "[[drain]]\nface = \"left\"\n", "");
    let dry = changed(
        &dry,
        "\"pore-pressure\", \"excess-pressure\", \"flux\", \"porosity\"",
        "\"pore-pressure\"",
    );
    let cut = dry
        .find("[[history]]\nquantity = \"excess-pressure\"")
        .expect("histories of flow");
    let still = format!(
        "{}[[history]]\nquantity = \"pore-pressure\"\nat = [0.5, 0.25]\n",
        &dry[..cut]
    );
    let columns = [MOVED.as_slice(), &[("pore-pressure", "pore-pressure")]].concat();
    let wet = changed(
        &still,
        "density = 2000",
        "unit_weight = \"17 kN/m3\"\nsaturated_unit_weight = \"20 kN/m3\"",
    );
    let line = changed(&wet, "level = 0.8", "line = [[0, 1.2], [1, 0.9]]");
    let falls = changed(&wet, "level = 0.8", "level_path = [[0, 1.4], [1, 0.7]]");
    let share = changed(&still, "density = 2000", "density = 2000\nru = 0.3");
    for case in [line, falls, changed(&share, "[water]\nlevel = 0.8\n", "")] {
        assert!(apart(&case, 1.0, &columns) < 1e-10);
    }
}

/// Rock as stiff as to hold still beside water that gives way, its pressure raised to 100 Pa on all six sides at once.
const CUBE: &str = r#"
geometry = "3d"
[analysis]
type = "consolidation"
end = 0.08
dt = 1e-3
growth = 1.05
dt_max = 2e-3
[grid]
lower = [0, 0, 0]
upper = [1, 1, 1]
cell = 0.16666666666666666
degree = "quadratic"
[material.rock]
model = "elastic"
young = "10 GPa"
poisson = 0
drainage = "coupled"
porosity = 0.5
permeability = "9.81e-3 m/s"
[water]
bulk = "0.5 MPa"
[[body]]
material = "rock"
box = { lower = [0, 0, 0], upper = [1, 1, 1] }
points_per_cell = 2
[solver]
tolerance = 1e-12
force_tolerance = 1e-8
[[history]]
quantity = "excess-pressure"
name = "centre"
at = [0.375, 0.375, 0.375]
[[history]]
quantity = "excess-pressure"
name = "side"
at = [0.375, 0.125, 0.375]
[[history]]
quantity = "pore-pressures"
[[history]]
quantity = "water-outflow"
name = "all"
[[history]]
quantity = "water-balance"
[output]
times = [0.05]
fields = ["pore-pressure", "flux"]
"#;
const SIDES: [&str; 6] = ["left", "right", "front", "back", "bottom", "top"];

fn cube() -> String {
    let drains = SIDES
        .map(|side| format!("[[drain]]\nface = \"{side}\"\npressure = 100\n"))
        .concat();
    let rollers = SIDES.map(|side| format!("{side} = \"roller\"\n")).concat();
    changed(CUBE, "[solver]", &format!("{drains}[boundary]\n{rollers}[solver]"))
}

/// What is left of the difference in a slab |x| < 1 at the time T, and its mean (Carslaw and Jaeger, 1959).
fn slab(x: f64, t: f64) -> [f64; 2] {
    let term = |n: i32| {
        let m = 0.5 * PI * f64::from(2 * n + 1);
        let fallen = (-m * m * t).exp();
        [
            2.0 / m * f64::from(1 - 2 * (n % 2)) * (m * x).cos() * fallen,
            2.0 / (m * m) * fallen,
        ]
    };
    (0..100)
        .map(term)
        .fold([0.0; 2], |sum, term| [sum[0] + term[0], sum[1] + term[1]])
}

#[test]
fn a_cube_drained_on_six_sides_follows_the_series() {
    let table = run(&cube());
    for t in [0.05, 0.08] {
        // c_v = k K_w/(gamma_w n) = 1 m2/s over half an edge.
        let centre = slab(0.25, 4.0 * t);
        let side = slab(0.75, 4.0 * t);
        let mean = slab(0.0, 4.0 * t)[1];
        let expected = [centre[0].powi(3), side[0] * centre[0].powi(2), mean.powi(3)].map(|left| 1.0 - left);
        let found = ["centre", "side", "pore-pressures-mean"].map(|column| at(&table, column, t) / 100.0);
        let errors: Vec<f64> = found
            .iter()
            .zip(expected)
            .map(|(found, expected)| found - expected)
            .collect();
        println!("{t}: {errors:?}, balance {:e}", at(&table, "water-balance", t));
        assert!(errors.iter().all(|error| error.abs() < 0.02), "{t}: {errors:?}");
        assert!(at(&table, "all", t) < 0.0 && at(&table, "water-balance", t).abs() < 1e-8);
    }
}

#[test]
fn a_cube_is_the_same_on_1_and_2_ranks_and_over_restarts() {
    let scratch = Scratch::with_case(&cube());
    for ranks in [1, 2] {
        scratch.goes_on(ranks, &["11"]);
    }
    let [one, two] = ["whole1", "whole2"].map(|name| history(&scratch.path(name)));
    for column in ["centre", "side", "pore-pressures-mean", "all"] {
        let apart = at(&two, column, 0.08) / at(&one, column, 0.08) - 1.0;
        assert!(apart.abs() < 1e-10, "{column}: {apart:e}");
    }
}

/// Level ground under water stays where it is: sigma_v' = -gamma' z.
#[test]
fn level_ground_under_water_rests() {
    let table = run(r#"
geometry = "3d"
analysis = { type = "quasi-static", steps = 2 }
grid = { lower = [-1, 0, 2], upper = [3, 2, 12], cell = 1, degree = "quadratic" }
gravity = { acceleration = [0, 0, -9.81] }
water = { level = 12 }
initial = { k0 = 0.5, equilibrium = "plastic" }
boundary = { bottom = "fixed", left = "roller", right = "roller", front = "roller", back = "roller" }
stabilisation = { method = "consistent-f-bar" }
solver = { tolerance = 1e-14, force_tolerance = 1e-10 }
[material.soil]
model = "mohr-coulomb"
young = "100 MPa"
poisson = 0.3
cohesion = "5 kPa"
friction_angle = 30.0
unit_weight = "17 kN/m3"
saturated_unit_weight = "20 kN/m3"
[[body]]
material = "soil"
box = { lower = [-1, 0, 2], upper = [3, 2, 9] }
points_per_cell = 3
[[history]]
quantity = "max-displacement"
[[history]]
quantity = "pore-pressure"
at = [0.5, 0.5, 5.5]
[[history]]
quantity = "stress"
at = [0.5, 0.5, 5.5]
[[history]]
quantity = "reaction"
face = "bottom"
"#);
    let of = |column: &str| at(&table, column, 1.0);
    let expected = -(20e3 - 9810.0) * 3.5;
    println!(
        "{:e} of {expected}, {:e} m",
        of("stress-zz") - expected,
        of("max-displacement")
    );
    assert!((of("stress-zz") - expected).abs() < 1e-6 && of("max-displacement") < 1e-12);
    assert!((of("pore-pressure") - 9810.0 * 6.5).abs() < 1e-9);
    assert!((of("reaction-z") / (56.0 * (20e3 - 9810.0)) - 1.0).abs() < 1e-10);
}
