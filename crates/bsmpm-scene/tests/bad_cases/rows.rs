//! The rows, by the kind of mistake.

use super::{Row, row};

/// Names, types and units (rows I01 to I04, I07).
pub const LANGUAGE: &[Row] = &[
    row("poisson  = 0.3", "poissson = 0.3", "material.sand.poissson", "did you mean `poisson`?"),
    row("points_per_cell = 3", "points-per-cell = 3", "body.0.points-per-cell", "did you mean `points_per_cell`?"),
    row("title    =", "young    =", "young", "`young` belongs to [material.NAME]"),
    row("title    =", "colour   =", "colour", "unknown key `colour`"),
    row("[gravity]", "[gravitation]", "gravitation", "unknown key"),
    row("[solver]", "[slover]", "slover", "did you mean `solver`?"),
    row("bottom = \"fixed\"", "bottom = \"friction\"", "boundary.bottom", "expected one of"),
    row("bottom = \"fixed\"", "bottom = 0.3", "boundary.bottom", "expected"),
    row("bottom = \"fixed\"", "bottom = { lifts = false }", "boundary.bottom.friction", "missing"),
    row("bottom = \"fixed\"", "bottom = { friction = -0.3 }", "boundary.bottom.friction", "0 <= friction <= 2"),
    row("bottom = \"fixed\"", "bottom = { friction = 2.1 }", "boundary.bottom.friction", "0 <= friction <= 2"),
    row("bottom = \"fixed\"", "bottom = { friction = \"20 deg\" }", "boundary.bottom.friction", ""),
    row("bottom = \"fixed\"", "bottom = { friction = 0.3, lifts = 1 }", "boundary.bottom.lifts", "true or false"),
    row("bottom = \"fixed\"", "bottom = { friction = 0.3, type = \"fixed\" }", "boundary.bottom.type", "unknown key"),
    row("top    = \"fixed\"", "upper = \"free\"", "boundary.upper", "known: left, right, bottom, top"),
    row("percentile = 99.9", "precentile = 99.9", "history.0.precentile", "did you mean `percentile`?"),
    row("ksp = \"preonly\",", "kps = \"preonly\",", "solver.linear.kps", "did you mean `ksp`?"),
    row("poisson  = 0.3", "poisson  = \"0.3\"", "material.sand.poisson", "expected a number, found \"0.3\""),
    row("poisson  = 0.3", "poisson  = true", "material.sand.poisson", "expected a number, found true"),
    row("poisson  = 0.3", "poisson  = [0.3]", "material.sand.poisson", "found a list of 1"),
    row("poisson  = 0.3", "poisson  = { a = 1 }", "material.sand.poisson", "found a table"),
    row("poisson  = 0.3", "poisson  = 1979-05-27", "material.sand.poisson", "found 1979-05-27"),
    row("title    = \"Every key that there is\"", "title = 5", "title", "expected a text"),
    row("title    = \"Every key", "title = \"Every\\nkey", "title", "without control characters"),
    row("geometry = \"plane-strain\"", "geometry = \"plane-stress\"", "geometry", "did you mean `plane-strain`?"),
    row("reproducible     = true", "reproducible = \"yes\"", "solver.reproducible", "expected true or false"),
    row("residuals = true", "residuals = \"all\"", "output.residuals", "expected true or false"),
    row("reproducible     = true", "reproducible = 1", "solver.reproducible", "found 1"),
    row("max_iterations   = 200", "max_iterations = 200.0", "solver.max_iterations", "whole number from 1 to"),
    row("lower = [0.0, \"0 m\"]", "lower = [0.0]", "grid.lower", "a list of two"),
    row("lower = [0.0, \"0 m\"]", "lower = [0.0, 0.0, 0.0]", "grid.lower", "found a list of 3"),
    row("lower = [0.0, \"0 m\"]", "lower = 0.0", "grid.lower", "a list of two"),
    row("lower = [0.0, \"0 m\"]", "lower = [0.0, \"0 s\"]", "grid.lower", "`s` is a unit of time; expected a length"),
    row("\"20 MPa\"", "\"20 kN/m3\"", "material.sand.young", "unit of unit weight; expected a stress"),
    row("\"20 MPa\"", "\"20 Mpa\"", "material.sand.young", "did you mean `MPa`?"),
    row("\"20 MPa\"", "\"20\"", "material.sand.young", "has no unit"),
    row("\"20 MPa\"", "\"MPa\"", "material.sand.young", "no number with a unit"),
    row("\"20 MPa\"", "\"\"", "material.sand.young", "no number with a unit"),
    row("\"30 deg\"", "\"30 m\"", "material.sand.friction", "expected an angle (deg, rad)"),
    row("\"10 ms\"", "\"10 mm\"", "analysis.dt", "expected a time"),
    row("\"2 t/m3\"", "\"20 kN/m3\"", "material.sand.density", "expected a density"),
    row("\"-1 m/s\"", "\"-1 m/s2\"", "body.2.velocity", "expected a velocity"),
    row("-9.81]", "\"-1 gee\"]", "gravity.acceleration", "no known unit (m/s2"),
    row("\"4 m\"", "\"4 s\"", "check.0.max", "takes a length"),
    row("\"0 kPa\"", "\"0 m\"", "check.1.max", "takes a stress"),
    row("material = \"sand\"", "material = 5", "body.0.material", "expected a name"),
    row("material = \"sand\"", "material = \"sa nd\"", "body.0.material", "expected a name"),
    row("[material.sand]", "[material.\"sa nd\"]", "material.sa nd", "the name must be"),
    row("[material.sand]", "[material]\nx = 5\n[material.sand]", "material.x", "expected a table").down(1),
    row("model    = \"mohr-coulomb\"\n", "", "material.sand.model", "missing; it is one of \"hencky\"").up(1),
    row("poisson  = 0.3\n", "", "material.sand.poisson", "missing; it is a number").up(3),
    row("acceleration = [0.0, -9.81]\n", "", "gravity.acceleration", "missing").up(1),
    row("order = \"quadratic\"\n", "", "grid.order", "missing").up(4),
    row("order = \"quadratic\"", "order = \"quartic\"", "grid.order", "expected one of"),
    row("method = \"f-bar\"", "", "stabilisation.method", "missing").up(1),
    row("poisson  = 0.3", "poisson = 0.3\npoisson = 0.2", "", "no valid TOML: duplicate key").down(1),
    row("[gravity]", "[grid]", "", "duplicate key"),
    row("title    = \"Every", "title    = Every", "", "no valid TOML: missing opening quote"),
    row("upper = [4.0, 3.0]", "upper = [4.0, 3.0", "", "no valid TOML").down(1),
    row("type = \"dynamic\"", "type = \"dynamic", "", "no valid TOML"),
    row("format = \"vtu\"", "checkpoint = { keep = 0 }", "output.checkpoint.keep", "1 <= keep <= 1000"),
    row("format = \"vtu\"", "checkpoint = { wall = \"15 m\" }", "output.checkpoint.wall", "a time by the clock"),
    row("format = \"vtu\"", "checkpoint = { wall = 0 }", "output.checkpoint.wall", "wall > 0"),
    row("format = \"vtu\"", "checkpoint = 500", "output.checkpoint", "a table, checkpoint = {"),
];

