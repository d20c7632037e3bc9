//! Tests that friction follows the effective normal force if `ru` gives the pore pressure.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{at, history};

/// A block of 72 kN/m that a moving wall pushes over a base with a friction coefficient of 0.4.
const BLOCK: &str = r#"
geometry = "plane-strain"
analysis = { type = "quasi-static", steps = 5 }
gravity  = { acceleration = [0.0, -9.81] }
initial  = { k0 = 0.3 }
boundary = { bottom = { friction_coefficient = 0.4 } }
grid     = { lower = [0.0, 0.0], upper = [8.0, 3.0], cell = CELL, degree = "quadratic" }
[material.soil]
model = "elastic"
young = "10 MPa"
poisson = 0.3
unit_weight = "18 kN/m3"
ru = RATIO
[[body]]
material = "soil"
box = { lower = [0.0, 0.0], upper = [4.0, 1.0] }
points_per_cell = 3
[[prescribed]]
name = "wall"
face = "left"
displacement = [0.02, 0.0]
components = "normal"
[[history]]
quantity = "reaction"
of = "wall"
name = "wall"
[[history]]
quantity = "reaction"
face = "bottom"
name = "base"
"#;

/// The same soil between two sides: its base moves up along a side with friction.
const SIDE: [[&str; 2]; 3] = [
    [
        "boundary = { bottom = { friction_coefficient = 0.4 } }",
        "boundary = { left = { friction_coefficient = 0.4 }, right = \"roller\" }",
    ],
    [
        "face = \"left\"\ndisplacement = [0.02, 0.0]",
        "face = \"bottom\"\ndisplacement = [0.0, 0.001]",
    ],
    ["face = \"bottom\"\nname = \"base\"", "face = \"left\"\nname = \"side\""],
];

fn filled(cell: &str, ratio: &str) -> String {
    changed(&changed(BLOCK, "CELL", cell), "RATIO", ratio)
}

#[test]
fn a_block_is_pushed_against_the_friction_of_its_effective_weight() {
    let scratch = Scratch::new();
    for ratio in [1e-3, 0.25, 0.5] {
        for cell in ["0.5", "0.25"] {
            scratch.write("case.toml", filled(cell, &format!("{ratio:?}")));
            scratch.direct(&["case.toml", "-q", "-o", "out", "--force"]).expect(0);
            let history = history(&scratch.path("out"));
            let [wall, base] = ["wall-x", "base-x"].map(|column| at(&history, column, 1.0));
            println!("ru = {ratio}, cells of {cell} m: wall {wall:.1} N, base {base:.1} N");
            // Before, the base took 0.4 of 72 kN with every ratio.
            let expected = 0.4 * (1.0 - ratio) * 72e3;
            assert!((base / expected + 1.0).abs() < 0.01, "{base} {expected}");
            assert!((wall + base).abs() < 1e-3 * expected, "{wall} {base}");
        }
    }
}

#[test]
fn a_side_has_the_friction_of_its_effective_normal_force() {
    let scratch = Scratch::new();
    for ratio in [1e-3, 0.5] {
        let text = SIDE
            .iter()
            .fold(filled("0.25", &format!("{ratio:?}")), |text, [from, to]| {
                changed(&text, from, to)
            });
        let text = changed(&text, "upper = [4.0, 1.0]", "upper = [8.0, 1.0]");
        scratch.write("case.toml", text);
        scratch.direct(&["case.toml", "-q", "-o", "out", "--force"]).expect(0);
        let history = history(&scratch.path("out"));
        let [normal, friction] = ["side-x", "side-y"].map(|column| at(&history, column, 1.0));
        // Pore pressure on a side 1 m high: its mean is half of that at the base.
        let water = ratio * 18e3 * 0.5;
        println!("ru = {ratio}: normal force {normal:.1} N, of it water {water:.1} N, friction {friction:.1} N");
        assert!(
            (friction / (-0.4 * (normal - water)) - 1.0).abs() < 0.02,
            "{normal} {water} {friction}"
        );
    }
}

/// The same block on a base that is a strip or a rigid body; its weight grows with gravity.
const ON_A_BASE: [[&str; 2]; 4] = [
    ["steps = 5", "steps = 10"],
    ["acceleration = [0.0, -9.81]", "acceleration = [0.0, -9.81], ramp = 0.4"],
    [
        "initial  = { k0 = 0.3 }\nboundary = { bottom = { friction_coefficient = 0.4 } }\n",
        "",
    ],
    [
        "box = { lower = [0.0, 0.0], upper = [4.0, 1.0] }",
        "box = { lower = [0.0, 0.5], upper = [4.0, 1.5] }",
    ],
];
const WALL: [[&str; 2]; 2] = [
    ["face = \"left\"", "from = [0.0, 0.5]\nto = [0.0, 1.5]"],
    [
        "displacement = [0.02, 0.0]",
        "path = [[0.4, 0.0, 0.0], [1.0, 0.02, 0.0]]",
    ],
];
const BASE: &str = "[[history]]\nquantity = \"reaction\"\nface = \"bottom\"\nname = \"base\"\n";
const STRIP: &str = "[[prescribed]]\nname = \"base\"\nfrom = [0.0, 0.5]\nto = [4.0, 0.5]\ndisplacement = [0.0, 0.0]\n\
                     components = { friction_coefficient = 0.4 }\n[[history]]\nquantity = \"reaction\"\nof = \"base\"\nname = \"base\"\n";
