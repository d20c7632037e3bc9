//! Invalid axisymmetric cases.

use super::{Row, row};

const DRAINED: &str = "density = 2000\nporosity = 0.4\ndrainage = \"coupled\"\npermeability = 1e-6\n[water]\nlevel = 1.0\n\
    [[drain]]\nface = \"bottom\"\n[[drain]]\nfrom = [0.0, 0.0]\nto = [0.0, 1.0]\n";
const FED: &str = "density = 2000\nporosity = 0.4\ndrainage = \"coupled\"\npermeability = 1e-6\n[water]\nlevel = 1.0\n\
    [[drain]]\nface = \"bottom\"\n[[inflow]]\nfrom = [0.0, 0.0]\nto = [0.0, 1.0]\nrate = 1e-6\n";

/// What an axisymmetric case must not have.
pub const AXISYMMETRIC: &[Row] = &[
    row(
        "lower = [0.0, 0.0]\nupper = [2.0",
        "lower = [-1.0, 0.0]\nupper = [2.0",
        "grid.lower",
        "E0238",
    ),
    row(
        "left   = \"roller\"",
        "left   = \"fixed\"",
        "boundary.left",
        "is the axis",
    ),
    row(
        "left   = \"roller\"",
        "left   = \"free\"",
        "boundary.left",
        "is the axis",
    ),
    row(
        "right  = \"free\"",
        "right  = \"free-field\"",
        "boundary.right",
        "E0240",
    ),
    row(
        "[boundary]",
        "[[stage]]\nat = 0.05\nboundary = { left = \"free\" }\n\n[boundary]",
        "stage.0.boundary.left",
        "is the axis",
    )
    .down(2),
    row(
        "[[point_load]]",
        "[[traction]]\nfrom = [0.0, 0.5]\nto = [0.0, 1.0]\nstress = [0.0, -1.0]\n\n[[point_load]]",
        "traction.0.from",
        "lies on the axis",
    )
    .down(1),
    row("density = 2000", DRAINED, "drain.1.from", "lies on the axis").down(9),
    row("density = 2000", FED, "inflow.0.from", "lies on the axis").down(9),
    row(
        "acceleration = [0.0",
        "acceleration = [1.0",
        "gravity.acceleration",
        "x is the radius",
    ),
    row(
        "velocity = [0.0",
        "velocity = [1.0",
        "body.0.velocity",
        "x is the radius",
    ),
    row(
        "points_per_cell",
        "spin = { rate = 1.0, about = [0.5, 0.5] }\npoints_per_cell",
        "body.0.spin",
        "E0242",
    ),
    row(
        "displacement = [0.0, -0.01]",
        "displacement = [0.1, -0.01]",
        "footing.displacement",
        "x is the radius",
    ),
    row("force = [0.0", "force = [1.0", "point_load.0.force", "E0242"),
    row(
        "displacement = [0.0, -0.1]",
        "displacement = [0.1, -0.1]",
        "rigid.0.displacement",
        "x is the radius",
    ),
    row(
        "displacement = [0.0, -0.1]",
        "rotation = [[0.1, 0.1]]",
        "rigid.0.rotation",
        "E0242",
    ),
    row(
        "displacement = [0.0, -0.1]",
        "free = [\"x\"]\nmass = 10",
        "rigid.0.free",
        "E0242",
    ),
    row(
        "quantity = \"mass\"",
        "quantity = \"angular-momentum\"",
        "history.0.quantity",
        "quantity \"angular-momentum\" is zero",
    ),
    row(
        "quantity = \"reaction\"",
        "quantity = \"moment\"",
        "history.1.quantity",
        "quantity \"moment\" is zero",
    ),
    row(
        "quantity = \"mass\"",
        "quantity = \"rigid-moment\"\nrigid = \"cone\"",
        "history.0.quantity",
        "quantity \"rigid-moment\" is zero",
    ),
    row(
        "quantity = \"mass\"",
        "quantity = \"rigid-rotation\"\nrigid = \"cone\"",
        "history.0.quantity",
        "quantity \"rigid-rotation\" is zero",
    ),
    row(
        "quantity = \"mass\"",
        "quantity = \"section-forces\"\nfrom = [0.0, 0.5]\nto = [0.0, 0.9]",
        "history.0.from",
        "lies on the axis",
    )
    .down(1),
];