/// Numbers out of range (I07 to I10, I15, I18, I25).
pub const RANGES: &[Row] = &[
    row(
        "poisson  = 0.3",
        "poisson  = 0.5",
        "material.sand.poisson",
        "allowed: -1 < poisson < 0.5 (at 0.5 the material is",
    ),
    row("poisson  = 0.3", "poisson  = 0.6", "material.sand.poisson", "0.6 is out of range"),
    row("poisson  = 0.3", "poisson  = -1", "material.sand.poisson", "allowed: -1 < poisson"),
    row("poisson  = 0.3", "poisson  = nan", "material.sand.poisson", "no finite number"),
    row("poisson  = 0.3", "poisson  = inf", "material.sand.poisson", "no finite number"),
    row("poisson  = 0.3", "poisson  = -inf", "material.sand.poisson", "no finite number"),
    row("poisson  = 0.3", "poisson  = 1e-999", "material.sand.poisson", "too small for a double"),
    row("\"20 MPa\"", "1e999", "material.sand.young", "too large for a double"),
    row("\"20 MPa\"", "1e308", "material.sand.young", "a stress is at most 1e18"),
    row("\"20 MPa\"", "99999999999999999999", "material.sand.young", "too large"),
    row("\"20 MPa\"", "0.0", "material.sand.young", "allowed: young > 0"),
    row("\"20 MPa\"", "\"-20 MPa\"", "material.sand.young", "allowed: young > 0"),
    row("\"30 deg\"", "90", "material.sand.friction", "allowed: 0 <= friction < 90"),
    row("\"30 deg\"", "-1", "material.sand.friction", "allowed: 0 <= friction < 90"),
    row("\"30 deg\"", "\"2 rad\"", "material.sand.friction", "\"2 rad\" is out of range"),
    row("dilation = 5", "dilation = 31", "material.sand.dilation", "dilation <= friction = 30"),
    row("dilation = 5", "dilation = -5", "material.sand.dilation", "allowed: 0 <= dilation"),
    row("\"1 kPa\"", "-1", "material.sand.cohesion", "allowed: cohesion >= 0"),
    row("\"2 t/m3\"", "0", "material.sand.density", "allowed: density > 0"),
    row("\"18 kN/m3\"", "-18e3", "material.clay.unit_weight", "allowed: unit_weight > 0"),
    row("end  = \"1 s\"", "end  = -1", "analysis.end", "allowed: end > 0"),
    row("end  = \"1 s\"", "end  = 0", "analysis.end", "allowed: end > 0"),
    row("\"10 ms\"", "0", "analysis.dt", "allowed: dt > 0"),
    row("\"10 ms\"", "\"2 s\"", "analysis.dt", "dt <= end = 1"),
    row("\"10 ms\"", "1e-12", "analysis.dt", "steps to the end; at most"),
    row("dt   = \"10 ms\"", "steps = 0", "analysis.steps", "allowed: 1 <= steps"),
    row("dt   = \"10 ms\"", "steps = 1000000000000", "analysis.steps", "allowed: 1 <= steps <= 1000000000"),
    row("dt   = \"10 ms\"", "steps = -1", "analysis.steps", "-1 is out of range"),
    row("dt   = ", "spectral_radius = 1.1\ndt   = ", "analysis.spectral_radius", "0 <= spectral_radius <= 1"),
    row("dt   = ", "spectral_radius = -0.1\ndt   = ", "analysis.spectral_radius", "-0.1 is out of range"),
    row("dt   = ", "mass = \"consistant\"\ndt   = ", "analysis.mass", "consistent"),
    row("dt   = ", "gamma = 0.4\ndt   = ", "analysis.gamma", "0.5 <= gamma <= 1 (below 1/2 it gains energy)"),
    row("points_per_cell = 3", "points_per_cell = 0", "body.0.points_per_cell", "1 <= points_per_cell <= 100"),
    row("points_per_cell = 3", "points_per_cell = 101", "body.0.points_per_cell", "1 <= points_per_cell <= 100"),
    row("-9.81]", "1e308]", "gravity.acceleration", "an acceleration is at most"),
    row("-9.81]", "nan]", "gravity.acceleration", "no finite number"),
    row("ramp = \"0 s\"", "ramp = -1", "gravity.ramp", "allowed: ramp >= 0"),
    row("tolerance        = 1e-8", "tolerance = 0", "solver.tolerance", "0 < tolerance < 1"),
    row("force_tolerance  = 1e-4", "force_tolerance = 1.5", "solver.force_tolerance", "0 < force_tolerance < 1"),
    row("background       = 0.0", "background = -0.1", "solver.background", "0 <= background <= 1"),
    row("\"points\"", "\"gauss\"", "solver.quadrature", "fitted"),
    row("\"strain\"", "\"bending\"", "solver.background_kind", "curvature"),
    row("max_iterations   = 200", "max_iterations = 0", "solver.max_iterations", "1 <= max_iterations"),
    row("every  = \"0.1 s\"", "every  = 0", "output.every", "allowed: every > 0"),
    row("every  = \"0.1 s\"", "every_steps = 0", "output.every_steps", "1 <= every_steps"),
    row("every  = \"0.1 s\"", "every  = 1e-10", "output.every", "frames are too many"),
    row("percentile = 99.9", "percentile = 100.1", "history.0.percentile", "0 < percentile <= 100"),
    row("scale    = 1e-3", "scale    = inf", "history.1.scale", "no finite number"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = 0", "grid.cell", "allowed: cell > 0"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = -0.0", "grid.cell", "allowed: cell > 0"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = 1e-9", "grid.cell", "cells along x; at most 2147483647"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = [0.5, 1e-9]", "grid.cell", "cells along y; at most 2147483647"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = 4e-6", "grid.cell", "cells and"),
    row("cell  = [0.5, \"50 cm\"]", "cell  = [0.5, 0.1, 0.1]", "grid.cell", "found a list of 3"),
];

/// Rules between keys (I11 to I18, I20, I26).
pub const RULES: &[Row] = &[
    row("dt   = \"10 ms\"", "dt = 0.01\nsteps = 5", "analysis.steps", "only one of dt, steps").down(1),
    row("dt   = ", "spectral_radius = 1\ngamma = 0.5\ndt   = ", "analysis.gamma", "only one of spectral_radius")
        .down(1),
    row("dt   = \"10 ms\"\n", "", "analysis", "missing: one of dt, steps").up(3),
    row("end  = \"1 s\"\n", "", "analysis.end", "missing; a dynamic analysis").up(2),
    row("density  = \"2 t/m3\"", "density = 1\nunit_weight = 2", "material.sand.density", "only one of"),
    row("density  = \"2 t/m3\"", "", "material.sand", "a dynamic analysis needs mass").up(7),
    row("format = \"vtu\"", "every_steps = 5", "output.every_steps", "`every` is given too"),
    row("cell  = [0.5, \"50 cm\"]", "cell = 0.5\nknots.x = [0, 1]", "grid.knots", "only one of cell, knots").down(1),
    row("cell  = [0.5, \"50 cm\"]", "knots.x = [0, 2, 1, 4]\nknots.y = [0, 3]", "grid.knots.x", "must increase"),
    row("cell  = [0.5, \"50 cm\"]", "knots.x = [0, 1, 2, 1, 4]\nknots.y = [0, 3]", "grid.knots.x", "stands in a row"),
    row("cell  = [0.5, \"50 cm\"]", "knots.x = [0, 1, 1, 1, 4]\nknots.y = [0, 3]", "grid.knots.x", "1 stands 3 times"),
    row("cell  = [0.5, \"50 cm\"]", "knots.x = [0, 1, 4]\nknots.y = [0, 0, 3]", "grid.knots.y", "the ends once")
        .down(1),
    row("cell  = [0.5, \"50 cm\"]", "knots.y = [0, 3]\nknots.x = [0]", "grid.knots.x", "at least two").down(1),
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
    row("cell  = [0.5, \"50 cm\"]", "knots.x = [0, 4]\nknots.y = [0, nan]", "grid.knots.y", "no finite").down(1),
    row(
        "upper = [4.0, 3.0]\ncell  = [0.5, \"50 cm\"]",
        "upper = [5.0, 3.0]\nknots.x = [0, 4]\nknots.y = [0, 3]",
        "grid.upper",
        "differs from the breakpoints of x",
    ),
    row("lower = [0.0, \"0 m\"]\n", "", "grid.lower", "missing; it is needed with `cell`").up(1),
    row("upper = [4.0, 3.0]", "upper = [4.0, 0.0]", "grid.upper", "is not above lower"),
    row("cell  = [0.5, \"50 cm\"]", "cell = [0.5, 0.7]", "grid.cell", "no whole number, and neither face is free"),
    row("friction = \"30 deg\"\n", "", "material.sand.friction", "model \"mohr-coulomb\" needs it").up(4),
    row("cohesion    = 2e4\n", "", "material.clay.cohesion", "model \"tresca\" needs it").up(4),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\nfriction = 20",
        "material.clay.friction",
        "no meaning in model \"tresca\"",
    )
    .down(1),
    row(
        "poisson     = 0.2",
        "poisson = 0.2\ncohesion = 2e4",
        "material.block.cohesion",
        "no meaning in model \"hencky\"",
    )
    .down(1),
    row("\"forgotten\"", "\"closed\"", "material.sand.separation", "expected one of \"forgotten\", \"closing\""),
    row("\"forgotten\"", "\"closing\"", "material.sand.separation", "needs friction and no cohesion"),
    row(
        "cohesion    = 2e4",
        "cohesion = 2e4\nseparation = \"closing\"",
        "material.clay.separation",
        "no meaning in model",
    )
    .down(1),
    row(
        "poisson     = 0.2",
        "poisson = 0.2\nseparation = \"closing\"",
        "material.block.separation",
        "no meaning in model",
    )
    .down(1),
    row("k0          = 0.6", "separation = \"closing\"", "material.till.separation", "needs friction and no cohesion"),
    row(
        "material = \"sand\"",
        "material = \"snad\"",
        "body.0.material",
        "there is no [material.snad]; did you mean `sand`?",
    ),
    row("upper = [4.0, 1.0] }", "upper = [4.0, 0.0] }", "body.0.box.upper", "the body is empty"),
    row("upper = [4.0, 1.0] }", "upper = [4.1, 1.0] }", "body.0.box.upper", "outside the grid, which ends at x = 4"),
    row("lower = [1.0, 2.0]", "lower = [-1.0, 2.0]", "body.2.box.lower", "outside the grid, which starts at x = 0"),
    row("upper = [4.0, 1.0] }", "upper = [4.0, 1e-10] }", "body.0.box.upper", "it has no points"),
    row("box = { lower = [0.0, 0.0], upper = [4.0, 1.0] }\n", "", "body.0", "missing: one of box").up(2),
    row("pc = \"cholesky\"", "pc = \"jacobi\"", "solver.linear.ksp", "\"preonly\" solves with a direct pc"),
    row("pc = \"cholesky\"", "pc = \"choleski\"", "solver.linear.pc", "did you mean `cholesky`?"),
    row("times  = [\"0.25 s\", 0.75]", "times = [2]", "output.times", "beyond the end"),
    row("times  = [\"0.25 s\", 0.75]", "times = [-2]", "output.times", "out of range"),
    row("percentile = 99.9", "face = \"left\"", "history.0.face", "no meaning for quantity \"runout\""),
    row("face     = \"bottom\"", "face = \"botom\"", "history.1.face", "did you mean `bottom`?"),
    row("face     = \"bottom\"\n", "", "history.1.face", "quantity \"reaction\" needs it").up(2),
    row("at       = [2.0, \"0.5 m\"]", "at = [5, 0]", "history.2.at", "outside the grid"),
    row("percentile = 99.9", "name = \"floor-x\"", "history.1.name", "a column `floor-x` already").down(5),
    row("percentile = 99.9", "name = \"time\"", "history.0.name", "a column `time` already"),
    row("quantity = \"runout\"\nat", "quantity = \"runuot\"\nat", "check.0.quantity", "did you mean `runout`?"),
    row("quantity = \"stress-yy\"", "quantity = \"stress\"", "check.1.quantity", "columns: runout, floor-x"),
    row("at       = \"0.5 s\"", "at = 2", "check.0.at", "beyond the end"),
    row("min      = 3.0", "min = 5.0", "check.0.min", "above max = 4"),
    row("max      = \"0 kPa\"", "", "check.1", "missing: min, max").up(2),
    row(
        "quantity = \"heave\"",
        "quantity = \"mass\"\nmaterial = \"sandy\"",
        "history.5.material",
        "no material `sandy`",
    )
    .down(1),
    row("quantity = \"heave\"", "quantity = \"front\"\nmaterial = \"sand\"", "history.5.material", "has no meaning")
        .down(1),
    row("quantity = \"heave\"", "quantity = \"gap\"", "history.5.face", "missing; quantity \"gap\" needs it").up(1),
    row(
        "quantity = \"heave\"",
        "quantity = \"contact\"\nface = \"bottom\"",
        "history.5.face",
        "\"contact\" is about a face in contact, and [boundary] bottom is not one: give { friction } or \"contact\"",
    )
    .down(1),
    row(
        "quantity = \"heave\"",
        "quantity = \"heave\"\nface = \"left\"",
        "history.5.face",
        "has no meaning for quantity \"heave\"",
    )
    .down(1),
];

