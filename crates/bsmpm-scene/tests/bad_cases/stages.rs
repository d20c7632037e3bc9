//! Invalid stages.

use super::{Row, row};

/// Stages: bodies that come and go.
pub const STAGES: &[Row] = &[
    row(
        "add  = [\"fill\"]",
        "add = [\"fil\"]",
        "stage.0.add",
        "did you mean `fill`?",
    ),
    row(
        "add  = [\"fill\"]",
        "add = \"fill\"",
        "stage.0.add",
        "expected a list of names",
    ),
    row("add  = [\"fill\"]", "add = []", "stage.0", "E0611").up(3),
    row(
        "add  = [\"fill\"]",
        "add = [\"fill\", \"fill\"]",
        "stage.0.add",
        "E0622",
    ),
    row(
        "remove = [\"fill\"]",
        "remove = [\"fill\", \"fill\"]",
        "stage.1.remove",
        "E0622",
    ),
    row(
        "add  = [\"fill\"]",
        "add = [\"fill\"]\nremove = [\"fill\"]",
        "stage.0.remove",
        "E0622",
    )
    .down(1),
    row(
        "add  = [\"fill\"]",
        "activate = [\"fill\"]",
        "stage.0.activate",
        "E0612",
    ),
    row(
        "add  = [\"fill\"]",
        "activate = [\"plough\"]",
        "stage.0.activate",
        "E0624",
    ),
    row(
        "add  = [\"fill\"]",
        "activate = [\"pipe\"]",
        "rigid.1.start_velocity",
        "E0430",
    )
    .down(47),
    row(
        "add  = [\"fill\"]",
        "materials = [{ from = \"sand\", to = \"clai\" }]",
        "stage.0.materials.0.to",
        "did you mean `clay`?",
    ),
    row(
        "add  = [\"fill\"]",
        "materials = [{ from = \"sand\" }]",
        "stage.0.materials.0.to",
        "missing",
    ),
    row(
        "add  = [\"fill\"]",
        "strength_reduction = 0.05",
        "stage.0.strength_reduction",
        "0.1 <= strength_reduction <= 100",
    ),
    row(
        "factor = 1.25",
        "factor = 1.25\nstage = \"filled\"",
        "strength_reduction.stage",
        "needs a quasi-static",
    )
    .down(1),
    row(
        "factor = 1.25",
        "factor = 1.25\nstage = \"end\"\ndrainage = \"undrained\"",
        "strength_reduction.drainage",
        "E0637",
    )
    .down(2),
    row(
        "factor = 1.25",
        "factor = 1.25\nsteps = 5",
        "strength_reduction.steps",
        "E0631",
    )
    .down(1),
    row(
        "factor = 1.25",
        "factor = 1.25\ndrainage = \"undrained\"",
        "strength_reduction.drainage",
        "E0631",
    )
    .down(1),
    row(
        "factor = 1.25",
        "factor = 1.25\nsteps = 1001",
        "strength_reduction.steps",
        "0 <= steps <= 1000",
    )
    .down(1),
    row("at     = \"500 ms\"", "at = 0.25", "stage.1.at", "E0621"),
    row("at     = \"500 ms\"", "at = \"1 s\"", "stage.1.at", "E0620"),
    row("at   = \"0.25 s\"", "at = 0", "stage.0.at", "E0010"),
    row(
        "name     = \"fill\"",
        "name = \"a b\"",
        "body.5.name",
        "expected a name",
    ),
    row(
        "[[stage]]\nname",
        "[[body]]\nname = \"fill\"\nmaterial = \"clay\"\npoints_per_cell = 2\nbox = { lower = \
        [3.5, 2.7], upper = [3.8, 2.9] }\n[[stage]]\nname",
        "body.6.name",
        "E0610",
    )
    .down(1),
];

