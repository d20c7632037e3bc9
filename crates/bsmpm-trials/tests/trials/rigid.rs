//! Tests of rigid bodies, among them the thrust of sand on a wall.

use crate::support::cases::changed;
use crate::support::results::{at, history, manifest};
use crate::support::{Scratch, shipped};

/// A block falls on soil beside a plough that goes through its surface.
const CASE: &str = r#"
geometry = "plane-strain"
[analysis]
type = "dynamic"
end = 0.12
dt = 0.003
[grid]
lower = [0, 0]
upper = [4, 2]
cell = 0.25
degree = "quadratic"
[material.soil]
model = "elastic"
young = "1 MPa"
poisson = 0.3
density = 1800
[[body]]
material = "soil"
box = { lower = [0, 0], upper = [4, 1] }
points_per_cell = 2
[[rigid]]
name = "block"
polygon = [[0.6, 1.02], [1.2, 1.02], [1.2, 1.4], [0.6, 1.4]]
density = 2500
friction_coefficient = 0.4
free = ["x", "y", "rotation"]
start_velocity = [0.3, -0.5]
[[rigid]]
name = "roller"
circle = { centre = [2.8, 1.5], radius = 0.5 }
friction_coefficient = 0.3
path = [[0.06, 0.0, -0.03], [0.12, 0.05, -0.03]]
rotation = [[0.06, 0.0], [0.12, -10.0]]
[gravity]
acceleration = [0, -9.81]
[initial]
k0 = 0.43
[boundary]
left = "roller"
right = "roller"
bottom = "fixed"
[solver]
tolerance = 1e-12
force_tolerance = 1e-9
[[stage]]
at = 0.06
reset_displacements = true
[[history]]
quantity = "rigid-force"
rigid = "block"
name = "block"
[[history]]
quantity = "rigid-velocity"
rigid = "block"
[[history]]
quantity = "rigid-rotation"
rigid = "block"
[[history]]
quantity = "rigid-force"
rigid = "roller"
name = "roller"
[[history]]
quantity = "rigid-moment"
rigid = "roller"
[[history]]
quantity = "rigid-slip"
rigid = "roller"
[[history]]
quantity = "rigid-work"
rigid = "roller"
[[history]]
quantity = "rigid-gap"
rigid = "block"
[[history]]
quantity = "rigid-displacement"
rigid = "roller"
[[history]]
quantity = "energy"
"#;

#[test]
fn rigid_bodies_are_the_same_on_any_number_of_ranks_and_over_restarts() {
    let scratch = Scratch::with_case(CASE);
    for ranks in [1, 3] {
        scratch.goes_on(ranks, &["5", "22"]);
    }
    let [one, three] = ["whole1", "whole3"].map(|name| history(&scratch.path(name)));
    for name in [
        "block-y",
        "rigid-velocity-x",
        "rigid-velocity-y",
        "roller-x",
        "roller-y",
        "rigid-moment",
        "rigid-work",
    ] {
        let a = at(&one, name, 0.12);
        let b = at(&three, name, 0.12);
        assert!((a - b).abs() < 1e-8 * a.abs(), "{name}: {a} and {b}");
    }
    assert!(at(&one, "block-y", 0.12) > 0.0 && at(&one, "roller-y", 0.06) > 1e3 && at(&one, "rigid-slip", 0.12) > 0.0);
    // Where it touches it goes back, 0.05 - 10 degrees of 0.5 m: friction drives it on, and turns against it.
    let [x, y, moment] = ["roller-x", "roller-y", "rigid-moment"].map(|name| at(&one, name, 0.12));
    assert!(x > 0.25 * y && moment > 0.25 * 0.5 * y, "{x} {y} {moment}");
    assert!((at(&one, "rigid-displacement-x", 0.12) - 0.05).abs() < 1e-12);
    let [before, after] = [0.06, 0.12].map(|t| at(&one, "rigid-displacement-y", t));
    assert!(
        (before + 0.03).abs() < 1e-12 && after.abs() < 1e-12,
        "{before:e}, from the stage on {after:e}"
    );
    assert!(at(&one, "rigid-work", 0.12) > 0.0, "it goes into the soil");
    let [closure, external] = ["energy-closure", "energy-external"].map(|name| at(&one, name, 0.12).abs());
    assert!(closure < 1e-6 * external, "{closure:e} of {external:e}");
}