/// Parts of histories, lines, surfaces, profiles and fields of frames.
pub const TOLD: &[Row] = &[
    row("body     = \"fill\"", "body = \"fil\"", "history.7.body", "did you mean `fill`?"),
    row(
        "body     = \"fill\"",
        "material = \"sand\"\nbody = \"fill\"",
        "history.7.body",
        "`material` is given too; only one of material, body may be",
    )
    .down(1),
    row("quantity = \"kinetic-energy\"", "quantity = \"energy\"", "history.7.body", "has no meaning").down(1),
    row("to       = [\"1 m\", 1.25]\n", "", "history.8.to", "quantity \"section-forces\" needs it").up(3),
    row("to       = [\"1 m\", 1.25]", "to = [1.0, 0.0]", "history.8.to", "it has no length"),
    row("to       = [\"1 m\", 1.25]", "to = [1.0, 9.0]", "history.8.to", "outside the grid"),
    row("quantity = \"heave\"", "quantity = \"heave\"\nsurface = true", "history.5.surface", "has no meaning").down(1),
    row(
        "quantity = \"heave\"",
        "quantity = \"displacement\"\nat = [1, 1]\nfixed = true",
        "history.5.fixed",
        "no meaning",
    )
    .down(2),
    row("count = 11", "count = 0", "profile.0.count", "1 <= count <= 1000"),
    row("to    = [2.0, 0.0]", "to = [2.0, -1.0]", "profile.0.to", "outside the grid"),
    row("to    = [2.0, 0.0]", "to = [2.0, 1.25]", "profile.0.to", "it has no length"),
    row("times = [\"0.5 s\", 1.0]", "times = [0.5, 2.0]", "profile.0.times", "beyond the end"),
    row("times = [\"0.5 s\", 1.0]", "times = []", "profile.0.times", "never told"),
    row(
        "quantities = [\"displacement\", ",
        "quantities = [\"disp\", ",
        "profile.0.quantities",
        "expected a list of words",
    ),
    row("quantities = [\"displacement\", ", "quantities = [\"q\", ", "profile.0.quantities", "\"q\" is named twice"),
    row(
        "fixed = false",
        "[[profile]]\nname = \"Depth\"\nfrom = [0, 0]\nto = [1, 1]\ncount = 2\nquantities = [\"p\"]",
        "profile.1.name",
        "there is a profile `Depth` already",
    )
    .down(1),
    row("fields = [\"q\", ", "fields = [\"p\", ", "output.fields", "expected a list of words"),
    row("fields = [\"q\", ", "fields = [\"density\", ", "output.fields", "\"density\" is named twice"),
];

