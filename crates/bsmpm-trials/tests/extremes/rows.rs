//! All rows of the extremes: number, measurement, bounds, known failures.

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

const EDGE: &str = "at a free edge nodes have next to no stiffness; the background, which dynamics has not, mends it";
const SEPARATION: &str =
    "a pulled footing loses contact where points enter the empty cell before it: its force acts on nodes without soil";
const NOISE_P: &str = "not reached with two cells under the strip";
const NOISE: &str = "4 u/dt^2 - 4 v/dt - a cancels, and a carries its round-off on from step to step";
const FLIP: &str = "accelerations lose what the grid cannot hold when they go to it and back";
const DIFFUSION: &str = "the paper's average of b^e is a diffusion per step";
const LATE: &str = "an error of the step: 8, 7, 2 % between 0.5 and 0.0625 ms";
const LOOSE: &str = "the farthest point has come loose, and slides on where its neighbours stick";
const SLOW: &str = "p/c changes by 0.1 to 0.4 % a doubling, and that falls by less than half each time";
const C1: &str = "the splines are C1: strain cannot jump at an interface inside the grid";

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
        row("N01", "nu = 0.49, confined column, none: height / l0, error", AtMost(5e-4),
            || incompressible::confined(0.49, Plain)),
        row("N01", "nu = 0.499, f-bar: the worst of 16 that differ by round-off", AtMost(5e-4),
            || incompressible::confined_by_round_off(0.499, FBar, 16)).or_refused(),
        row("N01", "nu = 0.4999, the same, f-bar", AtMost(5e-4), || incompressible::confined(0.4999, FBar)).or_refused(),
        row("N01", "nu = 0.4999, the same, modified-f-bar", AtMost(5e-4),
            || incompressible::confined(0.4999, ModifiedFBar)).or_refused(),
        row("N01", "nu = 0.4999, the same, consistent-f-bar", AtMost(5e-4),
            || incompressible::confined(0.4999, ConsistentFBar)).or_refused(),
        row("N01", "nu = 0.49999, the same, f-bar", AtMost(5e-4),
            || incompressible::confined(0.49999, FBar)).or_refused(),
        row("N01", "nu = 0.4999, cantilever, f-bar: deflection / that with 0.495 and the same E', - 1", AtMost(0.02),
            || incompressible::bending(0.4999, "f-bar")),
    ]
}

/// Nearly incompressible clay under a strip.
#[rustfmt::skip] // a row is a line or two
fn footings() -> Vec<Row> {
    vec![
        row("N01", "nu = 0.3, footing, modified-f-bar: p/c at z/B = 0.1", YIELDING,
            || incompressible::footing(0.3, MODIFIED)),
        row("N01", "nu = 0.49, the same", BEARING, || incompressible::footing(0.49, MODIFIED)),
        row("N01", "nu = 0.499, the same", BEARING, || incompressible::footing(0.499, MODIFIED)),
        row("N01", "nu = 0.4999, the same", BEARING, || incompressible::footing(0.4999, MODIFIED)).or_refused(),
        row("N01", "nu = 0.3, the same, consistent-f-bar", YIELDING, || incompressible::footing(0.3, CONSISTENT)),
        row("N01", "nu = 0.4999, the same, consistent-f-bar", BEARING,
            || incompressible::footing(0.4999, CONSISTENT)).or_refused(),
        row("N01", "nu = 0.4999, the same, f-bar", BEARING,
            || incompressible::footing(0.4999, "f-bar")).or_refused().full(),
        row("N01", "nu = 0.49999, the same, modified-f-bar", BEARING,
            || incompressible::footing(0.49999, MODIFIED)).or_refused().full(),
        row("N01", "nu = 0.49999, the same, f-bar", BEARING,
            || incompressible::footing(0.49999, "f-bar")).or_refused().full(),
        row("N01", "nu = 0.4999999, the same, modified-f-bar", BEARING,
            || incompressible::footing(0.499_999_9, MODIFIED)).or_refused().full(),
        row("N01", "nu = 0.499, footing, modified-f-bar: noise of p about planes / mean |p|", AtMost(0.02),
            || incompressible::checkerboard(0.499, MODIFIED)).fails(NOISE_P),
        row("N01", "nu = 0.499, footing, consistent-f-bar: noise of p about planes / mean |p|", AtMost(0.02),
            || incompressible::checkerboard(0.499, CONSISTENT)).fails(NOISE_P),
        row("N01", "nu = 0.499, footing, modified-f-bar: iterations / those with 0.3", AtMost(3.0),
            || incompressible::iterations(0.499, MODIFIED)),
        row("N01", "nu = 0.49999: a warning", Reported, || incompressible::warned(0.49999)).or_refused(),
    ]
}

