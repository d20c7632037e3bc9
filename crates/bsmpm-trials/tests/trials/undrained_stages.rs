//! Tests fast loading of drained ground in stages.

use crate::support::Scratch;
use crate::support::cases::changed;
use crate::support::results::{at, history, manifest};
use std::f64::consts::PI;

/// Pa, -: constrained modulus, bulk modulus of the water, porosity of a column 1 m high, drained at its top.
const MODULUS: f64 = 1e8;
const WATER: f64 = 2.2e9;
const POROSITY: f64 = 0.4;
/// m/s  permeability, so that c_v = k M/gamma_w = 1 m2/s of water that does not give
const PERMEABILITY: f64 = 9.81e-5;
/// Pa  the load that has drained, and what comes at 4 s
const LOADS: [f64; 2] = [1e3, 2e3];

fn column() -> String {
    let load = |pressure: f64| format!("from = [0, 1]\nto = [0.1, 1]\nstress = [0, {}]\n", -pressure);
    let [first, second] = LOADS.map(load);
    format!(
        "geometry = \"plane-strain\"\n[analysis]\ntype = \"consolidation\"\nend = \"4.3 s\"\ndt = \"5 ms\"\n\
         [grid]\nlower = [0, 0]\nupper = [0.1, 1]\ncell = 0.05\ndegree = \"quadratic\"\n\
         [material.soil]\nmodel = \"elastic\"\nyoung = {MODULUS}\npoisson = 0\ndrainage = \"coupled\"\n\
         porosity = {POROSITY}\npermeability = {PERMEABILITY}\n[water]\nbulk = {WATER}\n\
         [[body]]\nmaterial = \"soil\"\nbox = {{ lower = [0, 0], upper = [0.1, 1] }}\npoints_per_cell = 3\n\
         [boundary]\nbottom = \"fixed\"\nleft = \"roller\"\nright = \"roller\"\n\
         [[drain]]\nname = \"top\"\nsurface = true\n[[traction]]\n{first}[[traction]]\nname = \"more\"\n{second}\
         [[stage]]\nat = \"4 s\"\nactivate = [\"more\"]\n[solver]\ntolerance = 1e-12\nforce_tolerance = 1e-8\n\
         [[history]]\nquantity = \"excess-pressure\"\nname = \"bottom\"\nat = [0.025, 0.025]\n\
         [[history]]\nquantity = \"displacement\"\nname = \"top\"\nat = [0.05, 1]\n"
    )
}

/// Excess pressure over the first one at a time factor (Terzaghi, 1923), at a distance over the drainage path from the
/// end that is closed, and the mean one.
fn left(factor: f64, place: f64) -> [f64; 2] {
    let term = |k: u32| {
        let m = PI / 2.0 * f64::from(2 * k + 1);
        let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let kept = (-m * m * factor).exp();
        [2.0 / m * sign * (m * place).cos() * kept, 2.0 / (m * m) * kept]
    };
    (0..100)
        .map(term)
        .fold([0.0; 2], |sum, term| [sum[0] + term[0], sum[1] + term[1]])
}

/// Once the first load has drained, the skeleton carries it, and the water what comes at once, but for what it gives:
/// q/(1 + n M/K_w). Then that drains, too.
#[test]
fn a_load_on_ground_that_has_drained_goes_to_the_water_first() {
    let scratch = Scratch::with_case(&column());
    scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(0);
    let found = history(&scratch.path("out"));
    let share = 1.0 / (1.0 + POROSITY * MODULUS / WATER);
    let pressure = |t: f64| at(&found, "bottom", t);
    let settled = |t: f64| -at(&found, "top-y", t) * MODULUS;
    assert!(
        pressure(4.0).abs() < 1e-3 * LOADS[0] && (settled(4.0) / LOADS[0] - 1.0).abs() < 1e-3,
        "{}",
        settled(4.0)
    );
    let first = share * LOADS[1];
    assert!(
        (pressure(4.005) / first - 1.0).abs() < 1e-3,
        "{}, {first}",
        pressure(4.005)
    );
    // Steps of 5 ms: 0.44 and 0.38 % off in the pressure, 0.6 and 0.3 % in the settlement.
    for later in [0.1, 0.3] {
        let [there, mean] = left(share * later, 0.025).map(|left| left * first);
        let [p, s] = [pressure(4.0 + later), settled(4.0 + later) - LOADS[0]];
        println!(
            "{later} s: {p} Pa, exactly {there}; settled {s} Pa/M, exactly {}",
            LOADS[1] - mean
        );
        assert!((p / there - 1.0).abs() < 0.01, "{p}, exactly {there}");
        assert!(
            (s / (LOADS[1] - mean) - 1.0).abs() < 0.01,
            "{s}, exactly {}",
            LOADS[1] - mean
        );
    }
}

