//! Compares histories in 3-D with closed forms.

use super::observations::goes_the_same_way;
use super::solid::{PLANE, slice};
use super::solid_loads::BAR;
use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{all_finite, all_frames, at, history, manifest};
use bsmpm_io::table;

/// 2 m of soil of 20 kN/m3 between smooth walls.
const BLOCK: &str = r#"
geometry = "3d"
[analysis]
type = "quasi-static"
steps = 4
[grid]
lower = [0, 0, -1]
upper = [0.75, 0.5, 2]
cell = 0.25
degree = "quadratic"
[material.soil]
model = "elastic"
young = "1 GPa"
poisson = 0.3
unit_weight = "20 kN/m3"
[[body]]
material = "soil"
box = { lower = [0, 0, -1], upper = [0.75, 0.5, 1] }
points_per_cell = 2
[gravity]
acceleration = [0, 0, -9.81]
ramp = 1.0
[boundary]
left = "roller"
right = "roller"
front = "roller"
back = "roller"
bottom = "fixed"
[solver]
linear = "direct"
tolerance = 1e-14
force_tolerance = 1e-11
[output]
every_steps = 2
checkpoint = { every_steps = 2 }
[[history]]
quantity = "section-forces"
rectangle = { lower = [0, 0, -0.4], upper = [0.75, 0.5, -0.4] }
[[history]]
quantity = "stress"
at = [0.375, 0.25, 1]
surface = true
name = "surface"
[[history]]
quantity = "stress"
at = [0.375, 0.25, 1]
name = "nearest"
[[profile]]
name = "depth"
from = [0.375, 0.25, 1]
to = [0.375, 0.25, -1]
count = 9
quantities = ["displacement", "stress", "p", "q", "plastic-strain"]
[[profile]]
name = "window"
from = [0.75, 0, 1.2]
to = [0, 0.5, 0]
count = 5
quantities = ["stress"]
times = [0.6, 1.0]
fixed = true
"#;
const TABLES: [&str; 3] = ["history.csv", "profile_depth.csv", "profile_window.csv"];
const WEIGHT: f64 = 20e3;

#[test]
fn lines_and_places_of_a_block_have_its_weight_on_any_ranks_and_after_a_restart() {
    let scratch = Scratch::with_case(BLOCK);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "one"]).expect(0);
    let one = scratch.path("one");
    let rows = history(&one);
    let [surface, nearest] = ["surface-zz", "nearest-zz"].map(|name| at(&rows, name, 1.0));
    println!("at the surface {surface} Pa, nearest {nearest} Pa");
    assert!(surface.abs() < nearest.abs());
    let of_section = |name: &str| at(&rows, &format!("section-forces-{name}"), 1.0);
    let normal = of_section("n") / (-WEIGHT * 1.4 * 0.375) - 1.0;
    println!("N off by {normal:.1e}");
    assert!(
        normal.abs() < 1e-4
            && ["q1", "q2", "t", "m1", "m2"]
                .iter()
                .all(|name| of_section(name).abs() < 1e-3)
    );

    let depth = table::read(&one.join("profile_depth.csv")).unwrap();
    let of = |name: &str| depth.get(name).unwrap();
    let at_end: Vec<usize> = (0..of("time").len()).filter(|&row| of("time")[row] == 1.0).collect();
    assert_eq!(at_end.len(), 9);
    let poisson = 0.3;
    let largest = 2.0 * WEIGHT;
    for row in at_end {
        let vertical = -WEIGHT * of("distance")[row];
        let aside = poisson / (1.0 - poisson) * vertical;
        let expected = [("stress-xx", aside), ("stress-yy", aside), ("stress-zz", vertical)];
        let shear = ["stress-xy", "stress-yz", "stress-xz"].map(|name| (name, 0.0));
        let invariants = [("p", -(vertical + 2.0 * aside) / 3.0), ("q", aside - vertical)];
        let inside = ![0.0, 2.0].contains(&of("distance")[row]);
        for (name, exact) in expected.into_iter().chain(shear).chain(invariants) {
            let off = (of(name)[row] - exact).abs() / largest;
            println!("{} m, {name}: off by {off:.1e} of the largest", of("distance")[row]);
            assert!(off < if inside { 1e-3 } else { 2e-2 });
        }
        assert_eq!(of("z")[row], 1.0 - of("distance")[row] + of("displacement-z")[row]);
    }
    // Times of its own; what is above the body is left out, and the line stays where it is.
    let window = table::read(&one.join("profile_window.csv")).unwrap();
    assert_eq!(window.get("time").unwrap(), [[0.6; 4], [1.0; 4]].as_flattened());
    for (z, stress) in window
        .get("z")
        .unwrap()
        .iter()
        .zip(window.get("stress-zz").unwrap())
        .skip(4)
    {
        let off = (stress + WEIGHT * (1.0 - z)).abs() / largest;
        println!("z {z}: off by {off:.1e}");
        assert!(off < if *z > 0.8 { 2e-2 } else { 1e-3 });
    }

    for ranks in [2, 1] {
        goes_the_same_way(&scratch, &TABLES, ranks, 1e-9);
    }
}