/// Next to no cohesion, and much friction.
#[rustfmt::skip] // a row is a line or two
fn cohesionless() -> Vec<Row> {
    vec![
        row("N02", "c = 0, 1e-6, 1e-3 at a point, 3e5 trials: f / E", AtMost(1e-8), materials::apex),
        row("N02", "c = 0, column at rest: error of its base's reaction", AtMost(1e-4), || weak::resting(0.3)),
        row("N02", "c = 0, nu = 0.4999, the same", AtMost(1e-4), || weak::resting(0.4999)).or_refused(),
        row("N02", "c = 1e-3 gamma H for 0, collapse to 0.1 s: change of the runout", AtMost(5e-3),
            || weak::little_cohesion(0.1)),
        row("N02", "the same to 0.607 s", AtMost(5e-3), || weak::little_cohesion(0.607)).full().fails(LOOSE),
        row("N02", "c = 0, nu = 0.4999, first 20 steps of the collapse, none: u, change with dt / 2", AtMost(0.05),
            || weak::beginning(0.4999, 21.9, "none")).or_refused().full(),
        row("N02", "c = 0, nu = 0.4999, f-bar: the same", AtMost(0.05),
            || weak::beginning(0.4999, 21.9, "f-bar")).or_refused(),
        row("N02", "c = 0, nu = 0.4999, modified-f-bar: the same", AtMost(0.05),
            || weak::beginning(0.4999, 21.9, MODIFIED)).or_refused(),
        row("N02", "c = 0, nu = 0.4999, consistent-f-bar: the same", AtMost(0.05),
            || weak::beginning(0.4999, 21.9, CONSISTENT)).or_refused(),
        row("N02", "c = 0, phi = 45, first 20 steps of the collapse: u, change with dt / 2", AtMost(0.05),
            || weak::beginning(0.3, 45.0, MODIFIED)),
        row("N02", "c = 0, phi = 60, the same", AtMost(0.05), || weak::beginning(0.3, 60.0, MODIFIED)),
        row("N02", "c = 0, phi = 89.9, the same", AtMost(0.05),
            || weak::beginning(0.3, 89.9, MODIFIED)).or_refused().fails(LATE),
    ]
}

/// Returns at a point.
#[rustfmt::skip] // a row is a line or two
fn returns() -> Vec<Row> {
    vec![
        row("N03", "phi = 0 (Tresca), 1e6 trials: f / (c + |p|)", AtMost(1e-10), || materials::yielding(0.0)),
        row("N03", "phi = 1e-9, the same", AtMost(1e-10), || materials::yielding(1e-9)),
        row("N03", "phi = 20, the same", AtMost(1e-10), || materials::yielding(20.0)),
        row("N03", "phi = 45, the same", AtMost(1e-10), || materials::yielding(45.0)),
        row("N03", "phi = 60, the same", AtMost(1e-10), || materials::yielding(60.0)),
        row("N03", "phi = 89.9, the same", AtMost(1e-10), || materials::yielding(89.9)),
        row("N03", "tangent against differences, six friction angles from 0 to 89.9", AtMost(1e-6), materials::tangent),
        row("N03", "associated return against the projection onto the cone", AtMost(1e-8), materials::projection),
        row("N03", "phi = 1e-9 against Tresca: stress / c", AtMost(1e-8), materials::tresca_limit),
    ]
}

/// Strains at a point.
#[rustfmt::skip] // a row is a line or two
fn strains() -> Vec<Row> {
    vec![
        row("N04", "principal strains 1 to 1e-16 apart: b rebuilt from tau", AtMost(1e-13), materials::nearly_equal),
        row("N04", "principal strains 1e-6 to 1e-16 apart: |d tau| / |d b|", AtMost(1.0), materials::no_jump),
        row("N05", "Hencky strain of 1e-10: relative error", AtMost(1e-7), || materials::strain(1e-10)),
        row("N05", "of 1e-6", AtMost(1e-11), || materials::strain(1e-6)),
        row("N05", "of 1", AtMost(1e-12), || materials::strain(1.0)),
        row("N05", "of ln 10", AtMost(1e-12), || materials::strain(10.0_f64.ln())),
        row("N05", "det F from 1e-6 to 1e6", AtMost(1e-12), materials::dilated),
        row("N17", "ten turns: principal stress / E", AtMost(1e-8), materials::turning),
        row("N25", "F-bar with dJ-bar / dJ = 1: bits of dF that change", Same, materials::untouched),
        row("N25", "F-bar's exponent, plane and solid: error of the determinant", AtMost(1e-14), materials::exponents),
    ]
}

