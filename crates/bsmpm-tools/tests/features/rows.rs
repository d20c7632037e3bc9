//! Features of the table in `tests/features.rs`. Each feature has lines that are added to a case to test the feature.

/// A feature as what it adds to a block of soil.
pub struct Feature {
    /// Its name in the table.
    pub name: &'static str,
    /// Keys of the top level.
    pub top: &'static str,
    /// Further keys of the analysis.
    pub analysis_keys: &'static str,
    /// Support of the bottom.
    pub bottom: Option<&'static str>,
    /// Support of the right side.
    pub right: Option<&'static str>,
    /// The law with its parameters; `{FIT}` is the cone that fits the geometry.
    pub law: Option<&'static str>,
    /// Further keys of the material.
    pub soil: &'static str,
    /// Further tables in a consolidation analysis.
    pub extra_with_flow: &'static str,
    /// Further tables, with `{X}` for the middle of the block, in axisymmetry for the axis.
    pub extra: &'static str,
    /// The same in 3-D where they differ.
    pub extra_in_space: Option<&'static str>,
    /// Whether `bsmpm fos` must accept the case too.
    pub is_factor_of_safety: bool,
}

/// A block of soil; braces with capitals stand for what a feature, a geometry and an analysis put there.
pub const BLOCK_IN_PLANE: &str = r#"geometry = "{GEOMETRY}"
{TOP}[analysis]
{ANALYSIS}
[gravity]
acceleration = [0.0, -9.81]
[grid]
lower = [0.0, 0.0]
upper = [8.0, 4.0]
cell = 0.5
[boundary]
bottom = "{BOTTOM}"
left = "roller"
right = "{RIGHT}"
[stabilisation]
method = "consistent-f-bar"
[material.soil]
{LAW}
unit_weight = "20 kN/m3"
{SOIL}[[body]]
material = "soil"
name = "ground"
box = { lower = [0.0, 0.0], upper = [8.0, 2.0] }
points_per_cell = 3
{TABLES}"#;

/// The same in 3-D.
pub const BLOCK_IN_SPACE: &str = r#"geometry = "{GEOMETRY}"
{TOP}[analysis]
{ANALYSIS}
[gravity]
acceleration = [0.0, 0.0, -9.81]
[grid]
lower = [0.0, 0.0, 0.0]
upper = [8.0, 2.0, 4.0]
cell = 0.5
[boundary]
bottom = "{BOTTOM}"
left = "roller"
right = "{RIGHT}"
front = "roller"
back = "roller"
[stabilisation]
method = "consistent-f-bar"
[material.soil]
{LAW}
unit_weight = "20 kN/m3"
{SOIL}[[body]]
material = "soil"
name = "ground"
box = { lower = [0.0, 0.0, 0.0], upper = [8.0, 2.0, 2.0] }
points_per_cell = 3
{TABLES}"#;

/// Pores of soil in a consolidation analysis.
pub const PORES: &str = "drainage = \"coupled\"\nporosity = 0.4\npermeability = 1e-6\n";
/// Water of a consolidation analysis whose feature has none.
pub const WATER: &str = "[water]\nlevel = 2.0\n[[drain]]\nface = \"bottom\"\n";

pub const MOHR_COULOMB: &str =
    "model = \"mohr-coulomb\"\nyoung = \"30 MPa\"\npoisson = 0.3\nfriction_angle = 25.0\ncohesion = \"10 kPa\"";

pub const TRESCA: &str = "model = \"tresca\"\nyoung = \"30 MPa\"\npoisson = 0.45\ncohesion = \"30 kPa\"";

impl Feature {
    /// The block of soil alone.
    pub const NONE: Self = Self {
        name: "",
        top: "",
        analysis_keys: "",
        bottom: None,
        right: None,
        law: None,
        soil: "",
        extra: "",
        extra_with_flow: "",
        extra_in_space: None,
        is_factor_of_safety: false,
    };
}

