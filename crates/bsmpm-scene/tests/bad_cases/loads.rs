//! Tests that invalid footings, prescribed motions, loads and shaking are refused.

use super::{Row, row};

const SHAKEN: &str = "[[0.0, 0.1, 0.0], [\"1 s\", \"-0.1 g\", \"5 cm/s2\"]]";
const STRESS: &str = "stress = [0.0, \"-20 kPa\"]";

/// The footing, prescribed motions, tractions and point loads.
pub const STRIPS: &[Row] = &[
    row(
        "to   = [\"2 m\", 2.5]",
        "to = [1.0, 2.5]",
        "footing.to",
        "the length is zero",
    ),
    row(
        "to   = [\"2 m\", 2.5]",
        "to = [5, 2.5]",
        "footing.to",
        "outside the grid, which ends at x = 4",
    ),
    row(
        "from = [1.0, 2.5]",
        "from = [1.0, -2.5]",
        "footing.from",
        "outside the grid, which starts at y = 0",
    ),
    row("from = [1.0, 2.5]", "", "footing", "none of the keys from").up(1),
    row(
        "displacement = [0.0, \"-10 cm\"]",
        "displacement = [0, -3]",
        "footing.displacement",
        "y = -0.5 m is outside the grid",
    ),
    row(
        "displacement = [0.0, \"-10 cm\"]",
        "velocity = [0, 1]",
        "footing.velocity",
        "y = 3.5 m is outside the grid",
    ),
    row(
        "displacement = [0.0, \"-10 cm\"]",
        "path = [[0.5, 0, -3], [1, 0, 0]]",
        "footing.path",
        "E0419",
    ),
    row(
        "displacement = [0.0, \"-10 cm\"]",
        "",
        "footing",
        "none of the keys displacement, velocity, path",
    )
    .up(3),
    row(
        "displacement = [0.0, \"-10 cm\"]",
        "displacement = [0, -1]\npath = [[1, 0, 0]]",
        "footing.path",
        "E0016",
    )
    .down(1),
    row(
        "displacement = [0.0, \"-10 cm\"]",
        "displacement = [0.1, 0]",
        "footing.displacement",
        "E0416",
    ),
    row(
        "displacement = [0.0, \"-10 cm\"]",
        "displacement = [0.0, 0]",
        "footing.displacement",
        "E0416",
    ),
    row(
        "displacement = [0.0, \"-10 cm\"]",
        "displacement = [0.0, \"-1 m/s\"]",
        "footing.displacement",
        "expected a length",
    ),
    row(
        "interface = \"smooth\"",
        "interface = \"slippery\"",
        "footing.interface",
        "expected one of \"smooth\", \"rough\"",
    ),
    row(
        "[1.0, 0.0, 0.0]]",
        "\n[0.5, 0.0, 0.0]]",
        "prescribed.1.path",
        "E0402 .. t = 0.5",
    )
    .down(1),
    row(
        "[[\"0.5 s\", 0.0, -0.1], [1.0, 0.0, 0.0]]",
        "[[0, 0, 0.1], [1, 0, 0]]",
        "prescribed.1.path",
        "E0403 .. [0.0, 0.1]",
    ),
    row(
        "[[\"0.5 s\", 0.0, -0.1], [1.0, 0.0, 0.0]]",
        "[[0, 0, 0], [0, 0, 0]]",
        "prescribed.1.path",
        "E0402",
    ),
    row(
        "[[\"0.5 s\", 0.0, -0.1], [1.0, 0.0, 0.0]]",
        "[[0, 0, 0]]",
        "prescribed.1.path",
        "at least one row",
    ),
    row(
        "[[\"0.5 s\", 0.0, -0.1], [1.0, 0.0, 0.0]]",
        "[[-1, 0, 0]]",
        "prescribed.1.path",
        "E0010",
    ),
    row(
        "[[\"0.5 s\", 0.0, -0.1], [1.0, 0.0, 0.0]]",
        "[[1, 0]]",
        "prescribed.1.path",
        "each [a time, a length, a length]",
    ),
    row(
        "[[\"0.5 s\", 0.0, -0.1], [1.0, 0.0, 0.0]]",
        "[[1, 2, 0]]",
        "prescribed.1.path",
        "x = 4.5 m is outside the grid",
    ),
    row("face = \"right\"", "face = \"left\"", "prescribed.0.face", "E0236"),
    row(
        "face = \"right\"",
        "face = \"up\"",
        "prescribed.0.face",
        "expected one of",
    ),
    row(
        "face = \"right\"",
        "face = \"right\"\nfrom = [0, 1]",
        "prescribed.0.from",
        "E0016",
    )
    .down(1),
    row(
        "face = \"right\"",
        "from = [0, 1]",
        "prescribed.0",
        "none of the keys face, to",
    )
    .up(1),
    row("face = \"right\"", "", "prescribed.0", "none of the keys face, from").up(1),
    row(
        "velocity = [0.0, \"-10 mm/s\"]",
        "velocity = [0.1, 0.0]",
        "prescribed.0.velocity",
        "E0420",
    ),
    row(
        "components = \"normal\"",
        "components = \"both\"",
        "prescribed.0.components",
        "expected one of \"all\", \"normal\"",
    ),
    row(
        "[footing]",
        "[[prescribed]]\nface = \"right\"\nvelocity = [0, 0]\n[footing]",
        "prescribed.1.face",
        "E0417",
    )
    .down(10),
    row(
        "to   = [1.0, 1.25]",
        "to = [9.0, 1.25]",
        "traction.0.to",
        "outside the grid",
    ),
    row(
        "to   = [1.0, 1.25]",
        "to = [0.0, 1.25]",
        "traction.0.to",
        "the length is zero",
    ),
    row(
        "stress = [0.0, \"-20 kPa\"]",
        "stress = [0.0, \"-20 kN/m\"]",
        "traction.0.stress",
        "expected a stress",
    ),
    row(
        "stress = [0.0, \"-20 kPa\"]",
        "",
        "traction.0",
        "none of the keys stress, pressure",
    )
    .up(3),
    row(
        STRESS,
        "stress = { value = [0, 1], at_y = 1 }",
        "traction.0.stress.per_metre",
        "missing",
    ),
    row(
        STRESS,
        "stress = { value = 1e3, at_y = 1, per_metre = [0, 1] }",
        "traction.0.stress.value",
        "a list of two",
    ),
    row(
        STRESS,
        "stress = { value = [0, 1], at_y = 1, per_metre = \"2 kPa/m\" }",
        "traction.0.stress.per_metre",
        "expected a list of two (three in 3-D), each a number (Pa/m) or a string with a unit (Pa/m, kPa/m",
    ),
    row(
        STRESS,
        "stress = { value = [0, 1], at_y = 1, per_metre = [0, \"2 kPa\"] }",
        "traction.0.stress.per_metre",
        "must be a unit per metre, because the value is a change with height. Use one of Pa/m",
    ),
    row(
        STRESS,
        "stress = { value = [0, 0], at_y = 1, per_metre = [0, 1], k0 = 1 }",
        "traction.0.stress.k0",
        "E0011",
    ),
    row(
        "at = [3.5, 1.25]",
        "at = [3.5, 3.25]",
        "point_load.0.at",
        "outside the grid, which ends at y = 3",
    ),
    row(
        "\"-1 kN/m\"",
        "\"-1 kN\"",
        "point_load.0.force",
        "expected a force per metre of thickness (N/m, kN/m, MN/m)",
    ),
    row(
        "\"-1 kN/m\"",
        "\"-1 kPa\"",
        "point_load.0.force",
        "expected a force per metre of thickness",
    ),
    row("ramp = \"0.5 s\"", "ramp = -1", "traction.0.ramp", "(ramp >= 0"),
    row(
        "ramp = \"0.5 s\"",
        "ramp = 0.5\namplitude = [[1.0, 1.0]]",
        "traction.0.amplitude",
        "E0016",
    )
    .down(1),
    row(
        "ramp = \"0.5 s\"",
        "pressure_path = [[1.0, 1.0]]",
        "traction.0.pressure_path",
        "E0016",
    ),
    row(
        "stress = [0.0, \"-20 kPa\"]",
        "stress_path = [[0.5, 1.0, 1.0]]",
        "traction.0.stress_path",
        "E0016",
    ),
    row(
        STRESS,
        "stress_path = [[0.5, 1.0]]",
        "traction.0.stress_path",
        "found a list of 2",
    ),
    row(
        STRESS,
        "stress_path = [[0.5, 1.0, \"1 m\"]]",
        "traction.0.stress_path",
        "found `m`, a unit of length",
    ),
    row(
        "force = [0.0, \"-1 kN/m\"]",
        "",
        "point_load.0",
        "none of the keys force, force_path",
    )
    .up(2),
    row(
        "moment  = 100.0",
        "force_path = [[0.5, 0.0, 1.0]]",
        "rigid.1.force_path",
        "E0016",
    ),
    row(
        "ramp = \"0.5 s\"",
        "amplitude = []",
        "traction.0.amplitude",
        "at least one row",
    ),
    row(
        "ramp = \"0.5 s\"",
        "amplitude = [[0.5, 1.0], [0.5, 0.0]]",
        "traction.0.amplitude",
        "E0402",
    ),
    row(
        "ramp = \"0.5 s\"",
        "amplitude = [[0.5, \"1 kPa\"]]",
        "traction.0.amplitude",
        "expected",
    ),
    row(SHAKEN, "[]", "shaking.acceleration", "E0435"),
    row(SHAKEN, "[[0.1, 0.0, 0.0]]", "shaking.acceleration", "E0415"),
    row(
        SHAKEN,
        "[[0.1, 1.0, 0.0], [0.1, 0.0, 0.0]]",
        "shaking.acceleration",
        "E0402 .. 0.1",
    ),
    row(SHAKEN, "[[0.1, 1.0]]", "shaking.acceleration", "found a list of 2"),
    row(
        SHAKEN,
        "[[0.1, \"1 m\", 0.0]]",
        "shaking.acceleration",
        "found `m`, a unit of length",
    ),
    row(SHAKEN, "{ file = \"kobe.csv\" }", "shaking.acceleration", "E0027"),
    // Points of the block are 0.25 m apart, those of sand 0.167 m and of clay 0.25 m.
    row(
        "from = [1.0, 2.5]\nto   = [\"2 m\", 2.5]",
        "from = [1.25, 2.63]\nto = [1.75, 2.63]",
        "footing.from",
        "E0401",
    ),
    row(
        "from = [2.5, 2.5]\nto   = [3.0, 2.5]",
        "from = [2.5, 2.63]\nto = [3.0, 2.63]",
        "prescribed.1.from",
        "E0401",
    ),
    row(
        "from = [0.0, 1.25]\nto   = [1.0, 1.25]",
        "from = [0.0, 1.4]\nto = [1.0, 1.4]",
        "traction.0.from",
        "E0401",
    ),
    row("to   = [1.0, 1.25]", "to = [1.0, 1.5]", "traction.0.from", "E0401").up(1),
    row("at = [3.5, 1.25]", "at = [2.25, 1.45]", "point_load.0.at", "E0401"),
];

