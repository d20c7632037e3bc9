//! Tests `--set KEY=VALUE`, and values of valid cases.

mod loads;
mod materials;
mod motion;

use bsmpm::field::pore_water::flow::Motion;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::material::{Law, LayeredMaterial, Material, MohrCoulomb};
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;
use bsmpm_scene::observables::{HistorySubject, Observable};
use bsmpm_scene::words::LinearSolver;
use bsmpm_scene::{
    Case, Error, Every, Face, GridAxis, Made, Place, PointSelection, Quadrature, Quantity, Site, Support, differences,
    seed,
};

const FULL: &str = include_str!("../full.toml");
const STATIC: &str = include_str!("../bad_cases/static.toml");
const ROUND: &str = include_str!("../bad_cases/round.toml");
const SEEPING: &str = include_str!("../bad_cases/seeping.toml");

fn set(text: &str, overrides: &[&str]) -> Result<Case, Vec<Error>> {
    Case::from_text(
        "case.toml",
        text,
        &overrides.iter().map(ToString::to_string).collect::<Vec<_>>(),
    )
}

fn valid(text: &str, overrides: &[&str]) -> Case {
    set(text, overrides).unwrap_or_else(|errors| panic!("{overrides:?}: {errors:#?}"))
}

/// What is warned of but for what the base itself is: rigid bodies of the full one are thinner than two of its cells.
fn doubts(text: &str, overrides: &[&str]) -> Vec<String> {
    let base = valid(text, &[]).warnings;
    valid(text, overrides)
        .warnings
        .into_iter()
        .filter(|warning| !base.contains(warning))
        .collect()
}

#[test]
fn values_arrive_as_toml_bare_words_and_units() {
    assert_eq!(valid(FULL, &["grid.cell=0.25"]).grid.axes[0].cells(), 16);
    assert_eq!(valid(FULL, &["grid.cell=25 cm"]).grid.axes[1].cells(), 12);
    assert_eq!(valid(FULL, &["grid.cell=\"25 cm\""]).grid.axes[1].cells(), 12);
    assert_eq!(valid(FULL, &["grid.cell=[0.25, 0.5]"]).grid.axes[1].cells(), 6);
    assert_eq!(valid(FULL, &["grid.degree=cubic"]).grid.order, 3);
    assert_eq!(
        valid(FULL, &[" stabilisation.method = none "]).stabilisation,
        Stabilisation::None
    );
    assert_eq!(
        valid(FULL, &["title=two words = one title"]).title,
        "two words = one title"
    );
    assert!(!valid(FULL, &["solver.reproducible=false"]).solver.reproducible);
}

#[test]
fn lists_are_reached_by_index_and_absent_tables_are_made() {
    let case = valid(
        FULL,
        &["body.0.points_per_cell=5", "grid.upper.1=4.0", "body.2.box.upper.0=3"],
    );
    assert_eq!(
        (
            case.bodies[0].points_per_cell,
            case.grid.upper()[1],
            case.bodies[2].bounds()[1][0]
        ),
        (5, 4.0, 3.0)
    );
    let case = valid(
        STATIC,
        &["gravity.acceleration=[0, -9.81]", "material.soil.density=2000"],
    );
    assert_eq!(case.gravity.unwrap().acceleration, [0.0, -9.81, 0.0]);
    let case = valid(
        STATIC,
        &[
            "history.0.quantity=height",
            "history.1.quantity=mass",
            "check.0={quantity=\"mass\", min=0}",
        ],
    );
    assert_eq!((case.histories.len(), case.checks[0].min), (2, Some(0.0)));
    assert_eq!(
        valid(STATIC, &["material.clay={model=\"elastic\", young=1e6, poisson=0}"]).materials[1].name,
        "clay"
    );
}

