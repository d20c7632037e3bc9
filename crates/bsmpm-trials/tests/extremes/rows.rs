//! List of all extreme cases: number, measurement, bounds and known failures.

use crate::table::Limit::{AtMost, Reported, Same, Within};
use crate::table::{Row, row};
use crate::{geometry, incompressible, long, materials, points, steps, units, weak};
use bsmpm::stabilisation::Stabilisation::{ConsistentFBar, FBar, ModifiedFBar, None as Plain};

/// Bearing capacity factors between which a footing's p/c must lie: Prandtl's and Meyerhof's.
const BEARING: crate::table::Limit = Within(5.14, 8.28);
/// The same where nu = 0.3: so compressible a clay has not yielded all round at z/B = 0.1, and less than Prandtl's is
/// right. With h = 0.125 m it is 4.75 (`modified-f-bar`) and 4.77 (`consistent-f-bar`), with 0.25 m 4.51 and 4.69: 10 %
/// of the finest.
const YIELDING: crate::table::Limit = Within(4.28, 5.23);
const MODIFIED: &str = "modified-f-bar";
const CONSISTENT: &str = "consistent-f-bar";

const EDGE: &str =
    "nodes at a free edge have almost no stiffness; an artificial stiffness, which is off in dynamics, helps";
const SEPARATION: &str =
    "a pulled footing loses contact where points enter the empty cell before it: its force acts on nodes without soil";
const NOISE_P: &str = "two cells under the footing are too few";
const NOISE: &str = "the acceleration is a difference of large numbers, and keeps its round-off from step to step";
const FLIP: &str = "the transfer of accelerations to the grid and back is dissipative";
const DIFFUSION: &str = "the average of the elastic strain is a diffusion in each step";
const LATE: &str = "the step is too long: the change is 8, 7, 2 % between 0.5 and 0.0625 ms";
const LOOSE: &str = "the farthest material point has separated, and slides on where its neighbours stick";
const SLOW: &str = "p/c changes by 0.1 to 0.4 % with each doubling, and this decreases by less than half";
const C1: &str = "strains cannot jump at an interface inside the grid, because the splines are C1";

/// All rows.
pub fn all() -> Vec<Row> {
    let groups = [
        confined(),
        footings(),
        cohesionless(),
        returns(),
        strains(),
        edges(),
        counts(),
        tiny_steps(),
        huge_steps(),
        stiffness(),
        other_units(),
        motions(),
        nothing(),
        long_runs(),
        step_counts(),
    ];
    groups.into_iter().flatten().collect()
}

/// Nearly incompressible material that cannot evade.
#[rustfmt::skip] // a row is a line or two
fn confined() -> Vec<Row> {
    vec![
        row("N01", "Poisson's ratio 0.49, confined column, no stabilisation: error of the height", AtMost(5e-4),
            || incompressible::confined(0.49, Plain)),
        row("N01", "Poisson's ratio 0.499, confined column, f-bar: largest error of the height in 16 runs that differ by round-off",
            AtMost(5e-4), || incompressible::confined_by_round_off(0.499, FBar, 16)).or_refused(),
        row("N01", "Poisson's ratio 0.4999, confined column, f-bar: error of the height", AtMost(5e-4),
            || incompressible::confined(0.4999, FBar)).or_refused(),
        row("N01", "Poisson's ratio 0.4999, confined column, modified-f-bar: error of the height", AtMost(5e-4),
            || incompressible::confined(0.4999, ModifiedFBar)).or_refused(),
        row("N01", "Poisson's ratio 0.4999, confined column, consistent-f-bar: error of the height", AtMost(5e-4),
            || incompressible::confined(0.4999, ConsistentFBar)).or_refused(),
        row("N01", "Poisson's ratio 0.49999, confined column, f-bar: error of the height", AtMost(5e-4),
            || incompressible::confined(0.49999, FBar)).or_refused(),
        row("N01", "Poisson's ratio 0.4999, cantilever, f-bar: change of the deflection from 0.495 and equal plane-strain modulus",
            AtMost(0.02), || incompressible::bending(0.4999, "f-bar")),
    ]
}

