//! Ground that has drained, and is then loaded so fast that it does not: by its water, or by a law of total stress.

use crate::support::Scratch;
use crate::support::results::{at, history};
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
         [grid]\nlower = [0, 0]\nupper = [0.1, 1]\ncell = 0.05\norder = \"quadratic\"\n\
         [material.soil]\nmodel = \"hencky\"\nyoung = {MODULUS}\npoisson = 0\ndrainage = \"coupled\"\n\
         porosity = {POROSITY}\npermeability = {PERMEABILITY}\n[water]\nbulk = {WATER}\n\
         [[body]]\nmaterial = \"soil\"\nbox = {{ lower = [0, 0], upper = [0.1, 1] }}\npoints_per_cell = 3\n\
         [boundary]\nbottom = \"fixed\"\nleft = \"roller\"\nright = \"roller\"\n\
         [[drain]]\nname = \"top\"\nsurface = true\n[[traction]]\n{first}[[traction]]\nname = \"more\"\n{second}\
         [[stage]]\nat = \"4 s\"\napply = [\"more\"]\n[solver]\ntolerance = 1e-12\nforce_tolerance = 1e-8\n\
         [[history]]\nquantity = \"excess-pressure\"\nname = \"bottom\"\nat = [0.025, 0.025]\n\
         [[history]]\nquantity = \"displacement\"\nname = \"top\"\nat = [0.05, 1]\n"
    )
}

/// Excess pressure over the first one at a height of 25 mm at a time factor (Terzaghi, 1923), and the mean one.
fn left(factor: f64) -> [f64; 2] {
    let term = |k: u32| {
        let m = PI / 2.0 * f64::from(2 * k + 1);
        let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let kept = (-m * m * factor).exp();
        [2.0 / m * sign * (m * 0.025).cos() * kept, 2.0 / (m * m) * kept]
    };
    (0..100).map(term).fold([0.0; 2], |sum, term| [sum[0] + term[0], sum[1] + term[1]])
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
    assert!(pressure(4.0).abs() < 1e-3 * LOADS[0] && (settled(4.0) / LOADS[0] - 1.0).abs() < 1e-3, "{}", settled(4.0));
    let first = share * LOADS[1];
    assert!((pressure(4.005) / first - 1.0).abs() < 1e-3, "{}, {first}", pressure(4.005));
    // Steps of 5 ms: .44 and .38 % off in the pressure, .6 and .3 % in the settlement.
    for later in [0.1, 0.3] {
        let [there, mean] = left(share * later).map(|left| left * first);
        let [p, s] = [pressure(4.0 + later), settled(4.0 + later) - LOADS[0]];
        println!("{later} s: {p} Pa, exactly {there}; settled {s} Pa/M, exactly {}", LOADS[1] - mean);
        assert!((p / there - 1.0).abs() < 0.01, "{p}, exactly {there}");
        assert!((s / (LOADS[1] - mean) - 1.0).abs() < 0.01, "{s}, exactly {}", LOADS[1] - mean);
    }
}

/// A block under 100 kPa all around, of soil with phi' = 25 degrees, is pressed by a smooth plate from 1 on.
fn pressed(stage: &str) -> String {
    let pressed = "pressure = \"100 kPa\"\nramp = 1\n";
    format!(
        "geometry = \"plane-strain\"\n[analysis]\ntype = \"quasi-static\"\nend = 2\nsteps = 8\n\
         [grid]\nlower = [0, 0]\nupper = [1.5, 1.5]\ncell = 0.25\norder = \"quadratic\"\n\
         [material.drained]\nmodel = \"mohr-coulomb\"\nyoung = \"2 GPa\"\npoisson = 0.3\nfriction = 25\ncohesion = 0\n\
         [material.undrained]\nmodel = \"tresca\"\nyoung = \"2 GPa\"\npoisson = 0.49\ncohesion = \"30 kPa\"\n\
         [[body]]\nmaterial = \"drained\"\nbox = {{ lower = [0, 0], upper = [1, 1] }}\npoints_per_cell = 3\n\
         [boundary]\nbottom = \"roller\"\nleft = \"roller\"\n\
         [[traction]]\nfrom = [0, 1]\nto = [1, 1]\n{pressed}[[traction]]\nfrom = [1, 0]\nto = [1, 1]\n{pressed}\
         [footing]\nname = \"plate\"\nbase = \"smooth\"\nfrom = [0, 1]\nto = [1, 1]\n\
         path = [[0, 0, 0], [1, 0, 0], [2, 0, -2e-4]]\n[[stage]]\nat = 1\napply = [\"plate\"]\n{stage}\
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
        assert!(before.iter().all(|pressure| (pressure / 1e5 - 1.0).abs() < 1e-4), "{before:?}");
        assert!((after[0] / 1e5 - 1.0).abs() < 2e-3 && (after[1] / exact - 1.0).abs() < 2e-3, "{after:?}, {exact}");
    }
}
