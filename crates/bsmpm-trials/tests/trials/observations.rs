//! Compares histories with closed forms.

use crate::support::results::{all_finite, at, differences, history, last_frame, manifest};
use crate::support::{Scratch, shipped};
use bsmpm_io::frame::FieldValues;
use bsmpm_io::table::{self, Columns};
use std::fs;

/// 2 m of soil of 20 kN/m3, in two bodies, on 2 m of rock of 25 kN/m3, between smooth walls 2 m apart. A profile
/// crosses the interface, where round-off decides which side it takes; points' own volumes have the same on any ranks.
const COLUMN: &str = r#"
geometry = "plane-strain"
[analysis]
type = "quasi-static"
steps = 5
[grid]
lower = [0.0, -1.0]
upper = [2.0, 4.0]
cell = 0.25
degree = "quadratic"
[material.soil]
model = "mohr-coulomb"
young = "1 GPa"
poisson = 0.3
friction_angle = 30
dilation_angle = 0
cohesion = "5 kPa"
unit_weight = "20 kN/m3"
[material.rock]
model = "elastic"
young = "10 GPa"
poisson = 0.2
unit_weight = "25 kN/m3"
[[body]]
name = "base"
material = "rock"
box = { lower = [0.0, -1.0], upper = [2.0, 1.0] }
points_per_cell = 2
[[body]]
material = "soil"
box = { lower = [0.0, 1.0], upper = [2.0, 2.0] }
points_per_cell = 2
[[body]]
name = "top"
material = "soil"
box = { lower = [0.0, 2.0], upper = [2.0, 3.0] }
points_per_cell = 2
[gravity]
acceleration = [0.0, -9.81]
ramp = 1.0
[boundary]
bottom = "fixed"
left = "roller"
right = "roller"
[solver]
quadrature = "points"
tolerance = 1e-12
force_tolerance = 1e-9
[output]
every_steps = 2
fields = ["q", "principal-stresses", "mobilised-strength", "deviatoric-strain", "yielding", "density", "body"]
checkpoint = { every_steps = 2 }
[[history]]
quantity = "mass"
body = "top"
[[history]]
quantity = "mean-stress"
material = "rock"
[[history]]
quantity = "height"
body = "base"
[[history]]
quantity = "section-forces"
from = [2.0, 1.5]
to = [0.0, 1.5]
[[history]]
quantity = "stress"
at = [1.0, 3.0]
surface = true
name = "surface"
[[history]]
quantity = "stress"
at = [1.0, 3.0]
name = "nearest"
[[profile]]
name = "depth"
from = [1.0, 3.0]
to = [1.0, -1.0]
count = 9
quantities = ["displacement", "stress", "p", "q", "plastic-strain"]
[[profile]]
name = "window"
from = [1.0, 3.2]
to = [1.0, 2.0]
count = 5
quantities = ["stress"]
times = [0.55, 1.0]
fixed = true
"#;
const TABLES: [&str; 3] = ["history.csv", "profile_depth.csv", "profile_window.csv"];

fn largest_difference(found: &Columns, expected: &Columns) -> f64 {
    assert_eq!(found.headings, expected.headings);
    let scale = expected
        .values
        .iter()
        .flatten()
        .fold(1.0_f64, |largest, value| largest.max(value.abs()));
    let pairs = found.values.iter().flatten().zip(expected.values.iter().flatten());
    pairs.fold(0.0, |largest, (a, b)| largest.max((a - b).abs() / scale))
}

/// A run on some ranks, on one with a restart, whose tables are those of the run `one`: to the bit on one rank. Its
/// name.
pub fn goes_the_same_way(scratch: &Scratch, tables: &[&str], ranks: usize, bound: f64) -> String {
    let name = format!("part-{ranks}");
    let part = ["case.toml", "-q", "-o", &name];
    if ranks == 1 {
        scratch
            .mpirun(1, &[&part[..], &["--max-steps", "3"]].concat())
            .expect(75);
        scratch
            .mpirun(1, &[&part[..], &["--restart", "auto"]].concat())
            .expect(0);
    } else {
        scratch.mpirun(ranks, &part).expect(0);
    }
    for file in tables {
        let [found, expected] = [&name, "one"].map(|run| scratch.path(&format!("{run}/{file}")));
        if ranks == 1 {
            assert_eq!(fs::read(found).unwrap(), fs::read(expected).unwrap(), "{file}");
        } else {
            let off = largest_difference(&table::read(&found).unwrap(), &table::read(&expected).unwrap());
            println!("{file} on {ranks} ranks: {off:.1e}");
            assert!(off < bound, "{file}: {off}");
        }
    }
    name
}