/// Nearly incompressible clay under a strip.
#[rustfmt::skip] // a row is a line or two
fn footings() -> Vec<Row> {
    vec![
        row("N01", "Poisson's ratio 0.3, footing, modified-f-bar: p/c at z/B = 0.1", YIELDING,
            || incompressible::footing(0.3, MODIFIED)),
        row("N01", "Poisson's ratio 0.49, footing, modified-f-bar: p/c at z/B = 0.1", BEARING, || incompressible::footing(0.49, MODIFIED)),
        row("N01", "Poisson's ratio 0.499, footing, modified-f-bar: p/c at z/B = 0.1", BEARING,
            || incompressible::footing(0.499, MODIFIED)),
        row("N01", "Poisson's ratio 0.4999, footing, modified-f-bar: p/c at z/B = 0.1", BEARING,
            || incompressible::footing(0.4999, MODIFIED)).or_refused(),
        row("N01", "Poisson's ratio 0.3, footing, consistent-f-bar: p/c at z/B = 0.1", YIELDING,
            || incompressible::footing(0.3, CONSISTENT)),
        row("N01", "Poisson's ratio 0.4999, footing, consistent-f-bar: p/c at z/B = 0.1", BEARING,
            || incompressible::footing(0.4999, CONSISTENT)).or_refused(),
        row("N01", "Poisson's ratio 0.4999, footing, f-bar: p/c at z/B = 0.1", BEARING,
            || incompressible::footing(0.4999, "f-bar")).or_refused().full(),
        row("N01", "Poisson's ratio 0.49999, footing, modified-f-bar: p/c at z/B = 0.1", BEARING,
            || incompressible::footing(0.49999, MODIFIED)).or_refused().full(),
        row("N01", "Poisson's ratio 0.49999, footing, f-bar: p/c at z/B = 0.1", BEARING,
            || incompressible::footing(0.49999, "f-bar")).or_refused().full(),
        row("N01", "Poisson's ratio 0.4999999, footing, modified-f-bar: p/c at z/B = 0.1", BEARING,
            || incompressible::footing(0.499_999_9, MODIFIED)).or_refused().full(),
        row("N01", "Poisson's ratio 0.499, footing, modified-f-bar: pressure oscillation / mean pressure", AtMost(0.02),
            || incompressible::checkerboard(0.499, MODIFIED)).fails(NOISE_P),
        row("N01", "Poisson's ratio 0.499, footing, consistent-f-bar: pressure oscillation / mean pressure", AtMost(0.02),
            || incompressible::checkerboard(0.499, CONSISTENT)).fails(NOISE_P),
        row("N01", "Poisson's ratio 0.499, footing, modified-f-bar: iterations / iterations with 0.3", AtMost(3.0),
            || incompressible::iterations(0.499, MODIFIED)),
        row("N01", "Poisson's ratio 0.49999: a warning is issued", Reported, || incompressible::warned(0.49999)).or_refused(),
    ]
}

