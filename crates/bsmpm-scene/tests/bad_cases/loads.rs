//! Invalid shapes, layers, footings, loads and initial stresses.

use super::{Row, row};

const BOX: &str = "box = { lower = [0.0, 0.0], upper = [4.0, 1.0] }";
const POLYGON: &str = "polygon = [[2.5, 1.5], [3.75, 1.5], [\"3 m\", 2.5], [2.5, 2.5]]";
const SHAKEN: &str = "[[0.0, 0.1, 0.0], [\"1 s\", \"-0.1 g\", \"5 cm/s2\"]]";
const STRESS: &str = "stress = [0.0, \"-20 kPa\"]";
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

/// Parameters by height, and strength reduction.
pub const LAYERS: &[Row] = &[
    row(
        "\"0.5 deg/m\"",
        "\"0.5 deg\"",
        "material.till.friction_angle.per_metre",
        "must be a unit per metre, because the value is a change with height. Use one of deg/m, rad/m",
    ),
    row(
        "\"2 MPa/m\"",
        "\"2 kN/m3\"",
        "material.till.young.per_metre",
        "must be a unit per metre, because the value is a change with height. Use one of Pa/m",
    ),
    row(
        "\"2 MPa/m\"",
        "\"2 s/m\"",
        "material.till.young.per_metre",
        "found `s`, a unit of time",
    ),
    row(
        "\"2 MPa/m\"",
        "true",
        "material.till.young.per_metre",
        "a number (Pa/m) or a string with a unit (Pa/m, kPa/m",
    ),
    row(
        "\"2 MPa/m\"",
        "\"2e30 MPa/m\"",
        "material.till.young.per_metre",
        "E0010",
    ),
    row(
        "at_y = 3, per_metre = 500",
        "per_metre = 500",
        "material.till.cohesion.at_y",
        "missing",
    ),
    row(
        "at_y = 3, per_metre",
        "y = 3, per_metre",
        "material.till.cohesion.y",
        "`y` is not a known key of",
    ),
    row(
        "per_metre = \"2 MPa/m\"",
        "per_metre = \"-7 MPa/m\"",
        "material.till.young",
        "E0303",
    ),
    row(
        "value = \"1 kPa\", at_y = 3",
        "value = 0, at_y = 2",
        "material.till.cohesion",
        "E0303 .. y = 2.5 m .. -250",
    ),
    row(
        "value = 30, at_y",
        "value = 89.5, at_y",
        "material.till.friction_angle",
        "E0303 .. y = 1.5 m .. 90.25",
    ),
    row(
        "value = 30, at_y",
        "value = -0.4, at_y",
        "material.till.friction_angle",
        "is -0.15",
    ),
    row(
        "dilation_angle    = 0\n",
        "dilation_angle = 31\n",
        "material.till.dilation_angle",
        "E0308",
    ),
    row(
        "poisson     = 0.2",
        "poisson = { value = 0.2, at_y = 0, per_metre = 0 }",
        "material.block.poisson",
        "found a table",
    ),
    row(
        "factor = 1.25",
        "factor = 0",
        "strength_reduction.factor",
        "(0.1 <= factor <= 100",
    ),
    row("factor = 1.25", "factor = 101", "strength_reduction.factor", "E0010"),
    row(
        "factor = 1.25",
        "factors = 1.25",
        "strength_reduction.factors",
        "did you mean `factor`?",
    ),
    row("factor = 1.25", "", "strength_reduction.factor", "missing").up(1),
];

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

