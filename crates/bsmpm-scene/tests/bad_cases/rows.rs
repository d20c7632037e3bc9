//! Invalid cases by kind of mistake.

use super::{Row, row};

/// Names, types and units (rows I01 to I04, I07).
pub const LANGUAGE: &[Row] = &[
    row(
        "poisson  = 0.3",
        "poissson = 0.3",
        "material.sand.poissson",
        "did you mean `poisson`?",
    ),
    row(
        "points_per_cell = 3",
        "points-per-cell = 3",
        "body.0.points-per-cell",
        "did you mean `points_per_cell`?",
    ),
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
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\nE = 1",
        "material.clay.E",
        "the key `young`",
    )
    .down(1),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\nnu = 1",
        "material.clay.nu",
        "the key `poisson`",
    )
    .down(1),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\nphi = 1",
        "material.clay.phi",
        "the key `friction_angle`",
    )
    .down(1),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\npsi = 1",
        "material.clay.psi",
        "the key `dilation_angle`",
    )
    .down(1),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\nc = 1",
        "material.clay.c",
        "the key `cohesion`",
    )
    .down(1),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\nsu = 1",
        "material.clay.su",
        "`cohesion` with model = \"tresca\"",
    )
    .down(1),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\ngamma = 1",
        "material.clay.gamma",
        "the key `unit_weight`",
    )
    .down(1),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\ne0 = 1",
        "material.clay.e0",
        "Cam-clay is the key `void_ratio`",
    )
    .down(1),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\ntension_cutoff = 1",
        "material.clay.tension_cutoff",
        "The tension cut-off is the key `tensile_strength`",
    )
    .down(1),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\nregularisation = 1",
        "material.clay.regularisation",
        "the key `band_width`",
    )
    .down(1),
    row("[gravity]", "[gravitation]", "gravitation", "E0011"),
    row("[solver]", "[slover]", "slover", "did you mean `solver`?"),
    row(
        "bottom = \"fixed\"",
        "bottom = \"friction\"",
        "boundary.bottom",
        "expected one of",
    ),
    row("bottom = \"fixed\"", "bottom = 0.3", "boundary.bottom", "expected"),
    row(
        "bottom = \"fixed\"",
        "bottom = { separates = false }",
        "boundary.bottom.friction_coefficient",
        "missing",
    ),
    row(
        "bottom = \"fixed\"",
        "bottom = { friction_coefficient = -0.3 }",
        "boundary.bottom.friction_coefficient",
        "0 <= friction_coefficient <= 2",
    ),
    row(
        "bottom = \"fixed\"",
        "bottom = { friction_coefficient = 2.1 }",
        "boundary.bottom.friction_coefficient",
        "0 <= friction_coefficient <= 2",
    ),
    row(
        "bottom = \"fixed\"",
        "bottom = { friction_coefficient = \"20 deg\" }",
        "boundary.bottom.friction_coefficient",
        "",
    ),
    row(
        "bottom = \"fixed\"",
        "bottom = { friction_coefficient = 0.3, lifts = 1 }",
        "boundary.bottom.separates",
        "true or false",
    ),
    row(
        "bottom = \"fixed\"",
        "bottom = { friction_coefficient = 0.3, type = \"fixed\" }",
        "boundary.bottom.type",
        "E0011",
    ),
    row(
        "top    = \"fixed\"",
        "upper = \"free\"",
        "boundary.upper",
        "Known keys: left, right, bottom, top",
    ),
    row(
        "percentile = 99.9",
        "precentile = 99.9",
        "history.0.precentile",
        "did you mean `percentile`?",
    ),
    row(
        "poisson  = 0.3",
        "poisson  = \"0.3\"",
        "material.sand.poisson",
        "expected a number, found \"0.3\"",
    ),
    row(
        "poisson  = 0.3",
        "poisson  = true",
        "material.sand.poisson",
        "expected a number, found true",
    ),
    row(
        "poisson  = 0.3",
        "poisson  = [0.3]",
        "material.sand.poisson",
        "found a list of 1",
    ),
    row(
        "poisson  = 0.3",
        "poisson  = { a = 1 }",
        "material.sand.poisson",
        "found a table",
    ),
    row(
        "poisson  = 0.3",
        "poisson  = 1979-05-27",
        "material.sand.poisson",
        "found 1979-05-27",
    ),
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
        "reproducible     = true",
        "reproducible = \"yes\"",
        "solver.reproducible",
        "expected true or false",
    ),
    row(
        "residuals = true",
        "residuals = \"all\"",
        "output.residuals",
        "expected true or false",
    ),
    row(
        "reproducible     = true",
        "reproducible = 1",
        "solver.reproducible",
        "found 1",
    ),
    row(
        "max_iterations   = 200",
        "max_iterations = 200.0",
        "solver.max_iterations",
        "whole number from 1 to",
    ),
    row("lower = [0.0, \"0 m\"]", "lower = [0.0]", "grid.lower", "a list of two"),
    row(
        "lower = [0.0, \"0 m\"]",
        "lower = [0.0, 0.0, 0.0]",
        "grid.lower",
        "found a list of 3",
    ),
    row("lower = [0.0, \"0 m\"]", "lower = 0.0", "grid.lower", "a list of two"),
    row(
        "lower = [0.0, \"0 m\"]",
        "lower = [0.0, \"0 s\"]",
        "grid.lower",
        "expected a length (m, cm, mm, um, nm, km), found `s`, a unit of time",
    ),
    row(
        "\"20 MPa\"",
        "\"20 kN/m3\"",
        "material.sand.young",
        "found `kN/m3`, a unit of unit weight",
    ),
    row("\"20 MPa\"", "\"20 Mpa\"", "material.sand.young", "did you mean `MPa`?"),
    row("\"20 MPa\"", "\"20\"", "material.sand.young", "has no unit"),
    row(
        "\"20 MPa\"",
        "\"MPa\"",
        "material.sand.young",
        "not a number with a unit",
    ),
    row("\"20 MPa\"", "\"\"", "material.sand.young", "not a number with a unit"),
    row(
        "\"30 deg\"",
        "\"30 m\"",
        "material.sand.friction_angle",
        "expected an angle (deg, rad)",
    ),
    row("\"10 ms\"", "\"10 mm\"", "analysis.dt", "expected a time"),
    row(
        "\"2 t/m3\"",
        "\"20 kN/m3\"",
        "material.sand.density",
        "Use the key `unit_weight`",
    ),
    row(
        "\"mohr-coulomb\"",
        "\"hardening-soil\"",
        "material.sand.model",
        "error E0012",
    ),
    row("\"-1 m/s\"", "\"-1 m/s2\"", "body.2.velocity", "expected a velocity"),
    row(
        "-9.81]",
        "\"-1 gee\"]",
        "gravity.acceleration",
        "is not known. Known units: m/s2",
    ),
    row("\"4 m\"", "\"4 s\"", "check.0.max", "E0665"),
    row("\"0 kPa\"", "\"0 m\"", "check.1.max", "E0665"),
    row(
        "material = \"sand\"",
        "material = 5",
        "body.0.material",
        "expected a name",
    ),
    row(
        "material = \"sand\"",
        "material = \"sa nd\"",
        "body.0.material",
        "expected a name",
    ),
    row("[material.sand]", "[material.\"sa nd\"]", "material.sa nd", "E0024"),
    row(
        "[material.sand]",
        "[material]\nx = 5\n[material.sand]",
        "material.x",
        "expected a table",
    )
    .down(1),
    row(
        "model    = \"mohr-coulomb\"\n",
        "",
        "material.sand.model",
        "this key is missing. Add it; its value is one of \"elastic\"",
    )
    .up(1),
    row(
        "poisson  = 0.3\n",
        "",
        "material.sand.poisson",
        "this key is missing. Add it; its value is a number",
    )
    .up(3),
    row("acceleration = [0.0, -9.81]\n", "", "gravity.acceleration", "missing").up(1),
    row(
        "degree = \"quadratic\"",
        "degree = \"quartic\"",
        "grid.degree",
        "expected one of",
    ),
    row("method = \"f-bar\"", "", "stabilisation.method", "missing").up(1),
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
    row(
        "format = \"vtu\"",
        "checkpoint = { keep = 0 }",
        "output.checkpoint.keep",
        "1 <= keep <= 1000",
    ),
    row(
        "format = \"vtu\"",
        "checkpoint = { wall = \"15 m\" }",
        "output.checkpoint.wall",
        "a wall-clock time",
    ),
    row(
        "format = \"vtu\"",
        "checkpoint = { wall = 0 }",
        "output.checkpoint.wall",
        "wall > 0",
    ),
    row(
        "format = \"vtu\"",
        "checkpoint = 500",
        "output.checkpoint",
        "a table, checkpoint = {",
    ),
];

