//! Tests the wave speed with each mass matrix.

use crate::support::Scratch;
use crate::support::results::{history, manifest};
use bsmpm_io::table::Columns;
use std::f64::consts::TAU;

/// m/s  sqrt(E/rho) of the bar
const SPEED: f64 = 60.0;
/// Hz
const FREQUENCY: f64 = 5.0;
/// m
const WAVELENGTH: f64 = SPEED / FREQUENCY;
/// m  at which the velocity is recorded
const PLACES: [f64; 2] = [9.0, 21.0];
/// s  of a run, in which the wave is steady over the last two periods
const END: f64 = 1.2;

/// A bar between rollers, Poisson's ratio 0, pushed at its left end by `amplitude`, rows [t, share]; at its right end
/// it absorbs.
fn bar(cell: f64, order: &str, dt: f64, amplitude: impl Fn(f64) -> f64) -> String {
    let length = (36.0 / cell).ceil() * cell;
    let rows: Vec<String> = (1..=(END / dt).round() as usize)
        .map(|k| k as f64 * dt)
        .map(|t| format!("[{t:?}, {:?}]", amplitude(t)))
        .collect();
    let records: Vec<String> = PLACES
        .iter()
        .zip(["near", "far"])
        .map(|(x, name)| {
            let y = 0.5 * cell;
            format!("[[history]]\nquantity = \"velocity\"\nat = [{x}, {y}]\nsurface = true\nname = \"{name}\"\n")
        })
        .collect();
    format!(
        r#"
geometry = "plane-strain"
[analysis]
type = "dynamic"
end = {END}
dt = {dt:?}
[grid]
lower = [{:?}, 0.0]
upper = [{length:?}, {cell:?}]
cell = {cell:?}
order = "{order}"
[material.elastic]
model = "elastic"
young = 6.48e6
poisson = 0.0
density = 1800.0
[[body]]
material = "elastic"
box = {{ lower = [0.0, 0.0], upper = [{length:?}, {cell:?}] }}
points_per_cell = 2
[boundary]
right = "absorbing"
bottom = "roller"
top = "roller"
[[traction]]
from = [0.0, 0.0]
to = [0.0, {cell:?}]
stress = [1000.0, 0.0]
amplitude = [{}]
{}"#,
        -2.0 * cell,
        rows.join(", "),
        records.concat()
    )
}

/// A harmonic that grows over two periods.
fn harmonic(t: f64) -> f64 {
    (TAU * FREQUENCY * t).sin() * (0.5 * FREQUENCY * t).min(1.0)
}

/// Lag of the far velocity behind the near one over that of the exact wave, less 1, by their phases in the last two
/// periods.
fn delay(table: &Columns) -> f64 {
    let times = table.get("time").unwrap();
    let phase = |name: &str| {
        let rows = times
            .iter()
            .zip(table.get(name).unwrap())
            .filter(|(t, _)| **t > END - 2.0 / FREQUENCY + 1e-9);
        let sums = rows.fold([0.0; 2], |[c, s], (t, v)| {
            let angle = TAU * FREQUENCY * t;
            [c + v * angle.cos(), s + v * angle.sin()]
        });
        sums[1].atan2(sums[0])
    };
    // The places are a wavelength apart, so that the lag is that of a whole turn and what is left over.
    let off = phase("far-x") - phase("near-x");
    (off - TAU * (off / TAU).round()) / TAU
}

/// Error of the speed with so many cells a wavelength.
fn speed_error(cells: f64, order: &str, mass: &str) -> f64 {
    let scratch = Scratch::with_case(&bar(WAVELENGTH / cells, order, 0.01 / FREQUENCY, harmonic));
    scratch
        .direct(&["case.toml", "-q", "--set", &format!("analysis.mass={mass}")])
        .expect(0);
    1.0 / (1.0 + delay(&history(&scratch.path("case.out")))) - 1.0
}

