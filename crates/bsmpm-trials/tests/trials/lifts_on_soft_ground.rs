//! Tests the consolidation of ground that stages load.

use crate::stages::repeats;
use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{at, history, manifest};
use std::f64::consts::PI;

/// N/m3  of the soil less the water's.
const BUOYANT: f64 = 20e3 - 9810.0;
/// m  of the ground and of what is placed on it; m2/s is the coefficient of consolidation.
const GROUND: f64 = 0.75;
const LIFT: f64 = 0.25;

/// A column under water, with a lift of the same soil that comes after a quarter of a second: the drain that was on the
/// ground ends, and one on the lift begins.
const LIFTED: &str = r#"geometry = "plane-strain"
[analysis]
type = "consolidation"
end = "0.55 s"
dt = "5 ms"
[grid]
lower = [0, 0]
upper = [0.1, 1]
cell = 0.05
degree = "quadratic"
[material.soil]
model = "elastic"
young = 1e8
poisson = 0
unit_weight = "20 kN/m3"
drainage = "coupled"
porosity = 0.4
permeability = 9.81e-5
[water]
level = 1.0
[initial]
k0 = 0.5
[gravity]
acceleration = [0, -9.81]
[[body]]
material = "soil"
box = { lower = [0, 0], upper = [0.1, 0.75] }
points_per_cell = 3
[[body]]
name = "lift"
material = "soil"
box = { lower = [0, 0.75], upper = [0.1, 1] }
points_per_cell = 3
[boundary]
bottom = "fixed"
left = "roller"
right = "roller"
[[drain]]
name = "ground"
from = [0, 0.75]
to = [0.1, 0.75]
[[drain]]
name = "crest"
from = [0, 1]
to = [0.1, 1]
[[stage]]
at = "0.25 s"
add = ["lift"]
deactivate = ["ground"]
activate = ["crest"]
[solver]
tolerance = 1e-12
force_tolerance = 1e-8
[[history]]
quantity = "excess-pressure"
name = "base"
at = [0.025, 0.025]
[[history]]
quantity = "excess-pressure"
name = "within"
at = [0.025, 0.875]
[[history]]
quantity = "displacement"
name = "top"
at = [0.05, 0.75]
[[history]]
quantity = "water-outflow"
drain = "ground"
name = "ground"
[[history]]
quantity = "water-outflow"
drain = "crest"
name = "crest"
[[history]]
quantity = "water-balance"
"#;

/// Of Terzaghi's equation with c_v = 1 m2/s after `t` seconds, m below the drained end of a column 1 m high whose other
/// end is closed: the sum of `first`'s terms, by their wave numbers.
fn terzaghi(first: impl Fn(f64) -> f64, t: f64) -> f64 {
    let wave = |k: u32| PI / 2.0 * f64::from(2 * k + 1);
    (0..200).map(wave).map(|k| first(k) * (-k * k * t).exp()).sum()
}

/// What a run of a case warns of before its first step.
fn warnings(case: &str) -> Vec<String> {
    let scratch = Scratch::with_case(case);
    scratch
        .mpirun(1, &["case.toml", "-q", "-o", "out", "--max-steps", "1"])
        .expect(75);
    manifest(&scratch.path("out")).warnings
}

