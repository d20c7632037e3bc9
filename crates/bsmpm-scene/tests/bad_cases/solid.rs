//! Invalid 3-D cases, and 3-D keys in plane cases.

use super::{Row, row};

const BOX: &str = "box = { lower = [0.0, 0.0, 0.0], upper = [2.0, 3.0, 1.0] }";

const LOADED: &str = "rectangle = { lower = [0.5, 1.0, 1.0], upper = [1.5, 2.0, 1.0] }";

const PLATE: &str = "rectangle    = { lower = [0.5, 2.0, 1.0], upper = [1.5, 3.0, 1.0] }";

const SECTION: &str = "rectangle = { lower = [0.0, 0.0, 0.5], upper = [1.5, 3.0, 0.5] }";

const BALL: &str = "sphere = { centre = [3.5, 0.5, 2.0], radius = 0.25 }";

const FORCE: &str = "force = [\"1 N\", 0.0, 0.0]";

const BASE: &str = "base = [[2, 0, 1], [3, 0, 1], [2, 3, 1], [3, 3, 1]]";

const FLOWS: &str = "density = 2000\nporosity = 0.4\ndrainage = \"coupled\"\npermeability = [1e-6, 1e-7, 1e-6]\n\
    [water]\nlevel = 1.0\n[[drain]]\nsurface = true\n";
const PERMEABLE: &str = "density = 2000\nporosity = 0.4\ndrainage = \"coupled\"\npermeability = [1e-6, 1e-7]\n";

/// Changes of `solid.toml`.
pub const WET: &[Row] = &[
    row(
        "upper = [2.0, 3.0, 1.5] }\nseepage",
        "upper = [2.5, 3.0, 1.5] }\nseepage",
        "drain.0.rectangle",
        "E0234",
    ),
    row(
        "disc     = { centre = [1.0",
        "disc = { centre = [3.5",
        "drain.1.disc",
        "E0401",
    ),
    row(
        "upper = [1.0, 3.0, 1.5] }\nrate",
        "upper = [3.0, 3.0, 1.5] }\nrate",
        "inflow.0.rectangle",
        "E0401",
    ),
    row(
        "disc = { centre = [1.5, 1.0, 1.5], radius = 0.4 }",
        "from = [0, 0]\nto = [1, 0]",
        "inflow.1.from",
        "E0225",
    ),
    row(
        "rectangle = { lower = [2.0, 0.0, 0.0], upper = [2.0, 3.0, 1.5] }",
        "surface = true",
        "drain.0.surface",
        "E0225",
    ),
];