/// The numbers of the warning: with them the speed is wrong by 2 % at most, and with a quarter less by more.
#[test]
fn with_as_many_cells_as_the_warning_asks_for_the_speed_is_within_2_per_cent() {
    for (mass, order, fewest) in [
        ("lumped", "linear", 18.0),
        ("lumped", "quadratic", 24.0),
        ("lumped", "cubic", 28.0),
        ("consistent", "linear", 9.0),
        ("consistent", "quadratic", 8.0),
        ("consistent", "cubic", 8.0),
    ] {
        let [at, below] = [fewest, 0.75 * fewest].map(|cells| speed_error(cells, order, mass));
        println!(
            "{mass}, {order}: {at:.4} with {fewest} cells, {below:.4} with {}",
            0.75 * fewest
        );
        assert!(at.abs() <= 0.02 && below.abs() > 0.02, "{mass}, {order}: {at}, {below}");
    }
}

/// The error of the speed is of second order in the cell: theta^2/4 with the lumped mass and quadratic splines; this
/// prints the table.
#[test]
fn the_speed_converges_with_the_square_of_the_cell() {
    for mass in ["lumped", "consistent"] {
        for degree in ["linear", "quadratic", "cubic"] {
            let error = |cells: f64| {
                let error = speed_error(cells, degree, mass);
                println!("{mass} {degree} {cells}: {:.2} %", 100.0 * error);
                error.abs()
            };
            let errors = [8.0, 10.0, 12.0, 16.0, 20.0, 24.0, 32.0].map(error);
            let order = (errors[3] / errors[6]).log2();
            assert!(
                errors.is_sorted_by(|coarse, fine| coarse > fine),
                "{mass}, {degree}: {errors:?}"
            );
            assert!(
                (1.5..2.5).contains(&order),
                "{mass}, {degree}: order {order:.2} between 16 and 32 cells"
            );
        }
    }
}

/// 12 cells a wavelength: the lumped mass is 8 % slow. The choice is noted, and a mass that is given wins.
#[test]
fn a_wave_of_12_cells_has_its_speed_within_1_per_cent_by_default() {
    let scratch = Scratch::with_case(&bar(1.0, "quadratic", 0.004, harmonic));
    let run = scratch.direct(&["case.toml"]).expect(0);
    let error = 1.0 / (1.0 + delay(&history(&scratch.path("case.out")))) - 1.0;
    println!("error of the speed: {error:.4}");
    assert!(error.abs() < 0.01, "{error}");
    assert!(!run.stderr.contains("W0680"), "{}", run.stderr);
    let choices = manifest(&scratch.path("case.out")).choices;
    assert!(
        choices
            .iter()
            .any(|choice| choice.key == "analysis.mass" && choice.value == "consistent")
    );
    let given = scratch
        .direct(&["case.toml", "--set", "analysis.mass=lumped", "-o", "given"])
        .expect(0);
    let slow = 1.0 / (1.0 + delay(&history(&scratch.path("given")))) - 1.0;
    assert!(slow < -0.05, "{slow}");
    let choices = manifest(&scratch.path("given")).choices;
    assert!(choices.iter().all(|choice| choice.key != "analysis.mass"));
    given.says_once("W0680: ");
    given.says_once("analysis.mass = \"consistent\"");
}

/// A Ricker pulse of 5 Hz, whose wave has 12 cells at its peak frequency, arrives within 2 % of the exact time, by the
/// largest correlation with what passed the nearer place.
#[test]
fn a_pulse_is_not_late() {
    let pulse = |t: f64| {
        let x = (0.5 * TAU * FREQUENCY * (t - 0.25)).powi(2);
        (1.0 - 2.0 * x) * (-x).exp()
    };
    let dt = 0.004;
    let scratch = Scratch::with_case(&bar(1.0, "quadratic", dt, pulse));
    scratch.direct(&["case.toml", "-q"]).expect(0);
    let table = history(&scratch.path("case.out"));
    let [near, far] = ["near-x", "far-x"].map(|name| table.get(name).unwrap());
    let likeness = |lag: usize| near.iter().zip(&far[lag..]).map(|(a, b)| a * b).sum::<f64>();
    let best = (20..100).max_by(|a, b| likeness(*a).total_cmp(&likeness(*b))).unwrap();
    let [before, at, after] = [best - 1, best, best + 1].map(likeness);
    let lag = dt * (best as f64 + 0.5 * (before - after) / (before - 2.0 * at + after));
    let exact = (PLACES[1] - PLACES[0]) / SPEED;
    println!("lag {lag:.4} s, exact {exact:.4} s");
    assert!((lag / exact - 1.0).abs() < 0.02, "{lag}");
}

