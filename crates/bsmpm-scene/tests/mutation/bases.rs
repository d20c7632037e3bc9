//! Valid cases that together contain every key.

pub const FULL: &str = include_str!("../full.toml");
const WET_SOLID: &str = include_str!("../bad_cases/wet_solid.toml");
pub const STATIC: &str = include_str!("../bad_cases/static.toml");
const RUBBING: &str = include_str!("../bad_cases/rubbing.toml");
const SEEPING: &str = include_str!("../bad_cases/seeping.toml");
const SOLID: &str = include_str!("../bad_cases/solid.toml");

/// The least that suction above a level needs.
const SUCTION: &str = r#"geometry = "plane-strain"
analysis = { type = "consolidation", end = "1 d", dt = "1 h" }
grid = { lower = [0.0, 0.0], upper = [2.0, 2.0], cell = 1, degree = "quadratic" }
water = { level = 0.5, suction = "5 kPa", drainage = "coupled" }
gravity = { acceleration = [0.0, -9.81] }
boundary = { bottom = "fixed" }
stabilisation = { method = "consistent-f-bar" }

[material.silt]
model        = "elastic"
young        = "1 MPa"
poisson      = 0.3
unit_weight  = "18 kN/m3"
porosity     = 0.5
permeability = "1e-6 m/s"
retention    = { curve = [[0.0, 1.0, 1.0], ["50 cm", 0.8, 0.3], [10.0, 0.3, 1e-4]], residual = 0.1 }

[[body]]
material = "silt"
box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }
points_per_cell = 3
"#;

/// A law with a tension cut-off that softens.
const CRACKED: &str = r#"geometry = "plane-strain"
analysis = { type = "quasi-static", steps = 10 }
grid = { lower = [0.0, 0.0], upper = [2.0, 2.0], cell = 1, degree = "quadratic" }
boundary = { bottom = "fixed" }
stabilisation = { method = "consistent-f-bar" }

[material.clay]
model                   = "mohr-coulomb"
young                   = "10 MPa"
poisson                 = 0.3
cohesion                = "20 kPa"
friction_angle          = 20.0
dilation_angle          = 0.0
unit_weight             = "18 kN/m3"
tensile_strength        = "5 kPa"
crack_opening           = "10 mm"
softening               = "exponential"
reduce_tensile_strength = true

[[body]]
material = "clay"
box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }
points_per_cell = 3
"#;

