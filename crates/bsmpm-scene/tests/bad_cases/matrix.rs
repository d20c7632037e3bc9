//! Tests that each invalid input of a list (`MATRIX`) is refused, or accepted with a warning.

use super::{DYNAMIC, Row, STATIC, row, rows, verify};
use bsmpm_scene::Case;

/// A row of the matrix, and what the cases are that it names.
struct Input {
    id: &'static str,
    refused: &'static [Row],
    /// refused in quasi-static analysis
    refused_static: &'static [Row],
    /// part of the dynamic base, what it becomes, and what is warned of; nothing where the text is empty
    taken: &'static [(&'static str, &'static str, &'static str)],
}

const NONE: Input = Input {
    id: "",
    refused: &[],
    refused_static: &[],
    taken: &[],
};

const YOUNG: &str = "\"20 MPa\"";
const POISSON: &str = "poisson  = 0.3";
const YOUNG_KEY: &str = "material.sand.young";

const MATRIX: &[Input] = &[
    Input {
        id: "I01",
        refused: &[row(POISSON, "poison = 0.3", "material.sand.poison", "E0011")],
        ..NONE
    },
    Input {
        id: "I03",
        refused: &[row(
            "young    = \"20 MPa\"\n",
            "",
            YOUNG_KEY,
            "this key is missing. Add it; its value is a number (Pa) or a string with a unit",
        )
        .up(2)],
        ..NONE
    },
    Input {
        id: "I04",
        refused: &[row(
            POISSON,
            "poisson = 0.3\npoisson = 0.3",
            "",
            "`poisson` is given twice, here and in line 19",
        )
        .down(1)],
        ..NONE
    },
    Input {
        id: "I08",
        refused: &[
            row(YOUNG, "0", YOUNG_KEY, "E0010"),
            row(YOUNG, "\"-20 MPa\"", YOUNG_KEY, "E0010"),
            row(YOUNG, "1e-30", YOUNG_KEY, "E0010"),
            row("\"2 t/m3\"", "-2000", "material.sand.density", "E0010"),
            row("\"2 t/m3\"", "5e-324", "material.sand.density", "E0010"),
            row("\"10 ms\"", "-0.01", "analysis.dt", "E0010"),
            row("\"10 ms\"", "0.0", "analysis.dt", "E0010"),
            row("[0.5, \"50 cm\"]", "[0.5, 0]", "grid.cell", "E0010"),
            row("[0.5, \"50 cm\"]", "[0.5, \"-50 cm\"]", "grid.cell", "E0010"),
        ],
        ..NONE
    },
    Input {
        id: "I09",
        refused: &[
            row(POISSON, "poisson = 0.5", "material.sand.poisson", "E0010"),
            row(
                POISSON,
                "poisson = 0.5000001",
                "material.sand.poisson",
                "(-1 < poisson < 0.5",
            ),
            row(
                POISSON,
                "poisson = -1",
                "material.sand.poisson",
                "-1 is outside the allowed range",
            ),
            row(POISSON, "poisson = -1.5", "material.sand.poisson", "E0010"),
        ],
        taken: &[
            (POISSON, "poisson = 0.49995", "W0303: material.sand: poisson = 0.49995"),
            (POISSON, "poisson = 0.499", "water.bulk = 1.66"),
            (POISSON, "poisson = 0.4989", ""),
            (POISSON, "poisson = -0.99", ""),
        ],
        ..NONE
    },
    Input {
        id: "I10",
        refused: &[
            row("\"30 deg\"", "-1", "material.sand.friction_angle", "E0010"),
            row("\"30 deg\"", "90", "material.sand.friction_angle", "E0010"),
            row(
                "dilation_angle = 5",
                "dilation_angle = 30.1",
                "material.sand.dilation_angle",
                "E0308",
            ),
            row(
                "dilation_angle = 5",
                "dilation_angle = -1",
                "material.sand.dilation_angle",
                "-1 is outside the allowed range",
            ),
            row("\"1 kPa\"", "\"-1 kPa\"", "material.sand.cohesion", "(cohesion >= 0"),
        ],
        taken: &[
            ("cohesion    = 2e4", "cohesion = 0", "W0309: material.clay: "),
            ("cohesion = \"1 kPa\"", "cohesion = 0", ""),
        ],
        ..NONE
    },
    Input {
        id: "I11",
        refused: &[
            row(
                "upper = [4.0, 1.0] }",
                "upper = [0.0, 1.0] }",
                "body.0.box.upper",
                "is not above the lower corner [0.0, 0.0] m along each axis",
            ),
            row(
                "upper = [4.0, 1.0] }",
                "upper = [4.0, 1e-12] }",
                "body.0.box.upper",
                "E0219",
            ),
            row("radius = 0.4", "radius = -0.4", "body.4.circle.radius", "(radius > 0"),
        ],
        refused_static: &[row("[[body]]\nmaterial", "[[bodies]]\nmaterial", "bodies", "E0011")],
        ..NONE
    },
    Input {
        id: "I12",
        refused: &[
            row(
                "upper = [4.0, 1.0] }",
                "upper = [4.0, 3.5] }",
                "body.0.box.upper",
                "y = 3.5 m is outside the grid, which ends at y = 3 m",
            ),
            row(
                "centre = [0.5, 2.0]",
                "centre = [0.3, 2.0]",
                "body.4.circle",
                "is outside the grid, which starts at x = 0",
            ),
        ],
        ..NONE
    },
    Input {
        id: "I13",
        refused: &[
            row(
                "[0.5, \"50 cm\"]",
                "[0.5, 0.7]",
                "grid.cell",
                "along y, but needs a whole number. It can grow at a \"free\" face only, and no face along y is \"free\". Use for example \
                 cell = 0.75",
            ),
            row("cell  = [0.5, \"50 cm\"]", "cell = [4, 3]", "footing.to", "E0235").down(76),
            row("upper = [4.0, 3.0]", "upper = [4.0, 0.0]", "grid.upper", "E0203"),
            row("upper = [4.0, 3.0]", "upper = [-4.0, 3.0]", "grid.upper", "E0203"),
        ],
        taken: &[("cell  = [0.5, \"50 cm\"]", "cell = [1, 3]", "W0222")],
        ..NONE
    },
    Input {
        id: "I14",
        taken: &[(
            "lower = [0.0, 1.0], upper",
            "lower = [0.0, 0.9], upper",
            "body.0 and body.1 overlap",
        )],
        ..NONE
    },
    Input {
        id: "I15",
        refused: &[
            row(
                "points_per_cell = 3",
                "points_per_cell = 0",
                "body.0.points_per_cell",
                "E0010",
            ),
            row(
                "points_per_cell = 3",
                "points_per_cell = 101",
                "body.0.points_per_cell",
                "E0010",
            ),
            row(
                "points_per_cell = 3",
                "points_per_cell = [2, 3]",
                "body.0.points_per_cell",
                "found a list of 2",
            ),
            row(
                "points_per_cell = 3",
                "points_per_cell = 2.5",
                "body.0.points_per_cell",
                "found 2.5",
            ),
        ],
        taken: &[
            ("points_per_cell = 3", "points_per_cell = 1", "W0210"),
            ("points_per_cell = 3", "points_per_cell = 100", ""),
        ],
        ..NONE
    },
    Input {
        id: "I16",
        refused: &[
            row("top    = \"fixed\"", "up = \"fixed\"", "boundary.up", "E0011"),
            row(
                "face = \"right\"",
                "face = \"rigth\"",
                "prescribed.0.face",
                "did you mean `right`?",
            ),
            row("face = \"right\"", "face = \"top\"", "prescribed.0.face", "E0236"),
        ],
        refused_static: &[
            row(
                "bottom = \"fixed\"",
                "",
                "boundary",
                "no support restrains the bodies along x",
            )
            .up(1),
            row(
                "bottom = \"fixed\"",
                "bottom = \"roller\"",
                "boundary",
                "a quasi-static analysis has no solution",
            )
            .up(1),
        ],
        ..NONE
    },
    Input {
        id: "I17",
        refused: &[
            row(
                "[[\"0.5 s\", 0.0, -0.1], [1.0, 0.0, 0.0]]",
                "[[1.0, 0, 0], [0.5, 0, 0]]",
                "prescribed.1.path",
                "E0402 .. t = 0.5 .. 1 in the row before",
            ),
            row(
                "[[\"0.5 s\", 0.0, -0.1], [1.0, 0.0, 0.0]]",
                "[]",
                "prescribed.1.path",
                "E0435",
            ),
            row(
                "[[\"0.5 s\", 0.0, -0.1], [1.0, 0.0, 0.0]]",
                "[[0, 0, 0]]",
                "prescribed.1.path",
                "at least one row",
            ),
            row(
                "[[\"0.5 s\", 0.0, -0.1], [1.0, 0.0, 0.0]]",
                "[[1.0, 0, nan]]",
                "prescribed.1.path",
                "E0010",
            ),
            row(
                "[[\"0.5 s\", 0.0, -0.1], [1.0, 0.0, 0.0]]",
                "[[1e-300, 0, 0]]",
                "prescribed.1.path",
                "E0010",
            ),
        ],
        taken: &[("[[\"0.5 s\", 0.0, -0.1], [1.0, 0.0, 0.0]]", "[[1.0, 0.0, -0.1]]", "")],
        ..NONE
    },
    Input {
        id: "I18",
        refused: &[
            row("end  = \"1 s\"", "end = \"-1 s\"", "analysis.end", "E0010"),
            row("\"10 ms\"", "1.5", "analysis.dt", "E0256"),
            row("dt   = \"10 ms\"", "steps = 0", "analysis.steps", "E0010"),
            row(
                "dt   = \"10 ms\"",
                "steps = 1_000_000_000_000",
                "analysis.steps",
                "E0010",
            ),
            row(
                "\"10 ms\"",
                "1e-12",
                "analysis.dt",
                "1.000e12 steps until the end of the analysis (at most 1e9)",
            ),
            row("every  = \"0.1 s\"", "every = 0", "output.every", "E0010"),
            row("times  = [\"0.25 s\", 0.75]", "times = [1e-9]", "output.times", "E0664"),
            row("at       = \"0.5 s\"", "at = 1e-9", "check.0.at", "E0664"),
        ],
        taken: &[
            ("dt   = \"10 ms\"", "steps = 1", ""),
            ("every  = \"0.1 s\"", "every = 3", "W0661: output.every: "),
            (
                "[\"1 s\", \"-0.1 g\"",
                "[\"2 ms\", \"-0.1 g\"",
                "W0404: shaking.acceleration: rows are 0.002 apart in time, but a step is 0.01",
            ),
            (
                "[\"1 s\", \"-0.1 g\"",
                "[\"2 ms\", \"-0.1 g\"",
                "W0404: shaking.acceleration: ",
            ),
            (
                "bottom = \"fixed\"",
                "bottom = { friction_coefficient = 1.5 }",
                "W0204: boundary.bottom.friction_coefficient: ",
            ),
            ("bottom = \"fixed\"", "bottom = \"contact\"", "W0671: analysis.dt: "),
            (
                "ramp = \"0.5 s\"",
                "amplitude = [[2, 1]]",
                "W0403: traction.0.amplitude: ",
            ),
            ("ramp = \"0.5 s\"", "amplitude = [[0, 1]]", "W0405: traction.0: "),
        ],
        ..NONE
    },
    Input {
        id: "I20",
        refused: &[
            row(
                "[0.5, \"50 cm\"]",
                "[4e-6, 3e-6]",
                "grid.cell",
                "1000000000000 cells and 2000008000008 unknowns (at most 2147483647",
            ),
            row(
                "[0.5, \"50 cm\"]",
                "[1e-9, 1e-9]",
                "grid.cell",
                "cells along x (at most 2147483647)",
            ),
            row(
                "upper = [4.0, 3.0]",
                "upper = [9223372036854775807, 3.0]",
                "grid.upper",
                "E0010",
            ),
            row(
                "[0.5, \"50 cm\"]",
                "[1e-4, 1e-4]",
                "grid.cell",
                "1200000000 cells and 2400280008 unknowns",
            ),
        ],
        ..NONE
    },
    Input {
        id: "I24",
        refused: &[
            row("factor = 1.25", "factor = -1.25", "strength_reduction.factor", "E0010"),
            row("factor = 1.25", "factor = 0", "strength_reduction.factor", "E0010"),
        ],
        ..NONE
    },
    Input {
        id: "I25",
        refused: &[
            row("-9.81]", "-1e308]", "gravity.acceleration", "E0010"),
            row("\"2 t/m3\"", "1e308", "material.sand.density", "E0010"),
        ],
        taken: &[
            ("-9.81]", "-1e12]", ""),
            (
                "density  = \"2 t/m3\"",
                "density = 1e9",
                "W0108: material.sand: a density of 1000000000.000 kg/m3",
            ),
        ],
        ..NONE
    },
    Input {
        id: "I26",
        refused: &[row(
            "density  = \"2 t/m3\"",
            "unit_weight = 2e4\ndensity = 2000",
            "material.sand.density",
            "`unit_weight` and `density` are both given",
        )
        .down(1)],
        taken: &[
            (YOUNG, "20", "W0101: material.sand.young: a modulus of 20 Pa (0.02 kPa)"),
            (YOUNG, "\"20000 GPa\"", "W0302: material.sand: "),
            (
                "\"18 kN/m3\"",
                "18",
                "W0108: material.clay: a density of 1.835 kg/m3 (unit weight 0.018 kN/m3)",
            ),
        ],
        ..NONE
    },
    Input {
        id: "tests of one point",
        refused: rows::element::ELEMENT,
        ..NONE
    },
];