pub const SOLID: &[Row] = &[
    row(
        "lower = [0.0, 0.0, 0.0]",
        "lower = [0.0, 0.0]",
        "grid.lower",
        "three in 3-D",
    ),
    row(
        "cell  = [0.5, 1.0, 0.5]",
        "cell  = [0.5, 1.0]",
        "grid.cell",
        "three in 3-D",
    ),
    row(
        "upper = [4.0, 3.0, 3.0]",
        "upper = [4.0, 3.0, -1.0]",
        "grid.upper",
        "m along z. Exchange",
    ),
    row(
        "velocity = [0.0, 0.0, -1.0]",
        "velocity = [0.0, -1.0]",
        "body.0.velocity",
        "three in 3-D",
    ),
    row(
        "[0.0, 0.0, -9.81]",
        "[0.0, -9.81]",
        "gravity.acceleration",
        "three in 3-D",
    ),
    row(
        BOX,
        "box = { lower = [0.0, 0.0, 1.0], upper = [2.0, 3.0, 1.0] }",
        "body.0.box.upper",
        "is not above the lower corner",
    ),
    row(
        BOX,
        "box = { lower = [0.0, 0.0, 0.0], upper = [2.0, 3.0, 4.0] }",
        "body.0.box",
        "ends at z = 3",
    ),
    row(BOX, "polygon = [[0, 0], [1, 0], [0, 1]]", "body.0.polygon", "E0225"),
    row("radius = 0.7", "radius = 1.7", "body.1.extrude", "outside the grid"),
    row("to = 1.0 }\n", "to = 0.0 }\n", "body.1.extrude.to", "is not above from"),
    row(
        "along = \"z\"",
        "along = \"r\"",
        "body.1.extrude.along",
        "expected one of",
    ),
    row(
        "radius = 0.5 }\npoints",
        "radius = 1.5 }\npoints",
        "body.2.sphere",
        "outside the grid",
    ),
    row(
        "[[0.0, 1.0]",
        "[[-0.5, 1.0]",
        "body.3.revolve.polygon",
        "smallest radius is -0.5 m",
    ),
    row(
        "revolve = { polygon = [[0.0, 1.0], [0.8, 1.0], [0.0, 2.0]], about = [1.0, 1.5] }\n\
         subtract = [{ revolve = { circle = { centre = [0.4, 1.2], radius = 0.1 }, about = [1.0, 1.5] } }]\n",
        "revolve = { polygon = [[0.8, 1], [0.800000001, 1], [0.800000001, 2], [0.8, 2]], about = [1.0, 1.5] }\n",
        "body.3.revolve",
        "E0037",
    ),
    row(
        "level = 2.5",
        "level = 2.8",
        "body.4.terrain.top",
        "at x = 2 m, y = 0 m the top (2.75 m) is below the base (2.8 m)",
    ),
    row(
        "level = 2.5",
        "base = [[2, 0, 1]]",
        "body.4.terrain.base",
        "two points along x",
    ),
    row(
        "level = 2.5",
        BASE,
        "body.4.terrain.base",
        "heights at different points",
    ),
    row(
        "[4.0, 3.0, 2.75]]",
        "[3.5, 3.0, 2.75]]",
        "body.4.terrain.top",
        "do not form a regular grid of points",
    ),
    row(
        "[4.0, 3.0, 2.75]]",
        "[4.0, 3.0, 3.75]]",
        "body.4.terrain",
        "ends at z = 3",
    ),
    row(
        "  [5, 3, 4, 5, 5, 4, 7, 3, 4],",
        "  ",
        "body.5.surface.triangles",
        "not closed at 3 edges",
    )
    .up(1),
    row(
        "[5, 3, 4, 5, 5, 4, 7, 3, 4]",
        "[5, 3, 4, 5, 5, 4]",
        "body.5.surface.triangles",
        "a list of 6",
    ),
    row(
        "5, 3, 6, 5, 5, 4],\n], scale = 0.5",
        "5, 3, 6, 5, 5, 4],\n], scale = 0.7",
        "body.5.surface",
        "E0202",
    )
    .up(1),
    row(
        "5, 3, 6, 5, 5, 4],\n], scale = 0.5",
        "5, 3, 6, 5, 5, 4],\n], scale = 500",
        "body.5.surface",
        "reaches from [2500.000, 1500.000, 2000.000] to [3500.000, 2500.000, 3000.000] m",
    )
    .up(1),
    row(
        "left   = \"roller\"",
        "left   = \"absorbing\"",
        "boundary.left",
        "E0226",
    ),
    row(
        "back   = \"roller\"\nbottom = \"fixed\"",
        "back   = { friction_coefficient = 0.3 }\nbottom = { friction_coefficient = 0.3 }",
        "boundary.bottom",
        "share an edge",
    )
    .down(1),
    row(
        "\"consistent-f-bar\"",
        "\"subgrid-f-bar\"",
        "stabilisation.method",
        "E0226",
    ),
    row(
        "at = [1.0, 1.5, 1.0]",
        "at = [1.0, 1.5]",
        "history.0.at",
        "three in 3-D",
    ),
    row(
        "at = [1.0, 1.5, 1.0]",
        "at = [1.0, 3.5, 1.0]",
        "history.0.at",
        "is outside the grid",
    ),
    row(
        "lower = [0.0, 0.5, 0.0]",
        "lower = [0.0, 0.5]",
        "history.6.box.lower",
        "three in 3-D",
    ),
    row(
        "lower = [0.0, 0.5, 0.0]",
        "lower = [0.0, 1.5, 0.0]",
        "history.6.box.upper",
        "the box is empty",
    ),
    row(
        "lower = [0.0, 0.5, 0.0], upper = [2.0",
        "lower = [5.0, 0.5, 0.0], upper = [6.0",
        "history.6.box",
        "outside the grid",
    ),
    row(
        "from  = [1.0, 1.5, 1.0]",
        "from  = [1.0, 1.5]",
        "profile.0.from",
        "three in 3-D",
    ),
    row(
        "rectangle = { lower = [0.0, 0.0, 0.5]",
        "# { lower = [0.0, 0.0, 0.5]",
        "history.4",
        "E0644",
    )
    .up(2),
    row(SECTION, "from = [0, 1]\nto = [1, 1]", "history.4.from", "E0642"),
    row(
        SECTION,
        "rectangle = { lower = [0, 0, 0.5], upper = [1, 3, 0.6] }",
        "history.4.rectangle",
        "E0234",
    ),
    row(
        SECTION,
        "rectangle = { lower = [0, 0, 0.5], upper = [1, 4, 0.5] }",
        "history.4.rectangle",
        "ends at y = 3",
    ),
    row(
        "disc     = { centre = [3.0",
        "rectangle = { lower = [0, 0, 0], upper = [1, 1, 0] }\ndisc = { centre = [3.0",
        "history.5.disc",
        "rectangle",
    )
    .down(1),
    row(
        "disc     = { centre = [3.0",
        "disc = { centre = [9.0",
        "history.5.disc",
        "no part of the disc is inside the grid",
    ),
    row(
        "from  = [1.0, 1.5, 1.0]",
        "from  = [1.0, 1.5, 3.5]",
        "profile.0.from",
        "which ends at z = 3",
    ),
    row(
        "from  = [1.0, 1.5, 1.0]",
        "from  = [1.0, 1.5, 0.0]",
        "profile.0.to",
        "E0651",
    )
    .down(1),
    row(
        "at = [1.0, 1.5, 1.0]",
        "at = [1.0, 1.5, 1.0]\nat_x = 1.0",
        "history.0.at_x",
        "E0642",
    )
    .down(1),
    row(
        "quantity = \"reaction\"\nface = \"back\"",
        "quantity = \"front\"",
        "history.1.quantity",
        "not available in 3-D",
    ),
    row(
        "[0.5, 0.0, 1.0, 0.0]",
        "[0.5, 0.0, 1.0]",
        "shaking.acceleration",
        "found a list of 3",
    ),
    row(
        "[gravity]",
        "[[rigid]]\nname = \"a\"\ncircle = { centre = [3, 2], radius = 0.5 }\n[gravity]",
        "rigid.3.circle",
        "E0432 .. `sphere`",
    )
    .down(2),
    row(
        BALL,
        "sphere = { centre = [1.0, 1.5, 0.6], radius = 0.4 }",
        "rigid.0.sphere",
        "E0431 .. body.0",
    ),
    row(
        BALL,
        "sphere = { centre = [1.0, 1.5, 0.6], radius = 0.05 }",
        "rigid.0.sphere",
        "E0431 .. body.0",
    ),
    row(
        BALL,
        "sphere = { centre = [1.0, 1.5], radius = 0.4 }",
        "rigid.0.sphere.centre",
        "three in 3-D",
    ),
    row(
        BALL,
        "box = { lower = [0, 0, 3], upper = [1, 1, 3] }",
        "rigid.0.box.upper",
        "E0203",
    ),
    row(
        BALL,
        "terrain = { top = [[0, 0, 1], [1, 0, 1]] }",
        "rigid.0.terrain.top",
        "two points along x",
    ),
    row(
        BALL,
        "revolve = { circle = { centre = [1, 1], radius = 0.5 }, about = [0, 0] }",
        "rigid.0.revolve.circle",
        "E0432 .. `polygon`",
    ),
    row(
        BALL,
        "revolve = { polygon = [[-0.1, 3], [1, 3], [0, 4]], about = [0, 0] }",
        "rigid.0.revolve.polygon",
        "E0434",
    ),
    row(
        "deactivate  = [\"plate\"]",
        "remove = [\"block\"]",
        "footing.rectangle",
        "E0626",
    )
    .up(37),
    row(
        "back = \"contact\" }",
        "back = \"absorbing\" }",
        "stage.0.boundary.back",
        "E0614",
    ),
    row(
        "front = \"roller\"",
        "front = { friction_coefficient = 1 }, bottom = { friction_coefficient = 1 }",
        "stage.0.boundary.bottom",
        "an edge",
    ),
    row(
        "[gravity]",
        "[water]\nlevel = 0.0\n[gravity]",
        "water.level",
        "E0524 .. z = 0 m",
    )
    .down(1),
    row(
        "[0.0, 0.0, -9.81]",
        "[0.0, -1.0, -9.81]\n[water]\nlevel = 1.0",
        "gravity.acceleration",
        "E0523",
    ),
    row(
        "[gravity]",
        "[[inflow]]\nfrom = [0, 0]\nto = [1, 1]\nrate = 1e-6\n[gravity]",
        "inflow.0.from",
        "E0225",
    )
    .down(1),
    row("density = 2000", FLOWS, "drain.0.surface", "E0225").down(7),
    row("density = 2000", PERMEABLE, "material.soil.permeability", "expected").down(3),
    row(
        "at    = [0.5, 0.0, 0.5]",
        "at    = [0.5, 0.5]",
        "point_load.0.at",
        "three in 3-D",
    ),
    row(
        "at    = [0.5, 0.0, 0.5]",
        "at    = [3.9, 0.1, 1.9]",
        "point_load.0.at",
        "E0401",
    ),
    row(
        FORCE,
        "force = \"-10 N\"",
        "point_load.0.force",
        "found \"-10 N\". Give three components in 3-D",
    ),
    row(
        FORCE,
        "force = [0.0, \"-10 N/m\"]",
        "point_load.0.force",
        "three components in 3-D, [x, y, z], in N",
    ),
    row(
        FORCE,
        "force = [0.0, 0.0, \"-10 kPa\"]",
        "point_load.0.force",
        "expected a force (N, kN, MN)",
    ),
    row(PLATE, "from = [0, 1]\nto = [1, 1]", "footing.from", "E0225"),
    row(
        PLATE,
        "rectangle = { lower = [0.5, 2, 1], upper = [1.5, 3, 1.2] }",
        "footing.rectangle",
        "E0234",
    ),
    row(
        PLATE,
        "rectangle = { lower = [0.6, 2, 1], upper = [0.9, 3, 1] }",
        "footing.rectangle",
        "shorter than a cell (0.5 m)",
    ),
    row(
        PLATE,
        "rectangle = { lower = [0.5, 2, 2.8], upper = [1.5, 3, 2.8] }",
        "footing.rectangle",
        "E0401",
    ),
    row(
        PLATE,
        "disc = { centre = [1.0, 2.5, 1.0], radius = 0 }",
        "footing.disc.radius",
        "radius > 0",
    ),
    row(
        PLATE,
        "disc = { centre = [9.0, 2.5, 1.0], radius = 0.5 }",
        "footing.disc",
        "no part of the disc is inside the grid",
    ),
    row(
        "displacement = [0.0, 0.0, -0.01]",
        "displacement = [0.0, -0.01]",
        "footing.displacement",
        "three in 3-D",
    ),
    row(
        "displacement = [0.0, 0.0, -0.01]",
        "displacement = [0.1, 0.0, 0.0]",
        "footing.displacement",
        "E0416",
    ),
    row(
        "displacement = [0.0, 0.0, -0.01]",
        "displacement = [0, 0, -1.5]",
        "footing.displacement",
        "E0419",
    ),
    row(
        "[0.5, 0.0, 0.0, -0.01]",
        "[0.5, 0.0, -0.01]",
        "prescribed.0.path",
        "(three in 3-D)",
    ),
    row(
        "normal = \"z\"",
        "normal = \"up\"",
        "prescribed.0.disc.normal",
        "expected one of",
    ),
    row(
        "quantity = \"contact\"",
        "quantity = \"moment\"",
        "history.2.quantity",
        "not available in 3-D",
    ),
    row(
        LOADED,
        "rectangle = { lower = [0.5, 1.0, 0.5], upper = [1.5, 2.0, 1.0] }",
        "traction.0.rectangle",
        "E0234",
    ),
    row(
        LOADED,
        "rectangle = { lower = [0.5, 1.0, 1.0], upper = [1.5, 3.5, 1.0] }",
        "traction.0.rectangle",
        "ends at y",
    ),
    row(
        LOADED,
        "rectangle = { lower = [0.5, 1.0, 2.0], upper = [1.5, 2.0, 2.0] }",
        "traction.0.rectangle",
        "no body",
    ),
    row(LOADED, "from = [0, 1]\nto = [1, 1]", "traction.0.from", "E0225"),
    row(
        "centre = [3, 1.5",
        "centre = [9, 1.5",
        "traction.2.sphere",
        "no part of the sphere is inside the grid",
    ),
    row(
        "2.0], radius = 0.5 }\nstress",
        "2.0], radius = 1.5 }\nstress",
        "traction.2.sphere",
        "E0401",
    ),
    row(
        "2.0], radius = 0.5 }\nstress",
        "2.0], radius = 51 }\nstress",
        "traction.2.sphere",
        "loaded points",
    ),
    row(
        "2.0], radius = 0.5 }\nstress = [0, 0, \"1 kPa\"]",
        "2.0], radius = 0.5 }\npressure = \"1 kPa\"",
        "traction.2.pressure",
        "lies on both sides",
    )
    .down(1),
    row("[[7.0, 3, 4", "[[9.0, 3, 4", "traction.3.surface", "ends at x"),
    row(
        "[[7.0, 3, 4, 5, 5, 4, 5, 3, 6]",
        "[[7.0, 3, 4, 5, 3, 6, 5, 5, 4]",
        "traction.3.surface",
        "normals on opposite sides",
    ),
    row(
        "[[7.0, 3, 4, 5, 5, 4,",
        "[[7.0, 3, 4, 5.001, 5, 4,",
        "traction.3.surface",
        "consists of 2 separate pieces",
    ),
    row(
        "[[7.0, 3, 4, 5, 5, 4, 5, 3, 6], [5, 3, 4, 5,",
        "[[5.0, 5, 4, 5,",
        "traction.3.surface.triangles",
        "area",
    ),
    row(
        "stress = [0.0, \"1 kPa\", \"-2 kPa\"]",
        "stress = [0.0, \"-2 kPa\"]",
        "traction.0.stress",
        "three in 3-D",
    ),
    row(
        "stress = [0.0, \"1 kPa\", \"-2 kPa\"]",
        "stress = { value = [0, 0, 1], at_y = 1.0, per_metre = [0, 1] }",
        "traction.0.stress.per_metre",
        "three in 3-D",
    ),
    row(
        "density = 2000",
        "density = 2000\nru = 1.2",
        "material.soil.ru",
        "(0 < ru < 1",
    )
    .down(1),
    row(
        "velocity = [0.0, 0.0, -1.0]",
        "spin = { rate = 1, about = [0, 0] }",
        "body.0.spin.about",
        "three in 3-D",
    ),
    row(
        "axis = [0.0, 1.0, 1.0]",
        "axis = [0, 0, 0]",
        "body.2.spin.axis",
        "has no direction",
    ),
    row(
        "geometry = \"3d\"",
        "geometry = \"3d\"\naccuracy = \"draft\"",
        "accuracy",
        "E0226",
    )
    .down(1),
    row(
        "cell  = [0.5, 1.0, 0.5]",
        "knots = { x = [0, 2, 4], y = [0, 3] }",
        "grid.knots.z",
        "E0206",
    ),
];

