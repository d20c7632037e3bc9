//! Tests that invalid tables [material] are refused.

use crate::{Row, row};

/// Names, types and units (rows I01 to I04, I07).
pub const LANGUAGE: &[Row] = &[
    row(
        "poisson  = 0.3",
        "poissson = 0.3",
        "material.sand.poissson",
        "did you mean `poisson`?",
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
];

/// Rules between keys (I11 to I18, I20, I26).
pub const RULES: &[Row] = &[
    row(
        "density  = \"2 t/m3\"",
        "density = 1\nunit_weight = 2",
        "material.sand.density",
        "E0016",
    ),
    row("density  = \"2 t/m3\"", "", "material.sand", "E0310").up(7),
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
];