/// Next to no cohesion, and much friction.
#[rustfmt::skip] // a row is a line or two
fn cohesionless() -> Vec<Row> {
    vec![
        row("N02", "cohesion 0, 1e-6, 1e-3, 3e5 trial states: yield function / E", AtMost(1e-8), materials::apex),
        row("N02", "cohesion 0, column at rest: error of the reaction", AtMost(1e-4), || weak::resting(0.3)),
        row("N02", "cohesion 0, Poisson's ratio 0.4999, column at rest: error of the reaction", AtMost(1e-4),
            || weak::resting(0.4999)).or_refused(),
        row("N02", "cohesion 1e-3 gamma H instead of 0, collapse to 0.1 s: change of the run-out", AtMost(5e-3),
            || weak::little_cohesion(0.1)),
        row("N02", "cohesion 1e-3 gamma H instead of 0, collapse to 0.607 s: change of the run-out", AtMost(5e-3),
            || weak::little_cohesion(0.607)).full().fails(LOOSE),
        row("N02", "cohesion 0, Poisson's ratio 0.4999, 20 steps of the collapse, no stabilisation: change of the displacement with dt/2",
            AtMost(0.05), || weak::beginning(0.4999, 21.9, "none")).or_refused().full(),
        row("N02", "cohesion 0, Poisson's ratio 0.4999, 20 steps of the collapse, f-bar: change of the displacement with dt/2",
            AtMost(0.05), || weak::beginning(0.4999, 21.9, "f-bar")).or_refused(),
        row("N02", "cohesion 0, Poisson's ratio 0.4999, 20 steps of the collapse, modified-f-bar: change of the displacement with dt/2",
            AtMost(0.05), || weak::beginning(0.4999, 21.9, MODIFIED)).or_refused(),
        row("N02", "cohesion 0, Poisson's ratio 0.4999, 20 steps of the collapse, consistent-f-bar: change of the displacement with dt/2",
            AtMost(0.05), || weak::beginning(0.4999, 21.9, CONSISTENT)).or_refused(),
        row("N02", "cohesion 0, friction angle 45 degrees, 20 steps of the collapse: change of the displacement with dt/2",
            AtMost(0.05), || weak::beginning(0.3, 45.0, MODIFIED)),
        row("N02", "cohesion 0, friction angle 60 degrees, 20 steps of the collapse: change of the displacement with dt/2",
            AtMost(0.05), || weak::beginning(0.3, 60.0, MODIFIED)),
        row("N02", "cohesion 0, friction angle 89.9 degrees, 20 steps of the collapse: change of the displacement with dt/2",
            AtMost(0.05), || weak::beginning(0.3, 89.9, MODIFIED)).or_refused().fails(LATE),
    ]
}

/// Returns at a point.
#[rustfmt::skip] // a row is a line or two
fn returns() -> Vec<Row> {
    vec![
        row("N03", "friction angle 0 (Tresca), 1e6 trial states: yield function / (c + |p|)", AtMost(1e-10), || materials::yielding(0.0)),
        row("N03", "friction angle 1e-9 degrees, 1e6 trial states: yield function / (c + |p|)", AtMost(1e-10),
            || materials::yielding(1e-9)),
        row("N03", "friction angle 20 degrees, 1e6 trial states: yield function / (c + |p|)", AtMost(1e-10), || materials::yielding(20.0)),
        row("N03", "friction angle 45 degrees, 1e6 trial states: yield function / (c + |p|)", AtMost(1e-10), || materials::yielding(45.0)),
        row("N03", "friction angle 60 degrees, 1e6 trial states: yield function / (c + |p|)", AtMost(1e-10), || materials::yielding(60.0)),
        row("N03", "friction angle 89.9 degrees, 1e6 trial states: yield function / (c + |p|)", AtMost(1e-10),
            || materials::yielding(89.9)),
        row("N03", "tangent: error against finite differences, six friction angles from 0 to 89.9 degrees", AtMost(1e-6),
            materials::tangent),
        row("N03", "associated return mapping: error against the projection onto the cone", AtMost(1e-8), materials::projection),
        row("N03", "friction angle 1e-9 degrees: difference of the stress from Tresca / c", AtMost(1e-8), materials::tresca_limit),
    ]
}