/// Changes of a case in a plane.
pub const IN_A_PLANE: &[Row] = &[
    row(
        "bottom = \"fixed\"",
        "bottom = \"fixed\"\nfront = \"fixed\"",
        "boundary.front",
        "E0207",
    )
    .down(1),
    row(
        "lower = [0.0, 0.0]\nupper",
        "lower = [0.0, 0.0, 0.0]\nupper",
        "grid.lower",
        "a list of two",
    ),
    row(
        "bottom = \"fixed\"",
        "bottom = \"fixed\"\n[[traction]]\nrectangle = { lower = [0, 1], upper = [1, 1] }\nstress = [0, 1]",
        "traction.0.rectangle",
        "E0207",
    )
    .down(2),
    row(
        "bottom = \"fixed\"",
        "bottom = \"fixed\"\n[[traction]]\nsphere = { centre = [0, 1], radius = 1 }\npressure = 1",
        "traction.0.sphere",
        "E0207",
    )
    .down(2),
    row(
        "bottom = \"fixed\"",
        "bottom = \"fixed\"\n[footing]\ndisc = { centre = [0, 1], radius = 1 }\ndisplacement = [0, -1]",
        "footing.disc",
        "E0207",
    )
    .down(2),
    row(
        "box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }",
        "sphere = { centre = [1.0, 1.0], radius = 0.5 }",
        "body.0.sphere",
        "E0207",
    ),
];