#[test]
fn what_is_doubtful_of_rigid_bodies_is_reported_and_what_nothing_holds_ends_the_run() {
    let met = changed(
        CASE,
        "centre = [2.8, 1.5], radius = 0.5",
        "centre = [1.3, 1.9], radius = 0.5",
    );
    let met = changed(&met, "[0.06, 0.0, -0.03]", "[0.06, -0.1, -0.3]");
    let scratch = Scratch::with_case(&changed(&met, "dt = 0.003", "dt = 0.03"));
    scratch
        .mpirun(1, &["case.toml", "--check"])
        .expect(0)
        .says_once("warning W0411");
    scratch.write("case.toml", met);
    let output = scratch
        .mpirun(1, &["case.toml", "-q", "-o", "met", "--max-steps", "20"])
        .expect(80);
    output.says_once("error E0752: ");
    let free = changed(CASE, "type = \"dynamic\"", "type = \"quasi-static\"");
    let free = changed(&free, "start_velocity = [0.3, -0.5]\n", "");
    let free = changed(
        &free,
        "[[history]]\nquantity = \"rigid-velocity\"\nrigid = \"block\"\n",
        "",
    );
    scratch.write("case.toml", free);
    scratch
        .mpirun(1, &["case.toml", "-q", "-o", "loose"])
        .expect(80)
        .says_once("error E0751: ");
}

/// A rigid wall that retains sand at rest on a rough base, and goes away from it from the first step on.
const WALL: &str = r#"
geometry = "plane-strain"
[analysis]
type = "quasi-static"
end = 1.0
steps = 20
[grid]
lower = [-1, 0]
upper = [8, 4]
cell = 0.25
degree = "quadratic"
[material.sand]
model = "mohr-coulomb"
young = "20 MPa"
poisson = 0.3
friction_angle = 30
dilation_angle = 0
cohesion = 0
unit_weight = "18 kN/m3"
[[body]]
material = "sand"
box = { lower = [0, 0], upper = [8, 3] }
points_per_cell = 3
[[rigid]]
name = "wall"
polygon = [[-0.9, 0], [0, 0], [0, 3.3], [-0.9, 3.3]]
friction_coefficient = 0.0
displacement = [-0.02, 0]
[initial]
k0 = 0.5
[gravity]
acceleration = [0, -9.81]
[boundary]
bottom = "fixed"
right = "roller"
[stabilisation]
method = "consistent-f-bar"
[[history]]
quantity = "rigid-force"
rigid = "wall"
"#;

/// The horizontal part of Coulomb's active thrust on that wall with this coefficient of friction at it, N.
fn active(friction: f64) -> f64 {
    let phi = 30.0_f64.to_radians();
    let delta = friction.atan();
    let root = ((phi + delta).sin() * phi.sin() / delta.cos()).sqrt();
    0.5 * 18.0e3 * 9.0 * (phi.cos() / (1.0 + root)).powi(2)
}

/// Forces of the sand on the wall away from it and down, by the wall's history `force`, at the end of a case, which has
/// none of its steps cut.
fn thrust(case: &str, ranks: usize, force: &str) -> [f64; 2] {
    let scratch = Scratch::with_case(case);
    scratch.mpirun(ranks, &["case.toml", "-q"]).expect(0);
    let summary = manifest(&scratch.path("case.out")).summary;
    assert_eq!((summary.steps, summary.cutbacks), (20, 0), "{summary:?}");
    let found = history(&scratch.path("case.out"));
    ["x", "y"].map(|axis| -at(&found, &format!("{force}-{axis}"), 1.0))
}

/// The wall lets go of nothing that still pushes: it ended in its first step away from sand that yields, which all its
/// points had left at once as it went farther in the step than they were in it.
#[test]
fn a_rigid_wall_that_goes_away_from_sand_has_rankines_and_coulombs_active_thrust() {
    // Gravity that grows before it moves, in the place of stress at rest.
    let grown = changed(WALL, "[initial]\nk0 = 0.5\n", "");
    let grown = changed(
        &grown,
        "acceleration = [0, -9.81]",
        "acceleration = [0, -9.81]\nramp = 0.5",
    );
    let grown = changed(
        &grown,
        "displacement = [-0.02, 0]",
        "path = [[0.5, 0, 0], [1, -0.02, 0]]",
    );
    let [smooth, two] = [1, 2].map(|ranks| thrust(&grown, ranks, "rigid-force"));
    // The base holds half a cell of what would come down: -2.4 %, in cells twice as long -10 %.
    assert!((smooth[0] / active(0.0) - 1.0).abs() < 0.03, "{smooth:?}");
    // 7e-13 seen.
    assert!(
        (two[0] / smooth[0] - 1.0).abs() < 1e-6,
        "{two:?} on two ranks, {smooth:?} on one"
    );
    // From rest; -2.2 %, and all of it slides: friction is 0.3 to rounding.
    let rough = thrust(
        &changed(WALL, "friction_coefficient = 0.0", "friction_coefficient = 0.3"),
        1,
        "rigid-force",
    );
    assert!((rough[0] / active(0.3) - 1.0).abs() < 0.03, "{rough:?}");
    assert!((rough[1] / rough[0] / 0.3 - 1.0).abs() < 1e-9, "{rough:?}");
}

