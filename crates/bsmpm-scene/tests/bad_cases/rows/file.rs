//! Tests that invalid syntax, names of tables and keys of the file itself are refused.

use crate::{Row, row};

/// Names, types and units (rows I01 to I04, I07).
pub const LANGUAGE: &[Row] = &[
    row("title    =", "young    =", "young", "it belongs to [material.NAME]"),
    row(
        "title    =",
        "colour   =",
        "colour",
        "`colour` is not a known key of the file",
    ),
    row(
        "[footing]",
        "[[probe]]\n[footing]",
        "probe",
        "a table [[history]] with `quantity` and `at`",
    ),
    row(
        "[footing]",
        "[groundwater]\n[footing]",
        "groundwater",
        "the table `[water]`",
    ),
    row(
        "[footing]",
        "[[anchor]]\n[footing]",
        "anchor",
        "structural elements (beams, plates, anchors) are not available",
    ),
    row("[gravity]", "[gravitation]", "gravitation", "E0011"),
    row("[solver]", "[slover]", "slover", "did you mean `solver`?"),
    row(
        "title    = \"Every key that there is\"",
        "title = 5",
        "title",
        "expected a text",
    ),
    row(
        "title    = \"Every key",
        "title = \"Every\\nkey",
        "title",
        "without control characters",
    ),
    row(
        "geometry = \"plane-strain\"",
        "geometry = \"plane-stress\"",
        "geometry",
        "Use \"plane-strain\"",
    ),
    row(
        "poisson  = 0.3",
        "poisson = 0.3\npoisson = 0.2",
        "",
        "`poisson` is given twice, here and in line 19",
    )
    .down(1),
    row(
        "[gravity]",
        "[grid]",
        "",
        "the table [grid] is given twice, here and in line 9",
    ),
    row("title    = \"Every", "title    = Every", "", "E0005"),
    row(
        "upper = [4.0, 3.0]",
        "upper = [4.0, 3.0",
        "",
        "the bracket `[` is not closed before line 12",
    ),
    row("type = \"dynamic\"", "type = \"dynamic", "", "E0005"),
];