/// Changes of [`FULL`] to what excludes what is there.
const OTHERWISE: [&[(&str, &str)]; 7] = [
    &[
        (
            "geometry = \"plane-strain\"",
            "geometry = \"plane-strain\"\naccuracy = \"draft\"",
        ),
        ("\nk0 = 0.5", "\nk0 = 0.5\nequilibrium = \"plastic\""),
        (
            "reset_displacements = true",
            "reset_displacements = true\nstrength_reduction = 1.2",
        ),
        ("interface = \"smooth\"", "interface = \"smooth\"\nname = \"strip\""),
        ("components = \"all\"", "components = \"all\"\nname = \"plate\""),
        ("\nramp = \"0.5 s\"", "\nramp = \"0.5 s\"\nname = \"surcharge\""),
        ("\nramp = 0.5\n", "\nramp = 0.5\nname = \"push\"\n"),
        (
            "remove = [\"fill\"]",
            "remove = [\"fill\"]\nactivate = [\"push\"]\ndeactivate = [\"surcharge\"]\n\
             boundary = { left = \"fixed\", right = \"free\", bottom = \"roller\", top = \"free\" }\n\
             materials = [{ from = \"block\", to = \"block\" }]",
        ),
    ],
    &[
        (
            "dt   = \"10 ms\"",
            "steps = 100\nspectral_radius = 0.8\nmass = \"consistent\"\nwall_velocity = \"relaxed\"",
        ),
        ("\"tresca\"", "\"von-mises\""),
        (
            "stress = [0.0, \"-20 kPa\"]\nramp = \"0.5 s\"",
            "stress_path = [[\"0.2 s\", 1.0, \"-1 kPa\"], [1.0, 0.0, 2.0]]",
        ),
        ("cohesion    = 2e4", "yield_stress = 2e4\nhardening = 1e3"),
        (
            "every  = \"0.1 s\"",
            "every_steps = 20\ncheckpoint = { wall = \"10 min\", every_steps = 50, keep = 3 }",
        ),
        ("quantity = \"heave\"", "quantity = \"height\"\nat_x = 1.0"),
        (
            "bottom = \"fixed\"",
            "bottom = { friction_coefficient = 0.3, separates = true }",
        ),
    ],
    &[
        ("dt   = \"10 ms\"", "dt = 0.01\nnewmark_gamma = 0.6"),
        (
            "stress = [0.0, \"-20 kPa\"]\nramp = \"0.5 s\"",
            "pressure_path = [[\"0.2 s\", \"1 kPa\"], [1.0, 0.0]]",
        ),
        ("\"tresca\"", "\"modified-cam-clay\""),
        (
            "cohesion    = 2e4",
            "kappa_star = 0.02\nlambda_star = 0.1\ncritical_state_ratio = 1.2\npreconsolidation = \"50 kPa\"",
        ),
        ("model    = \"mohr-coulomb\"", "model = \"drucker-prager\""),
        ("separation = \"plastic\"", "fit = \"inner\""),
        (
            "cell  = [0.5, \"50 cm\"]",
            "knots = { x = [0, 0.5, 1.5, \"4 m\"], y = [0, 1, 2, 3] }",
        ),
    ],
    &[
        ("\nk0 = 0.5", "\ngravity = \"elastic\""),
        ("k0          = 0.6\n", ""),
        ("model    = \"mohr-coulomb\"", "model = \"mohr-coulomb-softening\""),
        (
            "separation = \"plastic\"",
            "residual_friction_angle = 20\nresidual_dilation_angle = 5\nresidual_cohesion = 10\nsoftening_strain = 0.2\n\
             softening = \"exponential\"\nband_width = 0.1",
        ),
        (
            "factor = 1.25",
            "factor = 1.25\nelastic = false\nstiffness = 1.5\nunloaded = false",
        ),
    ],
    &[
        ("displacement = [0.0, \"-10 cm\"]", "velocity = [0.0, -0.1]"),
        (
            "path     = [[\"0.5 s\", -0.1, 0.0], [1.0, 0.0, \"5 cm\"]]",
            "velocity = [-0.1, 0.0]",
        ),
        ("density = \"0.5 t/m3\"", "mass = 50"),
        ("\"tresca\"", "\"modified-cam-clay\""),
        (
            "cohesion    = 2e4",
            "kappa = 0.04\nlambda = 0.2\nvoid_ratio = 1.0\ncritical_state_ratio = 1.2\nocr = 1.5",
        ),
        ("factor = 1.25", "factor = 1.0"),
        ("velocity = [0.0, \"-10 mm/s\"]", "displacement = [-0.1, 0.0]"),
        (
            "{ circle = { centre = [2.75, 2.0], radius = \"10 cm\" } }",
            "{ polygon = [[2.6, 1.6], [2.9, 1.6], [2.9, 1.9]] }",
        ),
    ],
    &[
        (
            "path     = [[\"0.5 s\", -0.1, 0.0], [1.0, 0.0, \"5 cm\"]]",
            "displacement = [-0.1, \"1 cm\"]",
        ),
        ("ramp    = \"0.25 s\"", "amplitude = [[\"0.2 s\", 1.0], [1.0, 0.0]]"),
        ("ramp = \"0.5 s\"", "amplitude = [[\"0.2 s\", 1.5], [0.5, 0.0]]"),
        (
            "stress = [0.0, \"-20 kPa\"]",
            "stress = { value = [0.0, \"-20 kPa\"], at_y = 1.25, per_metre = [\"1 kPa/m\", -500] }",
        ),
        ("ramp = 0.5\n", "amplitude = [[0.0, 1.0]]\n"),
        (
            "displacement = [0.0, \"-10 cm\"]",
            "path = [[0.5, 0.0, -0.1], [\"1 s\", 0.0, \"-20 cm\"]]",
        ),
        ("\"tresca\"", "\"sensitive-clay\""),
        (
            "cohesion    = 2e4",
            "cohesion = 2e4\nsensitivity = 4\nsoftening_strain = 20\nrate_parameter = 0.1\nreference_rate = 1e-4",
        ),
    ],
    &[
        (
            "from = [0.0, 1.25]\nto   = [1.0, 1.25]",
            "circle = { centre = [2.75, 2.0], radius = \"10 cm\" }",
        ),
        (
            "stress = [0.0, \"-20 kPa\"]",
            "pressure = { value = 1e3, at_y = 3.0, per_metre = \"10 kPa/m\" }",
        ),
        (
            "velocity = [0.0, \"-1 m/s\"]",
            "spin = { rate = 2.0, about = [1.5, \"2 m\"] }",
        ),
        ("\"tresca\"", "\"mu-i\""),
        (
            "cohesion    = 2e4",
            "damping = { ratio = 0.05, frequency = 2.0 }\nmu_s = 0.38\nmu_2 = 0.64\n\
             inertial_number = 0.28\ngrain_diameter = \"1 mm\"\ngrain_density = 2500",
        ),
        (
            "force = [0.0, \"-1 kN/m\"]\nramp = 0.5",
            "force_path = [[\"0.2 s\", 1.0, \"-1 kN/m\"], [1.0, 0.0, 2.0]]",
        ),
        (
            "force   = [0.0, \"-1 kN/m\"]\nmoment  = 100.0\nramp    = \"0.25 s\"",
            "force_path = [[\"0.2 s\", 1.0, \"-1 kN/m\"], [1.0, 0.0, 2.0]]",
        ),
    ],
];

