//! Compares surface loads in 3-D with closed forms.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{at, history};
use std::f64::consts::PI;

/// A cube on three rollers that is loaded along one axis.
const CUBE: &str = r#"
geometry = "3d"
[analysis]
type = "quasi-static"
steps = 1
[grid]
lower = [0, 0, 0]
upper = [1.5, 1.5, 1.5]
cell = 0.25
degree = "quadratic"
[material.soil]
model = "elastic"
young = "1 MPa"
poisson = 0.3
[[body]]
material = "soil"
box = { lower = [0, 0, 0], upper = [1, 1, 1] }
points_per_cell = 2
[[traction]]
rectangle = { lower = [0, 0, 1], upper = [1, 1, 1] }
stress = [0, 0, "-100 kPa"]
ramp = 1.0
[boundary]
left = "roller"
front = "roller"
bottom = "roller"
[solver]
background = 0
tolerance = 1e-18
force_tolerance = 1e-12
[[history]]
quantity = "displacement"
at = [1, 1, 1]
"#;

/// The root of `f` between two places, by halves.
fn root(f: impl Fn(f64) -> f64, mut ends: [f64; 2]) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (ends[0] + ends[1]);
        ends[usize::from(f(middle) * f(ends[0]) <= 0.0)] = middle;
    }
    ends[0]
}

/// Kirchhoff's stress is E ln(lambda) along the load; a dead load has lambda of it, a pressure J.
#[test]
fn a_cube_under_a_dead_load_and_under_a_pressure_is_that_of_henckys_law() {
    let young = 1e6;
    let poisson = 0.3;
    let load = 1e5;
    let dead = root(|l| young * f64::ln(l) + load * l, [0.5, 1.0]);
    let pressed = root(
        |l| young * f64::ln(l) + load * f64::powf(l, 1.0 - 2.0 * poisson),
        [0.5, 1.0],
    );
    let top = "{ lower = [0, 0, 1], upper = [1, 1, 1] }\nstress = [0, 0, \"-100 kPa\"]";
    let right = "{ lower = [1, 0, 0], upper = [1, 1, 1] }\nstress = [\"-100 kPa\", 0, 0]";
    let back = "{ lower = [0, 1, 0], upper = [1, 1, 1] }\npressure = \"100 kPa\"";
    for (number, (axis, line, expected)) in [("z", top, dead), ("x", right, dead), ("y", back, pressed)]
        .into_iter()
        .enumerate()
    {
        // In one step points stand where they integrate exactly.
        let scratch = Scratch::with_case(&changed(CUBE, top, line));
        scratch
            .mpirun(1 + number % 2, &["case.toml", "-q", "-o", "out"])
            .expect(0);
        let table = history(&scratch.path("out"));
        for along in ["x", "y", "z"] {
            let stretch = 1.0 + at(&table, &format!("displacement-{along}"), 1.0);
            let expected = if along == axis {
                expected
            } else {
                expected.powf(-poisson)
            };
            println!("{axis}, {along}: {stretch} for {expected}");
            assert!(
                (stretch - expected).abs() < 1e-9,
                "{axis}, {along}: {stretch} for {expected}"
            );
        }
    }
}

/// What acts on a part of a face that the cells do not share, in all directions, is what the base holds.
#[test]
fn the_base_holds_what_acts_on_a_part_of_a_face() {
    let rollers = "left = \"roller\"\nfront = \"roller\"\nbottom = \"roller\"";
    let held = changed(CUBE, rollers, "bottom = \"fixed\"");
    let part = "{ lower = [0.1, 0.3, 1], upper = [0.7, 0.85, 1] }\nstress = [\"1 kPa\", \"-2 kPa\", \"3 kPa\"]";
    let top = "{ lower = [0, 0, 1], upper = [1, 1, 1] }\nstress = [0, 0, \"-100 kPa\"]";
    let held = changed(&held, top, part);
    let wanted = "[[history]]\nquantity = \"reaction\"\nface = \"bottom\"\n";
    let scratch = Scratch::with_case(&format!("{held}{wanted}"));
    scratch.mpirun(2, &["case.toml", "-q", "-o", "out"]).expect(0);
    let table = history(&scratch.path("out"));
    for (along, stress) in [("x", 1e3), ("y", -2e3), ("z", 3e3)] {
        let force = at(&table, &format!("reaction-{along}"), 1.0);
        assert!((force + 0.6 * 0.55 * stress).abs() < 1e-6, "{along}: {force}");
    }
}