/// m  height of a column without drainage under its weight, which acts at once: 10 cells
const HEIGHT: f64 = 10.0;
/// Pa  modulus of the skeleton, without lateral strain
const SKELETON: f64 = 1e7;
/// kg/m3
const DENSITY: f64 = 2000.0;
/// -  porosity
const PORES: f64 = 0.4;

/// A column between rollers whose water is `ratio` times as stiff as the skeleton, in so many cells over 10 periods of
/// 60 steps; with its period, s.
fn column(ratio: f64, cells: f64) -> (String, f64) {
    let cell = HEIGHT / cells;
    let modulus = (1.0 + ratio) * SKELETON;
    let period = 4.0 * HEIGHT / (modulus / DENSITY).sqrt();
    let case = format!(
        r#"
geometry = "plane-strain"
[analysis]
type = "dynamic"
end = {:?}
steps = 600
[grid]
lower = [0.0, 0.0]
upper = [{:?}, {:?}]
cell = {cell:?}
degree = "quadratic"
[material.soil]
model = "elastic"
young = {SKELETON:?}
poisson = 0.0
density = {DENSITY:?}
drainage = "undrained"
porosity = {PORES}
[[body]]
material = "soil"
box = {{ lower = [0.0, 0.0], upper = [{:?}, {HEIGHT:?}] }}
points_per_cell = 3
[water]
unit_weight = 10000.0
bulk = {:?}
[gravity]
acceleration = [0.0, -0.01]
[boundary]
bottom = "fixed"
left = "roller"
right = "roller"
[solver]
tolerance = 1e-12
force_tolerance = 1e-8
[[history]]
quantity = "displacement"
at = [{cell:?}, {HEIGHT:?}]
name = "top"
"#,
        10.0 * period,
        2.0 * cell,
        HEIGHT + 2.0 * cell,
        2.0 * cell,
        PORES * ratio * SKELETON
    );
    (case, period)
}

/// s, -  period of a column by the passages through its place at rest, and the mean swing (RMS) in the last of ten
/// periods over that in the first
fn vibration(table: &Columns, rest: f64) -> (f64, f64) {
    let times = table.get("time").unwrap();
    let places = table.get("top-y").unwrap();
    let swing: Vec<f64> = places.iter().map(|y| y - rest).collect();
    let passages: Vec<f64> = (1..swing.len())
        .filter(|k| swing[k - 1] * swing[*k] < 0.0)
        .map(|k| times[k - 1] + (times[k] - times[k - 1]) * swing[k - 1] / (swing[k - 1] - swing[k]))
        .collect();
    let last = passages.len() - 1;
    let square = |swing: &[f64]| swing.iter().map(|z| z * z).sum::<f64>();
    let part = swing.len() / 10;
    let kept = (square(&swing[swing.len() - part..]) / square(&swing[..part])).sqrt();
    (2.0 * (passages[last] - passages[0]) / last as f64, kept)
}

/// T = 4 H sqrt(rho/(M + K/n)). With the tau term of rest, whose compliance of h^2 k^2/(6 M) comes to that of the
/// water, the periods were 1.8 and 18 % long.
#[test]
fn a_column_without_drainage_vibrates_with_the_period_of_its_water() {
    for ratio in [10.0, 100.0] {
        let (case, period) = column(ratio, 10.0);
        let scratch = Scratch::with_case(&case);
        for ranks in [1, 2] {
            scratch.mpirun(ranks, &["case.toml", "-q", "--force"]).expect(0);
            let rest = -0.5 * DENSITY * 0.01 * HEIGHT * HEIGHT / ((1.0 + ratio) * SKELETON);
            let (found, kept) = vibration(&history(&scratch.path("case.out")), rest);
            println!(
                "K/(n M) = {ratio}: period {:.4} of the exact one, swing {kept:.4} after 9",
                found / period
            );
            assert!((found / period - 1.0).abs() < 0.005, "{ratio}: {found} {period}");
            assert!((kept - 1.0).abs() < 0.02, "{ratio}: {kept}");
        }
    }
}
