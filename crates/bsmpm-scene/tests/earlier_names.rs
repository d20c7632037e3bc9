//! Tests outdated names of keys.

use bsmpm_scene::schema::{Kind, ROOT, Table};
use bsmpm_scene::{Case, differences};

/// A case with the names that were replaced in November 2026.
const EARLIER: &str = r#"
geometry = "solid"
[analysis]
type = "dynamic"
dt = 0.01
end = 0.1
gamma = 0.6
[grid]
lower = [0, 0, 0]
upper = [4, 4, 6]
cell = 1
order = "linear"
[material.soil]
model = "mohr-coulomb-softening"
young = 1e7
poisson = 0.3
friction = 30
dilation = 5
cohesion = 1e5
residual_friction = 25
residual_dilation = 0
residual_cohesion = 1e4
softening_strain = 0.1
density = 2000
[material.sand]
model = "mohr-coulomb"
young = 1e7
poisson = 0.3
friction = { value = 30, at_y = 3, per_metre = "0.5 deg/m" }
cohesion = 0
separation = "closing"
density = 2000
[material.cone]
model = "drucker-prager"
young = 1e7
poisson = 0.3
friction = 30
cohesion = 1e3
match = "outer"
density = 2000
[material.rock]
model = "hencky"
young = 1e9
poisson = 0.2
density = 2000
[[body]]
material = "soil"
box = { lower = [0, 0, 0], upper = [4, 4, 1] }
points_per_cell = 2
[[body]]
material = "sand"
box = { lower = [0, 0, 1], upper = [4, 4, 2] }
points_per_cell = 2
[[body]]
material = "cone"
box = { lower = [0, 0, 2], upper = [4, 4, 3] }
points_per_cell = 2
[[body]]
material = "rock"
sphere = { center = [2, 2, 4.5], radius = 0.5 }
points_per_cell = 2
[[traction]]
name = "load"
rectangle = { lower = [1, 1, 3], upper = [2, 2, 3] }
stress = [0, 0, -1e3]
[footing]
rectangle = { lower = [0, 0, 3], upper = [1, 1, 3] }
displacement = [0, 0, -0.01]
base = { friction = 0.2, lifts = false }
[[rigid]]
name = "plate"
box = { lower = [2, 2, 3], upper = [4, 4, 3.5] }
friction = 0.3
[boundary]
bottom = { friction = 0.3, lifts = true }
left = "roller"
front = "roller"
[[stage]]
at = 0.02
apply = ["load"]
[[stage]]
at = 0.04
release = ["load"]
"#;

/// The same names in pairs of text, with those of now.
const RENAMED: [(&str, &str); 19] = [
    ("\"solid\"", "\"3d\""),
    ("\ngamma = ", "\nnewmark_gamma = "),
    ("\norder = ", "\ndegree = "),
    ("\nresidual_friction = ", "\nresidual_friction_angle = "),
    ("\nresidual_dilation = ", "\nresidual_dilation_angle = "),
    ("\nfriction = 30", "\nfriction_angle = 30"),
    ("\nfriction = {", "\nfriction_angle = {"),
    ("\ndilation = ", "\ndilation_angle = "),
    ("\"closing\"", "\"gap\""),
    ("\nmatch = ", "\nfit = "),
    ("\"hencky\"", "\"elastic\""),
    ("{ center = ", "{ centre = "),
    ("\nbase = ", "\ninterface = "),
    ("{ friction = ", "{ friction_coefficient = "),
    ("\nfriction = 0.3", "\nfriction_coefficient = 0.3"),
    ("lifts = false", "separates = false"),
    ("lifts = true", "separates = true"),
    ("\napply = ", "\nactivate = "),
    ("\nrelease = ", "\ndeactivate = "),
];

fn now() -> String {
    RENAMED.iter().fold(EARLIER.to_owned(), |text, (earlier, now)| {
        assert!(text.contains(earlier), "{earlier}");
        text.replace(earlier, now)
    })
}

fn read(text: &str, overrides: &[&str]) -> Result<Case, String> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    Case::from_text("case.toml", text, &overrides).map_err(|errors| format!("{errors:?}"))
}

#[test]
fn a_case_with_earlier_names_is_the_same_case_and_each_name_is_noted_once() {
    let [earlier, now] = [EARLIER, &now()].map(|text| read(text, &[]).expect("a valid case"));
    assert_eq!(differences(&earlier.text, &now.text).unwrap(), []);
    assert_eq!(differences(EARLIER, &now.text).unwrap(), []);
    assert!(now.renamings.is_empty());
    let friction = "material.soil.friction, material.sand.friction and material.cone.friction: `friction` is now called \
    `friction_angle`. Replace the earlier name, which is still read.";
    assert!(
        earlier.renamings.iter().any(|note| note == friction),
        "{:#?}",
        earlier.renamings
    );
    for name in [
        "\"3d\"",
        "\"elastic\"",
        "newmark_gamma",
        "degree",
        "fit",
        "\"gap\"",
        "centre",
        "interface",
        "deactivate",
    ] {
        let notes = earlier
            .renamings
            .iter()
            .filter(|note| note.contains(&format!("is now called `{name}`.")));
        assert_eq!(notes.count(), 1, "{name}: {:#?}", earlier.renamings);
    }
    for earlier in ["hencky", "lifts", "center", "\"solid\""] {
        assert!(!now.text.contains(earlier), "{earlier}");
    }
}