#[test]
fn a_star_is_every_item_of_a_list_and_every_name() {
    let case = valid(
        FULL,
        &[
            "body.*.points_per_cell=5",
            "material.*.poisson=0.25",
            "body.1.points_per_cell=3",
        ],
    );
    let points: Vec<usize> = case.bodies.iter().map(|body| body.points_per_cell).collect();
    assert_eq!(points, [5, 3, 5, 5, 5, 5]);
    assert!(
        case.materials
            .iter()
            .all(|named| named.material.elastic().poisson == 0.25)
    );
    for (text, change) in [(FULL, "body.*=3"), (STATIC, "traction.*.ramp=1"), (FULL, "grid.*=1")] {
        assert!(set(text, &[change]).is_err(), "{change}");
    }
}

#[test]
fn one_of_two_exclusive_keys_removes_the_other() {
    assert_eq!(valid(FULL, &["analysis.steps=4"]).analysis.dt, 0.25);
    assert_eq!(valid(STATIC, &["analysis.dt=0.5"]).analysis.dt, 0.5);
    assert_eq!(
        valid(STATIC, &["analysis.dt=0.5", "analysis.steps=8"]).analysis.dt,
        0.125
    );
    assert_eq!(
        valid(FULL, &["output.every_steps=7"]).output.every,
        Some(Every::Steps(7))
    );
    assert_eq!(
        valid(FULL, &["material.clay.density=1500"]).materials[1].density,
        Some(1500.0)
    );
    assert!(
        valid(FULL, &["material.sand.unit_weight=981 kN/m3"]).materials[0]
            .density
            .is_some_and(|d| d > 9.9e4)
    );
    let case = valid(FULL, &["grid.knots.x=[0, 1, 4]", "grid.knots.y=[0, 1.5, 3]"]);
    assert_eq!(
        case.grid.axes,
        [
            GridAxis::Graded(vec![0.0, 1.0, 4.0]),
            GridAxis::Graded(vec![0.0, 1.5, 3.0])
        ]
    );
    assert_eq!(valid(&case.text, &["grid.cell=1"]).grid.axes[0].cells(), 4);
    let round = valid(FULL, &["body.3.circle={centre=[3, 2], radius=0.5}"]);
    assert_eq!(round.bodies[3].bounds(), [[2.5, 1.5], [3.5, 2.5]]);
    assert_eq!(
        valid(FULL, &["body.4.box={lower=[0, 2], upper=[0.5, 2.5]}"]).bodies[4].area(),
        0.25
    );
    let moved = |set: &str| valid(FULL, &[set]).footing.unwrap().path.rows;
    assert_eq!(moved("footing.velocity=[0, -0.25]"), [(1.0, [0.0, -0.25, 0.0])]);
    assert_eq!(
        moved("footing.path=[[0, 0, 0], [0.5, 0, -0.25]]"),
        [(0.5, [0.0, -0.25, 0.0])]
    );
    let case = valid(
        FULL,
        &[
            "prescribed.1.face=left",
            "boundary.left=free",
            "prescribed.1.path.0=[0.5, 0.1, 0]",
        ],
    );
    assert_eq!(case.prescribed[1].site, Site::Face(Face { axis: 0, upper: false }));
    let errors = set(FULL, &["initial.gravity=elastic"]).unwrap_err();
    assert!(
        errors.len() == 1 && errors[0].key == "material.till.k0",
        "only its own k0 is left: {errors:?}"
    );
}