/// Strains at a point.
#[rustfmt::skip] // a row is a line or two
fn strains() -> Vec<Row> {
    vec![
        row("N04", "principal strains that differ by 1 to 1e-16: error of b computed from the stress", AtMost(1e-13),
            materials::nearly_equal),
        row("N04", "principal strains that differ by 1e-6 to 1e-16: change of the stress / change of b", AtMost(1.0), materials::no_jump),
        row("N05", "Hencky strain of 1e-10: relative error", AtMost(1e-7), || materials::strain(1e-10)),
        row("N05", "Hencky strain of 1e-6: relative error", AtMost(1e-11), || materials::strain(1e-6)),
        row("N05", "Hencky strain of 1: relative error", AtMost(1e-12), || materials::strain(1.0)),
        row("N05", "Hencky strain of ln 10: relative error", AtMost(1e-12), || materials::strain(10.0_f64.ln())),
        row("N05", "det F from 1e-6 to 1e6: relative error of the stress", AtMost(1e-12), materials::dilated),
        row("N17", "ten rotations: change of the principal stress / E", AtMost(1e-8), materials::turning),
        row("N25", "F-bar with a factor of 1: bits of the deformation increment that change", Same, materials::untouched),
        row("N25", "F-bar in plane strain and three dimensions: error of the determinant", AtMost(1e-14), materials::exponents),
    ]
}

/// Where material ends in its cells.
#[rustfmt::skip] // a row is a line or two
fn edges() -> Vec<Row> {
    vec![
        row("N06", "body at 200 positions in a cell, no artificial stiffness: change of the stress inside", AtMost(0.01),
            || geometry::crossing(0.0)).fails(EDGE),
        row("N06", "body at 200 positions in a cell, artificial stiffness 1e-4: change of the stress inside", AtMost(0.01),
            || geometry::crossing(1e-4)),
        row("N06", "edge of the body 0 to 1e-2 cells beyond a grid line, no artificial stiffness: change of the stress inside",
            AtMost(0.01), || geometry::entering(0.0)).fails(EDGE),
        row("N06", "edge of the body 0 to 1e-2 cells beyond a grid line, artificial stiffness 1e-4: change of the stress inside",
            AtMost(0.01), || geometry::entering(1e-4)),
        row("N06", "body falls across a cell: largest acceleration of a node / g", AtMost(100.0), geometry::nodal_acceleration),
        row("N06", "body falls across a cell: relative loss of momentum", AtMost(1e-12), geometry::lost_momentum),
    ]
}

/// Points per cell.
#[rustfmt::skip] // a row is a line or two
fn counts() -> Vec<Row> {
    vec![
        // The bar comes apart. Whether an indicator reports that at the end, or a loose point leaves the grid before,
        // depends on round-off, and so on the processor.
        row("N07", "1 point per cell, bar stretched to 1.5 times its length: error of the stress", AtMost(0.05),
            || points::stretched(1, 1.5)).or_refused().or_left(),
        row("N07", "1 point per cell, bar stretched to 3 times its length: error of the stress", AtMost(0.05),
            || points::stretched(1, 3.0)).or_refused().or_left(),
        row("N07", "2 x 2 points per cell, bar stretched to 3 times its length: error of the stress", AtMost(0.05),
            || points::stretched(2, 3.0)).or_refused().fails(SEPARATION),
        row("N07", "1 point per cell, footing: p/c at z/B = 0.1", BEARING, || points::footing(1)).or_refused(),
        row("N07", "1 point per cell, collapse to 0.1 s: displacement of the front / that with 4 points", Within(0.95, 1.05),
            points::collapse).or_refused(),
        row("N08", "36, 100, 400, 1e4 points per cell: error of the stress / error with fewer points", AtMost(1.0), points::many),
        row("N08", "1e4 points per cell: time for a point / time with 100 points per cell", Reported, points::cost),
    ]
}