/// Where material ends in its cells.
#[rustfmt::skip] // a row is a line or two
fn edges() -> Vec<Row> {
    vec![
        row("N06", "a body moved across a cell in 200 places, no background: inner stress, change", AtMost(0.01),
            || geometry::crossing(0.0)).fails(EDGE),
        row("N06", "the same with the background 1e-4", AtMost(0.01), || geometry::crossing(1e-4)),
        row("N06", "its edge on a knot and 1e-2 .. 1e-15 h beyond, no background: the same", AtMost(0.01),
            || geometry::entering(0.0)).fails(EDGE),
        row("N06", "the same with the background 1e-4", AtMost(0.01), || geometry::entering(1e-4)),
        row("N06", "falling across a cell: acceleration of nodes / g", AtMost(100.0), geometry::nodal_acceleration),
        row("N06", "falling across a cell: momentum lost, relative", AtMost(1e-12), geometry::lost_momentum),
    ]
}

/// Points per cell.
#[rustfmt::skip] // a row is a line or two
fn counts() -> Vec<Row> {
    vec![
        row("N07", "one point a cell, bar pulled to 1.5 l: error of its stress", AtMost(0.05),
            || points::stretched(1, 1.5)).or_refused(),
        row("N07", "one point a cell, bar pulled to 3 l: the same", AtMost(0.05),
            || points::stretched(1, 3.0)).or_refused().fails(SEPARATION),
        row("N07", "two points a cell and axis, bar pulled to 3 l: the same", AtMost(0.05),
            || points::stretched(2, 3.0)).or_refused().fails(SEPARATION),
        row("N07", "one point a cell, footing: p/c at z/B = 0.1", BEARING, || points::footing(1)).or_refused(),
        row("N07", "one point a cell, collapse to 0.1 s: way of the front / that with four", Within(0.95, 1.05),
            points::collapse).or_refused(),
        row("N08", "36, 100, 400, 1e4 points a cell: stress error / that with fewer", AtMost(1.0), points::many),
        row("N08", "1e4 points a cell: time a point / that with 100", Reported, points::cost),
    ]
}

/// Tiny steps.
#[rustfmt::skip] // a row is a line or two
fn tiny_steps() -> Vec<Row> {
    vec![
        row("N09", "dt = 0.25 ms, bar, 1000 steps: energy", AtMost(1e-6), || steps::tiny(2.5e-4)),
        row("N09", "dt = 1e-6 s, the same", AtMost(1e-6), || steps::tiny(1e-6)),
        row("N09", "dt = 1e-9 s, the same", AtMost(1e-6), || steps::tiny(1e-9)),
        row("N09", "dt = 0.25 ms: acceleration noise / amplitude", AtMost(1e-6), || steps::acceleration_noise(2.5e-4)),
        row("N09", "dt = 1e-6 s: the same", AtMost(1e-6), || steps::acceleration_noise(1e-6)),
        row("N09", "dt = 1e-9 s: the same", AtMost(1e-6), || steps::acceleration_noise(1e-9)).fails(NOISE),
    ]
}

/// Huge steps.
#[rustfmt::skip] // a row is a line or two
fn huge_steps() -> Vec<Row> {
    vec![
        row("N10", "dt = 1e3 s, settling block: distance from the static state", AtMost(1e-6), || steps::huge(1e3)),
        row("N10", "dt = 1e6 s: the same", AtMost(1e-6), || steps::huge(1e6)),
        row("N10", "dt = 1e3 s, 200 steps: ringing of the last 100 / of the first", AtMost(1.0),
            || steps::ringing(1e3)),
        row("N10", "dt = 10 ms, collapse to 0.1 s: way of the front, error", AtMost(0.05),
            || steps::collapse(0.01, 0.1)).or_refused(),
        row("N10", "dt = 50 ms, the same", AtMost(0.05), || steps::collapse(0.05, 0.1)).or_refused(),
        row("N10", "dt = 10 ms, collapse to 0.607 s: the same", AtMost(0.05),
            || steps::collapse(0.01, 0.607)).or_refused().full(),
        row("N10", "dt = 50 ms, the same", AtMost(0.05), || steps::collapse(0.05, 0.607)).or_refused().full(),
        row("N10", "dt = 1000 ms, collapse to 1 s: the same", AtMost(0.05),
            || steps::collapse(1.0, 1.0)).or_refused().full(),
    ]
}