#[test]
fn errors_cite_the_override() {
    let rows = [
        ("grid.cell=-1", "grid.cell", "(cell > 0"),
        ("grid.cell=5 s", "grid.cell", "unit of time"),
        ("grid.cel=5 mm", "grid.cel", "did you mean `cell`?"),
        ("body.6.points_per_cell=3", "body.6", "missing"),
        (
            "body.9.points_per_cell=3",
            "body.9.points_per_cell",
            "has no item 9. It has 6 items",
        ),
        (
            "body.x.points_per_cell=3",
            "body.x.points_per_cell",
            "`x` is not a number, but a list needs the number of an item",
        ),
        ("shaking.acceleration.file=a.csv", "shaking.acceleration.file", "E0027"),
        (
            "shaking={acceleration={file=\"a.csv\"}}",
            "shaking.acceleration",
            "E0027",
        ),
        ("title.x=3", "title.x", "not a table"),
        ("grid.cell", "", "E0025"),
        ("grid..cell=1", "grid..cell", "E0025"),
        ("=1", "", "E0025"),
        ("grid.cell=[1", "grid.cell", "E0025"),
        ("a.b.c.d.e.f.g.h=1", "a.b.c.d.e.f.g.h", "E0025"),
        ("material.mud.young=1", "material.mud.model", "missing"),
        (
            "footing.interface=soft",
            "footing.interface",
            "expected one of \"smooth\", \"rough\"",
        ),
        (
            "strength_reduction.factor=0.01",
            "strength_reduction.factor",
            "0.1 <= factor <= 100",
        ),
        (
            "body.3.subtract.0.circle.radius=0",
            "body.3.subtract.0.circle.radius",
            "radius > 0",
        ),
        ("profile.0.end=1", "profile.0.end", "E0011"),
    ];
    for (text, key, says) in rows {
        let errors = set(FULL, &[text]).unwrap_err();
        let fits = |error: &Error| {
            error.place == Place::Override(text.to_owned())
                && error.key.starts_with(key)
                && error.to_string().contains(says)
        };
        assert!(errors.iter().any(fits), "{text}: {errors:#?}");
        assert!(
            errors[0].to_string().starts_with(&format!("--set {text}: ")),
            "{}",
            errors[0]
        );
    }
}

#[test]
fn the_effective_text_gives_the_same_case() {
    for (text, overrides) in [
        (
            FULL,
            &[
                "grid.cell=0.25",
                "title=a \"quoted\" \\ title",
                "body.0.box.upper=[4, 0.9]",
            ][..],
        ),
        (
            STATIC,
            &["history.0={quantity=\"displacement\", at=[1, 1]}", "analysis.dt=0.125"][..],
        ),
    ] {
        let case = valid(text, overrides);
        let again = valid(&case.text, &[]);
        assert_eq!(again, case);
        assert_eq!(valid(text, &[]).text, text);
    }
}

#[test]
fn the_full_case_in_si() {
    let case = valid(FULL, &[]);
    assert_eq!((case.analysis.end, case.analysis.dt), (1.0, 0.01));
    assert_eq!(
        case.grid.axes,
        [8, 6].map(|cells| GridAxis::Uniform {
            lower: 0.0,
            cell: 0.5,
            cells
        })
    );
    let names: Vec<&str> = case.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["sand", "clay", "block", "till"]);
    let LayeredMaterial::Uniform(Material::MohrCoulomb(sand)) = &case.materials[0].material else {
        panic!()
    };
    let whole = MohrCoulomb::new(sand.elastic().clone(), 30_f64.to_radians(), 5_f64.to_radians(), 1e3);
    assert!(sand.elastic().young == 2e7 && *sand == whole.reduced(1.25));
    let LayeredMaterial::Uniform(Material::MohrCoulomb(clay)) = &case.materials[1].material else {
        panic!()
    };
    assert_eq!(clay.parameters(), [0.0, 0.0, 1.6e4]);
    assert!(matches!(
        case.materials[2].material,
        LayeredMaterial::Uniform(Material::Hencky(_))
    ));
    assert_eq!(case.bodies[2].velocity, Some([0.0, -1.0, 0.0]));
    assert_eq!(
        case.boundary,
        [
            [Support::Roller, Support::Free],
            [Support::Fixed; 2],
            [Support::Free; 2]
        ]
    );
    assert_eq!(case.solver.background, 0.0);
    assert_eq!(case.output.times, [0.25, 0.75]);
    assert_eq!(
        case.histories[1].quantity,
        Quantity::new(
            Observable::Reaction,
            HistorySubject::Face(Face { axis: 1, upper: false })
        )
    );
    let columns: Vec<String> = case
        .histories
        .iter()
        .flat_map(|h| h.columns())
        .map(|c| c.name)
        .collect();
    let expected = [
        "runout",
        "floor-x",
        "floor-y",
        "stress-xx",
        "stress-yy",
        "stress-zz",
        "stress-xy",
        "footing-pressure",
        "pressure-noise-average",
        "pressure-noise-plane",
        "heave",
        "centre-of-mass-x",
        "centre-of-mass-y",
        "kinetic-energy",
        "section-forces-n",
        "section-forces-q",
        "section-forces-m",
        "velocity-x",
        "velocity-y",
        "rigid-force-x",
        "rigid-force-y",
    ];
    assert_eq!(columns, expected);
    assert_eq!(
        case.histories[6].quantity,
        Quantity::new(
            Observable::CentreOfMass,
            HistorySubject::Part(PointSelection {
                made: Made::Material(0),
                within: None
            })
        )
    );
    let within = Some([[0.0, 0.0, 0.0], [2.0, 1.0, 0.0]]);
    assert_eq!(
        case.histories[4].quantity,
        Quantity::new(
            Observable::PressureNoise,
            HistorySubject::Part(PointSelection {
                made: Made::All,
                within
            })
        )
    );
    assert_eq!(
        (case.checks[0].at, case.checks[0].max, case.checks[1].at),
        (0.5, Some(4.0), 1.0)
    );
    let count = |code: &str| case.warnings.iter().filter(|warning| warning.starts_with(code)).count();
    let thin = count("W0413: rigid.");
    let placed = count("W0416: rigid.");
    let cut = case.warnings.iter().filter(|warning| warning.contains("W0428")).count();
    let coarse = case
        .warnings
        .iter()
        .filter(|warning| warning.contains("cells per wavelength"))
        .count();
    let approach = case
        .warnings
        .iter()
        .filter(|warning| warning.starts_with("W0229"))
        .count();
    let found = (case.warnings.len(), thin, placed, cut, coarse, approach);
    assert_eq!(found, (10, 2, 1, 2, 1, 1), "{:?}", case.warnings);
}