/// A bar of square section that is held at one end, 4 and 8 cells across.
pub const BAR: &str = r#"
geometry = "3d"
[analysis]
type = "quasi-static"
steps = 1
[grid]
lower = [0, 0, 0]
upper = [2.25, 0.75, 0.75]
cell = 0.125
degree = "quadratic"
[material.soil]
model = "elastic"
young = "1 MPa"
poisson = 0.3
[[body]]
material = "soil"
box = { lower = [0, 0.125, 0.125], upper = [2, 0.625, 0.625] }
points_per_cell = 2
[boundary]
left = "fixed"
[solver]
linear = "direct"
tolerance = 1e-14
force_tolerance = 1e-9
"#;

/// What a bar's end moves by under tractions there, of `places` along its axis and of height z.
fn bar(loads: &[([f64; 2], [f64; 2], [f64; 3])], cell: f64, places: &[(f64, f64)]) -> Vec<[f64; 3]> {
    let loads = loads.iter().map(|(lower, upper, stress)| {
        let [lower, upper] = [lower, upper].map(|[y, z]| format!("[2, {y}, {z}]"));
        format!("[[traction]]\nrectangle = {{ lower = {lower}, upper = {upper} }}\nstress = {stress:?}\nramp = 1.0\n")
    });
    let reported = places.iter().enumerate().map(|(number, (x, z))| {
        format!("[[history]]\nname = \"at{number}\"\nquantity = \"displacement\"\nat = [{x}, 0.375, {z}]\n")
    });
    let bar = changed(BAR, "cell = 0.125", &format!("cell = {cell}"));
    let scratch = Scratch::with_case(&format!(
        "{bar}{}{}",
        loads.collect::<String>(),
        reported.collect::<String>()
    ));
    scratch.direct(&["case.toml", "-q", "-o", "out"]).expect(0);
    let table = history(&scratch.path("out"));
    let moved = |number: usize| ["x", "y", "z"].map(|along| at(&table, &format!("at{number}-{along}"), 1.0));
    (0..places.len()).map(moved).collect()
}

/// Timoshenko's beam with Cowper's (1966) coefficient of shear; Saint-Venant's torsion of a square, whose constant is
/// 0.1406 of the edge's fourth power.
#[test]
fn a_bar_bends_and_twists_as_beams_do() {
    let young = 1e6;
    let poisson = 0.3;
    let edge = 0.5_f64;
    let length = 2.0_f64;
    let shear = young / (2.0 * (1.0 + poisson));
    let whole = [([0.125, 0.125], [0.625, 0.625], [0.0, 0.0, -10.0])];
    let force = 10.0 * edge * edge;
    let bending = force * length.powi(3) / (3.0 * young * edge.powi(4) / 12.0);
    let coefficient = 10.0 * (1.0 + poisson) / (12.0 + 11.0 * poisson);
    let expected = bending + force * length / (coefficient * shear * edge * edge);
    let found = -bar(&whole, 0.125, &[(2.0, 0.375)])[0][2] / expected;
    println!("bending: {found}");
    assert!((found - 1.0).abs() < 0.005, "{found}");
    // Strips along the four edges of the end, a quarter of it wide.
    let stress = 100.0;
    let strips = [
        ([0.125, 0.5], [0.625, 0.625], [0.0, -stress, 0.0]),
        ([0.125, 0.125], [0.625, 0.25], [0.0, stress, 0.0]),
        ([0.5, 0.125], [0.625, 0.625], [0.0, 0.0, stress]),
        ([0.125, 0.125], [0.25, 0.625], [0.0, 0.0, -stress]),
    ];
    let torque = 4.0 * 0.1875 * 0.125 * edge * stress;
    let rate = torque / (shear * 0.1406 * edge.powi(4));
    for (cell, bound) in [(0.125, 0.06), (0.0625, 0.015)] {
        let moved = bar(&strips, cell, &[(0.5, 0.625), (1.5, 0.625)]);
        let found = (moved[0][1] - moved[1][1]) / (0.5 * edge * rate);
        println!("torsion, cells of {cell}: {found}");
        assert!((found - 1.0).abs() < bound, "{found} with cells of {cell}");
    }
}