/// Layers of very different stiffness, and gravity of any size.
#[rustfmt::skip] // a row is a line or two
fn stiffness() -> Vec<Row> {
    vec![
        row("N11", "stiffness 1 : 1e3, two layers: error of the base's reaction", AtMost(1e-6),
            || weak::weight(1e3, false)),
        row("N11", "1 : 1e6", AtMost(1e-6), || weak::weight(1e6, false)),
        row("N11", "1 : 1e9", AtMost(1e-6), || weak::weight(1e9, false)).or_refused(),
        row("N11", "1 : 1e6: largest force measure accepted", AtMost(1e-4), || weak::balance(1e6)),
        row("N11", "1 : 1e9: the same", AtMost(1e-4), || weak::balance(1e9)).or_refused(),
        row("N11", "1 : 1e9 and a layer of 1e-3 on top", AtMost(1e-6), || weak::weight(1e9, true)).or_refused(),
        row("N11", "1 : 1e3: vertical stress at the interface, error", AtMost(1e-6), || weak::interface(1e3)).fails(C1),
        row("N11", "1 : 1e9: the same", AtMost(1e-6), || weak::interface(1e9)).or_refused().fails(C1),
        row("N12", "gravity and E x 1e3: result over size, change", AtMost(1e-10), || weak::scaled_gravity(1e3)),
        row("N12", "gravity and E x 1e-6: the same", AtMost(1e-10), || weak::scaled_gravity(1e-6)),
        row("N12", "gravity x 1e3 / 16 alone: error of the base's reaction", AtMost(1e-4), weak::heavy).or_refused(),
    ]
}

/// Other units and origins.
#[rustfmt::skip] // a row is a line or two
fn other_units() -> Vec<Row> {
    vec![
        row("N13", "units x 2^n, collapse, modified-f-bar: numbers that differ", Same, || units::collapse(MODIFIED)),
        row("N13", "units x 2^n, collapse, consistent-f-bar: the same", Same, || units::collapse(CONSISTENT)),
        row("N13", "units x 2^n, collapse, none: the same", Same, || units::collapse("none")),
        row("N13", "units x 2^n, footing, modified-f-bar: the same", Same, || units::footing(MODIFIED)),
        row("N13", "units x 2^n, footing, cg with jacobi: the same", Same, units::iterative),
        row("N13", "mm, kPa, ms for m, Pa, s: largest difference", AtMost(1e-9), units::prefixes),
        row("N14", "origin at 2^20 m, cells of 1/128 m, collapse: numbers that differ", Same,
            || units::exact_origin(1_048_576.0)),
        row("N14", "origin at 1e3 m, cells of 10 mm, collapse: displacement, change", AtMost(1e-9),
            || units::origin(1e3)),
        row("N14", "origin at 1e6 m: the same", AtMost(1e-6), || units::origin(1e6)),
        row("N14", "origin at 1e8 m: the same", AtMost(1e-12), || units::origin(1e8)).or_refused(),
        row("N14", "points on knots in flight: momentum, change", AtMost(1e-10), units::knots),
    ]
}

/// Symmetry and motion through cells.
#[rustfmt::skip] // a row is a line or two
fn motions() -> Vec<Row> {
    vec![
        row("N15", "mirrored, 100 elastic steps, three methods: difference", AtMost(1e-10), geometry::mirrored),
        row("N15", "x and y exchanged: the same", AtMost(1e-10), geometry::swapped),
        row(
            "N15",
            "mirrored collapse to 0.05 s: difference / (10 x spread by one ulp + 1e-10 m)",
            AtMost(1.0),
            geometry::mirrored_collapse,
        ),
        row("N16", "1000 cells in flight: change of velocity a step at 1 m/s", AtMost(1e-12), geometry::flight_velocity),
        row("N16", "the same: stress / E", AtMost(1e-10), geometry::flight_stress),
        row("N16", "crossing cells by 24 % shortening: stress error, quadratic / linear", AtMost(0.2), geometry::crossing_noise),
        row("N17", "a square spins ten times: angular momentum lost", Reported, geometry::spinning),
    ]
}