/// Under its lift the ground's water bears its buoyant weight at once, in the lift what lies above; then both drain
/// through the lift, and the ground settles by the strain of what has gone.
#[test]
fn a_lift_loads_the_water_below_and_both_drain_through_its_top() {
    let scratch = Scratch::with_case(LIFTED);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "whole"]).expect(0);
    let reported = manifest(&scratch.path("whole"));
    assert!(
        reported.warnings.iter().all(|warning| !warning.contains("stage.0")),
        "{:?}",
        reported.warnings
    );
    assert_eq!(
        (&reported.stages[0].applied[..], &reported.stages[0].released[..]),
        (&["crest".into()][..], &["ground".into()][..])
    );
    let found = history(&scratch.path("whole"));
    let of = |name: &str, t: f64| at(&found, name, t);
    let whole = BUOYANT * LIFT;
    // Ground at rest stays so, but for what the first stress is off by.
    assert!(
        ["base", "within"]
            .iter()
            .all(|name| of(name, 0.25).abs() < 1e-3 * whole)
    );
    assert!(
        (of("base", 0.255) / whole - 1.0).abs() < 1e-3,
        "{}, exactly {whole}",
        of("base", 0.255)
    );
    // At first gamma' z in the lift and gamma' h below.
    let of_lift = |k: f64| 2.0 * BUOYANT * (k * LIFT).sin() / (k * k);
    for t in [0.1, 0.3] {
        for (name, depth) in [("base", 1.0 - 0.025), ("within", 0.125)] {
            let exact = terzaghi(|k| of_lift(k) * (k * depth).sin(), t);
            let p = of(name, 0.25 + t);
            println!("{name} after {t} s: {p} Pa, exactly {exact}");
            // The point is up to a sixth of a cell from there, and steps are of 5 ms.
            assert!((p - exact).abs() < 0.01 * whole, "{name}: {p}, exactly {exact}");
        }
        // The ground's surface sinks by the mean of what has drained below it, over M.
        let below = terzaghi(|k| of_lift(k) * (k * LIFT).cos() / k, t);
        let settled = of("top-y", 0.25) - of("top-y", 0.25 + t);
        let exact = (whole * GROUND - below) / 1e8;
        println!("settled after {t} s: {settled:e} m, exactly {exact:e}");
        assert!((settled / exact - 1.0).abs() < 0.01, "{settled:e}, exactly {exact:e}");
    }
    // What the old drain has let out it keeps, and the new one begins with nothing.
    assert_eq!(of("ground", 0.25), of("ground", 0.55));
    assert!(of("crest", 0.25) == 0.0 && of("crest", 0.255) > 0.0);
    let balance = of("water-balance", 0.55).abs();
    println!("balance {balance:e}");
    assert!(balance < 1e-7, "{balance:e}");
    let covered = warnings(&changed(LIFTED, "deactivate = [\"ground\"]\n", ""));
    assert!(
        covered
            .iter()
            .any(|warning| warning.contains("W0545") && warning.contains("drain.0")),
        "{covered:?}"
    );
    // Before, at and after the stage.
    repeats(
        &scratch,
        &["base", "within", "top-y", "crest"],
        &["49", "50", "51", "60"],
    );
}

