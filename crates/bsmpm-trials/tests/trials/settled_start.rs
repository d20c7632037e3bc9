//! Tests initial stresses in plastic equilibrium.

mod water;

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{all_frames, at, differences, history, last_frame, manifest};
use bsmpm_io::frame::Frame;
use bsmpm_io::manifest::ManifestInitial;

const LAYERS: &str = r#"
geometry = "plane-strain"
[analysis]
type = "dynamic"
end = 0.02
steps = 4
[grid]
lower = [0, 0]
upper = [4, 8]
cell = "1 m"
degree = "quadratic"
[material.low]
model = "mohr-coulomb"
young = "100 MPa"
poisson = 0.3
cohesion = 0.0
friction_angle = 30.0
ocr = 2.0
unit_weight = "20 kN/m3"
[material.high]
model = "drucker-prager"
young = "30 MPa"
poisson = 0.2
cohesion = "1 kPa"
friction_angle = 25.0
k0 = 0.65
unit_weight = "17 kN/m3"
[[body]]
material = "low"
box = { lower = [0, 0], upper = [4, 4] }
points_per_cell = 3
[[body]]
material = "high"
box = { lower = [0, 4], upper = [4, 7] }
points_per_cell = 3
[gravity]
acceleration = [0, -9.81]
[initial]
equilibrium = "plastic"
[boundary]
bottom = "fixed"
left = "roller"
right = "roller"
[stabilisation]
method = "consistent-f-bar"
[output]
every_steps = 4
[[history]]
quantity = "max-displacement"
"#;

/// sigma_xx, sigma_yy, sigma_xy of a frame's points.
fn stresses(frame: &Frame) -> Vec<[f64; 3]> {
    let stress = frame.real("stress", 6).expect("a stress");
    stress
        .chunks_exact(6)
        .map(|stress| [stress[0], stress[1], stress[3]])
        .collect()
}

fn initial(scratch: &Scratch, name: &str) -> ManifestInitial {
    manifest(&scratch.path(name)).initial.expect("a stress at the start")
}

#[test]
fn level_layers_keep_k0_and_nothing_moves() {
    let scratch = Scratch::with_case(LAYERS);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(0);
    let found = initial(&scratch, "out");
    assert!(found.unbalance < 1e-12 && found.yielding == 0, "{found:?}");
    assert_eq!(found.settling.expect("it was led there").rounds, 0);
    let low = 0.5 * 2.0_f64.powf(0.5);
    for frame in all_frames(&scratch.path("out")) {
        for (place, [side, vertical, shear]) in frame.position.iter().zip(stresses(&frame)) {
            let k0 = if place[1] < 4.0 { low } else { 0.65 };
            assert!(
                (side / vertical - k0).abs() < 1e-12 && shear.abs() < 1e-9 * vertical.abs(),
                "{place:?}"
            );
        }
    }
    // The weight above as it is given is off by the points' quadrature, and moves them.
    let given = changed(LAYERS, "equilibrium = \"plastic\"", "");
    scratch.write("given.toml", &given);
    scratch.mpirun(1, &["given.toml", "-q", "-o", "given"]).expect(0);
    assert!(initial(&scratch, "given").unbalance > 1e-3);
    let [settled, given] = ["out", "given"].map(|name| at(&history(&scratch.path(name)), "max-displacement", 0.02));
    assert!(settled < 1e-9 * given, "{settled:e} {given:e}");
}

/// A slope of 1 in 2 of sand without cohesion, 26.6 degrees, whose friction angle is 30 degrees.
const SAND: &str = r#"
geometry = "plane-strain"
[analysis]
type = "quasi-static"
end = 1.0
steps = 4
[grid]
lower = [0, 0]
upper = [32, 12]
cell = "2 m"
degree = "quadratic"
[material.sand]
model = "mohr-coulomb"
young = "100 MPa"
poisson = 0.3
cohesion = 0.0
friction_angle = 30.0
unit_weight = "20 kN/m3"
[[body]]
material = "sand"
polygon = [[0, 0], [32, 0], [32, 2], [24, 2], [8, 10], [0, 10]]
points_per_cell = 3
[gravity]
acceleration = [0, -9.81]
[initial]
k0 = 0.5
equilibrium = "plastic"
[boundary]
bottom = "fixed"
left = "roller"
right = "roller"
[stabilisation]
method = "consistent-f-bar"
[output]
every_steps = 1
[[history]]
quantity = "max-displacement"
"#;