/// Updates of no length, no load, denormal numbers.
#[rustfmt::skip] // a row is a line or two
fn nothing() -> Vec<Row> {
    vec![
        row("N22", "Broyden, steps of no length, 250 updates: numbers that are none", Same, steps::degenerate_broyden),
        row("N22", "Broyden with more steps than it keeps (nu = 0.4999), footing: p/c", BEARING, steps::long_broyden).or_refused().full(),
        row("N22", "Broyden beyond round-off (tolerances 1e-30, 1e-15), footing: p/c", Reported, steps::beyond_round_off).or_refused(),
        row("N23", "no load, quasi-static: iterations of 10 steps", AtMost(0.0), || steps::no_load(false)),
        row("N23", "no load, dynamic: the same", AtMost(0.0), || steps::no_load(true)),
        row("N23", "in equilibrium already: iterations a step", AtMost(1.0), steps::in_equilibrium),
        row("N24", "velocity 1e-310 m/s: evaluations / those with 1 m/s", AtMost(2.0), steps::denormal),
    ]
}

/// Long runs.
#[rustfmt::skip] // a row is a line or two
fn long_runs() -> Vec<Row> {
    vec![
        row("N18", "1e5 steps, flight: steps with another total mass", Same, long::mass_in_flight).full(),
        row("N18", "1e5 steps, flight: drift of the momentum", AtMost(1e-10), long::momentum).full(),
        row("N18", "1e5 steps, bouncing block: steps with another total mass", Same, long::mass_in_bounce).full(),
        row("N18", "1e5 steps, bouncing block: highest rebound / height of fall", AtMost(1.0), long::rebound).full(),
        row("N18", "1e5 steps, at rest: growth of memory, kB / 1000 steps", AtMost(1.0), || long::memory(0.0)).full(),
        row("N18", "1e5 steps, flight through 50 cells: the same", AtMost(1.0), || long::memory(0.25)).full(),
        row("N18", "1e5 steps, elastic bar: change of its energy", AtMost(1e-3), long::bar_change).full().fails(FLIP),
        row("N18", "1e5 steps, elastic bar: slope of its energy a step", AtMost(1e-9), long::bar_slope).full().fails(FLIP),
        row("N18", "steps numbered around 2^31: error of their length", AtMost(1e-6), long::far_steps),
    ]
}

/// What belongs to the number of steps, and deep penetration.
#[rustfmt::skip] // a row is a line or two
fn step_counts() -> Vec<Row> {
    vec![
        row("N19", "1e4 steps at rest, none: creep / elastic settlement", AtMost(0.01), || long::held("none")).full(),
        row("N19", "1e4 steps at rest, f-bar: the same", AtMost(0.01), || long::held("f-bar")).full(),
        row("N19", "1e4 steps at rest, modified-f-bar: the same", AtMost(0.01),
            || long::held(MODIFIED)).full().fails(DIFFUSION),
        row("N19", "1e4 steps at rest, consistent-f-bar: the same", AtMost(0.01), || long::held(CONSISTENT)).full(),
        row("N20", "footing in 8, 16, 32, 64 steps, none: change by a doubling / the one before", AtMost(0.5),
            || long::step_count("none")).or_refused().full().fails(SLOW),
        row("N20", "the same, f-bar", AtMost(0.5), || long::step_count("f-bar")).or_refused().full().fails(SLOW),
        row("N20", "the same, modified-f-bar", AtMost(0.5), || long::step_count(MODIFIED)).or_refused().full(),
        row("N20", "the same, consistent-f-bar", AtMost(0.5),
            || long::step_count(CONSISTENT)).or_refused().full().fails(SLOW),
        row("N21", "footing to z = 2 B, none: noise of p about planes / c", Reported,
            || long::deep("none")).or_refused().full(),
        row("N21", "the same, f-bar", Reported, || long::deep("f-bar")).or_refused().full(),
        row("N21", "the same, modified-f-bar", Reported, || long::deep(MODIFIED)).or_refused().full(),
        row("N21", "the same, consistent-f-bar", Reported, || long::deep(CONSISTENT)).or_refused().full(),
    ]
}