#[test]
fn the_background_is_a_ten_thousandth_at_rest_unless_the_case_wants_another() {
    let coefficient = |text: &str, overrides: &[&str]| valid(text, overrides).solver.background;
    for order in ["linear", "quadratic", "cubic"] {
        assert_eq!(coefficient(STATIC, &[&format!("grid.degree={order}")]), 1e-4);
    }
    assert_eq!(coefficient(STATIC, &["solver.background=0.5"]), 0.5);
    let warnings = |set: &[&str]| valid(STATIC, set).warnings.join("\n");
    assert!(warnings(&["solver.background=1e-3"]).contains("(1e-3) is above 1e-4"));
    assert!(!warnings(&["solver.background=1e-4"]).contains("solver.background"));
    assert_eq!(coefficient(&FULL.replace("background       = 0.0\n", ""), &[]), 0.0);
}

#[test]
fn words_of_retired_keys_that_change_nothing_are_read_with_a_warning() {
    let plain = valid(STATIC, &[]);
    for (set, reported) in [
        (
            "solver.background_kind=strain",
            "W0001: solver.background_kind: this key has no effect any more, because the artificial stiffness \
             always resists strain. Delete the key.",
        ),
        (
            "solver.background_kind=laplacian",
            "W0001: solver.background_kind: this key has no effect any more, because the artificial stiffness \
             always resists strain. Delete the key.",
        ),
        (
            "solver.background_cells=occupied",
            "W0001: solver.background_cells: this key has no effect any more, because all occupied cells always have \
             the artificial stiffness. Delete the key.",
        ),
    ] {
        let case = valid(STATIC, &[set]);
        let further: Vec<_> = case
            .warnings
            .iter()
            .filter(|warning| !plain.warnings.contains(warning))
            .collect();
        assert_eq!(further, [reported]);
        assert_eq!((&case.solver, &case.notes), (&plain.solver, &plain.notes), "{set}");
        assert_eq!(
            differences(&case.text, &plain.text).unwrap(),
            [],
            "a run goes on with or without it"
        );
    }
}