/// The same loaded by gravity that grows from zero.
fn grown(case: &str) -> String {
    let a = case.find("[initial]").expect("a start");
    let b = case.find("[boundary]").expect("supports");
    changed(&(case[..a].to_owned() + &case[b..]), "-9.81]", "-9.81]\nramp = 1.0")
}

#[test]
fn a_slope_of_sand_near_its_friction_angle_begins_at_rest() {
    let scratch = Scratch::new();
    let elastic = changed(SAND, "k0 = 0.5", "gravity = \"elastic\"");
    for (name, case) in [("k0", SAND), ("elastic", &elastic), ("grown", &grown(SAND))] {
        scratch.write("case.toml", case);
        scratch.mpirun(1, &["case.toml", "-q", "-o", name]).expect(0);
    }
    let moved = |name: &str| at(&history(&scratch.path(name)), "max-displacement", 1.0);
    for name in ["k0", "elastic"] {
        let found = initial(&scratch, name);
        println!("{name}: {found:?}, moves {:.1e} of {:.1e}", moved(name), moved("grown"));
        assert!(found.unbalance < 1e-4 && found.yielding == 0, "{name}: {found:?}");
        assert!(
            moved(name) < 1e-2 * moved("grown"),
            "{name}: {:e} {:e}",
            moved(name),
            moved("grown")
        );
    }
    for (name, case) in [("weight", SAND), ("loaded", &elastic)] {
        scratch.write("case.toml", changed(case, "equilibrium = \"plastic\"", ""));
        let run = scratch.mpirun(1, &["case.toml", "-o", name]).expect(0);
        let given = initial(&scratch, name);
        println!("as given, {name}: {given:?}, moves {:.1e}", moved(name));
        assert!(given.unbalance > 1e-2 || given.yielding > 0, "{given:?}");
        assert!(run.stderr.contains("equilibrium = \"plastic\""), "{}", run.stderr);
    }
}

/// Elastic soil is pulled at a slope's top, where a law that has nothing without pressure has no state to start from.
#[test]
fn a_slope_of_cam_clay_begins_at_rest() {
    let clay = "modified-cam-clay\"\nkappa_star = 0.02\nlambda_star = 0.12\ncritical_state_ratio = 1.0\nocr = 2.5";
    let case = changed(SAND, "mohr-coulomb\"", clay);
    let case = changed(&case, "cohesion = 0.0\nfriction_angle = 30.0\n", "");
    let case = changed(&case, "100 MPa", "10 MPa");
    let case = changed(&case, "[8, 10], [0, 10]", "[8, 6], [0, 6]");
    let scratch = Scratch::with_case(&changed(&case, "k0 = 0.5", "k0 = 0.7"));
    scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(0);
    let moved = at(&history(&scratch.path("out")), "max-displacement", 1.0);
    assert!(initial(&scratch, "out").unbalance < 1e-4 && moved < 1e-4, "{moved:e} m"); // measured 5.5e-5
}

/// Shaken from the start: at rest before, the same on three ranks, and to the bit however it is cut.
#[test]
fn a_settled_slope_is_shaken_the_same_on_any_ranks_and_in_parts() {
    let case = changed(
        SAND,
        "type = \"quasi-static\"\nend = 1.0\nsteps = 4",
        "type = \"dynamic\"\nend = 0.2\ndt = 0.01",
    );
    let case = changed(&case, "every_steps = 1", "every_steps = 20");
    let case = case
        + "[shaking]\nacceleration = [[0.05, 0, 0], [0.1, 2, 0], [0.15, 0, 0]]\n\
           [solver]\ntolerance = 1e-12\nforce_tolerance = 1e-8\n";
    let scratch = Scratch::with_case(&case);
    for ranks in ["1", "3"] {
        let count = ranks.parse().unwrap();
        scratch.mpirun(count, &["case.toml", "-q", "-o", ranks]).expect(0);
    }
    let columns = history(&scratch.path("1"));
    let [before, after] = [0.05, 0.2].map(|t| at(&columns, "max-displacement", t));
    println!(
        "moved {before:.1e} before, {after:.1e} after: {:?}",
        initial(&scratch, "1")
    );
    assert!(before < 1e-4 * after, "{before:e} {after:e}");
    for (field, difference) in differences(&last_frame(&scratch.path("3")), &last_frame(&scratch.path("1"))) {
        assert!(difference < 1e-8, "{field} on 3 ranks differs by {difference:.1e}");
    }
    let part = ["case.toml", "-q", "-o", "part", "--restart", "auto"];
    scratch
        .mpirun(1, &[&part[..], &["--max-steps", "3"]].concat())
        .expect(75);
    scratch.mpirun(1, &part).expect(0);
    let text = |name: &str| std::fs::read_to_string(scratch.path(name).join("history.csv")).unwrap();
    assert!(text("1") == text("part"));
}

