//! Compares `cases/results/wrong_cases.md` with present messages.

use super::{DYNAMIC, SEEPING, STATIC};
use bsmpm_scene::Case;
use std::path::Path;

/// What is wrong, a base, and changes of it: the first error of the case that they make is shown.
struct Wrong {
    what: &'static str,
    base: &'static str,
    changes: &'static [(&'static str, &'static str)],
}

const fn dynamic(what: &'static str, changes: &'static [(&'static str, &'static str)]) -> Wrong {
    Wrong {
        what,
        base: DYNAMIC,
        changes,
    }
}

const fn at_rest(what: &'static str, changes: &'static [(&'static str, &'static str)]) -> Wrong {
    Wrong {
        what,
        base: STATIC,
        changes,
    }
}

const fn wet(what: &'static str, changes: &'static [(&'static str, &'static str)]) -> Wrong {
    Wrong {
        what,
        base: SEEPING,
        changes,
    }
}

const CLAY: &str = "cohesion    = 2e4\n";
const RECORD: &str = "acceleration = [[0.0, 0.1, 0.0], [\"1 s\", \"-0.1 g\", \"5 cm/s2\"]]";

const WRONG: &[Wrong] = &[
    dynamic("a law that is none", &[("\"tresca\"", "\"cam-clay\"")]),
    dynamic(
        "clay that is stronger once it is remoulded",
        &[
            ("\"tresca\"", "\"sensitive-clay\""),
            (CLAY, "cohesion = 2e4\nsensitivity = 0.5\nsoftening_strain = 20\n"),
        ],
    ),
    dynamic(
        "Cam-clay without its swelling",
        &[("\"tresca\"", "\"modified-cam-clay\""), (CLAY, "lambda_star = 0.1\n")],
    ),
    dynamic(
        "a granular law that flows fastest with less friction",
        &[
            ("\"tresca\"", "\"mu-i\""),
            (
                CLAY,
                "mu_s = 0.64\nmu_2 = 0.38\ninertial_number = 0.28\ngrain_diameter = \"1 mm\"\ngrain_density = 2500\n",
            ),
        ],
    ),
    at_rest(
        "damping where nothing vibrates",
        &[(
            "poisson = 0.3",
            "poisson = 0.3\ndamping = { ratio = 0.05, frequency = 2.0 }",
        )],
    ),
    dynamic(
        "friction as an angle",
        &[("bottom = \"fixed\"", "bottom = { friction_coefficient = \"20 deg\" }")],
    ),
    dynamic(
        "a face with friction that is fixed",
        &[(
            "bottom = \"fixed\"",
            "bottom = { friction_coefficient = 0.3, type = \"fixed\" }",
        )],
    ),
    at_rest(
        "a body that only friction would hold",
        &[("bottom = \"fixed\"", "bottom = \"contact\"")],
    ),
    dynamic(
        "the gap at a face that is in no contact",
        &[("quantity = \"heave\"", "quantity = \"gap\"\nface = \"left\"")],
    ),
    at_rest(
        "what a free face carries",
        &[(
            "[output]",
            "[[history]]\nquantity = \"reaction\"\nface = \"top\"\n[output]",
        )],
    ),
    wet(
        "an axis that is drained",
        &[
            ("\"plane-strain\"", "\"axisymmetric\""),
            ("face    = \"bottom\"", "face    = \"left\""),
            ("face     = \"bottom\"", "face     = \"left\""),
        ],
    ),
    at_rest(
        "an axis in the middle of the grid",
        &[
            ("\"plane-strain\"", "\"axisymmetric\""),
            ("lower = [0.0, 0.0]", "lower = [-1.0, 0.0]"),
        ],
    ),
    at_rest(
        "waves in a quasi-static analysis",
        &[("bottom = \"fixed\"", "bottom = \"absorbing\"")],
    ),
    dynamic(
        "what leaves, where nothing can",
        &[("quantity = \"heave\"", "quantity = \"outflow\"")],
    ),
    dynamic(
        "a record that goes back in time",
        &[(RECORD, "acceleration = [[0.5, 0.1, 0.0], [0.4, 0.2, 0.0]]")],
    ),
    dynamic(
        "a pressure and a stress at once",
        &[(
            "stress = [0.0, \"-20 kPa\"]",
            "stress = [0.0, \"-20 kPa\"]\npressure = \"20 kPa\"",
        )],
    ),
    dynamic(
        "a spin in metres per second",
        &[(
            "velocity = [0.0, \"-1 m/s\"]",
            "velocity = [0.0, \"-1 m/s\"]\nspin = { rate = \"2 m/s\", about = [1.5, \"2 m\"] }",
        )],
    ),
    dynamic(
        "a stage that places what has no name",
        &[("add  = [\"fill\"]", "add = [\"fil\"]")],
    ),
    dynamic(
        "a body that is placed twice",
        &[("add  = [\"fill\"]", "add = [\"fill\", \"fill\"]")],
    ),
    dynamic("stages that go back in time", &[("at     = \"500 ms\"", "at = 0.25")]),
    dynamic("a stage that changes nothing", &[("add  = [\"fill\"]", "add = []")]),
    dynamic(
        "a law for a material that there is none of",
        &[(
            "add  = [\"fill\"]",
            "add = [\"fill\"]\nmaterials = [{ from = \"clai\", to = \"sand\" }]",
        )],
    ),
    dynamic(
        "bodies that would change their mass",
        &[(
            "add  = [\"fill\"]",
            "add = [\"fill\"]\nmaterials = [{ from = \"sand\", to = \"clay\" }]",
        )],
    ),
    dynamic(
        "a face that opens and is driven",
        &[(
            "add  = [\"fill\"]",
            "add = [\"fill\"]\nboundary = { right = \"roller\" }",
        )],
    ),
    dynamic(
        "a rigid body within the soil",
        &[("[1.9, 1.35], [2.45, \"135 cm\"]", "[1.9, 1.0], [2.45, 1.0]")],
    ),
    dynamic(
        "a rigid body that flies without mass",
        &[("density = \"0.5 t/m3\"\n", "")],
    ),
    dynamic(
        "the force on a rigid body that there is none of",
        &[("rigid    = \"pipe\"", "rigid = \"pip\"")],
    ),
    dynamic(
        "friction by a word",
        &[(
            "interface = \"smooth\"",
            "interface = { friction_coefficient = \"smooth\" }",
        )],
    ),
    dynamic(
        "the work of a strip without a name",
        &[("quantity = \"heave\"", "quantity = \"work\"\nof = \"strip\"")],
    ),
    dynamic(
        "a cut through nothing",
        &[("from     = [1.0, 0.0]", "from = [1.0, 1.25]")],
    ),
    dynamic(
        "a profile of a field that is none",
        &[("\"plastic-strain\"]", "\"plastic strain\"]")],
    ),
    at_rest(
        "a field of frames that stands there already",
        &[("every = 0.5", "every = 0.5\nfields = [\"q\", \"p\"]")],
    ),
    at_rest(
        "a pressure on what fill covers",
        &[(
            "[output]",
            "[[traction]]\nfrom = [0, 1]\nto = [2, 1]\npressure = 1e3\n[[body]]\nname = \"fill\"\nmaterial = \"soil\"\n\
             box = { lower = [0, 1], upper = [2, 1.5] }\npoints_per_cell = 3\n[[stage]]\nat = 0.5\nadd = [\"fill\"]\n[output]",
        )],
    ),
    at_rest(
        "a free field in a quasi-static analysis",
        &[("bottom = \"fixed\"", "bottom = \"fixed\"\nleft = \"free-field\"")],
    ),
    dynamic(
        "a start that is settled by a word that is none",
        &[("k0 = 0.5", "k0 = 0.5\nequilibrium = \"elastic\"")],
    ),
    dynamic(
        "strength that is divided by nothing",
        &[("add  = [\"fill\"]", "add = [\"fill\"]\nstrength_reduction = 0.0")],
    ),
    at_rest(
        "water that flows in no time",
        &[(
            "poisson = 0.3",
            "poisson = 0.3\ndrainage = \"coupled\"\nporosity = 0.4\npermeability = \"1e-9 m/s\"",
        )],
    ),
    at_rest(
        "consolidation of dry ground",
        &[("\"quasi-static\"\nend   = 1.0", "\"consolidation\"\nend   = \"1 day\"")],
    ),
    at_rest(
        "a drain in ground without flow",
        &[("[output]", "[[drain]]\nsurface = true\n\n[output]")],
    ),
    wet("steps that shrink", &[("growth = 1.2", "growth = 0.9")]),
    wet("equal steps that grow", &[("dt     = \"1 h\"", "steps  = 100")]),
    wet("a permeability in m2", &[("\"1e-9 m/s\"", "\"1e-16 m2\"")]),
    wet(
        "a porosity in per cent",
        &[("porosity         = 0.6", "porosity         = 60")],
    ),
    wet(
        "clay that drains without a permeability",
        &[("permeability     = \"1e-9 m/s\"\n", "")],
    ),
    wet(
        "a permeability where nothing flows",
        &[("porosity = 0.5", "porosity = 0.5\npermeability = \"1e-9 m/s\"")],
    ),
    wet(
        "a drained face away from the ground",
        &[("face    = \"bottom\"", "face    = \"top\"")],
    ),
    wet(
        "a drain on undrained clay",
        &[("from      = [2.0, 1.0]", "from      = [0.5, 3.0]")],
    ),
    wet("a head in kPa", &[("\"3 m\"", "\"30 kPa\"")]),
    wet("rain as a depth", &[("\"10 mm/h\"", "\"10 mm\"")]),
    wet(
        "the outflow of a drain that there is none of",
        &[("drain    = \"base\"", "drain    = \"bas\"")],
    ),
    wet("water in linear cells", &[("\"quadratic\"", "\"linear\"")]),
    wet("water and Broyden's update", &[("\"auto\"", "\"broyden\"")]),
    wet(
        "water beside a face with friction",
        &[("right  = \"roller\"", "right  = { friction_coefficient = 0.3 }")],
    ),
];