/// Tiny steps.
#[rustfmt::skip] // a row is a line or two
fn tiny_steps() -> Vec<Row> {
    vec![
        row("N09", "dt = 0.25 ms, elastic bar, 1000 steps: change of the energy", AtMost(1e-6), || steps::tiny(2.5e-4)),
        row("N09", "dt = 1e-6 s, elastic bar, 1000 steps: change of the energy", AtMost(1e-6), || steps::tiny(1e-6)),
        row("N09", "dt = 1e-9 s, elastic bar, 1000 steps: change of the energy", AtMost(1e-6), || steps::tiny(1e-9)),
        row("N09", "dt = 0.25 ms, elastic bar: noise of the acceleration / amplitude", AtMost(1e-6), || steps::acceleration_noise(2.5e-4)),
        row("N09", "dt = 1e-6 s, elastic bar: noise of the acceleration / amplitude", AtMost(1e-6), || steps::acceleration_noise(1e-6)),
        row("N09", "dt = 1e-9 s, elastic bar: noise of the acceleration / amplitude", AtMost(1e-6),
            || steps::acceleration_noise(1e-9)).fails(NOISE),
    ]
}

/// Huge steps.
#[rustfmt::skip] // a row is a line or two
fn huge_steps() -> Vec<Row> {
    vec![
        row("N10", "dt = 1e3 s, settling block: distance from the static state", AtMost(1e-6), || steps::huge(1e3)),
        row("N10", "dt = 1e6 s, settling block: distance from the static state", AtMost(1e-6), || steps::huge(1e6)),
        row("N10", "dt = 1e3 s, settling block, 200 steps: oscillation of the last 100 steps / of the first 100", AtMost(1.0),
            || steps::ringing(1e3)),
        row("N10", "dt = 10 ms, collapse to 0.1 s: error of the displacement of the front", AtMost(0.05),
            || steps::collapse(0.01, 0.1)).or_refused(),
        row("N10", "dt = 50 ms, collapse to 0.1 s: error of the displacement of the front", AtMost(0.05),
            || steps::collapse(0.05, 0.1)).or_refused(),
        row("N10", "dt = 10 ms, collapse to 0.607 s: error of the displacement of the front", AtMost(0.05),
            || steps::collapse(0.01, 0.607)).or_refused().full(),
        row("N10", "dt = 50 ms, collapse to 0.607 s: error of the displacement of the front", AtMost(0.05),
            || steps::collapse(0.05, 0.607)).or_refused().full(),
        row("N10", "dt = 1000 ms, collapse to 1 s: error of the displacement of the front", AtMost(0.05),
            || steps::collapse(1.0, 1.0)).or_refused().full(),
    ]
}

/// Layers of very different stiffness, and gravity of any size.
#[rustfmt::skip] // a row is a line or two
fn stiffness() -> Vec<Row> {
    vec![
        row("N11", "two layers, stiffness ratio 1:1e3: error of the reaction", AtMost(1e-6),
            || weak::weight(1e3, false)),
        row("N11", "two layers, stiffness ratio 1:1e6: error of the reaction", AtMost(1e-6), || weak::weight(1e6, false)),
        row("N11", "two layers, stiffness ratio 1:1e9: error of the reaction", AtMost(1e-6), || weak::weight(1e9, false)).or_refused(),
        row("N11", "two layers, stiffness ratio 1:1e6: largest accepted residual force", AtMost(1e-4), || weak::balance(1e6)),
        row("N11", "two layers, stiffness ratio 1:1e9: largest accepted residual force", AtMost(1e-4), || weak::balance(1e9)).or_refused(),
        row("N11", "two layers, stiffness ratio 1:1e9, and a layer of 1e-3 on top: error of the reaction", AtMost(1e-6),
            || weak::weight(1e9, true)).or_refused(),
        row("N11", "two layers, stiffness ratio 1:1e3: error of the vertical stress at the interface", AtMost(1e-6),
            || weak::interface(1e3)).fails(C1),
        row("N11", "two layers, stiffness ratio 1:1e9: error of the vertical stress at the interface", AtMost(1e-6),
            || weak::interface(1e9)).or_refused().fails(C1),
        row("N12", "gravity and E times 1e3: relative change of the result", AtMost(1e-10), || weak::scaled_gravity(1e3)),
        row("N12", "gravity and E times 1e-6: relative change of the result", AtMost(1e-10), || weak::scaled_gravity(1e-6)),
        row("N12", "gravity times 1e3 / 16: error of the reaction", AtMost(1e-4), weak::heavy).or_refused(),
    ]
}