/// A vertical bank of sand has no equilibrium: the run says so before its first step.
#[test]
fn ground_that_cannot_stand_has_no_start() {
    let bank = changed(SAND, "[32, 2], [24, 2], [8, 10]", "[32, 2], [8, 2], [8, 10]");
    let case = bank + "[solver]\nmax_iterations = 30\n";
    let scratch = Scratch::with_case(&case);
    let run = scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(80);
    assert!(run.stderr.contains("the initial stress failed"), "{}", run.stderr);
}

/// A toe that ends in a point has cells with next to no material there. Without extended splines two points along an
/// axis cannot hold what these carry, and the run says where.
#[test]
fn a_toe_that_ends_in_a_point_needs_extended_splines_or_more_points() {
    let changes = [
        (
            "[[0, 0], [32, 0], [32, 2], [24, 2], [8, 10], [0, 10]]",
            "[[0, 0], [18, 0], [8, 5], [0, 5]]",
        ),
        ("upper = [32, 12]", "upper = [20, 6]"),
        ("cell = \"2 m\"", "cell = \"1 m\""),
        (
            "cohesion = 0.0\nfriction_angle = 30.0",
            "cohesion = \"10 kPa\"\nfriction_angle = 25.0",
        ),
    ];
    let case = changes
        .iter()
        .fold(SAND.to_owned(), |case, (part, by)| changed(&case, part, by));
    let two = changed(&case, "points_per_cell = 3", "points_per_cell = 2");
    let scratch = Scratch::with_case(&two);
    let off = ["--set", "solver.extension=off"];
    let run = scratch
        .mpirun(2, &[&["case.toml", "-q", "-o", "off"], &off[..]].concat())
        .expect(80);
    let place = run.stderr.split_once("Location: node ").expect("the place").1;
    assert!(
        place.contains(" at [17.5") && run.stderr.contains("points_per_cell = 3"),
        "{}",
        run.stderr
    );
    scratch.mpirun(2, &["case.toml", "-q", "-o", "two"]).expect(0);
    scratch.write("case.toml", &case);
    scratch.mpirun(2, &["case.toml", "-q", "-o", "three"]).expect(0);
    for name in ["two", "three"] {
        let found = initial(&scratch, name);
        assert!(found.unbalance < 1e-4 && found.yielding == 0, "{name}: {found:?}");
    }
}

/// Clay with a step of 3 m in its surface, at x = 12 m.
fn stepped() -> String {
    let case = changed(
        SAND,
        "cohesion = 0.0\nfriction_angle = 30.0",
        "cohesion = \"15 kPa\"\nfriction_angle = 20.0",
    );
    let case = changed(
        &case,
        "[[0, 0], [32, 0], [32, 2], [24, 2], [8, 10], [0, 10]]",
        "[[0, 0], [24, 0], [24, 7], [12, 7], [12, 10], [0, 10]]",
    );
    let case = changed(&case, "upper = [32, 12]", "upper = [24, 12]");
    let case = changed(&case, "k0 = 0.5", "k0 = 0.43");
    changed(&case, "cell = \"2 m\"", "cell = \"1 m\"")
}