/// The page: of every wrong case what was changed, and what the program says.
fn page() -> String {
    let mut page = String::from(
        "# Wrong cases\n\nWhat the program says of wrong soils, contacts, loads, motions, stages, histories and water: the first \
         error of each, as it\nis printed, with exit code 65. All errors of a case are reported at once. The toml block is what \
         was put into a valid case\n(`tests/full.toml` of `bsmpm-scene`, `static.toml` and `seeping.toml` of its \
         `tests/bad_cases`). Made by the\ntest \
         `page`, which compares; `BSMPM_RENEW=1 cargo test -p bsmpm-scene --test bad_cases page` writes it again.\n",
    );
    for wrong in WRONG {
        let mut text = wrong.base.to_owned();
        for (find, put) in wrong.changes {
            assert!(text.contains(find), "{}: `{find}` is not in the base", wrong.what);
            text = text.replacen(find, put, 1);
        }
        let errors = Case::from_text("case.toml", &text, &[]).err();
        let errors = errors.unwrap_or_else(|| panic!("{}: the case is accepted", wrong.what));
        let first = format!("{:#}", errors[0]);
        let shown = |(find, put): &(&str, &str)| {
            if put.is_empty() {
                format!("# left out: {find}")
            } else {
                format!("{}\n", put.trim_end())
            }
        };
        let changed: String = wrong.changes.iter().map(shown).collect();
        page += &format!(
            "\n## {}\n\n```toml\n{changed}```\n\n```text\n{first}\n```\n",
            wrong.what
        );
    }
    page
}

#[test]
fn the_page_of_wrong_cases_is_what_a_user_sees() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/results/wrong_cases.md");
    if std::env::var_os("BSMPM_RENEW").is_some() {
        std::fs::write(&file, page()).unwrap();
    }
    assert!(
        std::fs::read_to_string(&file).unwrap() == page(),
        "renew it, as its head says, and read what has changed"
    );
}