#[test]
fn overrides_with_earlier_names_set_the_keys_of_now() {
    let now = now();
    let case = read(
        &now,
        &[
            "material.soil.friction=28",
            "grid.order=quadratic",
            "material.rock.model=hencky",
        ],
    )
    .unwrap();
    let expected = read(&now, &["material.soil.friction_angle=28", "grid.degree=quadratic"]).unwrap();
    assert_eq!(differences(&case.text, &expected.text).unwrap(), []);
    assert_eq!(case.renamings.len(), 3, "{:#?}", case.renamings);
    let case = read(
        &now,
        &["rigid.0={ name = 'plate', box = { lower = [2, 2, 3], upper = [4, 4, 3.5] }, friction = 0.1 }"],
    );
    assert_eq!(case.unwrap().rigid[0].friction, 0.1);
}

#[test]
fn an_earlier_name_beside_that_of_now_is_refused() {
    let both = now().replace(
        "friction_angle = 30\ndilation",
        "friction_angle = 30\nfriction = 30\ndilation",
    );
    let message = read(&both, &[]).unwrap_err();
    assert!(
        message.contains("is the earlier name of the key `friction_angle`, and the case gives both"),
        "{message}"
    );
    assert!(!message.contains("E0011"), "{message}");
}

#[test]
fn slopes_of_cam_clay_are_those_of_the_textbook_with_a_void_ratio_and_the_starred_ones_without() {
    const CLAY: &str = r#"
geometry = "plane-strain"
analysis = { type = "quasi-static", steps = 1 }
grid = { lower = [0, 0], upper = [1, 2], cell = 1 }
boundary = { bottom = "fixed", left = "roller", right = "roller" }
gravity = { acceleration = [0, -9.81] }
initial = { k0 = 0.6 }
body = [{ material = "clay", box = { lower = [0, 0], upper = [1, 1] }, points_per_cell = 2 }]
[material.clay]
model = "modified-cam-clay"
young = "4 MPa"
poisson = 0.3
critical_state_ratio = 1.0
ocr = 1.5
density = 1800
"#;
    let clay = |keys: &str| read(&format!("{CLAY}{keys}"), &[]);
    let numbers = |case: Case| case.materials[0].material.parameters();
    let textbook = numbers(clay("kappa = 0.04\nlambda = 0.2\nvoid_ratio = 1.5").unwrap());
    let starred = numbers(clay("kappa_star = 0.016\nlambda_star = 0.08").unwrap());
    assert!(
        textbook
            .iter()
            .zip(&starred)
            .all(|(a, b)| (a - b).abs() <= 1e-15 * b.abs()),
        "{textbook:?} {starred:?}"
    );
    let message = clay("kappa = 0.04\nlambda = 0.2").unwrap_err();
    for part in [
        "material.clay.kappa",
        "E0314",
        "Add `void_ratio`",
        "`kappa_star` = kappa/(1 + e0)",
    ] {
        assert!(message.contains(part), "{part}: {message}");
    }
    assert!(
        clay("kappa_star = 0.04")
            .unwrap_err()
            .contains("Add `lambda_star`, or `lambda` and `void_ratio`")
    );
    // The text of a run that was made before had the starred slopes by these names.
    let before = format!("{CLAY}kappa = 0.016\nlambda = 0.08");
    let now = format!("{CLAY}kappa_star = 0.016\nlambda_star = 0.08");
    assert_eq!(differences(&before, &now).unwrap(), []);
}

/// No earlier name is a name of now in the same table, and words that were renamed lead to words that there are.
#[test]
fn earlier_names_lead_to_names_of_now() {
    let tables: Vec<&Table> = ROOT.all();
    for table in tables {
        for key in table.keys {
            for earlier in key.earlier {
                assert!(table.key(earlier).is_none(), "{} of {}", earlier, table.header);
            }
            let (Kind::Choice(words) | Kind::ChoiceOr(words, _) | Kind::Choices(words)) = &key.kind else {
                continue;
            };
            for (earlier, now) in words.earlier {
                let known: Vec<&str> = words.words().collect();
                assert!(
                    known.contains(now) && !known.contains(earlier),
                    "{earlier} of {}",
                    key.name
                );
            }
        }
    }
}
