//! Mistakes of new users, with expected messages.

use super::{Row, Says};

/// All of them but those that are no case file, or need a run.
pub const ROWS: &[Row] = &[
    Row {
        number: "1",
        what: "cohesion in Pa for kPa",
        edits: &[("\"10 kPa\"", "10.0")],
        says: Says::Warning(&["W0102", "10 Pa (0.01 kPa)", "200 kPa", "write \"10 kPa\""]),
    },
    Row {
        number: "2",
        what: "stiffness in Pa for kPa",
        edits: &[("\"100 MPa\"", "100000")],
        says: Says::Warning(&["W0101", "100000 Pa (100 kPa)"]),
    },
    Row {
        number: "3",
        what: "friction angle in radians",
        edits: &[("friction_angle = 20.0", "friction_angle = 0.349")],
        says: Says::Warning(&["W0103", "radians may be meant (19.996 degrees)"]),
    },
    Row {
        number: "4",
        what: "gravity upwards",
        edits: &[("-9.81]", "9.81]")],
        says: Says::Warning(&["W0104", "points upwards", "[0, -9.81]"]),
    },
    Row {
        number: "5",
        what: "gravity sideways",
        edits: &[("[0.0, -9.81]", "[9.81, 0.0]")],
        says: Says::Warning(&["W0104", "points sideways"]),
    },
    Row {
        number: "6",
        what: "polygon in mm",
        edits: &[(
            "[[0.0, 0.0], [32.0, 0.0], [12.0, 10.0], [0.0, 10.0]]",
            "[[0.0, 0.0], [0.032, 0.0], [0.012, 0.010], [0.0, 0.010]]",
        )],
        says: Says::Warning(&["W0105", "body.0", "0.032 m x 0.01 m", "40 m x 12 m"]),
    },
    Row {
        number: "7",
        what: "unit weight in N/m3 for kN/m3",
        edits: &[("\"20 kN/m3\"", "20")],
        says: Says::Warning(&["W0108", "unit_weight = "]),
    },
    Row {
        number: "8",
        what: "no gravity",
        edits: &[("gravity  = { acceleration = [0.0, -9.81], ramp = 1.0 }\n", "")],
        says: Says::Warning(&["W0674", "no load", "[gravity] with acceleration = [0, -9.81]"]),
    },
    Row {
        number: "9",
        what: "history off the body",
        edits: &[(
            "[[history]]\nquantity = \"max-displacement\"\n",
            "[[history]]\nquantity = \"max-displacement\"\n\n[[history]]\nquantity = \"displacement\"\nname = \"p\"\nat = [35.0, 8.0]\n",
        )],
        says: Says::Warning(&["W0106", "history.1.at"]),
    },
    Row {
        number: "10",
        what: "history on the boundary of the body",
        edits: &[(
            "[[history]]\nquantity = \"max-displacement\"\n",
            "[[history]]\nquantity = \"max-displacement\"\n\n[[history]]\nquantity = \"displacement\"\nname = \"p\"\nat = [12.0, 10.0]\n",
        )],
        says: Says::Nothing,
    },
    Row {
        number: "11",
        what: "wrong case of a unit",
        edits: &[("\"10 kPa\"", "\"10 KPa\"")],
        says: Says::Errors(1, &["did you mean `kPa`"]),
    },
    Row {
        number: "12",
        what: "unit of a force for a stress",
        edits: &[("\"10 kPa\"", "\"10 kN\"")],
        says: Says::Errors(1, &["expected a stress", "`kN`"]),
    },
    Row {
        number: "13",
        what: "unit weight for a density",
        edits: &[("unit_weight    = \"20 kN/m3\"", "density = \"20 kN/m3\"")],
        says: Says::Errors(1, &["`unit_weight`"]),
    },
    Row {
        number: "14",
        what: "units of time as people write them",
        edits: &[(
            "analysis = { type = \"quasi-static\" }",
            "analysis = { type = \"dynamic\", end = \"30 sec\" }",
        )],
        says: Says::Nothing,
    },
    Row {
        number: "15",
        what: "t/m2 for a stress",
        edits: &[("\"10 kPa\"", "\"10 t/m2\"")],
        says: Says::Errors(1, &["tf/m2"]),
    },
    Row {
        number: "15b",
        what: "a stress in psf",
        edits: &[("\"10 kPa\"", "\"200 psf\"")],
        says: Says::Nothing,
    },
    Row {
        number: "15c",
        what: "kg/m2 for a stress",
        edits: &[("\"10 kPa\"", "\"1000 kg/m2\"")],
        says: Says::Errors(1, &["kgf/m2"]),
    },
    Row {
        number: "16",
        what: "misspelt key",
        edits: &[("poisson", "poison")],
        says: Says::Errors(1, &["`poisson`"]),
    },
    Row {
        number: "17",
        what: "symbols nu and su",
        edits: &[
            ("poisson        = 0.3", "nu = 0.3"),
            ("cohesion       = \"10 kPa\"", "su = \"10 kPa\""),
        ],
        says: Says::Errors(2, &["`poisson`", "`cohesion`"]),
    },
    Row {
        number: "17b",
        what: "symbols in capitals",
        edits: &[
            ("poisson        = 0.3", "NU = 0.3"),
            ("friction_angle = 20.0", "PHI = 20.0"),
        ],
        says: Says::Errors(2, &["is the key `poisson`", "is the key `friction_angle`"]),
    },
    Row {
        number: "18",
        what: "symbols E, phi, psi and c",
        edits: &[
            ("young  ", "E"),
            ("friction_angle", "phi"),
            ("dilation_angle", "psi"),
            ("cohesion", "c"),
        ],
        says: Says::Errors(4, &["`young`", "`friction_angle`", "`dilation_angle`", "`cohesion`"]),
    },
    Row {
        number: "19",
        what: "symbol gamma",
        edits: &[("unit_weight", "gamma")],
        says: Says::Errors(1, &["`unit_weight`"]),
    },
    Row {
        number: "20",
        what: "[groundwater]",
        edits: &[(
            "[[history]]\nquantity = \"max-displacement\"\n",
            "[[history]]\nquantity = \"max-displacement\"\n\n[groundwater]\nlevel = 4.0\n",
        )],
        says: Says::Errors(1, &["`[water]`"]),
    },
    Row {
        number: "21",
        what: "model with capital letters",
        edits: &[("\"mohr-coulomb\"", "\"Mohr-Coulomb\"")],
        says: Says::Errors(1, &["did you mean `mohr-coulomb`"]),
    },
    Row {
        number: "22",
        what: "model of another program",
        edits: &[("\"mohr-coulomb\"", "\"hardening-soil\"")],
        says: Says::Errors(1, &["not available"]),
    },
    Row {
        number: "23",
        what: "tension cut-off",
        edits: &[(
            "cohesion       = \"10 kPa\"",
            "cohesion       = \"10 kPa\"\ntension_cutoff = 0",
        )],
        says: Says::Errors(1, &["tensile_strength"]),
    },
    Row {
        number: "24",
        what: "no body",
        edits: &[(
            "[[body]]\nmaterial = \"soil\"\npolygon  = [[0.0, 0.0], [32.0, 0.0], [12.0, 10.0], [0.0, 10.0]]\n",
            "",
        )],
        says: Says::Errors(1, &["E0052", "[[body]] is missing", "`material`"]),
    },
    Row {
        number: "25",
        what: "[body] for [[body]]",
        edits: &[("[[body]]", "[body]")],
        says: Says::Errors(1, &["E0047", "[[body]]"]),
    },
    Row {
        number: "25b",
        what: "[material] without a name",
        edits: &[("[material.soil]", "[material]")],
        says: Says::Errors(1, &["E0051", "[material.soil]"]),
    },
    Row {
        number: "25c",
        what: "geometry of two dimensions",
        edits: &[("\"plane-strain\"", "\"2D\"")],
        says: Says::Errors(1, &["E0017", "Use \"plane-strain\" or \"axisymmetric\""]),
    },
    Row {
        number: "26",
        what: "misspelt accuracy",
        edits: &[("\"draft\"", "\"coarse\"")],
        says: Says::Errors(1, &["accuracy", "\"draft\""]),
    },
    Row {
        number: "27",
        what: "corners of the grid exchanged",
        edits: &[(
            "lower = [0.0, 0.0]\nupper = [40.0, 12.0]",
            "lower = [40.0, 12.0]\nupper = [0.0, 0.0]",
        )],
        says: Says::Errors(1, &["E0203", "Exchange or correct"]),
    },
    Row {
        number: "28",
        what: "misspelt analysis type",
        edits: &[("\"quasi-static\"", "\"quasistatic\"")],
        says: Says::Errors(1, &["did you mean `quasi-static`"]),
    },
    Row {
        number: "29",
        what: "dynamic analysis without end",
        edits: &[("\"quasi-static\"", "\"dynamic\"")],
        says: Says::Errors(1, &["analysis.end"]),
    },
    Row {
        number: "30",
        what: "body outside the grid",
        edits: &[("[32.0, 0.0]", "[52.0, 0.0]")],
        says: Says::Errors(1, &["E0201", "enlarge the grid"]),
    },
    Row {
        number: "31",
        what: "overlapping bodies",
        edits: &[(
            "[[history]]\nquantity = \"max-displacement\"\n",
            "[[history]]\nquantity = \"max-displacement\"\n\n\
             [[body]]\nmaterial = \"soil\"\nbox = { lower = [2.0, 2.0], upper = [5.0, 5.0] }\n",
        )],
        says: Says::Warning(&["W0213", "[2.000, 2.000] and [5.000, 5.000] m", "subtract"]),
    },
    Row {
        number: "32",
        what: "a loose second body",
        edits: &[(
            "[[history]]\nquantity = \"max-displacement\"\n",
            "[[history]]\nquantity = \"max-displacement\"\n\n\
             [[body]]\nname = \"rock\"\nmaterial = \"soil\"\nbox = { lower = [33.0, 5.0], upper = [36.0, 8.0] }\n",
        )],
        says: Says::Warning(&["W0107", "body.1 `rock`", "x and y"]),
    },
    Row {
        number: "33",
        what: "gap of 0.1 m between layers",
        edits: &[(
            "[[body]]\nmaterial = \"soil\"\npolygon  = [[0.0, 0.0], [32.0, 0.0], [12.0, 10.0], [0.0, 10.0]]\n",
            "[[body]]\nmaterial = \"soil\"\nbox = { lower = [0.0, 0.0], upper = [40.0, 4.9] }\n\n\
             [[body]]\nmaterial = \"soil\"\nbox = { lower = [0.0, 5.0], upper = [40.0, 10.0] }\n",
        )],
        says: Says::Warning(&["body.0 and body.1", "apart"]),
    },
    Row {
        number: "34",
        what: "misspelt name of a material",
        edits: &[("material = \"soil\"", "material = \"sol\"")],
        says: Says::Errors(1, &["Did you mean `soil`"]),
    },
    Row {
        number: "35",
        what: "polygon that repeats its first corner",
        edits: &[("[0.0, 10.0]]", "[0.0, 10.0], [0.0, 0.0]]")],
        says: Says::Nothing,
    },
    Row {
        number: "36",
        what: "polygon that crosses itself",
        edits: &[(
            "[[0.0, 0.0], [32.0, 0.0], [12.0, 10.0], [0.0, 10.0]]",
            "[[0.0, 0.0], [32.0, 0.0], [0.0, 10.0], [12.0, 10.0]]",
        )],
        says: Says::Errors(1, &["E0223", "order"]),
    },
    Row {
        number: "37",
        what: "bracket that is not closed",
        edits: &[("[0.0, 10.0]]", "[0.0, 10.0]")],
        says: Says::Errors(1, &["E0041", "`[` is not closed"]),
    },
    Row {
        number: "38",
        what: "decimal comma",
        edits: &[("= 0.3", "= 0,3")],
        says: Says::Errors(1, &["E0042", "0.3."]),
    },
    Row {
        number: "39",
        what: "Poisson's ratio of 0.5",
        edits: &[("= 0.3", "= 0.5")],
        says: Says::Errors(1, &["poisson < 0.5", "0.49"]),
    },
    Row {
        number: "39b",
        what: "Poisson's ratio of 0.499",
        edits: &[("= 0.3", "= 0.499")],
        says: Says::Warning(&["W0303", "drainage = \"undrained\""]),
    },
    Row {
        number: "40",
        what: "key given twice",
        edits: &[("poisson        = 0.3", "poisson        = 0.3\npoisson        = 0.4")],
        says: Says::Errors(1, &["E0044", "line 15"]),
    },
    Row {
        number: "40b",
        what: "table given twice",
        edits: &[(
            "[[history]]\nquantity = \"max-displacement\"\n",
            "[[history]]\nquantity = \"max-displacement\"\n\n[grid]\nlower = [0.0, 0.0]\n",
        )],
        says: Says::Errors(1, &["E0045", "line 8"]),
    },
    Row {
        number: "41",
        what: "slope without cohesion",
        edits: &[("\"10 kPa\"", "0.0")],
        says: Says::Warning(&["W0111", "26.6 degrees", "`cohesion`"]),
    },
    Row {
        number: "42",
        what: "no supports",
        edits: &[(
            "boundary = { bottom = \"fixed\", left = \"roller\", right = \"roller\" }",
            "boundary = { }",
        )],
        says: Says::Errors(1, &["E0270", "x and y", "bottom = \"fixed\"", "left, bottom"]),
    },
    Row {
        number: "43",
        what: "cells of 1 um",
        edits: &[("upper = [40.0, 12.0]", "upper = [40.0, 12.0]\ncell = 1e-6")],
        says: Says::Errors(1, &["cells"]),
    },
    Row {
        number: "47",
        what: "footing in the air",
        edits: &[(
            "[[history]]\nquantity = \"max-displacement\"\n",
            "[[history]]\nquantity = \"max-displacement\"\n\n\
             [footing]\nfrom = [20.0, 8.0]\nto = [22.0, 8.0]\ndisplacement = [0.0, -0.1]\ninterface = \"smooth\"\n",
        )],
        says: Says::Errors(1, &["E0401"]),
    },
    Row {
        number: "47b",
        what: "load off the body",
        edits: &[(
            "[[history]]\nquantity = \"max-displacement\"\n",
            "[[history]]\nquantity = \"max-displacement\"\n\n[[traction]]\nfrom = [20.0, 8.0]\nto = [22.0, 8.0]\npressure = \"10 kPa\"\n",
        )],
        says: Says::Errors(1, &["E0401", "[20.010, 8.000] m", "surface of a body"]),
    },
];