/// A column under water that its base drains, and a quarter of which is taken away after a second.
const RELIEVED: &str = r#"geometry = "plane-strain"
[analysis]
type = "consolidation"
end = "1.3 s"
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
name = "soil"
material = "soil"
box = { lower = [0, 0], upper = [0.1, 0.75] }
points_per_cell = 3
[[body]]
name = "cap"
material = "soil"
box = { lower = [0, 0.75], upper = [0.1, 1] }
points_per_cell = 3
[boundary]
bottom = "fixed"
left = "roller"
right = "roller"
[[drain]]
face = "bottom"
[[stage]]
at = "1 s"
remove = ["cap"]
[solver]
tolerance = 1e-12
force_tolerance = 1e-8
[output]
checkpoint = { every_steps = 100 }
[[history]]
quantity = "excess-pressure"
name = "top"
at = [0.025, 0.725]
[[history]]
quantity = "excess-pressure"
name = "middle"
at = [0.025, 0.375]
[[history]]
quantity = "water-balance"
"#;

/// The water loses what the weight of the cap under water pressed with, and comes back through the base; what is laid
/// bare is closed, which is reported. What the cap took away of the water is in the books.
#[test]
fn water_under_what_is_removed_loses_its_weight_and_comes_back() {
    let scratch = Scratch::with_case(RELIEVED);
    scratch.mpirun(2, &["case.toml", "-q", "-o", "out"]).expect(0);
    let is_reported = |out: &str| {
        manifest(&scratch.path(out))
            .warnings
            .iter()
            .any(|warning| warning.starts_with("W0544"))
    };
    assert!(is_reported("out"));
    let found = history(&scratch.path("out"));
    let of = |name: &str, t: f64| at(&found, name, t);
    let first: f64 = -(20e3 - 9810.0) * 0.25;
    let path: f64 = 0.75;
    assert!(
        ["top", "middle"]
            .iter()
            .all(|name| of(name, 1.0).abs() < 1e-3 * first.abs())
    );
    assert!(
        (of("top", 1.005) / first - 1.0).abs() < 5e-3,
        "{}, {first}",
        of("top", 1.005)
    );
    for (name, place) in [("top", 0.025 / path), ("middle", 0.5)] {
        let exact = first * left(0.3 / (path * path), place)[0];
        println!("{name}: {} Pa, exactly {exact}", of(name, 1.3));
        assert!(
            (of(name, 1.3) / exact - 1.0).abs() < 0.02,
            "{}, exactly {exact}",
            of(name, 1.3)
        );
    }
    // 5e-8 of what moves in the first step then, as with a load in place of the stage; 2e-3 were the cap's water lost.
    let balance = [1.005, 1.3].map(|t| of("water-balance", t).abs());
    println!("balance {balance:?}");
    assert!(balance.iter().all(|of| *of < 1e-7), "{balance:?}");
    // Stopped behind the stage and gone on with on one rank.
    scratch
        .mpirun(1, &["case.toml", "-q", "-o", "part", "--max-steps", "230"])
        .expect(75);
    scratch
        .mpirun(1, &["case.toml", "-q", "-o", "part", "--restart", "auto"])
        .expect(0);
    let one = history(&scratch.path("part"));
    let same = |name: &str| (at(&one, name, 1.3) / of(name, 1.3) - 1.0).abs() < 1e-6;
    assert!(same("top") && same("middle") && at(&one, "water-balance", 1.3).abs() < 1e-7);
    // Drained where it is laid bare, from the start on.
    let drained = changed(RELIEVED, "face = \"bottom\"", "from = [0, 0.75]\nto = [0.1, 0.75]");
    scratch.write("drained.toml", &drained);
    scratch.mpirun(1, &["drained.toml", "-q", "-o", "drained"]).expect(0);
    assert!(!is_reported("drained"));
    let found = history(&scratch.path("drained"));
    let balance = at(&found, "water-balance", 1.3);
    assert!(
        at(&found, "top", 1.3).abs() < 0.2 * first.abs() && balance.abs() < 1e-7,
        "{balance:e}"
    );
}