#[test]
fn words_of_retired_keys_that_were_removed_are_refused_with_what_replaces_them() {
    for (key, word) in [
        ("solver.background_kind", "ghost-penalty"),
        ("solver.background_kind", "curvature"),
        ("solver.background_cells", "partly-filled"),
    ] {
        for text in [STATIC, FULL] {
            let errors = set(text, &[&format!("{key}={word}")]).unwrap_err();
            let [error] = &errors[..] else { panic!("{errors:?}") };
            let reported = format!(
                "the value \"{word}\" does not exist any more; the last version with this value was bsmpm 0.1.0, commit \
                 c1b20825. Delete the key: solver.extension = \"linear\", the default in quasi-static analysis, replaces it."
            );
            assert_eq!((error.key.as_str(), &error.message), (key, &reported));
            assert_eq!(error.removed.map(|removed| removed.word), Some(word));
        }
    }
    let errors = set(STATIC, &["solver.background_kind=bending"]).unwrap_err();
    assert!(
        errors.len() == 1 && errors[0].message.contains("expected one of \"strain\""),
        "{errors:?}"
    );
    assert_eq!(errors[0].removed, None);
    let errors = set(STATIC, &["solver.background_sort=strain"]).unwrap_err();
    assert!(
        errors.iter().all(|error| !error.message.contains("background_kind")),
        "not recommended: {errors:?}"
    );
}

#[test]
fn points_weigh_fitted_volumes_where_unlike_materials_meet_on_a_c0_line() {
    let fitted = "solver.quadrature=fitted";
    let layers = include_str!("../../../../cases/validation/two_densities.toml");
    let layers = |set: &[&str]| valid(layers, set).solver.quadrature;
    assert_eq!(layers(&[]), Quadrature::Fitted);
    assert_eq!(layers(&["grid.degree=linear"]), Quadrature::Fitted);
    assert_eq!(layers(&["grid.degree=cubic"]), Quadrature::Points);
    assert_eq!(layers(&["grid.c0_lines=none"]), Quadrature::Points);
    assert_eq!(layers(&["solver.quadrature=points"]), Quadrature::Points);
    assert_eq!(valid(STATIC, &[]).solver.quadrature, Quadrature::Points);
    assert_eq!(valid(SEEPING, &[]).solver.quadrature, Quadrature::Points);
    let strip = "footing={ from = [0.0, 1.0], to = [1.0, 1.0], displacement = [0, -0.01], interface = \"smooth\" }";
    assert_eq!(valid(STATIC, &[strip]).solver.quadrature, Quadrature::Points);
    assert_eq!(valid(STATIC, &[fitted]).solver.quadrature, Quadrature::Fitted);
    assert_eq!(
        valid(FULL, &["solver.quadrature=points"]).solver.quadrature,
        Quadrature::Points
    );
    let errors = set(STATIC, &["grid.degree=cubic", fitted]).unwrap_err();
    assert!(
        errors.len() == 1 && errors[0].message.contains("cubic splines"),
        "{errors:?}"
    );
    let errors = set(FULL, &[fitted]).unwrap_err();
    assert!(
        errors.len() == 1 && errors[0].code.as_deref() == Some("E0602"),
        "{errors:?}"
    );
}

/// Twelve million unknowns.
const LARGE: &str = "grid.cell=0.8 mm";

#[test]
fn the_linear_solver_that_is_left_open_is_chosen_by_size_and_explained() {
    let chosen = |changes: &[&str]| {
        let case = valid(STATIC, changes);
        let reason = |key: &str| {
            case.notes
                .iter()
                .find(|note| note.key == key)
                .map(|note| note.reason.clone())
        };
        (case.solver.linear, reason("solver.linear"))
    };
    let direct = LinearSolver::Direct;
    let multigrid = LinearSolver::Multigrid;
    assert_eq!(chosen(&["solver.linear=direct"]), (direct, None));
    assert_eq!(chosen(&["solver.linear=multigrid"]), (multigrid, None));
    assert_eq!(
        chosen(&[LARGE, "solver.reproducible=false", "solver.linear=direct"]).0,
        direct
    );
    for (wrong, why) in [
        (&["solver.linear=multigird"][..], "did you mean `multigrid`?"),
        (&["solver.linear=7"], "\"direct\""),
    ] {
        let errors = set(STATIC, wrong).unwrap_err();
        assert!(errors.len() == 1 && errors[0].message.contains(why), "{errors:?}");
    }
    let (found, reason) = chosen(&[]);
    assert!(found == direct && reason.is_some_and(|reason| reason.contains("a direct solver is fastest")));
    let (found, reason) = chosen(&[LARGE]);
    assert!(found == direct && reason.is_some_and(|reason| reason.contains("bitwise reproducible")));
    let any = "solver.reproducible=false";
    let (found, reason) = chosen(&[LARGE, any]);
    assert!(found == multigrid && reason.is_some_and(|reason| reason.contains("above 10000000")));
    let (found, reason) = chosen(&[LARGE, any, "material.soil.poisson=0.46"]);
    assert!(found == direct && reason.is_some_and(|reason| reason.contains("Poisson")));
}