/// Numbers out of range (I07 to I10, I15, I18, I25).
pub const RANGES: &[Row] = &[
    row(
        "poisson  = 0.3",
        "poisson  = 0.5",
        "material.sand.poisson",
        "(-1 < poisson < 0.5): at 0.5 the material is",
    ),
    row(
        "poisson  = 0.3",
        "poisson  = 0.6",
        "material.sand.poisson",
        "0.6 is outside the allowed range",
    ),
    row(
        "poisson  = 0.3",
        "poisson  = -1",
        "material.sand.poisson",
        "(-1 < poisson",
    ),
    row("poisson  = 0.3", "poisson  = nan", "material.sand.poisson", "E0010"),
    row("poisson  = 0.3", "poisson  = inf", "material.sand.poisson", "E0010"),
    row("poisson  = 0.3", "poisson  = -inf", "material.sand.poisson", "E0010"),
    row(
        "poisson  = 0.3",
        "poisson  = 1e-999",
        "material.sand.poisson",
        "too small: the smallest number",
    ),
    row(
        "\"20 MPa\"",
        "1e999",
        "material.sand.young",
        "too large: the largest number",
    ),
    row(
        "\"20 MPa\"",
        "1e308",
        "material.sand.young",
        "largest allowed value of a stress is 1e18",
    ),
    row(
        "\"20 MPa\"",
        "99999999999999999999",
        "material.sand.young",
        "too many digits",
    ),
    row("\"20 MPa\"", "0.0", "material.sand.young", "(young > 0"),
    row("\"20 MPa\"", "\"-20 MPa\"", "material.sand.young", "(young > 0"),
    row(
        "\"30 deg\"",
        "90",
        "material.sand.friction_angle",
        "(0 <= friction_angle < 90",
    ),
    row(
        "\"30 deg\"",
        "-1",
        "material.sand.friction_angle",
        "(0 <= friction_angle < 90",
    ),
    row(
        "\"30 deg\"",
        "\"2 rad\"",
        "material.sand.friction_angle",
        "\"2 rad\" is outside the allowed range",
    ),
    row(
        "dilation_angle = 5",
        "dilation_angle = 31",
        "material.sand.dilation_angle",
        "E0308",
    ),
    row(
        "dilation_angle = 5",
        "dilation_angle = -5",
        "material.sand.dilation_angle",
        "(0 <= dilation_angle",
    ),
    row("\"1 kPa\"", "-1", "material.sand.cohesion", "(cohesion >= 0"),
    row("\"2 t/m3\"", "0", "material.sand.density", "(density > 0"),
    row("\"18 kN/m3\"", "-18e3", "material.clay.unit_weight", "(unit_weight > 0"),
    row("end  = \"1 s\"", "end  = -1", "analysis.end", "(end > 0"),
    row("end  = \"1 s\"", "end  = 0", "analysis.end", "(end > 0"),
    row("\"10 ms\"", "0", "analysis.dt", "(dt > 0"),
    row("\"10 ms\"", "\"2 s\"", "analysis.dt", "E0256"),
    row("\"10 ms\"", "1e-12", "analysis.dt", "E0257"),
    row("dt   = \"10 ms\"", "steps = 0", "analysis.steps", "(1 <= steps"),
    row(
        "dt   = \"10 ms\"",
        "steps = 1000000000000",
        "analysis.steps",
        "(1 <= steps <= 1000000000",
    ),
    row(
        "dt   = \"10 ms\"",
        "steps = -1",
        "analysis.steps",
        "-1 is outside the allowed range",
    ),
    row(
        "dt   = ",
        "spectral_radius = 1.1\ndt   = ",
        "analysis.spectral_radius",
        "0 <= spectral_radius <= 1",
    ),
    row(
        "dt   = ",
        "spectral_radius = -0.1\ndt   = ",
        "analysis.spectral_radius",
        "-0.1 is outside the allowed range",
    ),
    row(
        "dt   = ",
        "mass = \"consistant\"\ndt   = ",
        "analysis.mass",
        "consistent",
    ),
    row(
        "dt   = ",
        "newmark_gamma = 0.4\ndt   = ",
        "analysis.newmark_gamma",
        "0.5 <= newmark_gamma <= 1): below 0.5",
    ),
    row(
        "points_per_cell = 3",
        "points_per_cell = 0",
        "body.0.points_per_cell",
        "1 <= points_per_cell <= 100",
    ),
    row(
        "points_per_cell = 3",
        "points_per_cell = 101",
        "body.0.points_per_cell",
        "1 <= points_per_cell <= 100",
    ),
    row(
        "-9.81]",
        "1e308]",
        "gravity.acceleration",
        "largest allowed value of an acceleration is",
    ),
    row("-9.81]", "nan]", "gravity.acceleration", "E0010"),
    row("ramp = \"0 s\"", "ramp = -1", "gravity.ramp", "(ramp >= 0"),
    row(
        "tolerance        = 1e-8",
        "tolerance = 0",
        "solver.tolerance",
        "0 < tolerance < 1",
    ),
    row(
        "force_tolerance  = 1e-4",
        "force_tolerance = 1.5",
        "solver.force_tolerance",
        "0 < force_tolerance < 1",
    ),
    row(
        "background       = 0.0",
        "background = -0.1",
        "solver.background",
        "0 <= background <= 1",
    ),
    row("\"points\"", "\"gauss\"", "solver.quadrature", "fitted"),
    row(
        "max_iterations   = 200",
        "max_iterations = 0",
        "solver.max_iterations",
        "1 <= max_iterations",
    ),
    row("every  = \"0.1 s\"", "every  = 0", "output.every", "(every > 0"),
    row(
        "every  = \"0.1 s\"",
        "every_steps = 0",
        "output.every_steps",
        "1 <= every_steps",
    ),
    row("every  = \"0.1 s\"", "every  = 1e-10", "output.every", "E0662"),
    row(
        "percentile = 99.9",
        "percentile = 100.1",
        "history.0.percentile",
        "0 < percentile <= 100",
    ),
    row("scale    = 1e-3", "scale    = inf", "history.1.scale", "E0010"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = 0", "grid.cell", "(cell > 0"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = -0.0", "grid.cell", "(cell > 0"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = 1e-9", "grid.cell", "E0204"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = [0.5, 1e-9]", "grid.cell", "E0204"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = 4e-6", "grid.cell", "cells and"),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "cell  = [0.5, 0.1, 0.1]",
        "grid.cell",
        "found a list of 3",
    ),
];

/// Rules between keys (I11 to I18, I20, I26).
pub const RULES: &[Row] = &[
    row("dt   = \"10 ms\"", "dt = 0.01\nsteps = 5", "analysis.steps", "E0016").down(1),
    row(
        "dt   = ",
        "spectral_radius = 1\nnewmark_gamma = 0.5\ndt   = ",
        "analysis.newmark_gamma",
        "E0016",
    )
    .down(1),
    row("dt   = \"10 ms\"\n", "", "analysis", "none of the keys dt, steps").up(3),
    row("end  = \"1 s\"\n", "", "analysis.end", "E0255").up(2),
    row(
        "density  = \"2 t/m3\"",
        "density = 1\nunit_weight = 2",
        "material.sand.density",
        "E0016",
    ),
    row("density  = \"2 t/m3\"", "", "material.sand", "E0310").up(7),
    row(
        "format = \"vtu\"",
        "every_steps = 5",
        "output.every_steps",
        "`every` and `every_steps` are both given",
    ),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "cell = 0.5\nknots.x = [0, 1]",
        "grid.knots",
        "E0016",
    )
    .down(1),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 2, 1, 4]\nknots.y = [0, 3]",
        "grid.knots.x",
        "E0208",
    ),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 1, 2, 1, 4]\nknots.y = [0, 3]",
        "grid.knots.x",
        "E0208",
    ),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 1, 1, 1, 4]\nknots.y = [0, 3]",
        "grid.knots.x",
        "1 is given 3 times in [grid.knots], but is allowed at most 2",
    ),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 1, 4]\nknots.y = [0, 0, 3]",
        "grid.knots.y",
        "0 is given 2 times in [grid.knots], but is allowed at most 1",
    )
    .down(1),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.y = [0, 3]\nknots.x = [0]",
        "grid.knots.x",
        "fewer than two",
    )
    .down(1),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 1e-51, 4]\nknots.y = [0, 3]",
        "grid.knots",
        "shortest cell along x is 1e-51",
    ),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 4]\nknots.y = [-1e9, 3, 3.00000001]",
        "grid.knots",
        "shortest cell along y is 0e0",
    ),
    row(
        "cell  = [0.5, \"50 cm\"]",
        "knots.x = [0, 4]\nknots.y = [0, nan]",
        "grid.knots.y",
        "E0010",
    )
    .down(1),
    row(
        "upper = [4.0, 3.0]\ncell  = [0.5, \"50 cm\"]",
        "upper = [5.0, 3.0]\nknots.x = [0, 4]\nknots.y = [0, 3]",
        "grid.upper",
        "E0210: grid.upper: the grid has a corner at x = 5 m, but",
    ),
    row("lower = [0.0, \"0 m\"]\n", "", "grid.lower", "E0211").up(1),
    row("upper = [4.0, 3.0]", "upper = [4.0, 0.0]", "grid.upper", "E0203"),
    row("cell  = [0.5, \"50 cm\"]", "cell = [0.5, 0.7]", "grid.cell", "E0212"),
    row(
        "friction_angle = \"30 deg\"\n",
        "",
        "material.sand.friction_angle",
        "E0305",
    )
    .up(4),
    row("cohesion    = 2e4\n", "", "material.clay.cohesion", "E0305").up(4),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\nfriction_angle = 20",
        "material.clay.friction_angle",
        "E0304",
    )
    .down(1),
    row(
        "poisson     = 0.2",
        "poisson = 0.2\ncohesion = 2e4",
        "material.block.cohesion",
        "E0304",
    )
    .down(1),
    row(
        "\"plastic\"",
        "\"closed\"",
        "material.sand.separation",
        "expected one of \"plastic\", \"gap\"",
    ),
    row("\"plastic\"", "\"gap\"", "material.sand.separation", "E0317"),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\nseparation = \"gap\"",
        "material.clay.separation",
        "E0304",
    )
    .down(1),
    row(
        "poisson     = 0.2",
        "poisson = 0.2\nseparation = \"gap\"",
        "material.block.separation",
        "E0304",
    )
    .down(1),
    row(
        "k0          = 0.6",
        "separation = \"gap\"",
        "material.till.separation",
        "E0317",
    ),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\ntensile_strength = \"-1 kPa\"",
        "material.clay.tensile_strength",
        "(tensile_strength >= 0",
    )
    .down(1),
    row(
        "poisson     = 0.2",
        "poisson = 0.2\ntensile_strength = 0",
        "material.block.tensile_strength",
        "E0304",
    )
    .down(1),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\ncrack_opening = \"2 mm\"",
        "material.clay.crack_opening",
        "E0323",
    )
    .down(1),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\ntensile_strength = 1e3\nsoftening = \"linear\"",
        "material.clay.softening",
        "E0323",
    )
    .down(2),
    row(
        "material = \"sand\"",
        "material = \"snad\"",
        "body.0.material",
        "E0220: body.0.material: [material.snad] is not defined. Did you mean `sand`?",
    ),
    row(
        "upper = [4.0, 1.0] }",
        "upper = [4.0, 0.0] }",
        "body.0.box.upper",
        "E0203",
    ),
    row(
        "upper = [4.0, 1.0] }",
        "upper = [4.1, 1.0] }",
        "body.0.box.upper",
        "outside the grid, which ends at x = 4 m",
    ),
    row(
        "lower = [1.0, 2.0]",
        "lower = [-1.0, 2.0]",
        "body.2.box.lower",
        "outside the grid, which starts at x = 0",
    ),
    row(
        "upper = [4.0, 1.0] }",
        "upper = [4.0, 1e-10] }",
        "body.0.box.upper",
        "E0219",
    ),
    row(
        "box = { lower = [0.0, 0.0], upper = [4.0, 1.0] }\n",
        "",
        "body.0",
        "none of the keys box",
    )
    .up(2),
    row(
        "linear           = \"direct\"",
        "linear           = \"multigird\"",
        "solver.linear",
        "did you mean `multigrid`?",
    ),
    row(
        "linear           = \"direct\"",
        "linear           = { ksp = \"cg\" }",
        "solver.linear",
        "E0018",
    ),
    row("times  = [\"0.25 s\", 0.75]", "times = [2]", "output.times", "E0663"),
    row("times  = [\"0.25 s\", 0.75]", "times = [-2]", "output.times", "E0010"),
    row("percentile = 99.9", "face = \"left\"", "history.0.face", "E0642"),
    row(
        "face     = \"bottom\"",
        "face = \"botom\"",
        "history.1.face",
        "did you mean `bottom`?",
    ),
    row("face     = \"bottom\"\n", "", "history.1.face", "E0644").up(2),
    row(
        "at       = [2.0, \"0.5 m\"]",
        "at = [5, 0]",
        "history.2.at",
        "outside the grid",
    ),
    row("percentile = 99.9", "name = \"floor-x\"", "history.1.name", "E0610").down(5),
    row("percentile = 99.9", "name = \"time\"", "history.0.name", "E0610"),
    row(
        "quantity = \"runout\"\nat",
        "quantity = \"runuot\"\nat",
        "check.0.quantity",
        "did you mean `runout`?",
    ),
    row(
        "quantity = \"stress-yy\"",
        "quantity = \"stress\"",
        "check.1.quantity",
        "E0660",
    ),
    row("at       = \"0.5 s\"", "at = 2", "check.0.at", "E0663"),
    row("min      = 3.0", "min = 5.0", "check.0.min", "E0661"),
    row("max      = \"0 kPa\"", "", "check.1", "E0661").up(2),
    row(
        "quantity = \"heave\"",
        "quantity = \"mass\"\nmaterial = \"sandy\"",
        "history.5.material",
        "E0612",
    )
    .down(1),
    row(
        "quantity = \"heave\"",
        "quantity = \"front\"\nmaterial = \"sand\"",
        "history.5.material",
        "E0642",
    )
    .down(1),
    row("quantity = \"heave\"", "quantity = \"gap\"", "history.5.face", "E0644").up(1),
    row(
        "quantity = \"heave\"",
        "quantity = \"contact\"\nface = \"bottom\"",
        "history.5.face",
        "E0646",
    )
    .down(1),
    row(
        "quantity = \"heave\"",
        "quantity = \"heave\"\nface = \"left\"",
        "history.5.face",
        "E0642",
    )
    .down(1),
];

