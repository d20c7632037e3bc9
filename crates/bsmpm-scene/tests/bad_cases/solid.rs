//! Tests that invalid 3-D cases, and 3-D keys in plane cases, are refused.

mod bodies;
mod grid;
mod histories;
mod loads;
mod warnings;
pub mod water;

use super::{Row, row};

/// Changes of `solid.toml`.
pub fn solid() -> Vec<Row> {
    [
        grid::GRID,
        bodies::BODIES,
        histories::HISTORIES,
        loads::LOADS,
        water::WATER,
    ]
    .concat()
}

/// Changes of a case in a plane.
pub const IN_A_PLANE: &[Row] = &[
    row(
        "bottom = \"fixed\"",
        "bottom = \"fixed\"\nfront = \"fixed\"",
        "boundary.front",
        "E0207",
    )
    .down(1),
    row(
        "lower = [0.0, 0.0]\nupper",
        "lower = [0.0, 0.0, 0.0]\nupper",
        "grid.lower",
        "a list of two",
    ),
    row(
        "bottom = \"fixed\"",
        "bottom = \"fixed\"\n[[traction]]\nrectangle = { lower = [0, 1], upper = [1, 1] }\nstress = [0, 1]",
        "traction.0.rectangle",
        "E0207",
    )
    .down(2),
    row(
        "bottom = \"fixed\"",
        "bottom = \"fixed\"\n[[traction]]\nsphere = { centre = [0, 1], radius = 1 }\npressure = 1",
        "traction.0.sphere",
        "E0207",
    )
    .down(2),
    row(
        "bottom = \"fixed\"",
        "bottom = \"fixed\"\n[footing]\ndisc = { centre = [0, 1], radius = 1 }\ndisplacement = [0, -1]",
        "footing.disc",
        "E0207",
    )
    .down(2),
    row(
        "box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }",
        "sphere = { centre = [1.0, 1.0], radius = 0.5 }",
        "body.0.sphere",
        "E0207",
    ),
];