/// The same wall as a strip in contact: it, too, ended in its first step, whose points pressed nothing before.
#[test]
fn a_strip_in_contact_that_goes_away_from_sand_at_rest_has_rankines_and_coulombs_active_thrust() {
    let body =
        "[[rigid]]\nname = \"wall\"\npolygon = [[-0.9, 0], [0, 0], [0, 3.3], [-0.9, 3.3]]\nfriction_coefficient = 0.0";
    let strip =
        "[[prescribed]]\nname = \"wall\"\nfrom = [0, 0]\nto = [0, 3]\ncomponents = { friction_coefficient = MU }";
    let as_strip = changed(
        &changed(WALL, body, strip),
        "\"rigid-force\"\nrigid",
        "\"reaction\"\nof",
    );
    for friction in [0.0, 0.3] {
        let found = thrust(&changed(&as_strip, "MU", &format!("{friction:?}")), 1, "reaction").map(f64::abs);
        // -2.2 and -2.1 %.
        assert!(
            (found[0] / active(friction) - 1.0).abs() < 0.03,
            "{friction}: {found:?}"
        );
        assert!((found[1] / found[0] - friction).abs() < 1e-9, "{friction}: {found:?}");
    }
}

#[test]
fn a_rigid_wall_that_is_pushed_into_sand_has_rankines_passive_thrust() {
    // On a smooth base, which has none of the thrust, and with associated flow, which has one limit.
    let mut pushed = WALL.to_owned();
    for (active, passive) in [
        ("displacement = [-0.02, 0]", "displacement = [0.05, 0]"),
        ("cell = 0.25", "cell = 0.5"),
        ("dilation_angle = 0", "dilation_angle = 30"),
        ("bottom = \"fixed\"", "bottom = \"roller\""),
    ] {
        pushed = changed(&pushed, active, passive);
    }
    let [found, _] = thrust(&pushed, 1, "rigid-force");
    let passive = 0.5 * 18.0e3 * 9.0 * 3.0;
    // +0.38 %: it has heaved.
    assert!((found / passive - 1.0).abs() < 0.01, "{found} for {passive}");
}

/// A plate with a force on elastic ground, which a stage places there and another one takes away.
const STAGED: &str = r#"
geometry = "plane-strain"
[analysis]
type = "quasi-static"
end = 4
steps = 8
[grid]
lower = [0, 0]
upper = [2, 4]
cell = 0.5
degree = "quadratic"
[material.soil]
model = "elastic"
young = "100 GPa"
poisson = 0.25
density = 2000
[[body]]
material = "soil"
box = { lower = [0, 0], upper = [2, 2] }
points_per_cell = 3
[[rigid]]
name = "plate"
polygon = [[-1, 2], [3, 2], [3, 3.5], [-1, 3.5]]
free = ["y"]
force = [0, -1e6]
ramp = 1
[[stage]]
at = 1
activate = ["plate"]
[[stage]]
at = 3
deactivate = ["plate"]
[boundary]
bottom = "fixed"
left = "roller"
right = "roller"
[solver]
tolerance = 1e-14
force_tolerance = 1e-9
background = 0
[[history]]
quantity = "rigid-force"
rigid = "plate"
name = "force"
[[history]]
quantity = "rigid-displacement"
rigid = "plate"
name = "plate"
[[history]]
quantity = "displacement"
at = [1, 2]
name = "top"
"#;

/// The ground goes down by q H/M under what stages place on it, half of it as half of the force acts, and comes back
/// without; the plate stays where it was. On three ranks, and over restarts, the same.
#[test]
fn stages_place_rigid_bodies_and_take_them_away() {
    let scratch = Scratch::with_case(STAGED);
    for ranks in [1, 3] {
        scratch.goes_on(ranks, &["2", "5", "6"]);
    }
    let [one, three] = ["whole1", "whole3"].map(|name| history(&scratch.path(name)));
    let exact = -1e6 / 2.0 * 2.0 / 1.2e11;
    assert_eq!(
        [
            at(&one, "force-y", 1.0),
            at(&one, "top-y", 1.0),
            at(&one, "plate-y", 1.0)
        ],
        [0.0; 3]
    );
    for (t, share) in [(1.5, 0.5), (2.0, 1.0), (3.0, 1.0)] {
        assert!((at(&one, "force-y", t) / (1e6 * share) - 1.0).abs() < 1e-6, "t = {t}");
        // The points' quadrature at the surface: 3.8e-4; the plate goes into them by the penalty, 3.0e-3.
        let [top, plate] = ["top-y", "plate-y"].map(|name| at(&one, name, t) / (exact * share) - 1.0);
        assert!(top.abs() < 5e-4 && plate.abs() < 4e-3, "t = {t}: {top:e} {plate:e}");
        assert!(
            (at(&three, "top-y", t) / at(&one, "top-y", t) - 1.0).abs() < 1e-8,
            "t = {t}"
        );
    }
    assert_eq!(at(&one, "force-y", 4.0), 0.0);
    assert!((at(&one, "top-y", 4.0) / exact).abs() < 1e-3);
    assert_eq!(at(&one, "plate-y", 4.0), at(&one, "plate-y", 3.0));
}

