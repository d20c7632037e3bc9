//! Texts of small cases.

/// An elastic block slides over a smooth floor, four cells far: it needs no case of its own to migrate.
pub const SLIDING_BLOCK: &str = r#"title    = "Elastic block that slides and sags"
geometry = "plane-strain"

[analysis]
type = "dynamic"
end  = "0.05 s"
dt   = "1 ms"

[grid]
lower = [0.0, 0.0]
upper = [1.0, 0.3]
cell  = "50 mm"
degree = "quadratic"

[material.rubber]
model   = "elastic"
young   = "500 kPa"
poisson = 0.3
density = 1000

[[body]]
material = "rubber"
box = { lower = [0.1, 0.0], upper = [0.5, 0.2] }
points_per_cell = 2
velocity = [4.0, 0.0]

[gravity]
acceleration = [0.0, -9.81]

[boundary]
bottom = "roller"
left   = "roller"
right  = "roller"

[solver]
tolerance       = 1e-14
force_tolerance = 1e-9

[output]
every = "20 ms"

[[history]]
quantity = "runout"

[[history]]
quantity = "mass"

[[history]]
quantity = "momentum"
"#;

/// The slope of the README, in a grid whose cells its surface cuts.
const SLOPE: &str = r#"
geometry = "plane-strain"
accuracy = "draft"
analysis = { type = "quasi-static" }
gravity = { acceleration = [0.0, -9.81], ramp = 1.0 }
boundary = { bottom = "fixed", left = "roller", right = "roller" }
[grid]
lower = [0.0, 0.0]
upper = [40.0, 12.0]
[material.soil]
model = "mohr-coulomb"
young = "100 MPa"
poisson = 0.3
cohesion = "10 kPa"
friction_angle = 20.0
dilation_angle = 0.0
unit_weight = "20 kN/m3"
[[body]]
material = "soil"
polygon = [[0.0, 0.0], [TOE, 0.0], [CREST, 10.0], [0.0, 10.0]]
[[history]]
quantity = "max-displacement"
"#;

/// The slope of the README with its foot at 32 m and `beyond` more.
pub fn slope(beyond: f64) -> String {
    let toe = changed(SLOPE, "TOE", &format!("{:?}", 32.0 + beyond));
    changed(&toe, "CREST", &format!("{:?}", 12.0 + beyond))
}

/// The same block on a floor with friction, 0.3 mm above it at the start, so that it drops, slides and rocks.
pub fn frictional_block() -> String {
    let text = changed(
        SLIDING_BLOCK,
        "bottom = \"roller\"",
        "bottom = { friction_coefficient = 0.4 }",
    );
    let text = changed(&text, "box = { lower = [0.1, 0.0]", "box = { lower = [0.1, 0.0003]");
    let histories = ["contact", "gap", "slip-rate", "friction-power", "reaction"];
    let history = |quantity| format!("\n[[history]]\nquantity = \"{quantity}\"\nface = \"bottom\"\n");
    text + &histories.map(history).concat()
}

/// The same block of clay whose strength follows strain and rate, damped, with a pressure on two of its sides.
pub fn pressed_block() -> String {
    let clay = "model = \"sensitive-clay\"\ncohesion = 2e3\nsensitivity = 3\nsoftening_strain = 5\nrate_parameter = 0.1\n\
                reference_rate = 1e-2\ndamping = { ratio = 0.1, frequency = 20.0 }";
    let press = "\n[[traction]]\nfrom = [0.5, 0.0]\nto = [0.5, 0.2]\npressure = { value = 1e3, at_y = 0.2, per_metre = 1e4 }\n\
                 ramp = 0.02\n[[traction]]\nfrom = [0.1, 0.2]\nto = [0.5, 0.2]\npressure = 2e3\nramp = 0.02\n";
    changed(SLIDING_BLOCK, "model   = \"elastic\"", clay) + press
}

/// One factorisation of the whole on every rank, so that nothing depends on the partition.
pub const EXACT: [&str; 3] = ["--", "-pc_type", "redundant"];

/// Quasi-static, five steps of next to no work.
pub const COLUMN: &str = r#"geometry = "plane-strain"

[analysis]
type  = "quasi-static"
steps = 5

[grid]
lower = [0.0, 0.0]
upper = [4.0, 5.0]
cell  = "1 m"
degree = "quadratic"

[material.soil]
model   = "elastic"
young   = "1 MPa"
poisson = 0.3
density = "2 t/m3"

[[body]]
material = "soil"
box = { lower = [0.0, 0.0], upper = [4.0, 4.0] }
points_per_cell = 2

[gravity]
acceleration = [0.0, -9.81]
ramp = 1.0

[boundary]
bottom = "fixed"
left   = "roller"
right  = "roller"

[output]
every = 0.4

[[history]]
quantity = "height"

[[history]]
quantity = "reaction"
face = "bottom"
"#;

/// So many steps of the column that it ends when it is asked to.
pub fn endless() -> String {
    changed(COLUMN, "steps = 5", "steps = 1000000")
}

/// A cut in clay under a weight that it can hardly bear, by many thousand iterations: its third step takes long.
pub fn long_step() -> String {
    let clay = changed(
        COLUMN,
        "model   = \"elastic\"",
        "model = \"tresca\"\ncohesion = \"6 kPa\"",
    );
    let cut = changed(&clay, "upper = [4.0, 4.0]", "upper = [2.0, 4.0]");
    let fine = changed(&cut, "\"1 m\"", "\"40 mm\"");
    changed(
        &fine,
        "steps = 5",
        "steps = 10\n\n[solver]\nnonlinear = \"broyden\"\nmax_iterations = 100000",
    )
}

/// The text with one part replaced, which must be in it once. Spaces that align equals signs do not count.
#[track_caller]
pub fn changed(text: &str, part: &str, by: &str) -> String {
    let [text, part] = [text, part].map(unaligned);
    assert_eq!(text.matches(&part).count(), 1, "{part:?} must be in the case once");
    text.replacen(&part, by, 1)
}

/// A text without the spaces that align the equals signs of a table.
fn unaligned(text: &str) -> String {
    let mut text = text.to_owned();
    while text.contains("  =") {
        text = text.replace("  =", " =");
    }
    text
}