/// Other units and origins.
#[rustfmt::skip] // a row is a line or two
fn other_units() -> Vec<Row> {
    vec![
        row("N13", "units times 2^n, collapse, modified-f-bar: numbers that differ", Same, || units::collapse(MODIFIED)),
        row("N13", "units times 2^n, collapse, consistent-f-bar: numbers that differ", Same, || units::collapse(CONSISTENT)),
        row("N13", "units times 2^n, collapse, no stabilisation: numbers that differ", Same, || units::collapse("none")),
        row("N13", "units times 2^n, footing, modified-f-bar: numbers that differ", Same, || units::footing(MODIFIED)),
        row("N13", "units times 2^n, footing, conjugate gradients: numbers that differ", Same, units::iterative),
        row("N13", "mm, kPa, ms instead of m, Pa, s: largest relative difference", AtMost(1e-9), units::prefixes),
        row("N14", "origin at 2^20 m, cells of 1/128 m, collapse: numbers that differ", Same,
            || units::exact_origin(1_048_576.0)),
        row("N14", "origin at 1e3 m, cells of 10 mm, collapse: change of the displacement", AtMost(1e-9),
            || units::origin(1e3)),
        row("N14", "origin at 1e6 m, cells of 10 mm, collapse: change of the displacement", AtMost(1e-6), || units::origin(1e6)),
        row("N14", "origin at 1e8 m, cells of 10 mm, collapse: change of the displacement", AtMost(1e-12),
            || units::origin(1e8)).or_refused(),
        row("N14", "material points on grid lines, free flight: change of the momentum", AtMost(1e-10), units::knots),
    ]
}

/// Symmetry and motion through cells.
#[rustfmt::skip] // a row is a line or two
fn motions() -> Vec<Row> {
    vec![
        row("N15", "mirrored body, 100 elastic steps, three stabilisations: difference", AtMost(1e-10), geometry::mirrored),
        row("N15", "x and y exchanged, 100 elastic steps: difference", AtMost(1e-10), geometry::swapped),
        row(
            "N15",
            "mirrored collapse to 0.05 s: difference / (10 x spread by one ulp + 1e-10 m)",
            AtMost(1.0), geometry::mirrored_collapse,
        ),
        row("N16", "free flight through 1000 cells: change of the velocity in a step at 1 m/s", AtMost(1e-12), geometry::flight_velocity),
        row("N16", "free flight through 1000 cells: stress / E", AtMost(1e-10), geometry::flight_stress),
        row("N16", "points cross cells at 24 % compression: error of the stress, quadratic / linear splines", AtMost(0.2),
            geometry::crossing_noise),
        row("N17", "square rotates ten times: loss of angular momentum", Reported, geometry::spinning),
    ]
}

/// Updates of no length, no load, denormal numbers.
#[rustfmt::skip] // a row is a line or two
fn nothing() -> Vec<Row> {
    vec![
        row("N22", "Broyden's method, steps of zero length, 250 updates: invalid numbers", Same, steps::degenerate_broyden),
        row("N22", "Broyden's method with more updates than it stores, footing, Poisson's ratio 0.4999: p/c", BEARING,
            steps::long_broyden).or_refused().full(),
        row("N22", "Broyden's method with tolerances below round-off, footing: p/c", Reported, steps::beyond_round_off).or_refused(),
        row("N23", "no load, quasi-static: iterations of 10 steps", AtMost(0.0), || steps::no_load(false)),
        row("N23", "no load, dynamic: iterations of 10 steps", AtMost(0.0), || steps::no_load(true)),
        row("N23", "initial equilibrium: iterations in a step", AtMost(1.0), steps::in_equilibrium),
        row("N24", "velocity 1e-310 m/s: evaluations / evaluations with 1 m/s", AtMost(2.0), steps::denormal),
    ]
}

