//! Rows about water that flows.

use super::{Row, row};

const TYPE: &str = "type   = \"consolidation\"";
const CLAY: &str = "model            = \"elastic\"";

const CURVE: &str = "curve = [[0, 1, 1], [1, 0.5, 0.1], [2, 0.4, 0.2]]";

/// Time, splines, soils, drains and inflows, and what is not shown to be right with them.
pub const FLOW: &[Row] = &[
    // Time.
    row(TYPE, "type = \"consolidate\"", "analysis.type", "did you mean `consolidation`?"),
    row(TYPE, "type = \"dynamic\"", "analysis.growth", "steps grow in a consolidation analysis only").down(3),
    row("end    = \"20 year\"\n", "", "analysis.end", "missing; a consolidation analysis needs its end").up(2),
    row("dt     = \"1 h\"", "steps = 100", "analysis.growth", "give dt, the first one").down(1),
    row("growth = 1.2", "growth = 0.9", "analysis.growth", "1 <= growth <= 10"),
    row("dt_max = \"60 d\"", "dt_max = \"1 min\"", "analysis.dt_max", "allowed: dt_max >= dt = 3600"),
    row("dt_max = \"60 d\"", "dt_max = \"60 daz\"", "analysis.dt_max", "did you mean `day`?"),
    // Splines, points, averages, iterations.
    row("degree = \"quadratic\"", "degree = \"linear\"", "grid.degree", "no gradient: take \"quadratic\""),
    row("degree = \"quadratic\"", "degree = \"cubic\"", "body.0.points_per_cell", "3 with cubic splines").down(29),
    row("\"consistent-f-bar\"", "\"subgrid-f-bar\"", "stabilisation.method", "take \"consistent-f-bar\""),
    row("\"auto\"", "\"broyden\"", "solver.nonlinear", "take \"auto\""),
    row("nonlinear = \"auto\"", "quadrature = \"fitted\"", "solver.quadrature", "take \"points\""),
    // Soils.
    row("porosity         = 0.6\n", "", "material.clay.porosity", "drainage = \"coupled\" needs it").up(5),
    row("permeability     = \"1e-9 m/s\"\n", "", "material.clay.permeability", "needs it").up(6),
    row("permeability     = \"1e-9 m/s\"", "permeability = \"1e-9 m\"", "material.clay.permeability", "a velocity"),
    row("permeability     = \"1e-9 m/s\"", "permeability = [1e-9, -1e-9]", "material.clay.permeability", "> 0"),
    row("porosity         = 0.6", "porosity = 60", "material.clay.porosity", "0 < porosity < 1"),
    row("porosity = 0.5", "porosity = 0.5\npermeability = 1e-9", "material.tight.permeability", "no meaning").down(1),
    row(
        "drainage = \"undrained\"",
        "drainage = \"drained\"",
        "material.tight.drainage",
        "soil that drains in time is \"coupled\"",
    ),
    row(
        CLAY,
        "model = \"modified-cam-clay\"\nkappa_star = 0.02\nlambda_star = 0.1\ncritical_state_ratio = 1\npreconsolidation = 1e5",
        "material.clay.model",
        "not shown to be right",
    ),
    row("alpha = 2.0", "alpha = 0", "material.clay.retention.alpha", "alpha > 0"),
    row("n = 1.5", "n = 1", "material.clay.retention.n", "1.05 <= n <= 20"),
    row("residual = 0.1", "residual = 1", "material.clay.retention.residual", "0 <= residual < 1"),
    row(
        "porosity = 0.5",
        "porosity = 0.5\nretention = { alpha = 1, n = 2 }",
        "material.tight.retention",
        "no meaning with drainage",
    )
    .down(1),
    row("alpha = 2.0, n = 1.5", "alpha = 2.0", "material.clay.retention.alpha", "goes with n"),
    row("alpha = 2.0", "curve = [[0, 1, 1], [1, 0.5, 0.1]]", "material.clay.retention.n", "no meaning with a curve"),
    row(
        "alpha = 2.0, n = 1.5",
        CURVE,
        "material.clay.retention.curve",
        "at the suction of 2 m it keeps or conducts more",
    ),
    row("alpha = 2.0, n = 1.5", "curve = [[0, 1, 1]]", "material.clay.retention.curve", "two rows at least"),
    row("alpha = 2.0, n = 1.5", "curve = [[1, 1, 1], [2, 0.5, 0.1]]", "material.clay.retention.curve", "[0, 1, 1]"),
    row(
        "alpha = 2.0, n = 1.5",
        "curve = [[0, 1, 1], [0, 0.5, 0.1]]",
        "material.clay.retention.curve",
        "is not above 0",
    ),
    row("alpha = 2.0, n = 1.5", "curve = [[0, 1, 1], [1, 0.05, 0.1]]", "material.clay.retention.curve", "residual"),
    row("bulk     = \"2.2 GPa\"", "suction = \"20 kPa\"", "water.suction", "is that above a level"),
    row("bulk     = \"2.2 GPa\"", "bulk = 0", "water.bulk", "bulk > 0"),
    row("bulk     = \"2.2 GPa\"", "bulk = \"2.2 m\"", "water.bulk", "expected a stress"),
    // Drains and inflows.
    row("face    = \"bottom\"", "face    = \"top\"", "drain.0.face", "no body of permeable soil lies at the face"),
    row("face    = \"bottom\"", "surface = false", "drain.0.surface", "give face, from and to, circle, or true"),
    row("face    = \"bottom\"\n", "", "drain.0", "one of face, from, circle, surface").up(2),
    row(
        "face    = \"bottom\"",
        "circle  = { centre = [2.0, 2.0], radius = 9.0 }",
        "drain.0.circle",
        "no part of it is inside the grid",
    ),
    row("face    = \"bottom\"", "circle  = { centre = [2.0, 2.0], radius = 1.5 }", "drain.0.circle", "no body is at"),
    row("head    = \"3 m\"", "head = 3\npressure = 0", "drain.0.pressure", "").down(1),
    row("head    = \"3 m\"", "head = \"3 kPa\"", "drain.0.head", "expected a length"),
    row("from      = [2.0, 1.0]", "from = [0.5, 3.0]", "drain.1.from", "lets no water through"),
    row("from      = [2.0, 1.0]", "from = [2.0, 3.5]", "drain.1.from", "no body is at"),
    row("[\"30 d\", 3.0]", "[\"0 d\", 3.0]", "drain.1.head_path", "t = 0 is not above 0"),
    row("surface  = true", "name = \"base\"\nsurface = true", "drain.2.name", "there is a drain `base` already"),
    row("seepage = true", "seepage = false", "drain.2.seepage", "give true, or leave it out"),
    row("head    = \"3 m\"", "seepage = true", "drain.0.seepage", "a face of the grid lets water both ways"),
    row(
        "seepage = true",
        "seepage = true\nhead = 2",
        "drain.2.seepage",
        "only one of head, head_path, pressure, pressure_path, seepage may be",
    ),
    row("seepage = true", "head = 2", "inflow.0", "what is put in leaves there at once").down(15),
    row("circle = { centre = [4.0, 0.0], radius = 1.0 }", "face = \"bottom\"", "drain.4", "gives another pressure")
        .up(1),
    row("face = \"right\"", "face = \"top\"", "inflow.2.face", "no body of permeable soil lies at the face"),
    row("[\"30 d\", \"5 kPa\"]", "[\"30 d\", \"5 m\"]", "drain.5.pressure_path", "expected a stress"),
    row("rate = \"10 mm/h\"", "rate = \"10 mm\"", "inflow.0.rate", "expected a velocity"),
    row("rate = \"10 mm/h\"\n", "", "inflow.0", "one of rate, rate_path").up(4),
    row("to   = [4.0, 2.0]\nrate = ", "to = [4.0, 9.0]\nrate = ", "inflow.0.to", "outside the grid"),
    // Histories.
    row("drain    = \"base\"", "drain = \"bas\"", "history.1.drain", "did you mean `base`?"),
    row("face     = \"bottom\"\nname", "face = \"top\"\nname", "history.2.face", "there is no such [[drain]]"),
    row("quantity = \"water-balance\"", "quantity = \"flux\"", "history.3.at", "missing").up(1),
    // What acts.
    row("right  = \"roller\"", "right = \"contact\"", "boundary.right", "faces in contact are not shown"),
    row("right  = \"roller\"", "right = \"outflow\"", "boundary.right", "\"outflow\" is not shown"),
    row("[solver]", "[strength_reduction]\nfactor = 1.2\n[solver]", "strength_reduction", "is not shown to be right"),
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
        "it would hold from the first step on",
    )
    .down(3),
    row("dt     = \"1 h\"", "dt     = 0.1", "analysis.dt", "6.312e9 steps of dt to the end; at most 1e9"),
    row(
        "[solver]",
        "[[stage]]\nat = \"1 day\"\nboundary = { left = \"fixed\" }\n[solver]",
        "stage.0.boundary",
        "faces that change are not shown",
    )
    .down(2),
    row(
        "type   = \"consolidation\"\nend    = \"20 year\"\ndt     = \"1 h\"\ngrowth = 1.2\ndt_max = \"60 d\"",
        "type = \"dynamic\"\nend = 1.0\ndt = 0.1\n[[stage]]\nat = 0.5\nadd = [\"fill\"]",
        "stage.0.add",
        "bodies that are placed while all moves are not shown",
    )
    .down(5),
    row(
        "[solver]",
        "[[body]]\nname = \"lift\"\nmaterial = \"clay\"\nbox = { lower = [2.0, 2.0], upper = [4.0, 3.0] }\n\
         points_per_cell = 3\n[[drain]]\nfrom = [2.5, 3.0]\nto = [4.0, 3.0]\n\
         [[stage]]\nat = \"1 day\"\nadd = [\"lift\"]\n[solver]",
        "drain.0.from",
        "when it begins to act, at the start unless a stage applies it",
    )
    .down(6),
    row(
        "[solver]",
        "[[stage]]\nat = \"1 day\"\nactivate = [\"rai\"]\n[solver]",
        "stage.0.activate",
        "[[drain]], [[inflow]] or [footing] with name = \"rai\"; did you mean `rain`?",
    )
    .down(2),
    row(
        "[solver]",
        "[[stage]]\nat = \"1 day\"\ndeactivate = [\"base\"]\n[[stage]]\nat = \"2 day\"\ndeactivate = [\"base\"]\n[solver]",
        "stage.1.deactivate",
        "base does not act, by a stage before",
    )
    .down(5),
    row(
        "[solver]",
        "[[stage]]\nat = \"1 day\"\nstrength_reduction = 1.2\n[solver]",
        "stage.0.strength_reduction",
        "strength that changes while water flows is not shown",
    )
    .down(2),
    row(
        "type   = \"consolidation\"\nend    = \"20 year\"\ndt     = \"1 h\"\ngrowth = 1.2\ndt_max = \"60 d\"",
        "type = \"dynamic\"\nend = 1.0\ndt = 0.1\n[shaking]\nacceleration = [[0.5, 1.0, 0.0]]",
        "shaking",
        "ground that shakes is not shown to be right with water that flows",
    )
    .down(3),
];