/// Stress at the start, and the histories of the footing and of the pressure.
pub const INITIAL: &[Row] = &[
    row("k0 = 0.5", "k0 = -0.5", "initial.k0", "0 <= k0 <= 100"),
    row(
        "k0 = 0.5",
        "k0 = 0.5\ngravity = \"elastic\"",
        "initial.gravity",
        "E0016",
    )
    .down(1),
    row(
        "k0 = 0.5",
        "gravity = \"plastic\"",
        "initial.gravity",
        "expected one of \"elastic\"",
    ),
    row(
        "k0 = 0.5",
        "k0 = 0.5\nequilibrium = \"elastic\"",
        "initial.equilibrium",
        "expected one of \"plastic\"",
    )
    .down(1),
    row("k0          = 0.6", "k0 = 0.6\nocr = 2", "material.till.ocr", "E0412").down(1),
    row("k0          = 0.6", "ocr = 0.5", "material.till.ocr", "ocr >= 1"),
    row("k0          = 0.6", "ocr = 2", "material.till.ocr", "E0410"),
    row("k0 = 0.5", "", "initial", "E0413 .. `sand`").up(1),
    row(
        "k0 = 0.5",
        "gravity = \"elastic\"",
        "material.till.k0",
        "E0405 .. initial.gravity",
    )
    .up(37),
    row("[initial]\nk0 = 0.5\n", "", "material.till.k0", "E0405 .. no [initial]").up(36),
    row("ramp = \"0 s\"", "ramp = \"0.1 s\"", "gravity.ramp", "E0409"),
    row("-9.81]", "9.81]", "gravity.acceleration", "E0406"),
    row(
        "acceleration = [0.0",
        "acceleration = [0.1",
        "gravity.acceleration",
        "E0406",
    ),
    row(
        "[gravity]\nacceleration = [0.0, -9.81]\nramp = \"0 s\"\n",
        "",
        "initial",
        "E0407",
    )
    .down(4),
    row(
        "upper = [\"2 m\", 1.0]",
        "upper = [\"-2 m\", 1.0]",
        "history.4.box.upper",
        "the box is empty",
    ),
    row(
        "lower = [0.0, 0.0], upper = [\"2 m\"",
        "lower = [9.0, 0.0], upper = [\"12 m\"",
        "history.4.box",
        "outside the grid",
    ),
    row(
        "quantity = \"pressure-noise\"",
        "quantity = \"front\"\nname = \"h\"",
        "history.4.box",
        "E0642",
    )
    .down(2),
    row(
        "quantity = \"footing-pressure\"",
        "quantity = \"footing-presure\"",
        "history.3.quantity",
        "did you mean `footing-pressure`?",
    ),
    row("max      = \"0 kPa\"", "max = \"0 kN/m\"", "check.1.max", "E0665"),
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

/// Strips that rub and let go, and histories of strips by name, in a quasi-static case.
pub const RUBBING: &[Row] = &[
    row(
        "interface = { friction_coefficient = 0.5, separates = true }",
        "base = {}",
        "footing.interface.friction_coefficient",
        "missing",
    ),
    row(
        "interface = { friction_coefficient = 0.5,",
        "interface = { friction_coefficient = -0.5,",
        "footing.interface.friction_coefficient",
        "E0010",
    ),
    row(
        "interface = { friction_coefficient = 0.5,",
        "interface = { friction_coefficient = 3,",
        "footing.interface.friction_coefficient",
        "E0010",
    ),
    row(
        "separates = true",
        "separates = 1",
        "footing.interface.separates",
        "expected true or false",
    ),
    row(
        "separates = true",
        "separate = true",
        "footing.interface.separate",
        "did you mean `separates`?",
    ),
    row(
        "from = [0.0, 1.0]\nto = [1.0, 1.0]",
        "from = [0.0, 0.5]\nto = [1.0, 0.5]",
        "footing.interface",
        "E0404",
    )
    .down(3),
    row(
        "components = { friction_coefficient = 0.5 }\nfrom = [1.0, 1.0]\nto = [2.0, 1.0]",
        "components = { friction_coefficient = 0.5 }\nface = \"right\"",
        "prescribed.0.components",
        "E0418",
    ),
    row(
        "of = \"footing\"",
        "of = \"foting\"",
        "history.0.of",
        "did you mean `footing`?",
    ),
    row("of = \"footing\"", "", "history.0.of", "E0644").up(2),
    row(
        "of = \"footing\"",
        "of = \"footing\"\nface = \"left\"",
        "history.0.face",
        "E0642",
    )
    .down(1),
    row("quantity = \"work\"", "quantity = \"heave\"", "history.0.of", "E0642").down(1),
    row(
        "components = { friction_coefficient = 0.5 }",
        "components = \"all\"",
        "history.1.of",
        "E0646",
    )
    .down(12),
];