/// Profiles in a quasi-static case.
pub const TOLD_QUASI_STATIC: &[Row] = &[row(
    "[output]",
    "[[profile]]\nname = \"a\"\nfrom = [0, 0]\nto = [1, 1]\ncount = 2\nquantities = [\"velocity\"]\n[output]",
    "profile.0.quantities",
    "there is no velocity in a quasi-static analysis",
)
.down(5)];

/// Faces that let waves out, in the case with all keys, which has stages, shakes and starts without stress.
pub const ABSORBING: &[Row] = &[
    row("left   = \"roller\"", "left = \"absorbing\"", "boundary.left", "cannot be used with [[stage]]"),
    row("left   = \"roller\"", "left = \"absorbing\"", "boundary.left", "the motion of the free field"),
    row("left   = \"roller\"", "left = \"free-field\"", "boundary.left", "cannot be used with [[stage]]"),
    row("left   = \"roller\"", "left = \"free-field\"", "boundary.left", "under a free \"top\""),
    row("left   = \"roller\"", "left = \"free-field\"", "boundary.left", "a traction acts on the cells"),
    row("bottom = \"fixed\"", "bottom = \"free-field\"", "boundary.bottom", "for \"left\" and \"right\" only"),
    row("quantity = \"heave\"", "quantity = \"outflow\"", "history.5.quantity", "nothing leaves"),
];

