//! Tests that cases with invalid pore-water flow are refused.

mod warnings;

use super::{Row, row};

const TYPE: &str = "type   = \"consolidation\"";
const CLAY: &str = "model            = \"elastic\"";

const CURVE: &str = "curve = [[0, 1, 1], [1, 0.5, 0.1], [2, 0.4, 0.2]]";

/// Time, splines, soils, drains and inflows, and what is not shown to be right with them.
pub const FLOW: &[Row] = &[
    // Time.
    row(
        TYPE,
        "type = \"consolidate\"",
        "analysis.type",
        "did you mean `consolidation`?",
    ),
    row(TYPE, "type = \"dynamic\"", "analysis.growth", "E0258").down(3),
    row("end    = \"20 year\"\n", "", "analysis.end", "E0255").up(2),
    row("dt     = \"1 h\"", "steps = 100", "analysis.growth", "E0259").down(1),
    row("growth = 1.2", "growth = 0.9", "analysis.growth", "1 <= growth <= 10"),
    row(
        "dt_max = \"60 d\"",
        "dt_max = \"1 min\"",
        "analysis.dt_max",
        "dt_max = 60 is less than dt = 3600",
    ),
    row(
        "dt_max = \"60 d\"",
        "dt_max = \"60 daz\"",
        "analysis.dt_max",
        "did you mean `day`?",
    ),
    // Splines, points, averages, iterations.
    row("degree = \"quadratic\"", "degree = \"linear\"", "grid.degree", "E0541"),
    row(
        "degree = \"quadratic\"",
        "degree = \"cubic\"",
        "body.0.points_per_cell",
        "E0542: .. 3 material points",
    )
    .down(29),
    row(
        "\"consistent-f-bar\"",
        "\"subgrid-f-bar\"",
        "stabilisation.method",
        "E0540 .. \"consistent-f-bar\"",
    ),
    row("\"auto\"", "\"broyden\"", "solver.nonlinear", "E0540 .. \"auto\""),
    row(
        "nonlinear = \"auto\"",
        "quadrature = \"fitted\"",
        "solver.quadrature",
        "E0540 .. \"points\"",
    ),
    // Soils.
    row(
        "porosity         = 0.6\n",
        "",
        "material.clay.porosity",
        "E0505 .. drainage = \"coupled\"",
    )
    .up(5),
    row(
        "permeability     = \"1e-9 m/s\"\n",
        "",
        "material.clay.permeability",
        "E0505",
    )
    .up(6),
    row(
        "permeability     = \"1e-9 m/s\"",
        "permeability = \"1e-9 m\"",
        "material.clay.permeability",
        "a velocity",
    ),
    row(
        "permeability     = \"1e-9 m/s\"",
        "permeability = [1e-9, -1e-9]",
        "material.clay.permeability",
        "> 0",
    ),
    row(
        "porosity         = 0.6",
        "porosity = 60",
        "material.clay.porosity",
        "0 < porosity < 1",
    ),
    row(
        "porosity = 0.5",
        "porosity = 0.5\npermeability = 1e-9",
        "material.tight.permeability",
        "E0506",
    )
    .down(1),
    row(
        "drainage = \"undrained\"",
        "drainage = \"drained\"",
        "material.tight.drainage",
        "soil that consolidates is \"coupled\"",
    ),
    row(
        CLAY,
        "model = \"modified-cam-clay\"\nkappa_star = 0.02\nlambda_star = 0.1\ncritical_state_ratio = \
         1\npreconsolidation = 1e5",
        "material.clay.model",
        "E0540 .. \"modified-cam-clay\"",
    ),
    row("alpha = 2.0", "alpha = 0", "material.clay.retention.alpha", "alpha > 0"),
    row("n = 1.5", "n = 1", "material.clay.retention.n", "1.05 <= n <= 20"),
    row(
        "residual = 0.1",
        "residual = 1",
        "material.clay.retention.residual",
        "0 <= residual < 1",
    ),
    row(
        "porosity = 0.5",
        "porosity = 0.5\nretention = { alpha = 1, n = 2 }",
        "material.tight.retention",
        "E0506",
    )
    .down(1),
    row(
        "alpha = 2.0, n = 1.5",
        "alpha = 2.0",
        "material.clay.retention.alpha",
        "E0507",
    ),
    row(
        "alpha = 2.0",
        "curve = [[0, 1, 1], [1, 0.5, 0.1]]",
        "material.clay.retention.n",
        "E0508",
    ),
    row(
        "alpha = 2.0, n = 1.5",
        CURVE,
        "material.clay.retention.curve",
        "E0509 .. from a suction head of 1 m to 2 m",
    ),
    row(
        "alpha = 2.0, n = 1.5",
        "curve = [[0, 1, 1]]",
        "material.clay.retention.curve",
        "E0509 .. at least two",
    ),
    row(
        "alpha = 2.0, n = 1.5",
        "curve = [[1, 1, 1], [2, 0.5, 0.1]]",
        "material.clay.retention.curve",
        "E0509",
    ),
    row(
        "alpha = 2.0, n = 1.5",
        "curve = [[0, 1, 1], [0, 0.5, 0.1]]",
        "material.clay.retention.curve",
        "E0402 .. the suction = 0",
    ),
    row(
        "alpha = 2.0, n = 1.5",
        "curve = [[0, 1, 1], [1, 0.05, 0.1]]",
        "material.clay.retention.curve",
        "E0509 .. 0.05",
    ),
    row(
        "bulk     = \"2.2 GPa\"",
        "suction = \"20 kPa\"",
        "water.suction",
        "E0504",
    ),
    row("bulk     = \"2.2 GPa\"", "bulk = 0", "water.bulk", "bulk > 0"),
    row(
        "bulk     = \"2.2 GPa\"",
        "bulk = \"2.2 m\"",
        "water.bulk",
        "expected a stress",
    ),
    // Drains and inflows.
    row("face    = \"bottom\"", "face    = \"top\"", "drain.0.face", "E0516"),
    row("face    = \"bottom\"", "surface = false", "drain.0.surface", "E0514"),
    row(
        "face    = \"bottom\"\n",
        "",
        "drain.0",
        "the keys face, from, circle, surface",
    )
    .up(2),
    row(
        "face    = \"bottom\"",
        "circle  = { centre = [2.0, 2.0], radius = 9.0 }",
        "drain.0.circle",
        "E0201",
    ),
    row(
        "face    = \"bottom\"",
        "circle  = { centre = [2.0, 2.0], radius = 1.5 }",
        "drain.0.circle",
        "E0401",
    ),
    row("head    = \"3 m\"", "head = 3\npressure = 0", "drain.0.pressure", "").down(1),
    row(
        "head    = \"3 m\"",
        "head = \"3 kPa\"",
        "drain.0.head",
        "expected a length",
    ),
    row(
        "from      = [2.0, 1.0]",
        "from = [0.5, 3.0]",
        "drain.1.from",
        "E0510 .. `tight`",
    ),
    row("from      = [2.0, 1.0]", "from = [2.0, 3.5]", "drain.1.from", "E0401"),
    row(
        "[\"30 d\", 3.0]",
        "[\"0 d\", 3.0]",
        "drain.1.head_path",
        "E0402 .. t = 0",
    ),
    row(
        "surface  = true",
        "name = \"base\"\nsurface = true",
        "drain.2.name",
        "E0421 .. `base`",
    ),
    row("seepage = true", "seepage = false", "drain.2.seepage", "E0514"),
    row("head    = \"3 m\"", "seepage = true", "drain.0.seepage", "E0515"),
    row("seepage = true", "seepage = true\nhead = 2", "drain.2.seepage", "E0016"),
    row("seepage = true", "head = 2", "inflow.0", "E0531").down(15),
    row(
        "circle = { centre = [4.0, 0.0], radius = 1.0 }",
        "face = \"bottom\"",
        "drain.4",
        "E0530",
    )
    .up(1),
    row("face = \"right\"", "face = \"top\"", "inflow.2.face", "E0516"),
    row(
        "[\"30 d\", \"5 kPa\"]",
        "[\"30 d\", \"5 m\"]",
        "drain.5.pressure_path",
        "expected a stress",
    ),
    row(
        "rate = \"10 mm/h\"",
        "rate = \"10 mm\"",
        "inflow.0.rate",
        "expected a velocity",
    ),
    row("rate = \"10 mm/h\"\n", "", "inflow.0", "the keys rate, rate_path").up(4),
    row(
        "to   = [4.0, 2.0]\nrate = ",
        "to = [4.0, 9.0]\nrate = ",
        "inflow.0.to",
        "outside the grid",
    ),
    // Histories.
    row(
        "drain    = \"base\"",
        "drain = \"bas\"",
        "history.1.drain",
        "E0518 .. did you mean `base`?",
    ),
    row(
        "face     = \"bottom\"\nname",
        "face = \"top\"\nname",
        "history.2.face",
        "E0518",
    ),
    row(
        "quantity = \"water-balance\"",
        "quantity = \"flux\"",
        "history.3.at",
        "E0644",
    )
    .up(1),
    // What acts.
    row(
        "right  = \"roller\"",
        "right = \"contact\"",
        "boundary.right",
        "E0540 .. \"contact\"",
    ),
    row(
        "right  = \"roller\"",
        "right = \"outflow\"",
        "boundary.right",
        "E0540 .. \"outflow\"",
    ),
    row(
        "[solver]",
        "[strength_reduction]\nfactor = 1.2\n[solver]",
        "strength_reduction",
        "E0543",
    ),
    row(
        "[solver]",
        "[strength_reduction]\nfactor = 1.2\nstage = \"end\"\ndrainage = \"coupled\"\n[solver]",
        "strength_reduction.drainage",
        "\"drained\", \"undrained\"",
    )
    .down(3),
    row(
        "[solver]",
        "[strength_reduction]\nfactor = 1.2\nstage = \"end\"\nstiffness = 3\n[solver]",
        "strength_reduction.stiffness",
        "E0638",
    )
    .down(3),
    row(
        "dt     = \"1 h\"",
        "dt     = 0.1",
        "analysis.dt",
        "6.312e9 steps until the end of the analysis (at most 1e9)",
    ),
    row(
        "[solver]",
        "[[stage]]\nat = \"1 day\"\nboundary = { left = \"fixed\" }\n[solver]",
        "stage.0.boundary",
        "E0540 .. a change of the boundary",
    )
    .down(2),
    row(
        "type   = \"consolidation\"\nend    = \"20 year\"\ndt     = \"1 h\"\ngrowth = 1.2\ndt_max = \"60 d\"",
        "type = \"dynamic\"\nend = 1.0\ndt = 0.1\n[[stage]]\nat = 0.5\nadd = [\"fill\"]",
        "stage.0.add",
        "E0540 .. placement of bodies",
    )
    .down(5),
    row(
        "[solver]",
        "[[body]]\nname = \"lift\"\nmaterial = \"clay\"\nbox = { lower = [2.0, 2.0], upper = [4.0, 3.0] }\n\
         points_per_cell = 3\n[[drain]]\nfrom = [2.5, 3.0]\nto = [4.0, 3.0]\n\
         [[stage]]\nat = \"1 day\"\nadd = [\"lift\"]\n[solver]",
        "drain.0.from",
        "E0511",
    )
    .down(6),
    row(
        "[solver]",
        "[[stage]]\nat = \"1 day\"\nactivate = [\"rai\"]\n[solver]",
        "stage.0.activate",
        "E0612",
    )
    .down(2),
    row(
        "[solver]",
        "[[stage]]\nat = \"1 day\"\ndeactivate = [\"base\"]\n[[stage]]\nat = \"2 day\"\ndeactivate = \
         [\"base\"]\n[solver]",
        "stage.1.deactivate",
        "E0619",
    )
    .down(5),
    row(
        "[solver]",
        "[[stage]]\nat = \"1 day\"\nstrength_reduction = 1.2\n[solver]",
        "stage.0.strength_reduction",
        "E0540 .. a strength reduction in a stage",
    )
    .down(2),
    row(
        "type   = \"consolidation\"\nend    = \"20 year\"\ndt     = \"1 h\"\ngrowth = 1.2\ndt_max = \"60 d\"",
        "type = \"dynamic\"\nend = 1.0\ndt = 0.1\n[shaking]\nacceleration = [[0.5, 1.0, 0.0]]",
        "shaking",
        "E0540 .. [shaking]",
    )
    .down(3),
];