/// Words of water that flows in a case without any.
pub const WITHOUT_FLOW: &[Row] = &[
    row(
        "type  = \"quasi-static\"\nend   = 1.0",
        "type = \"consolidation\"\nend = 1.0",
        "analysis.type",
        "no water flows",
    ),
    row("[output]", "[[drain]]\nsurface = true\n[output]", "drain.0", "no material lets water flow"),
    row("[output]", "[water]\nbulk = 2e9\nlevel = 1\n[output]", "water.bulk", "no material is \"coupled\"").down(1),
    row("poisson = 0.3", "poisson = 0.3\nporosity = 0.4", "material.soil.porosity", "no meaning with drainage").down(1),
    row(
        "poisson = 0.3",
        "poisson = 0.3\ndrainage = \"coupled\"\nporosity = 0.4\npermeability = 1e-9",
        "analysis.type",
        "water flows in real time",
    )
    .up(13),
    row("[output]", "[[history]]\nquantity = \"water-balance\"\n[output]", "history.0.quantity", "no material is")
        .down(1),
    row("every = 0.5", "every = 0.5\nfields = [\"flux\"]", "output.fields", "no water flows").down(1),
];

/// More rain than the ground takes, and walls and gaps that are thinner than the pressure's functions.
#[test]
fn rain_that_lifts_and_walls_that_leak_are_warned_of() {
    let case = |changes: &[(&str, &str)]| {
        let text =
            changes.iter().fold(include_str!("seeping.toml").to_owned(), |text, (was, is)| text.replace(was, is));
        bsmpm_scene::Case::from_text("case.toml", &text, &[]).expect("a valid case").warnings
    };
    let reports = |warnings: &[String], of: &str| warnings.iter().any(|warning| warning.contains(of));
    let (lifts, gap, wall) = ("inflow.0: 2.7", "a gap between bodies", "material.tight: a wall of it");
    let whole = case(&[]);
    assert!(![lifts, gap, wall].into_iter().any(|of| reports(&whole, of)), "{whole:?}");
    assert!(reports(&case(&[("runoff = true\n", "")]), lifts));
    let steep = [("alpha = 2.0", "alpha = 100.0")];
    assert!(reports(&case(&steep), "100 times less than a cell") && !reports(&whole, "times less than a cell"));
    let clay = "box = { lower = [0.0, 0.0], upper = [4.0, 2.0] }\npoints_per_cell = 3\n";
    let apart = |x: f64| {
        format!(
            "box = {{ lower = [0.0, 0.0], upper = [1.0, 2.0] }}\npoints_per_cell = 3\n[[body]]\nmaterial = \"clay\"\n\
             box = {{ lower = [{x}, 0.0], upper = [4.0, 2.0] }}\npoints_per_cell = 3\n"
        )
    };
    assert!(reports(&case(&[(clay, &apart(1.5))]), gap));
    let held = apart(1.5)
        + "[[body]]\nmaterial = \"tight\"\nbox = { lower = [1.0, 0.0], upper = [1.5, 2.0] }\npoints_per_cell = 3\n";
    assert!(reports(&case(&[(clay, &held)]), wall));
    let finer = ("cell  = \"1 m\"", "cell = 0.25");
    assert!(!reports(&case(&[(clay, &held), finer]), wall) && !reports(&case(&[(clay, &apart(1.5)), finer]), gap));
}