/// Parts of histories, lines, surfaces, profiles and fields of frames.
pub const REPORTED: &[Row] = &[
    row(
        "body     = \"fill\"",
        "body = \"fil\"",
        "history.7.body",
        "did you mean `fill`?",
    ),
    row(
        "body     = \"fill\"",
        "material = \"sand\"\nbody = \"fill\"",
        "history.7.body",
        "E0016",
    )
    .down(1),
    row(
        "quantity = \"kinetic-energy\"",
        "quantity = \"energy\"",
        "history.7.body",
        "E0642",
    )
    .down(1),
    row("to       = [\"1 m\", 1.25]\n", "", "history.8.to", "E0644").up(3),
    row("to       = [\"1 m\", 1.25]", "to = [1.0, 0.0]", "history.8.to", "E0651"),
    row(
        "to       = [\"1 m\", 1.25]",
        "disc = { centre = [1, 1], radius = 1 }",
        "history.8.disc",
        "E0642",
    ),
    row(
        "to       = [\"1 m\", 1.25]",
        "to = [1.0, 9.0]",
        "history.8.to",
        "outside the grid",
    ),
    row(
        "quantity = \"heave\"",
        "quantity = \"heave\"\nsurface = true",
        "history.5.surface",
        "E0642",
    )
    .down(1),
    row(
        "quantity = \"heave\"",
        "quantity = \"displacement\"\nat = [1, 1]\nfixed = true",
        "history.5.fixed",
        "E0642",
    )
    .down(2),
    row("count = 11", "count = 0", "profile.0.count", "1 <= count <= 1000"),
    row(
        "to    = [2.0, 0.0]",
        "to = [2.0, -1.0]",
        "profile.0.to",
        "outside the grid",
    ),
    row("to    = [2.0, 0.0]", "to = [2.0, 1.25]", "profile.0.to", "E0651"),
    row(
        "times = [\"0.5 s\", 1.0]",
        "times = [0.5, 2.0]",
        "profile.0.times",
        "E0663",
    ),
    row("times = [\"0.5 s\", 1.0]", "times = []", "profile.0.times", "E0652"),
    row(
        "quantities = [\"displacement\", ",
        "quantities = [\"disp\", ",
        "profile.0.quantities",
        "expected a list of words",
    ),
    row(
        "quantities = [\"displacement\", ",
        "quantities = [\"q\", ",
        "profile.0.quantities",
        "the list has \"q\" twice",
    ),
    row(
        "fixed = false",
        "[[profile]]\nname = \"Depth\"\nfrom = [0, 0]\nto = [1, 1]\ncount = 2\nquantities = [\"p\"]",
        "profile.1.name",
        "E0610",
    )
    .down(1),
    row(
        "fields = [\"q\", ",
        "fields = [\"p\", ",
        "output.fields",
        "expected a list of words",
    ),
    row(
        "fields = [\"q\", ",
        "fields = [\"density\", ",
        "output.fields",
        "the list has \"density\" twice",
    ),
];

