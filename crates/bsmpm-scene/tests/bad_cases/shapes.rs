//! Tests that invalid polygons, circles and cut-outs are refused.

use super::{Row, row};

const BOX: &str = "box = { lower = [0.0, 0.0], upper = [4.0, 1.0] }";
const POLYGON: &str = "polygon = [[2.5, 1.5], [3.75, 1.5], [\"3 m\", 2.5], [2.5, 2.5]]";
const CIRCLE: &str = "circle = { centre = [0.5, 2.0], radius = 0.4 }";

/// Polygons, circles and what is cut out.
pub const SHAPES: &[Row] = &[
    row(
        POLYGON,
        "polygon = [[2.5, 1.5], [3.5, 1.5]]",
        "body.3.polygon",
        "has 2 corners, but needs at least 3",
    ),
    row(POLYGON, "polygon = []", "body.3.polygon", "0 corners"),
    row(POLYGON, "polygon = [1, 2, 3]", "body.3.polygon", "found 1"),
    row(
        POLYGON,
        "polygon = [[1, 2], [1, 2, 3], [2, 2]]",
        "body.3.polygon",
        "found a list of 3",
    ),
    row(
        POLYGON,
        "polygon = [[1, 2], [1, \"2 s\"], [2, 2]]",
        "body.3.polygon",
        "found `s`, a unit of time",
    ),
    row(
        POLYGON,
        "polygon = [[1, 2], [1, inf], [2, 2]]",
        "body.3.polygon",
        "E0010",
    ),
    row(
        POLYGON,
        "polygon = [\n[2.5, 1.5],\n[3.5, 1.5],\n[3.5, 1.5],\n[3, 2]]",
        "body.3.polygon",
        "the corner [3.5, 1.5] twice in a row",
    )
    .down(3),
    row(
        POLYGON,
        "polygon = [\n[2.5, 1.5],\n[3.5, 1.5],\n[2.5, 1.5]]",
        "body.3.polygon",
        "the corner [2.5, 1.5] twice in a row",
    )
    .down(3),
    row(
        POLYGON,
        "polygon = [[2.5, 1.5], [3.0, 2.0], [3.5, 2.5]]",
        "body.3.polygon",
        "E0222",
    ),
    row(
        POLYGON,
        "polygon = [\n[2.5, 1.5],\n[3.5, 2.5],\n[3.5, 1.5],\n[2.5, 2.5]]",
        "body.3.polygon",
        "crosses or touches",
    )
    .down(3),
    row(
        POLYGON,
        "polygon = [[2, 1.5], [3, 1.5], [3, 2], [2.5, 1.5], [2, 2]]",
        "body.3.polygon",
        "crosses or touches",
    ),
    row(
        POLYGON,
        "polygon = [[2, 1.5], [3, 1.5], [2.5, 1.5], [2, 2]]",
        "body.3.polygon",
        "crosses or touches",
    ),
    row(
        POLYGON,
        "polygon = [\n[2.5, 1.5],\n[4.5, 1.5],\n[3, 2]]",
        "body.3.polygon",
        "x = 4.5 m is outside the grid, which ends at x = 4 m",
    )
    .down(2),
    row(
        CIRCLE,
        "circle = { centre = [0.5, 2.0], radius = 0 }",
        "body.4.circle.radius",
        "(radius > 0",
    ),
    row(
        CIRCLE,
        "circle = { centre = [0.5, 2.0] }",
        "body.4.circle.radius",
        "missing",
    ),
    row(
        CIRCLE,
        "circle = { centre = [0.5, 2.0], radius = 0.6 }",
        "body.4.circle",
        "outside the grid, which starts at x = 0",
    ),
    row(
        BOX,
        "box = { lower = [0, 0], upper = [4, 1] }\ncircle = {}",
        "body.0.circle",
        "E0016",
    )
    .down(1),
    row(
        "{ circle = { centre = [2.75",
        "{ cirle = { centre = [2.75",
        "body.3.subtract.0.cirle",
        "did you mean `circle`?",
    ),
    row(
        "{ box = { lower = [3.0, 1.5], upper = [3.25, 1.75] } }",
        "{}",
        "body.3.subtract.1",
        "none of the keys box",
    ),
    row(
        "{ box = { lower = [3.0, 1.5], upper = [3.25, 1.75] } }",
        "5",
        "body.3.subtract.1",
        "expected a table",
    ),
    row(
        "upper = [3.25, 1.75]",
        "upper = [2.25, 1.75]",
        "body.3.subtract.1.box.upper",
        "is not above the lower corner",
    ),
    row(
        "lower = [3.0, 1.5], upper = [3.25, 1.75]",
        "lower = [0, 0], upper = [4, 3]",
        "body.3.polygon",
        "E0219",
    )
    .up(1),
];