/// Ground above the water table that stays full, and a step of the table that no point may see.
#[test]
fn water_that_hangs_and_steps_that_are_narrow_are_warned_of() {
    let case = |water: &str, more: &str| {
        let text = include_str!("../../../../cases/rapid_drawdown.toml")
            .replace("level_path = [[\"0 d\", 15.0], [\"10 d\", 5.0]]", water)
            .replace("permeability   = \"1e-9 m/s\"", &format!("permeability = \"1e-9 m/s\"\n{more}"));
        bsmpm_scene::Case::from_text("case.toml", &text, &[]).expect("a valid case").warnings
    };
    let reports = |warnings: &[String], of: &str| warnings.iter().any(|warning| warning.contains(of));
    let hangs = "up to 5.00 m of it are above the water table";
    assert!(reports(&case("level = 10.0", ""), hangs));
    assert!(!reports(&case("level = 15.0", ""), "above the water table"));
    let retention = "retention = { alpha = 0.1, n = 2.0, residual = 0.1 }";
    assert!(!reports(&case("level = 10.0", retention), "above the water table"));
    let step = |width: f64| format!("line = [[0, 15], [30, 15], [{}, 5], [60, 5]]", 30.0 + width);
    assert!(reports(&case(&step(0.5), retention), "from x = 30 to 30.5 is narrower than a cell, 1"));
    assert!(!reports(&case(&step(2.0), retention), "narrower than a cell"));
}