/// A case that seeks a limit load.
const LIMIT_LOAD: &str = r#"geometry = "plane-strain"
analysis = { type = "quasi-static", steps = 4, purpose = "limit-load" }
boundary = { bottom = "fixed", left = "roller", right = "roller" }
grid = { lower = [0.0, 0.0], upper = [4.0, 2.5], cell = 0.25, degree = "quadratic" }
material.clay = { model = "tresca", young = "5 MPa", poisson = 0.49, cohesion = "10 kPa" }
body = [{ material = "clay", box = { lower = [0.0, 0.0], upper = [4.0, 2.0] }, points_per_cell = 2 }]
footing = { from = [0.0, 2.0], to = [1.0, 2.0], displacement = [0.0, -0.1], interface = "smooth" }
stabilisation = { method = "consistent-f-bar" }
"#;

/// All of them.
pub fn all() -> Vec<String> {
    let later =
        format!("{STATIC}\n[strength_reduction]\nfactor = 1.2\nstage = \"end\"\nsteps = 5\ndrainage = \"drained\"\n");
    let wet = |table: &str| {
        let soil = "poisson = 0.3\nunit_weight = \"19 kN/m3\"\nsaturated_unit_weight = \"20 kN/m3\"";
        let fields = "every = 0.5\nfields = [\"pore-pressure\"]";
        let rest =
            "[gravity]\nacceleration = [0.0, -9.81]\n\n[[history]]\nquantity = \"pore-pressure\"\nat = [1.0, 0.5]";
        let dry = STATIC
            .replacen("poisson = 0.3", soil, 1)
            .replacen("every = 0.5", fields, 1);
        format!("{dry}\n[water]\n{table}\nunit_weight = \"10 kN/m3\"\n\n{rest}\n")
    };
    let still = [
        "level = 0.75",
        "level_path = [[0.0, \"2 m\"], [1.0, 0.5]]",
        "line = [[0.0, 0.75], [\"2 m\", 0.5]]",
        "line_path = [[0, 0, 0.75], [0, \"2 m\", 0.5], [1, 0, 1], [1, 2, 0.5]]",
    ];
    let retired = "background_kind = \"strain\"\nbackground_cells = \"occupied\"";
    let retired = format!("{STATIC}\n[solver]\nextension = \"linear\"\n{retired}\n");
    let mut bases = vec![
        LIMIT_LOAD.to_owned(),
        FULL.to_owned(),
        STATIC.to_owned(),
        CRACKED.to_owned(),
        later,
        retired,
        RUBBING.to_owned(),
        SEEPING.to_owned(),
    ];
    bases.extend(still.map(wet));
    let ratio = STATIC.replacen(
        "poisson = 0.3",
        "poisson = 0.3\nunit_weight = \"19 kN/m3\"\nru = 0.3",
        1,
    );
    bases.push(format!("{ratio}\n[gravity]\nacceleration = [0.0, -9.81]\n"));
    bases.push(SUCTION.to_owned());
    bases.push(SOLID.to_owned());
    bases.push(WET_SOLID.to_owned());
    let knots = "knots = { x = [0.0, 0.5, 1.5, 4.0], y = [0.0, 1.0, 2.0, 3.0], z = [0.0, 1.0, 1.0, 3.0] }";
    let otherwise = SOLID.replacen("cell  = [0.5, 1.0, 0.5]", knots, 1);
    let plate = "rectangle    = { lower = [0.5, 2.0, 1.0], upper = [1.5, 3.0, 1.0] }";
    let disc = "disc = { centre = [1.25, 0.5, 1.0], radius = 0.25, normal = \"z\" }";
    let otherwise = otherwise.replacen(plate, "disc = { centre = [1.0, 2.5, 1.0], radius = 0.25 }", 1);
    let base = "base = [[2.0, 0.0, 2.5], [4.0, 0.0, 2.5], [2.0, 3.0, 2.6], [4.0, 3.0, 2.75]]";
    let otherwise = otherwise.replacen("level = 2.5", base, 1);
    let ball = "sphere = { centre = [3.5, 0.5, 2.0], radius = 0.25 }";
    let ground = "terrain = { top = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0], [4.0, 3.0, 0.0]] }";
    let otherwise = otherwise.replacen(ball, ground, 1);
    bases.push(otherwise.replacen(
        disc,
        "rectangle = { lower = [0.5, 0.0, 1.0], upper = [1.5, 1.0, 1.0] }",
        1,
    ));
    for changes in OTHERWISE {
        let mut text = FULL.to_owned();
        for (part, by) in changes {
            assert_eq!(text.matches(part).count(), 1, "{part}");
            text = text.replacen(part, by, 1);
        }
        bases.push(text);
    }
    bases
}