/// Quasi-static cases (I13, I16, I18).
pub const QUASI_STATIC: &[Row] = &[
    row("end   = 1.0", "end = \"1 s\"", "analysis.end", "pseudo-time without unit"),
    row("every = 0.5", "every = \"1 s\"", "output.every", "pseudo-time without unit"),
    row("bottom = \"fixed\"", "bottom = \"free\"", "boundary", "nothing holds the bodies along x").up(1),
    row("bottom = \"fixed\"", "bottom = \"roller\"", "boundary", "nothing holds the bodies along x").up(1),
    row("bottom = \"fixed\"", "left = \"roller\"", "boundary", "nothing holds the bodies along y").up(1),
    row("bottom = \"fixed\"", "top = \"fixed\"", "boundary", "no fixed face, roller or face in contact that").up(1),
    row("bottom = \"fixed\"", "bottom = \"contact\"", "boundary", "nothing holds the bodies along x").up(1),
    row("bottom = \"fixed\"", "bottom = \"absorbing\"", "boundary.bottom", "there are no waves"),
    row("bottom = \"fixed\"", "left = \"free-field\"", "boundary.left", "nothing moves the free field"),
    row("bottom = \"fixed\"", "left = \"free-field\"", "boundary.left", "there are no waves"),
    row("points_per_cell = 3", "points_per_cell = 3\nvelocity = [1, 0]", "body.0.velocity", "quasi-static").down(1),
    row("[output]", "[[history]]\nquantity = \"momentum\"\n[output]", "history.0.quantity", "no momentum").down(1),
    row("steps = 4", "steps = 4\nspectral_radius = 0.8", "analysis.spectral_radius", "no inertia").down(1),
    row("steps = 4", "steps = 4\nmass = \"consistent\"", "analysis.mass", "no mass matrix").down(1),
    row("steps = 4", "steps = 4\ngamma = 0.6", "analysis.gamma", "no inertia").down(1),
    row("steps = 4", "steps = 4.5", "analysis.steps", "whole number"),
    row(
        "box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }\npoints_per_cell = 3",
        "box = 5\npoints_per_cell = 3",
        "body.0.box",
        "expected a table",
    ),
    row("[[body]]", "[body]", "body", "expected a list of tables, [[body]]"),
];

