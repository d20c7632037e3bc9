//! Tests of other units and origins.

use crate::scenes::{Collapse, Footing, SI, Units, block};
use crate::solver::Run;
use crate::table::Found;

/// Powers of two of length, mass and time: the first ones of the list of extremes, and two more.
const POWERS: [[i32; 3]; 3] = [[10, 20, 5], [-2, 5, -4], [3, -10, 6]];

/// Place, velocity or not, stress and plastic strain of all points of the last frame, in SI.
fn state(run: &Run, units: &Units) -> Vec<f64> {
    let frame = run.frame();
    let field = |name: &str, components: usize, unit: f64| {
        frame
            .real(name, components)
            .unwrap_or_default()
            .iter()
            .map(|x| x / unit)
            .collect::<Vec<_>>()
    };
    let place = frame.position.as_flattened().iter().map(|x| x / units.length);
    let displacement = field("displacement", 3, units.length);
    let velocity = field("velocity", 3, units.length / units.time);
    let stress = field("stress", 6, units.stress());
    place
        .chain(displacement)
        .chain(velocity)
        .chain(stress)
        .chain(field("plastic_strain", 1, 1.0))
        .collect()
}

/// Numbers whose bits differ in any of the other units.
fn differing(text: impl Fn(Units) -> String) -> Found {
    let reference = state(&Run::of(&text(SI), 1, &[]), &SI);
    let mut count = 0;
    let mut total = 0;
    for [length, mass, time] in POWERS.map(|powers| powers.map(|power| 2.0_f64.powi(power))) {
        let units = Units {
            length,
            mass,
            time,
            origin: 0.0,
        };
        let run = Run::of(&text(units), 1, &[]);
        let found = run.found(|run| {
            let found = state(run, &units);
            assert_eq!(found.len(), reference.len());
            total += found.len();
            found.iter().zip(&reference).filter(|(a, b)| a != b).count() as f64
        });
        match found {
            Found::Figure(differing, _) => count += differing as usize,
            other => return other,
        }
    }
    Found::Figure(count as f64, format!("of {total} numbers"))
}

/// The collapse, 40 steps of it.
pub fn collapse(method: &'static str) -> Found {
    differing(|units| {
        Collapse {
            units,
            method,
            end: 0.02,
            ..Collapse::default()
        }
        .text()
    })
}

/// The footing to z/B = 0.1.
pub fn footing(method: &'static str) -> Found {
    differing(|units| {
        Footing {
            units,
            method,
            ..Footing::default()
        }
        .text()
    })
}

/// The footing with an iterative linear solver, whose tolerances are relative.
pub fn iterative() -> Found {
    let solver = "linear = \"multigrid\"";
    differing(|units| {
        Footing {
            units,
            solver,
            steps: 4,
            depth: 0.01,
            ..Footing::default()
        }
        .text()
    })
}

/// Largest difference of two states over the largest number.
fn relative(found: &[f64], reference: &[f64]) -> f64 {
    let size = reference.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    found
        .iter()
        .zip(reference)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
        / size
}

/// The collapse in mm, kPa and ms: largest difference, relative.
pub fn prefixes() -> Found {
    let plain = Collapse {
        end: 0.02,
        ..Collapse::default()
    }
    .text();
    let other = plain
        .replacen("dt = 0.0005", "dt = \"0.5 ms\"", 1)
        .replacen("cell = 0.01", "cell = \"10 mm\"", 1)
        .replacen("young = 5840000", "young = \"5840 kPa\"", 1)
        .replacen("unit_weight = 20400", "unit_weight = \"20.4 kN/m3\"", 1)
        .replacen("[0.0, -9.81]", "[0.0, \"-9810 mm/s2\"]", 1);
    assert_eq!(other.matches('"').count(), plain.matches('"').count() + 10, "{other}");
    let reference = state(&Run::of(&plain, 1, &[]), &SI);
    Run::of(&other, 1, &[]).found(|run| relative(&state(run, &SI), &reference))
}

/// Displacement, velocity and stress, which know no origin.
fn fields(run: &Run) -> Vec<f64> {
    let frame = run.frame();
    let field = |name: &str, components: usize| frame.real(name, components).unwrap_or_default().to_vec();
    [field("displacement", 3), field("velocity", 3), field("stress", 6)].concat()
}

/// The collapse on cells of 1/128 m at an origin that a float holds exactly: numbers whose bits differ.
pub fn exact_origin(origin: f64) -> Found {
    let text = |origin: f64| {
        let units = Units { origin, ..SI };
        Collapse {
            units,
            cell: 1.0 / 128.0,
            end: 0.02,
            ..Collapse::default()
        }
        .text()
    };
    let reference = fields(&Run::of(&text(0.0), 1, &[]));
    Run::of(&text(origin), 1, &[]).found(|run| {
        let found = fields(run);
        Found::Figure(
            found.iter().zip(&reference).filter(|(a, b)| a != b).count() as f64,
            format!("of {} numbers", found.len()),
        )
    })
}

/// The same on cells of 10 mm, which no float holds: largest difference of a displacement, relative.
pub fn origin(origin: f64) -> Found {
    let text = |origin: f64| {
        let units = Units { origin, ..SI };
        Collapse {
            units,
            end: 0.02,
            ..Collapse::default()
        }
        .text()
    };
    let moved = |run: &Run| run.frame().real("displacement", 3).expect("displacements").to_vec();
    let reference = moved(&Run::of(&text(0.0), 1, &[]));
    let run = Run::of(&text(origin), 1, &[]);
    run.found_or_warned("W0208", |run| relative(&moved(run), &reference))
}

/// A block that flies through 20 m of cells, an eighth of a metre a step, so that half of its points stand on knots
/// after every second step: change of its momentum, relative.
pub fn knots() -> Found {
    Run::of(&block([125.0, 0.0], 160, ""), 2, &[]).found(|run| {
        let momentum = run.column("momentum-x");
        let first = momentum[0];
        momentum.iter().map(|p| (p / first - 1.0).abs()).fold(0.0, f64::max)
    })
}