/// Profiles in a quasi-static case.
pub const REPORTED_QUASI_STATIC: &[Row] = &[row(
    "[output]",
    "[[profile]]\nname = \"a\"\nfrom = [0, 0]\nto = [1, 1]\ncount = 2\nquantities = [\"velocity\"]\n[output]",
    "profile.0.quantities",
    "E0645",
)
.down(5)];

/// Faces that let waves out, in the case with all keys, which has stages, shakes and starts without stress.
pub const ABSORBING: &[Row] = &[
    row(
        "left   = \"roller\"",
        "left = \"absorbing\"",
        "stage.0.at",
        "E0627 .. [shaking] begin later",
    )
    .down(101),
    row("left   = \"roller\"", "left = \"absorbing\"", "boundary.left", "E0674"),
    row(
        "left   = \"roller\"",
        "left = \"free-field\"",
        "stage.1.at",
        "E0627 .. rigid bodies",
    )
    .down(105),
    row("left   = \"roller\"", "left = \"free-field\"", "boundary.left", "E0246"),
    row("left   = \"roller\"", "left = \"free-field\"", "boundary.left", "E0248"),
    row(
        "bottom = \"fixed\"",
        "bottom = \"free-field\"",
        "boundary.bottom",
        "E0244",
    ),
    row(
        "quantity = \"heave\"",
        "quantity = \"outflow\"",
        "history.5.quantity",
        "E0646",
    ),
];