#[test]
fn parts_lines_and_places_of_a_column_have_its_weight_on_any_ranks_and_after_a_restart() {
    let scratch = Scratch::with_case(COLUMN);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "one"]).expect(0);
    let one = scratch.path("one");
    all_finite(&one);
    let rows = history(&one);
    let end = |name: &str| at(&rows, name, 1.0);
    assert!((end("mass") / (2.0 * 20e3 / 9.81) - 1.0).abs() < 1e-12);
    // Rock carries the soil and the half of itself.
    assert!(
        (end("mean-stress-yy") / -65e3 - 1.0).abs() < 1e-3,
        "{}",
        end("mean-stress-yy")
    );
    assert!((end("height") - 0.9375).abs() < 1e-3);
    // 1.5 m of soil.
    let normal = end("section-forces-n") / -60e3 - 1.0;
    println!(
        "N off by {normal:.1e}; at the surface {} Pa, nearest {} Pa",
        end("surface-yy"),
        end("nearest-yy")
    );
    assert!(normal.abs() < 1e-4 && end("section-forces-m").abs() < 1.0);
    assert!(end("surface-yy").abs() < end("nearest-yy").abs());

    // Inside, the stress is linear.
    let depth = table::read(&one.join("profile_depth.csv")).unwrap();
    let [times, places, stress] = ["time", "distance", "stress-yy"].map(|name| depth.get(name).unwrap());
    let of_end: Vec<usize> = (0..times.len()).filter(|&row| times[row] == 1.0).collect();
    assert_eq!(of_end.len(), 9);
    for &row in &of_end {
        let exact = if places[row] <= 2.0 {
            -20e3 * places[row]
        } else {
            -40e3 - 25e3 * (places[row] - 2.0)
        };
        let off = (stress[row] - exact).abs() / 90e3;
        println!("{} m: off by {off:.1e} of the largest", places[row]);
        assert!(
            off < if [0.0, 2.0, 4.0].contains(&places[row]) {
                1e-2
            } else {
                1e-3
            }
        );
    }
    // Times of its own; what is above the body is left out.
    let window = table::read(&one.join("profile_window.csv")).unwrap();
    assert_eq!(window.get("time").unwrap(), [[0.55; 4], [1.0; 4]].as_flattened());
    let reported = manifest(&one);
    assert!(TABLES.iter().all(|file| {
        reported
            .outputs
            .iter()
            .any(|of| of.path == *file && of.blake3.is_some())
    }));

    for ranks in [3, 1] {
        let name = goes_the_same_way(&scratch, &TABLES, ranks, 1e-8);
        let off = differences(&last_frame(&scratch.path(&name)), &last_frame(&one));
        assert!(off.iter().all(|(_, off)| *off < 1e-8), "{off:?}");
    }
}

/// A block on a base whose inclination has the tangent 0.5. At rest it mobilises 0.5 divided by the friction
/// coefficient. With a friction coefficient below 0.5 it slides, and mobilises all friction.
#[test]
fn a_block_on_an_incline_mobilises_its_inclination_over_the_friction_coefficient() {
    let text = fs::read_to_string(shipped("validation/block_on_incline.toml")).unwrap();
    let wanted = "\n[[history]]\nquantity = \"mobilised-friction\"\nface = \"bottom\"\n";
    let scratch = Scratch::with_case(&(text + wanted));
    for (friction, expected, bound) in [(0.8, 0.625, 1e-3), (0.3, 1.0, 1e-6)] {
        let set = format!("boundary.bottom={{ friction_coefficient = {friction} }}");
        let name = format!("friction-{friction}");
        scratch
            .mpirun(1, &["case.toml", "-q", "-o", &name, "--set", &set])
            .expect(0);
        let rows = history(&scratch.path(&name));
        let mobilised = at(&rows, "mobilised-friction", 0.5);
        println!("friction {friction}: mobilised {mobilised:.7}");
        assert!(
            (mobilised / expected - 1.0).abs() < bound,
            "friction {friction}: {mobilised}"
        );
    }
}

#[test]
fn frames_have_the_fields_that_are_asked_for_with_names_of_bodies() {
    let scratch = Scratch::with_case(COLUMN);
    scratch.mpirun(2, &["case.toml", "-q", "-o", "asked"]).expect(0);
    let frame = last_frame(&scratch.path("asked"));
    let real = |name: &str, components: usize| frame.real(name, components).unwrap();
    let stress = real("stress", 6);
    let q = real("q", 1);
    let principal = real("principal_stresses", 3);
    let mobilised = real("mobilised_strength", 1);
    let density = real("density", 1);
    let number = |name: &str| frame.fields.iter().find(|field| field.name == name).unwrap();
    let FieldValues::U64(bodies) = &number("body").values else {
        panic!("bodies are numbers")
    };
    for (p, x) in frame.position.iter().enumerate() {
        let xx = stress[6 * p];
        let yy = stress[6 * p + 1];
        assert!((q[p] - (xx - yy).abs()).abs() < 1e-3 * q[p].max(1.0));
        assert!((principal[3 * p] - xx).abs() < 1e-3 * yy.abs() && (principal[3 * p + 2] - yy).abs() < 1e-3 * yy.abs());
        let body = if x[1] < 1.0 {
            0
        } else {
            1 + u64::from(x[1] > 2.0 - 1e-3)
        };
        assert_eq!(bodies[p], body);
        assert!((density[p] * 9.81 / if body == 0 { 25e3 } else { 20e3 } - 1.0).abs() < 1e-3);
        // Rock has no strength to mobilise; soil is not at yield: with c' = m c, tan phi' = m tan phi it would be.
        let tan = mobilised[p] * 30.0_f64.to_radians().tan();
        let c = mobilised[p] * 5e3;
        let (sin, cos) = tan.atan().sin_cos();
        let excess = (xx - yy) + (xx + yy) * sin - 2.0 * c * cos;
        assert!(if body == 0 {
            mobilised[p] == 0.0
        } else {
            excess.abs() < 1e-3 * yy.abs()
        });
    }
    assert!(real("yielding", 1).iter().all(|&yielding| yielding == 0.0));
    let reported = manifest(&scratch.path("asked"));
    assert_eq!(reported.frame_names["body"], ["base", "", "top"]);
    assert_eq!(reported.frame_names["material"], ["soil", "rock"]);
}