/// What is reserved and not done yet.
pub const LATER: &[(&str, &str, &str)] = &[
    ("geometry = \"plane-strain\"", "geometry = \"axisymmetric\"", "geometry"),
    ("geometry = \"plane-strain\"", "geometry = \"solid\"", "geometry"),
    ("format = \"vtu\"", "format = \"vtkhdf\"", "output.format"),
    ("top    = \"fixed\"", "front = \"free\"", "boundary.front"),
];

/// Stages: bodies that come and go.
pub const STAGES: &[Row] = &[
    row("add  = [\"fill\"]", "add = [\"fil\"]", "stage.0.add", "did you mean `fill`?"),
    row("add  = [\"fill\"]", "add = \"fill\"", "stage.0.add", "expected a list of names"),
    row("add  = [\"fill\"]", "add = []", "stage.0", "it changes nothing").up(3),
    row("add  = [\"fill\"]", "add = [\"fill\", \"fill\"]", "stage.0.add", "has been placed before"),
    row("remove = [\"fill\"]", "remove = [\"fill\", \"fill\"]", "stage.1.remove", "has been removed before"),
    row("add  = [\"fill\"]", "add = [\"fill\"]\nremove = [\"fill\"]", "stage.0.remove", "is not there yet").down(1),
    row("add  = [\"fill\"]", "apply = [\"fill\"]", "stage.0.apply", "there is no [[traction]]"),
    row(
        "add  = [\"fill\"]",
        "materials = [{ from = \"sand\", to = \"clai\" }]",
        "stage.0.materials.0.to",
        "did you mean `clay`?",
    ),
    row("add  = [\"fill\"]", "materials = [{ from = \"sand\" }]", "stage.0.materials.0.to", "missing"),
    row(
        "add  = [\"fill\"]",
        "strength_reduction = 0.05",
        "stage.0.strength_reduction",
        "0.1 <= strength_reduction <= 100",
    ),
    row("factor = 1.25", "factor = 1.25\nstage = \"filled\"", "strength_reduction.stage", "needs a quasi-static")
        .down(1),
    row("factor = 1.25", "factor = 1.25\nsteps = 1001", "strength_reduction.steps", "0 <= steps <= 1000").down(1),
    row("at     = \"500 ms\"", "at = 0.25", "stage.1.at", "stages follow in time"),
    row("at     = \"500 ms\"", "at = \"1 s\"", "stage.1.at", "not before the end of the run"),
    row("at   = \"0.25 s\"", "at = 0", "stage.0.at", "out of range"),
    row("name     = \"fill\"", "name = \"a b\"", "body.5.name", "expected a name"),
    row(
        "[[stage]]\nname",
        "[[body]]\nname = \"fill\"\nmaterial = \"clay\"\npoints_per_cell = 2\nbox = { lower = \
        [3.5, 2.7], upper = [3.8, 2.9] }\n[[stage]]\nname",
        "body.6.name",
        "body.5 has that name",
    )
    .down(1),
];