/// Ground in which a plate, or of the plane a strip, is pressed; with PLATE, PLACES and BOUNDARY.
const GROUND: &str = r#"
GEOMETRY
[analysis]
type = "quasi-static"
steps = 6
[material.clay]
model = "tresca"
young = "1 MPa"
poisson = 0.3
cohesion = "1 kPa"
[[history]]
quantity = "footing-force"
[[history]]
quantity = "footing-pressure"
[[history]]
quantity = "reaction"
of = "footing"
[[history]]
quantity = "work"
of = "footing"
[[history]]
quantity = "energy"
[solver]
background = 0
tolerance = 1e-22
force_tolerance = 1e-11
"#;

/// A plate across the whole of a slice, smooth, rough and with friction.
#[test]
fn a_plate_across_a_slice_is_the_strip_of_plane_strain() {
    let plane = "geometry = \"plane-strain\"\ngrid = { lower = [0, 0], upper = [2, 1.25], cell = 0.25, degree = \"quadratic\" }\n\
        boundary = { left = \"roller\", right = \"roller\", bottom = \"fixed\" }\n\
        body = [{ material = \"clay\", box = { lower = [0, 0], upper = [2, 1] }, points_per_cell = 4 }]\n\
        footing = { from = [0.5, 1], to = [1, 1], displacement = [AHEAD, -0.005], base = BASE }";
    let slice = "geometry = \"3d\"\ngrid = { lower = [0, 0, 0], upper = [2, 0.5, 1.25], cell = 0.25, degree = \"quadratic\" }\n\
        boundary = { left = \"roller\", right = \"roller\", front = \"roller\", back = \"roller\", bottom = \"fixed\" }\n\
        body = [{ material = \"clay\", box = { lower = [0, 0, 0], upper = [2, 0.5, 1] }, points_per_cell = 4 }]\n\
        footing = { rectangle = { lower = [0.5, 0, 1], upper = [1, 0.5, 1] }, displacement = [AHEAD, 0, -0.005], base = BASE }";
    // What has friction in soil that yields needs far smaller steps.
    let has_friction = "{ friction_coefficient = 0.1, separates = true }";
    for (base, ahead, cohesion) in [
        ("\"smooth\"", "0", "1 kPa"),
        ("\"rough\"", "0", "1 kPa"),
        (has_friction, "0.02", "1 MPa"),
    ] {
        let run = |geometry: &str, ranks: usize| {
            let geometry = geometry.replace("BASE", base).replace("AHEAD", ahead);
            let case = changed(&changed(GROUND, "GEOMETRY", &geometry), "1 kPa", cohesion);
            let scratch = Scratch::with_case(&case);
            scratch.mpirun(ranks, &["case.toml", "-q", "-o", "out"]).expect(0);
            let table = history(&scratch.path("out"));
            let of = |name: &str| at(&table, name, 1.0);
            [
                of("footing-force"),
                of("footing-pressure"),
                of("work"),
                of("reaction-x"),
                of("energy-elastic"),
            ]
        };
        let expected = run(plane, 1);
        for ranks in [1, 2] {
            let found = run(slice, ranks);
            // All but the pressure are of a slice half as thick as the plane's metre.
            for (k, thickness) in [0.5, 1.0, 0.5, 0.5, 0.5].into_iter().enumerate() {
                let off = (found[k] / thickness - expected[k]) / expected[if k == 3 { 0 } else { k }];
                println!("{base} {ranks}: {k} {off:e} {}", expected[k]);
                assert!(off.abs() < 1e-9, "{base}, {ranks} ranks, {k}: {off}");
            }
        }
    }
}