#[test]
fn i01_to_i26_every_row_of_the_matrix() {
    let mut failed = Vec::new();
    for input in MATRIX {
        let refused = input.refused.iter().map(|row| verify(DYNAMIC, row));
        let refused = refused.chain(input.refused_static.iter().map(|row| verify(STATIC, row)));
        let taken = input.taken.iter().map(|(part, by, says)| take(part, by, says));
        failed.extend(
            refused
                .chain(taken)
                .filter_map(Result::err)
                .map(|error| format!("{}: {error}", input.id)),
        );
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

fn take(part: &str, by: &str, says: &str) -> Result<(), String> {
    if DYNAMIC.matches(part).count() == 0 {
        return Err(format!("`{part}` is not in the base"));
    }
    let case = Case::from_text("case.toml", &DYNAMIC.replacen(part, by, 1), &[]);
    let mut warnings = case.map_err(|errors| format!("`{by}`: {errors:#?}"))?.warnings;
    let base = Case::from_text("case.toml", DYNAMIC, &[])
        .expect("a valid case")
        .warnings;
    warnings.retain(|warning| !base.contains(warning));
    let fits = if says.is_empty() {
        warnings.is_empty()
    } else {
        warnings.iter().any(|warning| warning.contains(says))
    };
    if fits {
        Ok(())
    } else {
        Err(format!("`{by}`: `{says}` is not what is warned of: {warnings:?}"))
    }
}