/// The quasi-static base has one body only.
pub const STAGES_OF_ONE: &[Row] = &[
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\nname = \"all\"\n[[stage]]\nat = 0.5\nremove = [\"all\"]",
        "stage.0.remove",
        "nothing is left after it",
    )
    .down(4),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\nname = \"all\"\n[[stage]]\nat = 0.5\nadd = [\"all\"]",
        "body",
        "none is there at the start",
    )
    .up(3),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\nname = \"top\"\n[[body]]\nmaterial = \"soil\"\npoints_per_cell = 2\n\
         box = { lower = [0.0, 1.0], upper = [2.0, 2.0] }\n[[stage]]\nat = 0.5\nremove = [\"top\"]\n\
         [[point_load]]\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0",
        "point_load.0.at",
        "there is no body from the start to the end",
    )
    .down(10),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\napply = [\"push\"]\nrelease = [\"push\"]",
        "stage.0.apply",
        "push is released by this stage, too",
    )
    .down(8),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\napply = [\"push\"]\n[[stage]]\nat = 0.75\napply = [\"push\"]",
        "stage.1.apply",
        "push acts already",
    )
    .down(11),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\nrelease = [\"push\"]\n[[stage]]\nat = 0.75\nrelease = [\"push\"]",
        "stage.1.release",
        "push does not act",
    )
    .down(11),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\nreset_displacements = true\n\
         [[point_load]]\nname = \"push\"\nat = [0.5, 0.5]\nforce = [0, -1]",
        "point_load.1.name",
        "point_load.0 has that name",
    )
    .down(10),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\nmaterials = [{ from = \"heavy\", to = \"soil\" }]\n\
         [material.heavy]\nmodel = \"hencky\"\nyoung = 1e6\npoisson = 0.3",
        "stage.0.materials.0.from",
        "no body is made of material.heavy",
    )
    .down(8),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\nmaterials = [{ from = \"soil\", to = \"heavy\" }]\n\
         [material.heavy]\nmodel = \"hencky\"\nyoung = 1e6\npoisson = 0.3\nunit_weight = 2e4",
        "stage.0.materials.0.to",
        "differ in density",
    )
    .down(8),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\nmaterials = [{ from = \"soil\", to = \"soft\" }]\n\
         [material.soft]\nmodel = \"modified-cam-clay\"\nkappa = 0.02\nlambda = 0.1\ncritical_ratio = 1\nocr = 1.5\nyoung = 1e6\npoisson = 0.3",
        "stage.0.materials.0.to",
        "is not told by the stress",
    )
    .down(8),
    row(
        "[output]",
        "[strength_reduction]\nfactor = 1.2\nstage = \"dig\"\n[[stage]]\nname = \"dug\"\nat = 0.5\n\
         reset_displacements = true\n[output]",
        "strength_reduction.stage",
        "did you mean `dug`?",
    )
    .down(2),
    row(
        "[output]",
        "[strength_reduction]\nfactor = 1.2\nstage = \"start\"\n[output]",
        "strength_reduction.stage",
        "nothing has loaded the ground",
    )
    .down(2),
    row(
        "[output]",
        "[strength_reduction]\nfactor = 1.2\nstage = \"end\"\n[[stage]]\nat = 0.5\nstrength_reduction = 1.1\n[output]",
        "strength_reduction.stage",
        "stage.0 divides the strength, too",
    )
    .down(2),
    row(
        "[material.soil]\nmodel   = \"hencky\"",
        "[gravity]\nacceleration = [0, -9.81]\n[initial]\nk0 = 0.6\n[[stage]]\nat = 0.5\nstrength_reduction = 1.1\n\
         [material.soil]\nunit_weight = 2e4\nkappa = 0.02\nlambda = 0.1\ncritical_ratio = 1\nocr = 1.5\n\
         model = \"modified-cam-clay\"",
        "stage.0.strength_reduction",
        "cannot be divided under the stress",
    )
    .down(6),
];