/// Words of water that flows in a case without any.
pub const WITHOUT_FLOW: &[Row] = &[
    row(
        "type  = \"quasi-static\"\nend   = 1.0",
        "type = \"consolidation\"\nend = 1.0",
        "analysis.type",
        "E0501",
    ),
    row("[output]", "[[drain]]\nsurface = true\n[output]", "drain.0", "E0501"),
    row(
        "[output]",
        "[water]\nbulk = 2e9\nlevel = 1\n[output]",
        "water.bulk",
        "E0501",
    )
    .down(1),
    row(
        "poisson = 0.3",
        "poisson = 0.3\nporosity = 0.4",
        "material.soil.porosity",
        "E0506",
    )
    .down(1),
    row(
        "poisson = 0.3",
        "poisson = 0.3\ndrainage = \"coupled\"\nporosity = 0.4\npermeability = 1e-9",
        "analysis.type",
        "E0502 .. \"quasi-static\"",
    )
    .up(13),
    row(
        "[output]",
        "[[history]]\nquantity = \"water-balance\"\n[output]",
        "history.0.quantity",
        "E0646",
    )
    .down(1),
    row(
        "every = 0.5",
        "every = 0.5\nfields = [\"flux\"]",
        "output.fields",
        "E0501 .. \"flux\"",
    )
    .down(1),
];
