//! Coulomb's friction on faces of the grid acts on the effective normal force: with pore pressure as a part `ru` of the
//! weight above.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{at, history};

/// A block of 72 kN/m that a moving wall pushes over a base with a friction coefficient of 0.4.
const BLOCK: &str = r#"
geometry = "plane-strain"
analysis = { type = "quasi-static", steps = 5 }
gravity  = { acceleration = [0.0, -9.81] }
initial  = { k0 = 0.3 }
boundary = { bottom = { friction = 0.4 } }
grid     = { lower = [0.0, 0.0], upper = [8.0, 3.0], cell = CELL, order = "quadratic" }
[material.soil]
model = "hencky"
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
    ["boundary = { bottom = { friction = 0.4 } }", "boundary = { left = { friction = 0.4 }, right = \"roller\" }"],
    ["face = \"left\"\ndisplacement = [0.02, 0.0]", "face = \"bottom\"\ndisplacement = [0.0, 0.001]"],
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
        let text = SIDE.iter().fold(filled("0.25", &format!("{ratio:?}")), |text, [from, to]| changed(&text, from, to));
        let text = changed(&text, "upper = [4.0, 1.0]", "upper = [8.0, 1.0]");
        scratch.write("case.toml", text);
        scratch.direct(&["case.toml", "-q", "-o", "out", "--force"]).expect(0);
        let history = history(&scratch.path("out"));
        let [normal, friction] = ["side-x", "side-y"].map(|column| at(&history, column, 1.0));
        // Pore pressure on a side 1 m high: its mean is half of that at the base.
        let water = ratio * 18e3 * 0.5;
        println!("ru = {ratio}: normal force {normal:.1} N, of it water {water:.1} N, friction {friction:.1} N");
        assert!((friction / (-0.4 * (normal - water)) - 1.0).abs() < 0.02, "{normal} {water} {friction}");
    }
}

#[test]
fn friction_of_rigid_bodies_on_soil_with_a_pressure_ratio_is_warned_of() {
    let rigid = "\n[[rigid]]\nname = \"plate\"\nfriction = 0.3\npolygon = [[1.0, 1.0], [2.0, 1.0], [2.0, 1.5], [1.0, 1.5]]\n\
                 displacement = [0.0, -0.001]\n";
    let scratch = Scratch::with_case(&(filled("0.5", "0.5") + rigid));
    let output = scratch.direct(&["case.toml", "--check"]).expect(0);
    output.says_once("friction of rigid.0 acts on the total normal force");
    output.says_once("Multiply its coefficient by 0.50");
}