/// A block under 100 kPa all around, of soil with phi' = 25 degrees, is pressed by a smooth plate from 1 on.
fn pressed(stage: &str) -> String {
    let pressed = "pressure = \"100 kPa\"\nramp = 1\n";
    format!(
        "geometry = \"plane-strain\"\n[analysis]\ntype = \"quasi-static\"\nend = 2\nsteps = 8\n\
         [grid]\nlower = [0, 0]\nupper = [1.5, 1.5]\ncell = 0.25\ndegree = \"quadratic\"\n\
         [material.drained]\nmodel = \"mohr-coulomb\"\nyoung = \"2 GPa\"\npoisson = 0.3\nfriction_angle = 25\ncohesion = 0\n\
         [material.undrained]\nmodel = \"tresca\"\nyoung = \"2 GPa\"\npoisson = 0.49\ncohesion = \"30 kPa\"\n\
         [[body]]\nmaterial = \"drained\"\nbox = {{ lower = [0, 0], upper = [1, 1] }}\npoints_per_cell = 3\n\
         [boundary]\nbottom = \"roller\"\nleft = \"roller\"\n\
         [[traction]]\nfrom = [0, 1]\nto = [1, 1]\n{pressed}[[traction]]\nfrom = [1, 0]\nto = [1, 1]\n{pressed}\
         [footing]\nname = \"plate\"\ninterface = \"smooth\"\nfrom = [0, 1]\nto = [1, 1]\n\
         path = [[0, 0, 0], [1, 0, 0], [2, 0, -2e-4]]\n[[stage]]\nat = 1\nactivate = [\"plate\"]\n{stage}\
         [[history]]\nquantity = \"stress\"\nat = [0.5, 0.5]\n"
    )
}

/// Slowly it carries (1 + sin phi)/(1 - sin phi) times 100 kPa; so fast that it stays as it has drained, by the law
/// that a stage puts in its place, 2 c more than that, on the stress that was there.
#[test]
fn clay_that_has_drained_fails_at_once_by_its_strength_without_drainage() {
    let run = |stage: &str| {
        let scratch = Scratch::with_case(&pressed(stage));
        scratch.mpirun(1, &["case.toml", "-q", "-o", "out"]).expect(0);
        let found = history(&scratch.path("out"));
        [1.0, 2.0].map(|t| ["stress-xx", "stress-yy"].map(|name| -at(&found, name, t)))
    };
    let sine = 25_f64.to_radians().sin();
    let exchange = "materials = [{ from = \"drained\", to = \"undrained\" }]\n";
    for (stage, exact) in [("", 1e5 * (1.0 + sine) / (1.0 - sine)), (exchange, 1e5 + 2.0 * 30e3)] {
        let [before, after] = run(stage);
        println!("{before:?} Pa, then {after:?}; exactly {exact}");
        assert!(
            before.iter().all(|pressure| (pressure / 1e5 - 1.0).abs() < 1e-4),
            "{before:?}"
        );
        assert!(
            (after[0] / 1e5 - 1.0).abs() < 2e-3 && (after[1] / exact - 1.0).abs() < 2e-3,
            "{after:?}, {exact}"
        );
    }
}