/// A cantilever of 2 m by 0.5 m by 0.5 m of 20 N/m3 that a couple of strips along the edges of its end twists.
#[test]
fn sections_of_a_bar_have_the_weight_beyond_its_moment_and_the_couple() {
    let edge = 0.5_f64;
    let length = 2.0;
    let unit_weight = 20.0;
    let stress = 100.0;
    let cell = 0.125;
    let strips = [
        ("[2, 0.125, 0.5]", "[2, 0.625, 0.625]", [0.0, -stress, 0.0]),
        ("[2, 0.125, 0.125]", "[2, 0.625, 0.25]", [0.0, stress, 0.0]),
        ("[2, 0.5, 0.125]", "[2, 0.625, 0.625]", [0.0, 0.0, stress]),
        ("[2, 0.125, 0.125]", "[2, 0.25, 0.625]", [0.0, 0.0, -stress]),
    ];
    let couple = 4.0 * 0.1875 * cell * edge * stress;
    let loads = strips.map(|(lower, upper, stress)| {
        format!("[[traction]]\nrectangle = {{ lower = {lower}, upper = {upper} }}\nstress = {stress:?}\nramp = 1.0\n")
    });
    let reported = [(0.5, "goes"), (1.1, "middle"), (0.5, "stays")].map(|(x, name)| {
        let fixed = name == "stays";
        format!(
            "[[history]]\nquantity = \"section-forces\"\nname = \"{name}\"\nfixed = {fixed}\n\
             rectangle = {{ lower = [{x}, 0.0625, 0.0625], upper = [{x}, 0.6875, 0.6875] }}\n"
        )
    });
    let gravity = "[gravity]\nacceleration = [0, 0, -9.81]\nramp = 1.0\n";
    let bar = changed(
        BAR,
        "poisson = 0.3\n",
        &format!("poisson = 0.3\nunit_weight = \"{unit_weight} N/m3\"\n"),
    );
    let scratch = Scratch::with_case(&format!("{bar}{gravity}{}{}", loads.concat(), reported.concat()));
    scratch.mpirun(1, &["case.toml", "-q", "-o", "one"]).expect(0);
    let rows = history(&scratch.path("one"));
    let per_length = unit_weight * edge * edge;
    for (x, name) in [(0.5, "goes"), (1.1, "middle"), (0.5, "stays")] {
        let of = |component: &str| at(&rows, &format!("{name}-{component}"), 1.0);
        let beyond = length - x;
        let shear = per_length * beyond;
        let moment = 0.5 * per_length * beyond * beyond;
        let off = [
            of("q2") / -shear - 1.0,
            of("t") / couple - 1.0,
            (of("m2") - moment) / moment,
        ];
        let others = [of("n") / shear, of("q1") / shear, of("m1") / moment];
        println!("{name}: Q, T, M off by {off:?}; N, Q1, M1 {others:?}");
        // The cut is smeared: M is too large by 0.16 w h^2.
        assert!(
            off[0].abs() < 2e-3 && off[1].abs() < 2e-3 && off[2].abs() < 4e-3,
            "{off:?}"
        );
        assert!(others.iter().all(|other| other.abs() < 2e-3), "{others:?}");
    }
    goes_the_same_way(&scratch, &["history.csv"], 2, 1e-9);
}