#[test]
fn a_linear_solver_by_petscs_names_is_refused_with_what_replaces_it() {
    for (text, table) in [
        (STATIC, "solver.linear={ ksp = \"cg\", pc = \"jacobi\" }"),
        (FULL, "solver.linear={ ksp = \"cg\", pc = \"jacobi\" }"),
        (STATIC, "solver.linear.factor=mumps"),
    ] {
        let errors = set(text, &[table]).unwrap_err();
        let [error] = &errors[..] else { panic!("{errors:?}") };
        let reported = "the value { ksp, pc, factor } does not exist any more; the last version with this value was \
                        bsmpm 0.1.0, commit 7816fb16. Use a word, such as linear = \"direct\", or pass PETSc options \
                        after `--`, such as `-- -pc_type redundant`.";
        assert_eq!(
            (error.key.as_str(), error.message.as_str()),
            ("solver.linear", reported)
        );
        assert!(error.removed.is_some());
    }
}

#[test]
fn the_f_bar_method_of_zhao_is_refused_with_what_replaces_it() {
    let errors = set(STATIC, &["stabilisation.method=f-bar-zhao"]).unwrap_err();
    let [error] = &errors[..] else { panic!("{errors:?}") };
    let reported = "the value \"f-bar-zhao\" does not exist any more; the last version with this value was bsmpm 0.1.0, \
                    commit 7816fb16. Use \"consistent-f-bar\", or \"f-bar\", which averages the volume changes of each \
                    step.";
    assert_eq!(
        (error.key.as_str(), error.message.as_str()),
        ("stabilisation.method", reported)
    );
    assert_eq!(error.removed.map(|removed| removed.word), Some("f-bar-zhao"));
}

#[test]
fn what_the_program_chooses_is_noted() {
    let case = valid(STATIC, &[]);
    let noted = |key: &str| {
        case.notes
            .iter()
            .find(|note| note.key == key)
            .map(|note| note.value.as_str())
    };
    assert_eq!(
        (noted("solver.background"), noted("solver.tolerance")),
        (Some("0.0001"), Some("1e-8"))
    );
    assert_eq!(
        (case.solver.background, case.solver.linear),
        (1e-4, LinearSolver::Direct)
    );
    let case = valid(&STATIC.replace("end   = 1.0\n", ""), &[]);
    assert_eq!(case.analysis.end, 1.0);
    assert!(case.notes.iter().any(|note| note.key == "analysis.end"));
}

#[test]
fn free_faces_move_outward() {
    let case = valid(STATIC, &["grid.upper=[2.5, 1.9]"]);
    assert_eq!(case.grid.upper(), [3.0, 2.0, 0.0]);
    let case = valid(STATIC, &["grid.upper=[2.5, 2]", "boundary.right=roller"]);
    assert_eq!(
        (case.grid.lower(), case.grid.upper()),
        ([-0.5, 0.0, 0.0], [2.5, 2.0, 0.0])
    );
    assert!(
        case.notes
            .iter()
            .any(|note| note.key == "grid.lower.0" && note.value == "-0.5")
    );
}