/// The quasi-static base has one body only.
pub const STAGES_OF_ONE: &[Row] = &[
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\nname = \"all\"\n[[stage]]\nat = 0.5\nremove = [\"all\"]",
        "stage.0.remove",
        "E0623",
    )
    .down(4),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[stage]]\nat = 0.5\nactivate = [\"wall\"]\n\
         [[rigid]]\nname = \"wall\"\npolygon = [[1, 0], [1.5, 0], [1.5, 2], [1, 2]]",
        "rigid.0.polygon",
        "E0431 .. body.0 .. when a stage adds the rigid body at t = 0.5",
    )
    .down(6),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[stage]]\nat = 0.5\nactivate = [\"lid\"]\n[[rigid]]\nname = \"lid\"\n\
         polygon = [[0, 1], [2, 1], [2, 2], [0, 2]]\n[[point_load]]\nname = \"lid\"\nat = [1.0, 0.5]\nforce = [0, -1]",
        "stage.0.activate",
        "E0610",
    )
    .down(3),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\nname = \"all\"\n[[stage]]\nat = 0.5\nadd = [\"all\"]",
        "body",
        "E0623",
    )
    .up(3),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\nname = \"top\"\n[[body]]\nmaterial = \"soil\"\npoints_per_cell = 2\n\
         box = { lower = [0.0, 1.0], upper = [2.0, 2.0] }\n[[stage]]\nat = 0.5\nremove = [\"top\"]\n\
         [[point_load]]\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0",
        "point_load.0.at",
        "E0626",
    )
    .down(10),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\nactivate = [\"push\"]\ndeactivate = [\"push\"]",
        "stage.0.activate",
        "E0618",
    )
    .down(8),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\nactivate = [\"push\"]\n[[stage]]\nat = 0.75\nactivate = [\"push\"]",
        "stage.1.activate",
        "E0619",
    )
    .down(11),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\ndeactivate = [\"push\"]\n[[stage]]\nat = 0.75\ndeactivate = [\"push\"]",
        "stage.1.deactivate",
        "E0619",
    )
    .down(11),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\nreset_displacements = true\n\
         [[point_load]]\nname = \"push\"\nat = [0.5, 0.5]\nforce = [0, -1]",
        "point_load.1.name",
        "E0610",
    )
    .down(10),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\nmaterials = [{ from = \"heavy\", to = \"soil\" }]\n\
         [material.heavy]\nmodel = \"elastic\"\nyoung = 1e6\npoisson = 0.3",
        "stage.0.materials.0.from",
        "E0613",
    )
    .down(8),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\nmaterials = [{ from = \"soil\", to = \"heavy\" }]\n\
         [material.heavy]\nmodel = \"elastic\"\nyoung = 1e6\npoisson = 0.3\nunit_weight = 2e4",
        "stage.0.materials.0.to",
        "differ in density",
    )
    .down(8),
    row(
        "points_per_cell = 3",
        "points_per_cell = 3\n[[point_load]]\nname = \"push\"\nat = [1.0, 0.5]\nforce = [0, -1]\nramp = 1.0\n\
         [[stage]]\nat = 0.5\nmaterials = [{ from = \"soil\", to = \"soft\" }]\n\
         [material.soft]\nmodel = \"modified-cam-clay\"\nkappa_star = 0.02\nlambda_star = 0.1\ncritical_state_ratio = \
         1\n\
         ocr = 1.5\nyoung = 1e6\npoisson = 0.3",
        "stage.0.materials.0.to",
        "E0625",
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
        "E0634",
    )
    .down(2),
    row(
        "[output]",
        "[strength_reduction]\nfactor = 1.2\nstage = \"pressed\"\n[[stage]]\nat = 0.25\nname = \"pressed\"\n\
         reset_displacements = true\n[[stage]]\nat = 0.5\nreset_displacements = true\n\
         [[prescribed]]\nfrom = [0, 1]\nto = [2, 1]\npath = [[1.0, 0, -0.01]]\n[output]",
        "strength_reduction.stage",
        "E0636",
    )
    .down(2),
    row(
        "[output]",
        "[strength_reduction]\nfactor = 1.2\nstage = \"end\"\n[[point_load]]\nat = [1.0, 0.5]\nforce = [0, -1]\n\
         amplitude = [[2.0, 1.0]]\n[output]",
        "strength_reduction.stage",
        "E0636",
    )
    .down(2),
    row(
        "[output]",
        "[strength_reduction]\nfactor = 1.2\nstage = \"end\"\n[[rigid]]\nname = \"block\"\nfree = [\"y\"]\n\
         polygon = [[0.5, 1], [1.5, 1], [1, 2]]\nforce = [0, -1]\nramp = 2.0\n[output]",
        "strength_reduction.stage",
        "E0636",
    )
    .down(2),
    row(
        "[output]",
        "[strength_reduction]\nfactor = 1.2\nstage = \"end\"\n[[stage]]\nat = 0.5\nstrength_reduction = 1.1\n[output]",
        "strength_reduction.stage",
        "E0635",
    )
    .down(2),
    row(
        "[material.soil]\nmodel   = \"elastic\"",
        "[gravity]\nacceleration = [0, -9.81]\n[initial]\nk0 = 0.6\n[[stage]]\nat = 0.5\nstrength_reduction = 1.1\n\
         [material.soil]\nunit_weight = 2e4\nkappa_star = 0.02\nlambda_star = 0.1\ncritical_state_ratio = 1\nocr = 1.5\n\
         model = \"modified-cam-clay\"",
        "stage.0.strength_reduction",
        "E0630",
    )
    .down(6),
    row(
        "[output]",
        "[[body]]\nname = \"fill\"\nmaterial = \"soil\"\npoints_per_cell = 3\nbox = { lower = [0, 1], upper = [2, \
         1.5] }\n\
         [[stage]]\nat = 0.5\nadd = [\"fill\"]\n[[traction]]\nfrom = [0, 1]\nto = [2, 1]\npressure = 1e3\n[output]",
        "traction.0.pressure",
        "E0252: traction.0.pressure: at t = 0.5",
    )
    .down(11),
    row(
        "[output]",
        "[[stage]]\nat = 0.5\nboundary = { right = \"roller\" }\n[[history]]\nquantity = \"reaction\"\nface = \
         \"right\"\n\
         name = \"held\"\n[[history]]\nquantity = \"reaction\"\nface = \"left\"\n[output]",
        "history.1.face",
        "E0646",
    )
    .down(9),
];