/// What a stage places in dynamics falls from rest from then on, exactly, while nothing is near.
#[test]
fn a_rigid_body_that_a_stage_places_falls_from_then_on() {
    let case = changed(STAGED, "\"quasi-static\"\nend = 4", "\"dynamic\"\nend = 0.4");
    let case = changed(
        &case,
        "polygon = [[-1, 2], [3, 2], [3, 3.5], [-1, 3.5]]",
        "circle = { centre = [1, 3.3], radius = 0.2 }",
    );
    let case = changed(&case, "force = [0, -1e6]\nramp = 1", "density = 2500");
    let case = changed(
        &case,
        "[[stage]]\nat = 3\ndeactivate = [\"plate\"]\n",
        "[gravity]\nacceleration = [0, -9.81]\n",
    );
    let scratch = Scratch::with_case(&changed(&case, "at = 1\n", "at = 0.2\n"));
    scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(0);
    let found = history(&scratch.path("out"));
    assert_eq!(at(&found, "plate-y", 0.2), 0.0);
    for t in [0.25, 0.4] {
        let fallen = -0.5 * 9.81 * (t - 0.2_f64).powi(2);
        assert!(
            (at(&found, "plate-y", t) / fallen - 1.0).abs() < 1e-12,
            "t = {t}: {}",
            at(&found, "plate-y", t)
        );
    }
}

/// A rough punch in plastic failure, with and without a C0 line at its corner: in these steps it had stopped at 0.44 of
/// the way without, as nothing led to an equilibrium, and had come to 6.09 c with ten times as many.
#[test]
fn a_rough_punch_on_clay_goes_the_whole_way() {
    let scratch = Scratch::new();
    let case = shipped("validation/rigid_punch.toml");
    for (lines, expected) in [("none", 6.09), ("automatic", 5.46)] {
        let lines = format!("grid.c0_lines={lines}");
        let set = [
            "--set",
            "rigid.0.friction_coefficient=1.0",
            "--set",
            "check=[]",
            "--set",
            &lines,
        ];
        scratch
            .mpirun(
                1,
                &[&[case.to_str().unwrap(), "-q", "--force", "-o", "out"][..], &set].concat(),
            )
            .expect(0);
        let pressure = at(&history(&scratch.path("out")), "p_over_c-y", 1.0);
        assert!((pressure / expected - 1.0).abs() < 0.005, "{pressure} for {expected}");
    }
}

/// Soil with a notch, to whose sides its points come no nearer than 0.7 of their spacing.
const NOTCH: &str = r#"
geometry = "plane-strain"
[analysis]
type = "quasi-static"
steps = 2
[grid]
lower = [0, 0]
upper = [2, 2.25]
cell = 0.125
degree = "quadratic"
[material.soil]
model = "elastic"
young = "10 MPa"
poisson = 0.3
[[body]]
material = "soil"
polygon = [[0, 0], [2, 0], [2, 2], [0.5, 2], [0, 1.5]]
points_per_cell = 3
[boundary]
left = "roller"
right = "roller"
bottom = "fixed"
[stabilisation]
method = "none"
"#;

/// What lies flush with an inclined outline touches it from the start: it had to be pushed by 12 mm here before.
#[test]
fn a_wedge_that_lies_in_a_notch_touches_its_sides() {
    let wedge = "[[rigid]]\nname = \"wedge\"\npolygon = [[0, 1.5], [0.5, 2], [0.5, 2.2], [-0.5, 2.2], [-0.5, 2]]\n\
                 displacement = [0, -0.002]\n[[history]]\nquantity = \"rigid-force\"\nrigid = \"wedge\"\nname = \"f\"\n";
    let footing = "[footing]\nfrom = [0, 1.5]\nto = [0.5, 2]\ndisplacement = [0, -0.002]\ninterface = \"smooth\"\n\
                   [[history]]\nquantity = \"footing-force\"\nname = \"f\"\n";
    let force = |by: &str, column: &str| {
        let scratch = Scratch::with_case(&format!("{NOTCH}{by}"));
        scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(0);
        at(&history(&scratch.path("out")), column, 1.0)
    };
    let by_body = force(wedge, "f-y");
    let by_footing = force(footing, "f");
    // measured 10,804 for 12,006; in cells half as long 11,137 for 11,849, a quarter 11,257 for 11,731
    assert!(
        (by_body / by_footing - 1.0).abs() < 0.12,
        "{by_body} for {by_footing} N"
    );
}