/// Quasi-static cases.
pub const QUASI_STATIC: &[Row] = &[
    row(
        "[output]",
        "[[prescribed]]\nface = \"top\"\nvelocity = [0, \"-1 m/s\"]\n[output]",
        "prescribed.0.velocity",
        "m per unit of pseudo-time",
    )
    .down(2),
    row(
        "[output]",
        "[[prescribed]]\nface = \"top\"\npath = [[\"1 s\", 0, 0]]\n[output]",
        "prescribed.0.path",
        "E0023",
    )
    .down(2),
    row(
        "[output]",
        "[[prescribed]]\nface = \"top\"\npath = [[\"1 s\", 0, 0], [\"2 s\", 0, 1]]\n[output]",
        "prescribed.0.path",
        "column 1 of all 2 rows: \"1 s\" has a unit, but time is a dimensionless pseudo-time",
    )
    .down(2),
    row(
        "[output]",
        "[[history]]\nquantity = \"slip\"\n[output]",
        "history.0.quantity",
        "E0646",
    )
    .down(1),
    row(
        "[output]",
        "[[history]]\nquantity = \"penetration\"\n[output]",
        "history.0.quantity",
        "E0646",
    )
    .down(1),
    row(
        "[output]",
        "[gravity]\nacceleration = [0, -9.81]\n[initial]\nk0 = 1\n[output]",
        "initial",
        "E0408",
    )
    .down(2),
];