#[test]
fn doubtful_cases_are_warned_of() {
    let rows = [
        (FULL, "gravity.acceleration=[0, -9.8]", "W0205"),
        (
            FULL,
            "material.sand.young=500",
            "W0101: material.sand.young: a modulus of 500 Pa (0.5 kPa)",
        ),
        (FULL, "material.sand.young=2e13", "W0302"),
        (FULL, "material.clay.poisson=0.49999", "W0303: material.clay: "),
        (FULL, "material.clay.cohesion=0", "W0309"),
        (FULL, "material.clay.unit_weight=18", "(unit weight 0.018 kN/m3)"),
        (FULL, "body.0.points_per_cell=1", "W0210"),
        (FULL, "body.1.box.lower.1=0.9", "W0213: body.0 and body.1 overlap"),
        (FULL, "body.1.material=sand", "W0313: material.clay: "),
        (STATIC, "gravity={acceleration=[0, -9.81], ramp=5}", "W0207"),
        (FULL, "traction.0.ramp=5", "W0402"),
        (FULL, "traction.0.ramp=0", "W0405: traction.0: "),
        (FULL, "point_load.0.ramp=0", "W0405: point_load.0: "),
        (FULL, "prescribed.1.path.1.0=2", "W0403: prescribed.1.path: "),
        (
            FULL,
            "material.till.dilation_angle=30.5",
            "W0308: material.till.dilation_angle: ",
        ),
        (
            FULL,
            "body.3.polygon=[[2.5, 1.0], [3.75, 1.0], [3, 2.5], [2.5, 2.5]]",
            "W0213",
        ),
        (STATIC, "strength_reduction.factor=2", "W0601"),
        (FULL, "output.every=5", "W0661"),
        (STATIC, "material.soil.poisson=0.46", "W0315"),
        (STATIC, "gravity.acceleration=[0, -9.81]", "W0314"),
        (STATIC, "title=x", "W0674"),
    ];
    for (text, change, says) in rows {
        let warnings = valid(text, &[change]).warnings;
        assert!(
            warnings.iter().any(|warning| warning.contains(says)),
            "{change}: {warnings:?}"
        );
    }
    let of_cubic = |points: &str| {
        valid(
            FULL,
            &["grid.degree=cubic", &format!("body.*.points_per_cell={points}")],
        )
        .warnings
    };
    let warned = |points: &str| of_cubic(points).iter().any(|warning| warning.starts_with("W0209"));
    assert!(warned("2") && !warned("3"));
    let at_axis = |set: &[&str]| {
        valid(ROUND, set)
            .warnings
            .iter()
            .any(|warning| warning.starts_with("W0234"))
    };
    let ring = [
        "grid.degree=cubic",
        "body.0.box.lower=[0.25, 0.0]",
        "point_load.0.at=[0.5, 1.0]",
    ];
    assert!(at_axis(&ring[..1]) && !at_axis(&ring) && !at_axis(&[]));
    let plastic = FULL.replace("[stabilisation]\nmethod = \"f-bar\"", "");
    assert!(
        valid(&plastic, &[])
            .warnings
            .iter()
            .any(|warning| warning.starts_with("W0315: stabilisation: material.sand"))
    );
}

/// A drain above the water table is a pond where the ground takes in what a step brings.
#[test]
fn drains_that_feed_the_ground_are_warned_of() {
    let warned = |base: &str, set: &[&str]| {
        let common = ["gravity={ acceleration = [0, -9.81] }", "water.level=0.2"];
        let warnings = valid(base, &[&common[..], set].concat()).warnings;
        warnings
            .iter()
            .filter(|warning| warning.contains("W0552"))
            .cloned()
            .collect::<Vec<_>>()
    };
    let full = SEEPING.replace("retention        = { alpha = 2.0, n = 1.5, residual = 0.1 }", "");
    let permeable = "material.clay.permeability=1e-5";
    let quick = "analysis.dt_max=3600";
    let found = warned(&full, &[permeable]);
    assert!(
        found.len() == 1 && found[0].starts_with("W0552: drain.4: ") && found[0].contains("51.8 cells"),
        "{found:?}"
    );
    assert!(warned(&full, &[]).is_empty() && warned(&full, &[permeable, quick]).is_empty());
    // Its suction is lost in short steps, too.
    let found = warned(SEEPING, &[permeable, quick, "analysis.end=72000"]);
    assert!(
        found.len() == 1 && found[0].contains("7 cells high during the analysis"),
        "{found:?}"
    );
    assert!(warned(SEEPING, &[permeable, "water.level=1.0"]).is_empty());
}