/// The flux in the cell of a surface, where it jumps; deeper it does not.
#[test]
fn a_flux_next_to_a_surface_is_warned_of() {
    let case = |at: &str| {
        let text = include_str!("../../../../cases/rapid_drawdown.toml").to_owned();
        let text = text + &format!("\n[[history]]\nquantity = \"flux\"\nat = {at}\n");
        bsmpm_scene::Case::from_text("case.toml", &text, &[]).expect("a valid case").warnings
    };
    let reports =
        |warnings: &[String]| warnings.iter().any(|warning| warning.contains("less than a cell from a surface"));
    assert!(reports(&case("[10.0, 14.2]")) && reports(&case("[29.8, 9.6]")));
    assert!(!reports(&case("[10.0, 13.5]")) && !reports(&case("[0.1, 0.1]")), "a face of the grid is no surface");
}

/// Ground one cell across under a load of half its stiffness, of which averages leave a way to go sideways.
#[test]
fn ground_one_cell_across_under_a_large_load_is_warned_of() {
    let case = |more: &[(&str, &str)]| {
        let text = include_str!("../../../../cases/validation/large_consolidation.toml").to_owned();
        let text = more.iter().fold(text, |text, (from, to)| text.replace(from, to));
        bsmpm_scene::Case::from_text("case.toml", &text, &[]).expect("a valid case").warnings
    };
    let reports = |warnings: &[String]| warnings.iter().any(|warning| warning.contains("one cell across"));
    let narrow = [("[0.1, 1.0]", "[0.05, 1.0]"), ("at       = [0.05, 1.0]", "at       = [0.025, 1.0]")];
    assert!(reports(&case(&narrow)) && !reports(&case(&[])));
    assert!(!reports(&case(&[&narrow[..], &[("consistent-f-bar", "none")]].concat())));
    assert!(!reports(&case(&[&narrow[..], &[("-500 kPa", "-200 kPa")]].concat())));
}