/// Friction acts against the motion, also along none of the axes.
#[test]
fn a_plate_that_slides_obliquely_has_its_friction_against_its_motion() {
    let ground = "geometry = \"3d\"\ngrid = { lower = [0, 0, 0], upper = [2, 2, 1.25], cell = 0.25, degree = \"quadratic\" }\n\
        boundary = { left = \"roller\", right = \"roller\", front = \"roller\", back = \"roller\", bottom = \"fixed\" }\n\
        body = [{ material = \"clay\", box = { lower = [0, 0, 0], upper = [2, 2, 1] }, points_per_cell = 2 }]\n\
        footing = { rectangle = { lower = [0.5, 0.5, 1], upper = [1.25, 1.25, 1] }, displacement = [0.03, -0.04, -0.005], \
        interface = { friction_coefficient = 0.1 } }";
    let case = changed(&changed(GROUND, "GEOMETRY", ground), "1 kPa", "1 MPa");
    let slid = "[[history]]\nquantity = \"friction-power\"\nof = \"footing\"\n";
    let scratch = Scratch::with_case(&format!("{case}{slid}"));
    scratch.mpirun(2, &["case.toml", "-q", "-o", "out"]).expect(0);
    let table = history(&scratch.path("out"));
    let force = ["x", "y", "z"].map(|axis| at(&table, &format!("reaction-{axis}"), 1.0));
    println!("{force:?}");
    assert!((force[0].hypot(force[1]) / -force[2] - 0.1).abs() < 2e-4, "{force:?}");
    assert!((force[0] / force[1] + 0.75).abs() < 0.01, "{force:?}");
    let power = at(&table, "friction-power", 1.0);
    let slides = 0.1 * -force[2] * 0.05;
    assert!((power / slides - 1.0).abs() < 0.15, "{power} {slides}");
}

/// A disc in the corner of two rollers holds a quarter of itself, at the same force on any number of parts, and goes on
/// from a checkpoint to the bit.
#[test]
fn a_disc_is_the_same_on_all_numbers_of_ranks_and_goes_on_to_the_bit() {
    let quarter = "geometry = \"3d\"\ngrid = { lower = [0, 0, 0], upper = [2, 2, 1.25], cell = 0.25, degree = \"quadratic\" }\n\
        boundary = { left = \"roller\", right = \"roller\", front = \"roller\", back = \"roller\", bottom = \"fixed\" }\n\
        body = [{ material = \"clay\", box = { lower = [0, 0, 0], upper = [2, 2, 1] }, points_per_cell = 2 }]\n\
        footing = { disc = { centre = [0, 0, 1], radius = 0.6 }, displacement = [0, 0, -0.01], interface = \"rough\" }";
    let scratch = Scratch::with_case(&changed(GROUND, "GEOMETRY", quarter));
    scratch.mpirun(1, &["case.toml", "-q", "-o", "one"]).expect(0);
    let table = history(&scratch.path("one"));
    let force = at(&table, "reaction-z", 1.0);
    let pressure = at(&table, "footing-pressure", 1.0);
    let area = std::f64::consts::PI * 0.36 / 4.0;
    println!("{force} {pressure}");
    assert!((-force / area / pressure - 1.0).abs() < 1e-6, "{force} {pressure}");
    assert!((at(&table, "reaction-x", 1.0) / at(&table, "reaction-y", 1.0) - 1.0).abs() < 1e-6);
    for ranks in [2, 4] {
        let out = format!("out{ranks}");
        scratch.mpirun(ranks, &["case.toml", "-q", "-o", &out]).expect(0);
        let found = at(&history(&scratch.path(&out)), "reaction-z", 1.0);
        assert!((found / force - 1.0).abs() < 1e-8, "{ranks}: {found} {force}");
    }
    scratch.goes_on(2, &["2", "4"]);
}