/// Permeable ground that no drain lies on, of its own or of what it touches.
#[test]
fn ground_that_its_water_cannot_leave_is_warned_of() {
    let case = include_str!("../../../../cases/validation/terzaghi.toml");
    let wide = [
        "grid.upper=[0.5, 1.0]",
        "drain.0={ name = \"top\", from = [0.0, 1.0], to = [0.1, 1.0] }",
    ];
    let column = |k: usize, [left, right]: [f64; 2], material: &str| {
        let shape = format!("box = {{ lower = [{left}, 0.0], upper = [{right}, 1.0] }}, points_per_cell = 3");
        format!("body.{k}={{ material = \"{material}\", {shape} }}")
    };
    let warned = |set: &[&str]| {
        let warnings = valid(case, set).warnings;
        warnings
            .into_iter()
            .filter(|warning| warning.contains("W0530"))
            .collect::<Vec<_>>()
    };
    assert!(warned(&[]).is_empty());
    assert!(warned(&["drain=[]"])[0].contains("no drain lies at body.0,"));
    let apart = column(1, [0.3, 0.4], "clay");
    let found = warned(&[&wide[..], &[&apart]].concat());
    assert!(
        found.len() == 1 && found[0].contains("no drain lies at body.1,"),
        "{found:?}"
    );
    let beside = [column(1, [0.3, 0.4], "clay"), column(2, [0.1, 0.3], "clay")];
    assert!(warned(&[&wide[..], &[&beside[0], &beside[1]]].concat()).is_empty());
    let tight =
        "material.tight={ model = \"elastic\", young = 1e6, poisson = 0.0, drainage = \"undrained\", porosity = 0.5 }";
    let behind = [tight, &column(1, [0.3, 0.4], "clay"), &column(2, [0.1, 0.3], "tight")];
    let found = warned(&[&wide[..], &behind].concat());
    assert!(
        found.len() == 1 && found[0].contains("no drain lies at body.1,"),
        "{found:?}"
    );
}

/// Ground that no water can flow through fails without drainage, unless the case says otherwise.
#[test]
fn strength_falls_as_the_ground_can_drain() {
    let at_rest = |set: &[&str]| {
        let common = ["strength_reduction={ factor = 1.2, stage = \"end\" }"];
        valid(SEEPING, &[&common[..], set].concat())
            .flow
            .map(|flow| flow.at_rest)
    };
    assert_eq!(at_rest(&[]), Some(Motion::Held));
    assert_eq!(
        at_rest(&["strength_reduction.drainage=undrained"]),
        Some(Motion::Undrained)
    );
    let tight = ["drain=[]", "inflow=[]", "history=[]", "body.*.material=tight"];
    assert_eq!(at_rest(&tight), Some(Motion::Undrained));
    assert_eq!(
        at_rest(&[&tight[..], &["strength_reduction.drainage=drained"]].concat()),
        Some(Motion::Held)
    );
}

/// Water that a head lets stand above the surface does not press on it.
#[test]
fn heads_above_the_surface_are_warned_of() {
    let text = SEEPING.replace("surface  = true", "from = [3.0, 2.0]\nto = [4.0, 2.0]");
    let text = text
        .replace("[2.0, 1.0]", "[2.0, 2.0]")
        .replace("[3.0, 1.0]", "[3.0, 2.0]");
    let warned = |set: &[&str]| {
        let warnings = valid(&text, set).warnings;
        warnings
            .into_iter()
            .filter(|warning| warning.contains("W0554"))
            .collect::<Vec<_>>()
    };
    let found = warned(&[]);
    assert!(
        found.len() == 1 && found[0].starts_with("W0554: drain.1: the head is up to 1.000 m above"),
        "{found:?}"
    );
    assert!(warned(&["drain.1.head_path=[[0, 1.0], [\"30 d\", 2.0]]"]).is_empty());
    let gravity = "gravity={ acceleration = [0, -9.81] }";
    assert!(
        warned(&[gravity, "water.level=3.0"]).is_empty(),
        "still water stands there"
    );
    let well = ["drain.1.from=[3.0, 0.2]", "drain.1.to=[3.0, 1.5]"];
    assert!(warned(&well).is_empty(), "a well inside the ground");
}