#[test]
fn beneath_a_step_of_the_surface_the_weight_is_spread_as_by_gravity_that_grows() {
    let scratch = Scratch::new();
    let given = changed(&stepped(), "equilibrium = \"plastic\"", "");
    for (name, case) in [("settled", stepped()), ("given", given), ("grown", grown(&stepped()))] {
        scratch.write("case.toml", case);
        scratch.mpirun(1, &["case.toml", "-q", "-o", name]).expect(0);
    }
    let [settled, given] = ["settled", "given"].map(|name| all_frames(&scratch.path(name)).remove(0));
    let grown = last_frame(&scratch.path("grown"));
    // A row of points a metre beneath the lower surface, by the places of the start.
    let row = |frame: &Frame| {
        let mut row: Vec<(f64, f64)> = settled
            .position
            .iter()
            .zip(stresses(frame))
            .filter(|(place, _)| (place[1] - 35.0 / 6.0).abs() < 1e-6)
            .map(|(place, [_, vertical, _])| (place[0], vertical))
            .collect();
        row.sort_by(|a, b| a.0.total_cmp(&b.0));
        row
    };
    let [settled, given, grown] = [&settled, &given, &grown].map(row);
    let jump = |row: &[(f64, f64)]| {
        row.windows(2)
            .map(|pair| (pair[1].1 - pair[0].1).abs())
            .fold(0.0, f64::max)
    };
    let weight = 2e4 * 3.0;
    println!(
        "jumps of {weight}: given {:.0}, settled {:.0}, grown {:.0} Pa",
        jump(&given),
        jump(&settled),
        jump(&grown)
    );
    let off = |row: &[(f64, f64)]| {
        row.iter()
            .zip(&grown)
            .map(|(a, b)| (a.1 - b.1).abs())
            .fold(0.0, f64::max)
            / weight
    };
    println!(
        "off from gravity that grows, of the step's weight: given {:.3}, settled {:.3}",
        off(&given),
        off(&settled)
    );
    assert!((jump(&given) / weight - 1.0).abs() < 1e-9);
    assert!(jump(&settled) < 1.2 * jump(&grown) && off(&settled) < 0.1 && off(&given) > 0.3);
}

/// The start of the slope between rollers, without a stabilisation, whose exponent would be another one: as in plane
/// strain, by as much as either is out of balance.
#[test]
fn a_slope_in_space_starts_as_in_plane_strain() {
    let stress = |name: &str, at: &str| format!("[[history]]\nquantity = \"stress\"\nname = \"{name}\"\nat = {at}\n");
    let plane = changed(SAND, "\"consistent-f-bar\"", "\"none\"");
    let outline = "polygon = [[0, 0], [32, 0], [32, 2], [24, 2], [8, 10], [0, 10]]";
    let mut slice = plane.clone();
    for (of_plane, of_solid) in [
        ("\"plane-strain\"", "\"solid\""),
        (
            "lower = [0, 0]\nupper = [32, 12]",
            "lower = [0, 0, 0]\nupper = [32, 2, 12]",
        ),
        (
            outline,
            &format!("extrude = {{ {outline}, along = \"y\", from = 0, to = 2 }}"),
        ),
        ("[0, -9.81]", "[0, 0, -9.81]"),
        (
            "bottom = \"fixed\"",
            "bottom = \"fixed\"\nfront = \"roller\"\nback = \"roller\"",
        ),
    ] {
        slice = changed(&slice, of_plane, of_solid);
    }
    let plane = plane + &stress("toe", "[22, 1]") + &stress("middle", "[14, 3]");
    let slice = slice + &stress("toe", "[22, 1, 1]") + &stress("middle", "[14, 1, 3]");
    let [(of_plane, plane), (of_slice, slice)] = [plane, slice].map(|case| {
        let scratch = Scratch::with_case(&case);
        scratch
            .direct(&["case.toml", "-q", "-o", "out", "--max-steps", "1"])
            .expect(75);
        (initial(&scratch, "out"), history(&scratch.path("out")))
    });
    assert!(
        of_plane.settling.is_some() && of_slice.settling.is_some() && of_slice.unbalance < 1e-4,
        "{of_slice:?}"
    );
    for place in ["toe", "middle"] {
        let vertical = at(&plane, &format!("{place}-yy"), 0.0);
        for (a, b) in [("xx", "xx"), ("yy", "zz"), ("zz", "yy"), ("xy", "xz")] {
            let [a, b] = [
                at(&plane, &format!("{place}-{a}"), 0.0),
                at(&slice, &format!("{place}-{b}"), 0.0),
            ];
            println!("{place}: {a} {b}: {:e}", (a - b) / vertical);
            assert!((a - b).abs() < 1e-4 * vertical.abs(), "{place}: {a} and {b}");
        }
        assert!(
            at(&plane, &format!("{place}-xy"), 0.0) > 0.1 * vertical.abs(),
            "k0 alone has no shear"
        );
    }
}