/// An eighth of a hollow sphere under a pressure inside.
const HOLLOW: &str = r#"
geometry = "3d"
[analysis]
type = "quasi-static"
steps = 1
[grid]
lower = [0, 0, 0]
upper = [1.2, 1.2, 1.2]
cell = 0.1
degree = "quadratic"
[material.wall]
model = "elastic"
young = "10 MPa"
poisson = 0.3
[[body]]
material = "wall"
surface = { triangles = BALL }
subtract = [{ sphere = { centre = [0, 0, 0], radius = 0.5 } }]
points_per_cell = 3
[[traction]]
sphere = { centre = [0, 0, 0], radius = 0.5 }
pressure = "1 kPa"
ramp = 1.0
[boundary]
left = "roller"
front = "roller"
bottom = "roller"
[stabilisation]
method = "none"
[solver]
tolerance = 1e-12
force_tolerance = 1e-8
[[history]]
quantity = "displacement"
name = "inner"
at = [0.28867513, 0.28867513, 0.28867513]
[[history]]
quantity = "reaction"
face = "left"
"#;

/// Rows of triangles of an eighth of a sphere, turned outwards; closed by the planes of symmetry or not.
fn eighth(radius: f64, parts: usize, closed: bool) -> String {
    let corner = |(i, j): (usize, usize)| {
        let flat = [i, j, parts - i - j].map(|part| part as f64);
        let length = flat.iter().map(|part| part * part).sum::<f64>().sqrt();
        flat.map(|along| (radius * along / length).to_string()).join(", ")
    };
    let mut rows = Vec::new();
    for i in 0..parts {
        for j in 0..parts - i {
            rows.push([(i + 1, j), (i, j + 1), (i, j)].map(corner));
            if i + j + 2 <= parts {
                rows.push([(i + 1, j), (i + 1, j + 1), (i, j + 1)].map(corner));
            }
        }
        if closed {
            for [from, to] in [
                [(0, i), (0, i + 1)],
                [(i + 1, 0), (i, 0)],
                [(i, parts - i), (i + 1, parts - i - 1)],
            ] {
                rows.push(["0.0, 0.0, 0.0".into(), corner(from), corner(to)]);
            }
        }
    }
    let rows: Vec<String> = rows.iter().map(|row| format!("[{}]", row.join(", "))).collect();
    format!("[{}]", rows.join(", "))
}

/// Lamé (1852): u(a) = p a^3 ((1 - 2 nu) a + (1 + nu) b^3/(2 a^2))/(E (b^3 - a^3)); a plane of symmetry holds
/// p pi a^2/4.
#[test]
fn a_hollow_sphere_under_internal_pressure_has_the_displacement_of_lame() {
    let a = 0.5_f64;
    let b = 1.0_f64;
    let young = 1e7;
    let poisson = 0.3;
    let load = 1e3;
    let wall = (1.0 - 2.0 * poisson) * a + (1.0 + poisson) * b.powi(3) / (2.0 * a * a);
    let moved = load * a.powi(3) * wall / (young * (b.powi(3) - a.powi(3)));
    let held = load * PI * a * a / 4.0;
    let hollow = changed(HOLLOW, "BALL", &eighth(b, 24, true));
    let sphere = "sphere = { centre = [0, 0, 0], radius = 0.5 }\npressure";
    let triangles = format!("surface = {{ triangles = {} }}\npressure", eighth(a, 24, false));
    for (line, ranks) in [(sphere, 1), (&triangles, 2)] {
        let scratch = Scratch::with_case(&changed(&hollow, sphere, line));
        scratch.mpirun(ranks, &["case.toml", "-q", "-o", "out"]).expect(0);
        let table = history(&scratch.path("out"));
        let inner = ["x", "y", "z"].map(|along| at(&table, &format!("inner-{along}"), 1.0) * 3.0_f64.sqrt() / moved);
        let reaction = at(&table, "reaction-x", 1.0) / -held; // of the face on the body
        println!("{inner:?} of Lame's, reaction {reaction}");
        assert!(inner.iter().all(|part| (part - 1.0).abs() < 0.01), "{inner:?}");
        assert!((reaction - 1.0).abs() < 2e-3, "{reaction}");
    }
}