const fn law(name: &'static str, law: &'static str) -> Feature {
    Feature {
        name,
        law: Some(law),
        ..Feature::NONE
    }
}

const fn tables(name: &'static str, extra: &'static str, extra_in_space: &'static str) -> Feature {
    Feature {
        name,
        extra,
        extra_in_space: Some(extra_in_space),
        ..Feature::NONE
    }
}

const fn bottom(name: &'static str, support: &'static str) -> Feature {
    Feature {
        name,
        bottom: Some(support),
        ..Feature::NONE
    }
}

pub const ROWS: &[Feature] = &[
    law("law: elastic", "model = \"elastic\"\nyoung = \"30 MPa\"\npoisson = 0.3"),
    law("law: Mohr-Coulomb", MOHR_COULOMB),
    law("law: Tresca", TRESCA),
    law(
        "law: Drucker-Prager",
        "model = \"drucker-prager\"\nyoung = \"30 MPa\"\npoisson = 0.3\nfriction_angle = 25.0\ncohesion = \"10 kPa\"\nfit = \"{FIT}\"",
    ),
    law(
        "law: von Mises with hardening",
        "model = \"von-mises\"\nyoung = \"30 MPa\"\npoisson = 0.3\nyield_stress = \"60 kPa\"\nhardening = \"1 MPa\"",
    ),
    law(
        "law: Mohr-Coulomb with softening",
        "model = \"mohr-coulomb-softening\"\nyoung = \"30 MPa\"\npoisson = 0.3\nfriction_angle = 30.0\ncohesion = \"10 kPa\"\n\
         residual_friction_angle = 25.0\nresidual_cohesion = \"2 kPa\"\nsoftening_strain = 0.2\nband_width = 0.1",
    ),
    law(
        "law: Mohr-Coulomb with tension cut-off",
        "model = \"mohr-coulomb\"\nyoung = \"30 MPa\"\npoisson = 0.3\nfriction_angle = 30.0\ncohesion = \"10 kPa\"\n\
         tensile_strength = \"2 kPa\"",
    ),
    law(
        "law: sensitive clay",
        "model = \"sensitive-clay\"\nyoung = \"30 MPa\"\npoisson = 0.45\ncohesion = \"30 kPa\"\nsensitivity = 5.0\n\
         softening_strain = 0.5\nband_width = 0.1",
    ),
    Feature {
        law: Some(
            "model = \"modified-cam-clay\"\nyoung = \"3 MPa\"\npoisson = 0.3\nkappa_star = 0.02\nlambda_star = 0.1\n\
             critical_state_ratio = 1.2\nocr = 1.5",
        ),
        extra: "[initial]\nk0 = 0.6\n[[traction]]\nfrom = [0.0, 2.0]\nto = [8.0, 2.0]\npressure = \"20 kPa\"\nramp = 0.5\n",
        extra_in_space: Some(
            "[initial]\nk0 = 0.6\n[[traction]]\nrectangle = { lower = [0.0, 0.0, 2.0], upper = [8.0, 2.0, 2.0] }\n\
             pressure = \"20 kPa\"\nramp = 0.5\n",
        ),
        name: "law: modified Cam-clay",
        ..Feature::NONE
    },
    law(
        "law: mu(I), granular flow",
        "model = \"mu-i\"\nyoung = \"10 MPa\"\npoisson = 0.3\nmu_s = 0.38\nmu_2 = 0.64\ninertial_number = 0.3\n\
         grain_diameter = \"1 mm\"\ngrain_density = 2500.0",
    ),
    Feature {
        name: "automatic cells and steps (`accuracy`)",
        top: "accuracy = \"draft\"\n",
        ..Feature::NONE
    },
    tables(
        "initial stress: K0 procedure, plastic equilibrium",
        "[initial]\nk0 = 0.6\nequilibrium = \"plastic\"\n",
        "[initial]\nk0 = 0.6\nequilibrium = \"plastic\"\n",
    ),
    Feature {
        name: "stages: excavation and fill",
        extra: "[[body]]\nmaterial = \"soil\"\nname = \"fill\"\nbox = { lower = [0.0, 2.0], upper = [4.0, 3.0] }\n\
                points_per_cell = 3\n[[stage]]\nat = 0.5\nadd = [\"fill\"]\n",
        extra_in_space: Some(
            "[[body]]\nmaterial = \"soil\"\nname = \"fill\"\nbox = { lower = [0.0, 0.0, 2.0], upper = [4.0, 2.0, 3.0] }\n\
             points_per_cell = 3\n[[stage]]\nat = 0.5\nadd = [\"fill\"]\n",
        ),
        ..Feature::NONE
    },
    Feature {
        name: "factor of safety (`bsmpm fos`)",
        is_factor_of_safety: true,
        ..Feature::NONE
    },
    tables(
        "surface loads that follow the surface",
        "[[traction]]\nfrom = [0.0, 2.0]\nto = [2.0, 2.0]\npressure = \"20 kPa\"\n",
        "[[traction]]\nrectangle = { lower = [0.0, 0.0, 2.0], upper = [2.0, 2.0, 2.0] }\npressure = \"20 kPa\"\n",
    ),
    tables(
        "rigid footing, prescribed displacement",
        "[footing]\nfrom = [0.0, 2.0]\nto = [2.0, 2.0]\ndisplacement = [0.0, -0.1]\n",
        "[footing]\nrectangle = { lower = [0.0, 0.0, 2.0], upper = [2.0, 1.0, 2.0] }\ndisplacement = [0.0, 0.0, -0.1]\n",
    ),
    Feature {
        name: "bearing capacity (`bsmpm limit-load`)",
        analysis_keys: "purpose = \"limit-load\"\n",
        law: Some(TRESCA),
        extra: "[footing]\nfrom = [0.0, 2.0]\nto = [2.0, 2.0]\ndisplacement = [0.0, -0.1]\n",
        extra_in_space: Some(
            "[footing]\nrectangle = { lower = [0.0, 0.0, 2.0], upper = [2.0, 1.0, 2.0] }\ndisplacement = [0.0, 0.0, -0.1]\n",
        ),
        ..Feature::NONE
    },
    tables(
        "footing in frictional contact",
        "[footing]\nfrom = [0.0, 2.0]\nto = [2.0, 2.0]\ndisplacement = [0.0, -0.1]\ninterface = { friction_coefficient = 0.3 }\n",
        "[footing]\nrectangle = { lower = [0.0, 0.0, 2.0], upper = [2.0, 1.0, 2.0] }\ndisplacement = [0.0, 0.0, -0.1]\n\
         interface = { friction_coefficient = 0.3 }\n",
    ),
    bottom("frictional contact at a face of the grid", "contact"),
    tables(
        "rigid body with a prescribed motion",
        "[[rigid]]\nname = \"ball\"\ncircle = { centre = [0.0, 3.0], radius = 1.0 }\ndisplacement = [0.0, -0.1]\n",
        "[[rigid]]\nname = \"ball\"\nsphere = { centre = [0.0, 0.0, 3.0], radius = 1.0 }\ndisplacement = [0.0, 0.0, -0.1]\n",
    ),
    tables(
        "rigid body moved by forces",
        "[[rigid]]\nname = \"ball\"\ncircle = { centre = [{X}, 3.0], radius = 1.0 }\nfree = [\"y\"]\nmass = 500.0\n",
        "[[rigid]]\nname = \"ball\"\nsphere = { centre = [4.0, 1.0, 3.0], radius = 1.0 }\nfree = [\"z\"]\nmass = 500.0\n",
    ),
    tables(
        "rigid body that rotates",
        "[[rigid]]\nname = \"ball\"\ncircle = { centre = [{X}, 3.0], radius = 1.0 }\nfree = [\"x\", \"y\", \"rotation\"]\nmass = 500.0\n",
        "[[rigid]]\nname = \"ball\"\nsphere = { centre = [4.0, 1.0, 3.0], radius = 1.0 }\nfree = [\"rotation\"]\nmass = 500.0\n",
    ),
    tables(
        "rigid terrain with friction",
        "[[rigid]]\nname = \"ground\"\nterrain = { top = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 2.0, 0.0], [8.0, 2.0, 0.0]] }\n",
        "[[rigid]]\nname = \"ground\"\nfriction_coefficient = 0.3\n\
         terrain = { top = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 2.0, 0.0], [8.0, 2.0, 0.0]] }\n",
    ),
    Feature {
        name: "hydrostatic water, moving water table",
        extra: "[water]\nlevel_path = [[0.0, 2.5], [1.0, 2.0]]\n",
        extra_with_flow: "[[drain]]\nface = \"bottom\"\n",
        ..Feature::NONE
    },
    Feature {
        name: "phreatic line",
        extra: "[water]\nline = [[0.0, 2.0], [8.0, 2.5]]\n",
        extra_with_flow: "[[drain]]\nface = \"bottom\"\n",
        ..Feature::NONE
    },
    Feature {
        name: "flowing water: drains, seepage faces, rain",
        right: Some("free"),
        soil: "drainage = \"coupled\"\nporosity = 0.4\npermeability = 1e-6\n",
        extra: "[water]\nlevel = 2.0\n[[inflow]]\nfrom = [0.0, 2.0]\nto = [8.0, 2.0]\nrate = \"1 mm/h\"\nrunoff = true\n\
                [[drain]]\nfrom = [8.0, 0.0]\nto = [8.0, 2.0]\nseepage = true\n",
        extra_in_space: Some(
            "[water]\nlevel = 2.0\n[[inflow]]\nrectangle = { lower = [0.0, 0.0, 2.0], upper = [8.0, 2.0, 2.0] }\nrate = \"1 mm/h\"\n\
             runoff = true\n[[drain]]\nrectangle = { lower = [8.0, 0.0, 0.0], upper = [8.0, 2.0, 2.0] }\nseepage = true\n",
        ),
        ..Feature::NONE
    },
    Feature {
        name: "unsaturated soil (retention curve)",
        soil: "drainage = \"coupled\"\nporosity = 0.4\npermeability = 1e-6\nretention = { alpha = 2.0, n = 1.6 }\n",
        extra: "[water]\nlevel = 1.0\n[[drain]]\nface = \"bottom\"\n",
        ..Feature::NONE
    },
    Feature {
        name: "undrained soil with friction (excess pore pressure)",
        soil: "drainage = \"undrained\"\nporosity = 0.4\n",
        extra: "[water]\nlevel = 2.0\n",
        ..Feature::NONE
    },
    Feature {
        extra: "[initial]\nk0 = 0.5\n",
        ..bottom("absorbing boundary", "absorbing")
    },
    Feature {
        name: "earthquake with free-field sides",
        right: Some("free-field"),
        extra: "[shaking]\nacceleration = [[0.0, 0.0, 0.0], [0.5, 2.0, 0.0], [1.0, 0.0, 0.0]]\n[initial]\nk0 = 0.5\n",
        extra_in_space: Some(
            "[shaking]\nacceleration = [[0.0, 0.0, 0.0, 0.0], [0.5, 2.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]\n[initial]\nk0 = 0.5\n",
        ),
        ..Feature::NONE
    },
    tables(
        "earthquake on a rigid base",
        "[shaking]\nacceleration = [[0.0, 0.0, 0.0], [0.5, 2.0, 0.0], [1.0, 0.0, 0.0]]\n",
        "[shaking]\nacceleration = [[0.0, 0.0, 0.0, 0.0], [0.5, 2.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]\n",
    ),
    Feature {
        name: "outflow boundary",
        right: Some("outflow"),
        ..Feature::NONE
    },
];