/// Sand that slumps through a box which it is partly in at the start, into one that it reaches, and far from a third;
/// in a plane and in space, held against sums over the points that frames have there.
#[test]
fn boxes_of_histories_count_the_points_that_frames_have_there() {
    const QUANTITIES: [&str; 6] = [
        "mass",
        "mean-stress",
        "mean-displacement",
        "mean-velocity",
        "plastic-strain",
        "kinetic-energy",
    ];
    const AXES: [&str; 3] = ["x", "y", "z"];
    // In the plane of the slump, (x, height).
    let boxes = [
        ("toe", [[0.55, 0.1], [1.3, 0.9]]),
        ("ahead", [[1.02, 0.0], [4.0, 2.0]]),
        ("never", [[3.0, 1.0], [4.0, 2.0]]),
    ];
    for (text, dims) in [(PLANE.to_owned(), 2), (slice(), 3)] {
        let corner = |[x, up]: [f64; 2], across: f64| if dims == 2 { vec![x, up] } else { vec![x, across, up] };
        let within = |(_, [lower, upper]): &(&str, [[f64; 2]; 2])| [corner(*lower, 0.1), corner(*upper, 0.25)];
        let mut case = changed(&text, "every = 0.1", "every = 0.1\nfields = [\"density\"]");
        for (name, quantity) in boxes.iter().flat_map(|of| QUANTITIES.map(|quantity| (of, quantity))) {
            let [lower, upper] = within(name);
            let name = name.0;
            case += &format!(
                "[[history]]\nquantity = \"{quantity}\"\nmaterial = \"sand\"\nname = \"{name}-{quantity}\"\n\
                 box = {{ lower = {lower:?}, upper = {upper:?} }}\n"
            );
        }
        let scratch = Scratch::with_case(&case);
        scratch.mpirun(1, &["case.toml", "-q", "-o", "one"]).expect(0);
        let one = scratch.path("one");
        let mut counts = Vec::new();
        all_finite(&one);
        let rows = history(&one);
        for (frame, of) in all_frames(&one)
            .iter()
            .flat_map(|frame| boxes.iter().map(move |of| (frame, of)))
        {
            let real = |name: &str, components: usize| frame.real(name, components).unwrap();
            let [lower, upper] = within(of);
            let inside = |x: &[f64; 3]| (0..dims).all(|axis| lower[axis] <= x[axis] && x[axis] <= upper[axis]);
            let found: Vec<usize> = (0..frame.position.len())
                .filter(|&p| inside(&frame.position[p]))
                .collect();
            counts.push((of.0, found.len()));
            let volume = |p: usize| real("volume", 1)[p];
            let sum = |value: &dyn Fn(usize) -> f64| found.iter().map(|&p| value(p)).sum::<f64>();
            let mean = |value: &dyn Fn(usize) -> f64| {
                if found.is_empty() {
                    0.0
                } else {
                    sum(&|p| volume(p) * value(p)) / sum(&volume)
                }
            };
            let mass = |p: usize| volume(p) * real("density", 1)[p];
            let speed2 = |p: usize| real("velocity", 3)[3 * p..3 * p + 3].iter().map(|v| v * v).sum::<f64>();
            let mut expected = vec![
                ("mass".to_owned(), sum(&mass), 2e3),
                ("kinetic-energy".to_owned(), sum(&|p| 0.5 * mass(p) * speed2(p)), 1e3),
                (
                    "plastic-strain-mean".to_owned(),
                    mean(&|p| real("plastic_strain", 1)[p]),
                    0.1,
                ),
                (
                    "plastic-strain-largest".to_owned(),
                    found.iter().map(|&p| real("plastic_strain", 1)[p]).fold(0.0, f64::max),
                    0.1,
                ),
                ("mean-stress-xx".to_owned(), mean(&|p| real("stress", 6)[6 * p]), 1e4),
                (
                    "mean-stress-xy".to_owned(),
                    mean(&|p| real("stress", 6)[6 * p + 3]),
                    1e4,
                ),
            ];
            for (axis, name) in AXES.into_iter().enumerate().take(dims) {
                expected.push((
                    format!("mean-velocity-{name}"),
                    mean(&|p| real("velocity", 3)[3 * p + axis]),
                    1.0,
                ));
                let along = mean(&|p| real("displacement", 3)[3 * p + axis]);
                expected.push((format!("mean-displacement-{name}"), along, 0.1));
            }
            for (name, expected, scale) in expected {
                let reported = at(&rows, &format!("{}-{name}", of.0), frame.time);
                assert!(
                    (reported - expected).abs() <= 1e-11 * scale,
                    "{dims}, {} {name}: {reported} for {expected}",
                    of.0
                );
            }
        }
        println!("{dims} axes: points in boxes {counts:?}");
        let of = |name: &str| {
            counts
                .iter()
                .filter(move |of| of.0 == name)
                .map(|of| of.1)
                .collect::<Vec<_>>()
        };
        assert!(
            of("toe")[0] > 0 && of("ahead")[0] == 0 && of("ahead")[3] > 0 && of("never") == [0; 4],
            "{counts:?}"
        );
        let warned = manifest(&one).warnings;
        let never = QUANTITIES.map(|quantity| format!("never-{quantity}")).join(", ");
        assert!(
            warned
                .iter()
                .any(|warning| warning.contains(&format!("the box of these histories: {never}."))),
            "{warned:?}"
        );
        // Sums are exact: the same bits as long as what is summed is.
        for ranks in [3, 1] {
            let name = goes_the_same_way(&scratch, &["history.csv"], ranks, 1e-9);
            assert_eq!(manifest(&scratch.path(&name)).warnings, warned);
        }
        // A sum over no point is zero; no mean is any number.
        for (quantity, code) in [("never-mass", 0), ("never-plastic-strain-largest", 77)] {
            scratch.write(
                "checked.toml",
                format!("{case}[[check]]\nquantity = \"{quantity}\"\nmax = 1.0\n"),
            );
            scratch
                .mpirun(1, &["checked.toml", "-q", "-o", "checked", "--force"])
                .expect(code);
        }
    }
}