/// Quasi-static cases (I13, I16, I18).
pub const QUASI_STATIC: &[Row] = &[
    row("end   = 1.0", "end = \"1 s\"", "analysis.end", "E0023"),
    row("every = 0.5", "every = \"1 s\"", "output.every", "E0023"),
    row(
        "bottom = \"fixed\"",
        "bottom = \"free\"",
        "boundary",
        "no support restrains the bodies along x",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "bottom = \"roller\"",
        "boundary",
        "no support restrains the bodies along x",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "left = \"roller\"",
        "boundary",
        "no support restrains the bodies along y",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "top = \"fixed\"",
        "boundary",
        "no support restrains the bodies along x and y",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "bottom = \"contact\"",
        "boundary",
        "no support restrains the bodies along x",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "bottom = \"free\"\n[[rigid]]\nname = \"smooth\"\npolygon = [[0, -1], [2, -1], [2, 0], [0, 0]]",
        "boundary",
        "no support restrains the bodies along x",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "bottom = \"free\"\n[[rigid]]\nname = \"free\"\npolygon = [[0, -1], [2, -1], [2, 0], [0, \
         0]]\nfriction_coefficient = 0.5\n\
         free = [\"y\"]\nforce = [0, 1]",
        "boundary",
        "no support restrains the bodies along x and y",
    )
    .up(1),
    row(
        "bottom = \"fixed\"",
        "bottom = \"absorbing\"",
        "boundary.bottom",
        "E0671",
    ),
    row(
        "bottom = \"fixed\"",
        "left = \"free-field\"",
        "boundary.left",
        "so the free field does not move",
    ),
    row("bottom = \"fixed\"", "left = \"free-field\"", "boundary.left", "E0671"),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\nvelocity = [1, 0]",
        "body.0.velocity",
        "E0218",
    )
    .down(1),
    row(
        "[output]",
        "[[history]]\nquantity = \"momentum\"\n[output]",
        "history.0.quantity",
        "E0645",
    )
    .down(1),
    row(
        "steps = 4",
        "steps = 4\nspectral_radius = 0.8",
        "analysis.spectral_radius",
        "needs inertia",
    )
    .down(1),
    row(
        "steps = 4",
        "steps = 4\nmass = \"consistent\"",
        "analysis.mass",
        "E0218",
    )
    .down(1),
    row(
        "steps = 4",
        "steps = 4\nnewmark_gamma = 0.6",
        "analysis.newmark_gamma",
        "needs inertia",
    )
    .down(1),
    row("steps = 4", "steps = 4.5", "analysis.steps", "whole number"),
    row(
        "model   = \"elastic\"",
        "model = \"sensitive-clay\"\ncohesion = 1e4\nsensitivity = 2\nsoftening_strain = 20\n\
         rate_parameter = 0.1\nreference_rate = 1e-4",
        "material.soil.rate_parameter",
        "E0319",
    )
    .down(4),
    row(
        "model   = \"elastic\"",
        "model = \"mu-i\"\nmu_s = 0.38\nmu_2 = 0.6\ninertial_number = 0.3\ngrain_diameter = 1e-3\ngrain_density = 2500",
        "material.soil.model",
        "E0319",
    ),
    row(
        "box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }\npoints_per_cell = 3",
        "box = 5\npoints_per_cell = 3",
        "body.0.box",
        "expected a table",
    ),
    row("[[body]]", "[body]", "body", "expected a list of tables, [[body]]"),
];

/// What is reserved and not done yet.
pub const LATER: &[(&str, &str, &str)] = &[("format = \"vtu\"", "format = \"vtkhdf\"", "output.format")];