/// Long runs.
#[rustfmt::skip] // a row is a line or two
fn long_runs() -> Vec<Row> {
    vec![
        row("N18", "1e5 steps, free flight: steps with a different total mass", Same, long::mass_in_flight).full(),
        row("N18", "1e5 steps, free flight: drift of the momentum", AtMost(1e-10), long::momentum).full(),
        row("N18", "1e5 steps, bouncing block: steps with a different total mass", Same, long::mass_in_bounce).full(),
        row("N18", "1e5 steps, bouncing block: highest rebound / height of fall", AtMost(1.0), long::rebound).full(),
        row("N18", "1e5 steps, at rest: growth of memory, kB in 1000 steps", AtMost(1.0), || long::memory(0.0)).full(),
        row("N18", "1e5 steps, flight through 50 cells: growth of memory, kB in 1000 steps", AtMost(1.0), || long::memory(0.25)).full(),
        row("N18", "1e5 steps, elastic bar: change of its energy", AtMost(1e-3), long::bar_change).full().fails(FLIP),
        row("N18", "1e5 steps, elastic bar: change of its energy in a step", AtMost(1e-9), long::bar_slope).full().fails(FLIP),
        row("N18", "steps numbered around 2^31: error of their length", AtMost(1e-6), long::far_steps),
    ]
}

/// What belongs to the number of steps, and deep penetration.
#[rustfmt::skip] // a row is a line or two
fn step_counts() -> Vec<Row> {
    vec![
        row("N19", "1e4 steps at rest, no stabilisation: creep / elastic settlement", AtMost(0.01), || long::held("none")).full(),
        row("N19", "1e4 steps at rest, f-bar: creep / elastic settlement", AtMost(0.01), || long::held("f-bar")).full(),
        row("N19", "1e4 steps at rest, modified-f-bar: creep / elastic settlement", AtMost(0.01),
            || long::held(MODIFIED)).full().fails(DIFFUSION),
        row("N19", "1e4 steps at rest, consistent-f-bar: creep / elastic settlement", AtMost(0.01), || long::held(CONSISTENT)).full(),
        row("N20", "footing in 8, 16, 32, 64 steps, no stabilisation: change of p/c by doubling the steps / the change before", AtMost(0.5),
            || long::step_count("none")).or_refused().full().fails(SLOW),
        row("N20", "footing in 8, 16, 32, 64 steps, f-bar: change of p/c by doubling the steps / the change before", AtMost(0.5),
            || long::step_count("f-bar")).or_refused().full().fails(SLOW),
        row("N20", "footing in 8, 16, 32, 64 steps, modified-f-bar: change of p/c by doubling the steps / the change before", AtMost(0.5),
            || long::step_count(MODIFIED)).or_refused().full(),
        row("N20", "footing in 8, 16, 32, 64 steps, consistent-f-bar: change of p/c by doubling the steps / the change before", AtMost(0.5),
            || long::step_count(CONSISTENT)).or_refused().full().fails(SLOW),
        row("N21", "footing to z = 2 B, no stabilisation: pressure oscillation / c", Reported,
            || long::deep("none")).or_refused().full(),
        row("N21", "footing to z = 2 B, f-bar: pressure oscillation / c", Reported, || long::deep("f-bar")).or_refused().full(),
        row("N21", "footing to z = 2 B, modified-f-bar: pressure oscillation / c", Reported, || long::deep(MODIFIED)).or_refused().full(),
        row("N21", "footing to z = 2 B, consistent-f-bar: pressure oscillation / c", Reported,
            || long::deep(CONSISTENT)).or_refused().full(),
    ]
}