const RIGID: &str = "[[rigid]]\nname = \"base\"\nfriction_coefficient = 0.4\n\
                     polygon = [[-0.5, 0.0], [8.5, 0.0], [8.5, 0.5], [-0.5, 0.5]]\n\
                     [[history]]\nquantity = \"rigid-force\"\nrigid = \"base\"\nname = \"base\"\n";

#[test]
fn strips_and_rigid_bodies_rub_by_the_effective_weight() {
    let scratch = Scratch::new();
    for (base, ranks) in [(STRIP, 1), (RIGID, 1), (STRIP, 3), (RIGID, 3)] {
        for ratio in [0.25, 0.5] {
            let text = filled("0.5", &format!("{ratio:?}"));
            let text = ON_A_BASE
                .iter()
                .chain(&WALL)
                .fold(text, |text, [from, to]| changed(&text, from, to));
            scratch.write("case.toml", changed(&text, BASE, base));
            scratch
                .mpirun(ranks, &["case.toml", "-q", "-o", "out", "--force"])
                .expect(0);
            let history = history(&scratch.path("out"));
            let [wall, base] = ["wall-x", "base-x"].map(|column| at(&history, column, 1.0));
            println!("ru = {ratio}, {ranks} ranks: wall {wall:.1} N, base {base:.1} N");
            // Within 2e-5 (strip) and 3e-4 (rigid body); before, both had 0.4 of 72 kN with every ratio.
            assert!((wall / (0.4 * (1.0 - ratio) * 72e3) - 1.0).abs() < 1e-3, "{wall}");
            assert!((base.abs() / wall - 1.0).abs() < 1e-3, "{base} {wall}");
        }
    }
}

#[test]
fn a_block_slides_where_its_pore_pressure_takes_its_friction() {
    // Pushed by 20 kN/m: friction 28.8 kN/m holds it with ru = 0 (0.001 here), 14.4 kN/m with 0.5 does not.
    let push = "\n[[traction]]\nfrom = [1.0, 0.5]\nto = [1.0, 1.5]\nstress = [20e3, 0.0]\namplitude = [[0.4, 0.0], [0.6, 1.0]]\n";
    let wall =
        "[[prescribed]]\nname = \"wall\"\nface = \"left\"\ndisplacement = [0.02, 0.0]\ncomponents = \"normal\"\n";
    let of_wall = "[[history]]\nquantity = \"reaction\"\nof = \"wall\"\nname = \"wall\"\n";
    let scratch = Scratch::new();
    let slid = |ratio: &str, base: &str| {
        let text = ON_A_BASE
            .iter()
            .fold(filled("0.5", ratio), |text, [from, to]| changed(&text, from, to));
        let text = changed(
            &changed(&text, wall, ""),
            of_wall,
            "[[history]]\nquantity = \"mean-velocity\"\n",
        );
        let text = changed(
            &text,
            "type = \"quasi-static\", steps = 10",
            "type = \"dynamic\", end = 1.0, dt = 0.01",
        );
        let text = changed(
            &text,
            "box = { lower = [0.0, 0.5], upper = [4.0, 1.5] }",
            "box = { lower = [1.0, 0.5], upper = [5.0, 1.5] }",
        );
        scratch.write("case.toml", changed(&text, BASE, base) + push);
        scratch.direct(&["case.toml", "-q", "-o", "out", "--force"]).expect(0);
        at(&history(&scratch.path("out")), "mean-velocity-x", 1.0)
    };
    let strip = changed(
        &changed(STRIP, "from = [0.0, 0.5]", "from = [1.0, 0.5]"),
        "to = [4.0, 0.5]",
        "to = [5.0, 0.5]",
    );
    for base in [&strip, RIGID] {
        let [held, slides] = ["1e-3", "0.5"].map(|ratio| slid(ratio, base));
        println!("velocity {held:.4} and {slides:.4} m/s");
        // A rigid block: the load exceeds friction from t = 0.544 s on, by 5.6 kN/m from 0.6 s on: 0.327 m/s.
        assert!(held.abs() < 0.02 && (0.31..0.345).contains(&slides), "{held} {slides}");
    }
}