/// Pipes' walls: by the factor of a hundredth of a cell and of a fifth, by their points of a tenth and of two fifths.
#[test]
fn thin_walls_are_warned_of() {
    let base = super::SOLID;
    let at = base.find("revolve =").expect("a turned outline");
    let end = at + base[at..].find("points_per_cell").expect("its points");
    let warned = |[inner, outer]: [f64; 2], of: &str| {
        let wall = format!("polygon = [[{inner}, 1.0], [{outer}, 1.0], [{outer}, 2.0], [{inner}, 2.0]]");
        let text = format!(
            "{}revolve = {{ {wall}, about = [1.0, 1.5] }}\n{}",
            &base[..at],
            &base[end..]
        );
        let warnings = bsmpm_scene::Case::from_text("case.toml", &text, &[])
            .expect("a valid case")
            .warnings;
        warnings.iter().any(|warning| warning.starts_with(of))
    };
    let factor = "W0214: body.3.";
    let alone = "W0211: body.3";
    assert!(warned([0.8, 0.803], factor) && !warned([0.8, 0.95], factor));
    assert!(warned([0.8, 0.85], alone) && !warned([0.8, 0.99], alone));
}

/// The default is that of plane strain wherever the cone is used; the word for it is not warned of.
#[test]
fn the_default_match_of_a_cone_is_warned_of_outside_of_plane_strain() {
    let warned = |base: &str, given: &str| {
        let law = format!("model = \"drucker-prager\"\nfriction_angle = 30\ncohesion = 1e3{given}\n");
        let text = base.replacen("model   = \"elastic\"", &law, 1);
        let warnings = bsmpm_scene::Case::from_text("case.toml", &text, &[])
            .expect("a valid case")
            .warnings;
        warnings
            .into_iter()
            .find(|warning| ["W0310", "W0311"].iter().any(|code| warning.starts_with(code)))
    };
    for base in [super::SOLID, super::ROUND] {
        let reported = warned(base, "").expect("a warning");
        // (3 - sin 30)/sqrt(13) and (3 + sin 30)/sqrt(13).
        assert!(
            reported.starts_with("W0310: material.soil.fit: ") && reported.contains("69.3 %"),
            "{reported}"
        );
        assert!(
            reported.contains("97.1 % in extension") && reported.contains("fit = \"outer\""),
            "{reported}"
        );
        for word in ["outer", "inner", "plane-strain"] {
            assert_eq!(warned(base, &format!("\nmatch = \"{word}\"")), None);
        }
    }
    let flat = warned(super::STATIC, "\nfit = \"outer\"").expect("a warning");
    assert!(flat.starts_with("W0311: material.soil: "), "{flat}");
}