/// Clay between sand below and fill that a stage places above, both of which let water through as if it were none:
/// drains where they meet. The column is at rest until then, and consolidates to both sides under the fill's weight.
#[test]
fn clay_between_sand_and_fill_in_which_no_water_flows_drains_to_both() {
    let case = changed(LIFTED, "level = 1.0", "level = 0.75");
    let case = changed(
        &case,
        "[water]",
        "[material.sand]\nmodel = \"elastic\"\nyoung = 1e8\npoisson = 0\nunit_weight = \"20 kN/m3\"\n[water]",
    );
    let case = changed(
        &case,
        "upper = [0.1, 0.75] }",
        "upper = [0.1, 0.25] }\npoints_per_cell = 3\n[[body]]\n\
        material = \"soil\"\nbox = { lower = [0, 0.25], upper = [0.1, 0.75] }",
    );
    let case = changed(
        &case,
        "[[body]]\nmaterial = \"soil\"\nbox = { lower = [0, 0]",
        "[[body]]\nmaterial = \"sand\"\nbox = { lower = [0, 0]",
    );
    let case = changed(
        &case,
        "name = \"lift\"\nmaterial = \"soil\"",
        "name = \"lift\"\nmaterial = \"sand\"",
    );
    let case = changed(
        &case,
        "from = [0, 1]\nto = [0.1, 1]",
        "from = [0, 0.25]\nto = [0.1, 0.25]",
    );
    let case = changed(&case, "deactivate = [\"ground\"]\nactivate = [\"crest\"]\n", "");
    let case = changed(&case, "dt = \"5 ms\"", "dt = \"1 ms\"");
    let case = changed(
        &case,
        "name = \"base\"\nat = [0.025, 0.025]",
        "name = \"middle\"\nat = [0.025, 0.4917]",
    );
    let scratch = Scratch::with_case(&case);
    scratch.mpirun(2, &["case.toml", "-q", "-o", "out"]).expect(0);
    let warned = manifest(&scratch.path("out")).warnings;
    assert!(
        warned
            .iter()
            .all(|warning| !warning.contains("drain") && !warning.contains("stage.0")),
        "{warned:?}"
    );
    let [a, b, c] = ["[[drain]]", "[[stage]]", "[[history]]"].map(|table| case.find(table).expect("a table"));
    let closed = warnings(&(case[..a].to_owned() + &case[b..c]));
    assert!(
        closed
            .iter()
            .any(|warning| warning.starts_with("W0543: material.sand: ")),
        "{closed:?}"
    );
    let found = history(&scratch.path("out"));
    let of = |name: &str, t: f64| at(&found, name, t);
    let weight = 20e3 * LIFT;
    assert!(of("middle", 0.25).abs() < 1e-3 * weight && of("top-y", 0.25).abs() < 1e-3 * weight / 1e8);
    for t in [0.01, 0.03] {
        // A quarter of a metre to either side.
        let exact = terzaghi(
            |k| weight * 2.0 / k * (k * (0.25 - 0.0083) / 0.25).sin(),
            t / (0.25 * 0.25),
        );
        let p = of("middle", 0.25 + t);
        println!("after {t} s: {p} Pa, exactly {exact}");
        assert!((p - exact).abs() < 0.02 * weight, "{p}, exactly {exact}");
    }
    let settled = weight * GROUND / 1e8;
    let found = -of("top-y", 0.55);
    println!("settled {found:e} m, exactly {settled:e}");
    assert!((found / settled - 1.0).abs() < 2e-3, "{found:e}, exactly {settled:e}");
    assert!(of("water-balance", 0.55).abs() < 1e-6);
}

/// A head at the base that a stage puts in the place of the still water, and water that another puts in at the top in
/// the place of the drain there: the pressure falls evenly, and then rises by what the flow asks for.
#[test]
fn a_head_and_an_inflow_begin_with_a_stage() {
    const HEAD: f64 = 1.5;
    const RATE: f64 = 1e-5;
    let case = changed(LIFTED, "end = \"0.55 s\"", "end = \"9 s\"");
    let case = changed(&case, "dt = \"5 ms\"", "dt = \"50 ms\"");
    let case = changed(&case, "name = \"lift\"", "name = \"upper\"");
    // It heaves, and is not to leave the grid.
    let case = changed(&case, "upper = [0.1, 1]\ncell", "upper = [0.1, 1.1]\ncell");
    let a = case.find("[[drain]]").expect("drains");
    let b = case.find("[solver]").expect("a solver");
    let c = case
        .find("[[history]]\nquantity = \"water-outflow\"")
        .expect("outflows");
    let drains = format!(
        "[[drain]]\nname = \"base\"\nface = \"bottom\"\n[[drain]]\nname = \"artesian\"\nface = \"bottom\"\nhead = {HEAD}\n\
         [[drain]]\nname = \"crest\"\nsurface = true\n\
         [[inflow]]\nname = \"pumped\"\nfrom = [0, 1]\nto = [0.1, 1]\nrate = {RATE}\n\
         [[stage]]\nat = 1\ndeactivate = [\"base\"]\nactivate = [\"artesian\"]\n\
         [[stage]]\nat = 5\ndeactivate = [\"crest\"]\nactivate = [\"pumped\"]\n"
    );
    let outflows =
        "[[history]]\nquantity = \"water-outflow\"\nname = \"out\"\n[[history]]\nquantity = \"water-balance\"\n";
    let scratch = Scratch::with_case(&(case[..a].to_owned() + &drains + &case[b..c] + outflows));
    scratch.mpirun(1, &["case.toml", "-q", "-o", "whole"]).expect(0);
    let found = history(&scratch.path("whole"));
    let of = |name: &str, t: f64| at(&found, name, t);
    let excess = 9810.0 * (HEAD - 1.0);
    assert!(of("base", 1.0).abs() < 1e-3 * excess);
    // The points nearest to the places.
    let heights = [0.025, 0.875].map(|y: f64| ((y / 0.05 * 3.0).floor() + 0.5) * 0.05 / 3.0);
    for (t, fall) in [(5.0, excess), (9.0, -9810.0 * RATE / 9.81e-5)] {
        for (name, y) in ["base", "within"].into_iter().zip(heights) {
            let p = of(name, t);
            let exact = excess - fall * y;
            println!("{name} at {t} s: {p} Pa, exactly {exact}");
            assert!((p - exact).abs() < 0.01 * excess, "{p}, exactly {exact}");
        }
    }
    let rate = (of("out", 5.0) - of("out", 4.5)) / 0.5;
    assert!(rate.abs() < 1e-6 * RATE, "steady: {rate:e}");
    let balance = of("water-balance", 9.0).abs();
    assert!(balance < 1e-6, "{balance:e}");
    repeats(
        &scratch,
        &["base", "within", "out"],
        &["19", "20", "21", "99", "100", "110"],
    );
}