/// Every triangle of the surface turned; of one that is not the row of open surfaces reports.
#[test]
fn a_surface_that_is_turned_inside_out_as_a_whole_is_taken_and_warned_of() {
    let base = super::SOLID;
    let turned = base
        .replacen("[5, 3, 4, 5, 5, 4, 7, 3, 4]", "[5, 3, 4, 7, 3, 4, 5, 5, 4]", 1)
        .replacen("[5, 3, 4, 7, 3, 4, 5, 3, 6]", "[5, 3, 4, 5, 3, 6, 7, 3, 4]", 1)
        .replacen("[7, 3, 4, 5, 5, 4, 5, 3, 6]", "[7, 3, 4, 5, 3, 6, 5, 5, 4]", 1)
        .replacen("[5, 3, 4, 5, 3, 6, 5, 5, 4]", "[5, 3, 4, 5, 5, 4, 5, 3, 6]", 1);
    let case = |text: &str| bsmpm_scene::Case::from_text("case.toml", text, &[]).expect("a valid case");
    let warned = |text: &str| {
        case(text)
            .warnings
            .iter()
            .any(|warning| warning.starts_with("W0215: body.5.surface.triangles"))
    };
    assert!(warned(&turned) && !warned(base));
    assert_eq!(case(&turned).bodies[5].region, case(base).bodies[5].region);
}