/// A lift of silt that keeps water under suction comes when the level has fallen: with what its pores hold then, which
/// is less than they would have held at the start, and the books know it.
#[test]
fn a_lift_comes_with_the_suction_of_its_time() {
    let case = changed(LIFTED, "level = 1.0", "level_path = [[0, 0.75], [0.2, 0.45]]");
    let case = changed(
        &case,
        "porosity = 0.4",
        "porosity = 0.4\nretention = { alpha = 2.0, n = 2.0 }",
    );
    let case = changed(
        &case,
        "[[drain]]\nname = \"ground\"\nfrom = [0, 0.75]\nto = [0.1, 0.75]",
        "[[drain]]\nface = \"bottom\"",
    );
    let case = changed(&case, "[[drain]]\nname = \"crest\"\nfrom = [0, 1]\nto = [0.1, 1]\n", "");
    let case = changed(&case, "deactivate = [\"ground\"]\nactivate = [\"crest\"]\n", "");
    let case = changed(
        &case,
        "[[history]]\nquantity = \"water-outflow\"\ndrain = \"ground\"\nname = \"ground\"\n",
        "",
    );
    let case = changed(&case, "drain = \"crest\"\nname = \"crest\"", "name = \"out\"");
    let case = changed(
        &case,
        "quantity = \"excess-pressure\"\nname = \"within\"",
        "quantity = \"pore-pressure\"\nname = \"within\"",
    );
    let scratch = Scratch::with_case(&case);
    scratch.mpirun(1, &["case.toml", "-q", "-o", "whole"]).expect(0);
    let reported = manifest(&scratch.path("whole")).warnings;
    assert!(
        reported
            .iter()
            .any(|warning| warning.starts_with("W0544: stage.0.add: the added body.1")),
        "{reported:?}"
    );
    let found = history(&scratch.path("whole"));
    // Under its own weight what pores hold bears little: p is near that of still water, gamma_w (0.45 - 0.875) m.
    let suction = at(&found, "within", 0.255);
    let still = 9810.0 * (0.45 - 0.875);
    println!("{suction} Pa, of still water {still}");
    assert!((suction / still - 1.0).abs() < 0.01, "{suction}, {still}");
    let balance = [0.25, 0.255, 0.55].map(|t| at(&found, "water-balance", t).abs());
    println!("balance {balance:?}");
    assert!(balance.iter().all(|of| *of < 1e-7), "{balance:?}");
    repeats(&scratch, &["base", "within", "out"], &["49", "50", "51"]);
}
