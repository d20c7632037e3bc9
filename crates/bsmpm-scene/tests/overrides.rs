//! `--set KEY=VALUE`, and what a valid case becomes.

use bsmpm::material::Material;
use bsmpm::stabilisation::Stabilisation;
use bsmpm_scene::{Axis, Case, Error, Every, Extent, Face, Place, Quantity, Support};

const FULL: &str = include_str!("full.toml");
const STATIC: &str = include_str!("bad_cases/static.toml");

fn set(text: &str, overrides: &[&str]) -> Result<Case, Vec<Error>> {
    Case::from_text("case.toml", text, &overrides.iter().map(ToString::to_string).collect::<Vec<_>>())
}

fn valid(text: &str, overrides: &[&str]) -> Case {
    set(text, overrides).unwrap_or_else(|errors| panic!("{overrides:?}: {errors:#?}"))
}

#[test]
fn values_arrive_as_toml_bare_words_and_units() {
    assert_eq!(valid(FULL, &["grid.cell=0.25"]).grid.axes[0].cells(), 16);
    assert_eq!(valid(FULL, &["grid.cell=25 cm"]).grid.axes[1].cells(), 12);
    assert_eq!(valid(FULL, &["grid.cell=\"25 cm\""]).grid.axes[1].cells(), 12);
    assert_eq!(valid(FULL, &["grid.cell=[0.25, 0.5]"]).grid.axes[1].cells(), 6);
    assert_eq!(valid(FULL, &["grid.order=cubic"]).grid.order, 3);
    assert_eq!(valid(FULL, &[" stabilisation.method = none "]).stabilisation, Stabilisation::None);
    assert_eq!(valid(FULL, &["title=two words = one title"]).title, "two words = one title");
    assert!(!valid(FULL, &["solver.reproducible=false"]).solver.reproducible);
}

#[test]
fn lists_are_reached_by_index_and_absent_tables_are_made() {
    let case = valid(FULL, &["body.0.points_per_cell=5", "grid.upper.1=4.0", "body.2.box.upper.0=3"]);
    assert_eq!((case.bodies[0].points_per_cell, case.grid.upper()[1], case.bodies[2].upper[0]), (5, 4.0, 3.0));
    let case = valid(STATIC, &["gravity.acceleration=[0, -9.81]", "material.soil.density=2000"]);
    assert_eq!(case.gravity.unwrap().acceleration, [0.0, -9.81]);
    let case =
        valid(STATIC, &["history.0.quantity=height", "history.1.quantity=mass", "check.0={quantity=\"mass\", min=0}"]);
    assert_eq!((case.histories.len(), case.checks[0].min), (2, Some(0.0)));
    assert_eq!(valid(STATIC, &["material.clay={model=\"hencky\", young=1e6, poisson=0}"]).materials[1].name, "clay");
    assert_eq!(valid(STATIC, &["solver.linear.pc=lu"]).solver.linear.factor, Some("mumps"));
}

#[test]
fn one_of_two_exclusive_keys_removes_the_other() {
    assert_eq!(valid(FULL, &["analysis.steps=4"]).analysis.dt, 0.25);
    assert_eq!(valid(STATIC, &["analysis.dt=0.5"]).analysis.dt, 0.5);
    assert_eq!(valid(STATIC, &["analysis.dt=0.5", "analysis.steps=8"]).analysis.dt, 0.125);
    assert_eq!(valid(FULL, &["output.every_steps=7"]).output.every, Some(Every::Steps(7)));
    assert_eq!(valid(FULL, &["material.clay.density=1500"]).materials[1].density, Some(1500.0));
    assert!(valid(FULL, &["material.sand.unit_weight=981 kN/m3"]).materials[0].density.is_some_and(|d| d > 9.9e4));
    let case = valid(FULL, &["grid.knots.x=[0, 1, 4]", "grid.knots.y=[0, 1.5, 3]"]);
    assert_eq!(case.grid.axes, [Axis::Graded(vec![0.0, 1.0, 4.0]), Axis::Graded(vec![0.0, 1.5, 3.0])]);
    assert_eq!(valid(&case.text, &["grid.cell=1"]).grid.axes[0].cells(), 4);
    let errors = set(FULL, &["body.0.polygon=[[0, 0]]"]).unwrap_err();
    assert!(errors.len() == 1 && errors[0].message == "not available yet", "{errors:?}");
}

#[test]
fn errors_cite_the_override() {
    let rows = [
        ("grid.cell=-1", "grid.cell", "allowed: cell > 0"),
        ("grid.cell=5 s", "grid.cell", "unit of time"),
        ("grid.cel=5 mm", "grid.cel", "did you mean `cell`?"),
        ("body.3.points_per_cell=3", "body.3", "missing"),
        ("body.9.points_per_cell=3", "body.9.points_per_cell", "index 9 is beyond the list of 3"),
        ("body.x.points_per_cell=3", "body.x.points_per_cell", "`x` is no index of a list"),
        ("title.x=3", "title.x", "which is no table"),
        ("grid.cell", "", "expected KEY=VALUE"),
        ("grid..cell=1", "grid..cell", "no key path"),
        ("=1", "", "no key path"),
        ("grid.cell=[1", "grid.cell", "no valid TOML"),
        ("a.b.c.d.e.f.g.h=1", "a.b.c.d.e.f.g.h", "no key path"),
        ("material.mud.young=1", "material.mud.model", "missing"),
        ("footing.from=[0, 1]", "footing", "not available yet"),
    ];
    for (text, key, says) in rows {
        let errors = set(FULL, &[text]).unwrap_err();
        let fits = |error: &Error| {
            error.place == Place::Override(text.to_owned())
                && error.key.starts_with(key)
                && error.message.contains(says)
        };
        assert!(errors.iter().any(fits), "{text}: {errors:#?}");
        assert!(errors[0].to_string().starts_with(&format!("--set {text}: ")), "{}", errors[0]);
    }
}

#[test]
fn the_effective_text_gives_the_same_case() {
    for (text, overrides) in [
        (FULL, &["grid.cell=0.25", "title=a \"quoted\" \\ title", "body.0.box.upper=[4, 0.9]"][..]),
        (STATIC, &["history.0={quantity=\"displacement\", at=[1, 1]}", "analysis.dt=0.125"][..]),
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
    assert_eq!(case.grid.axes, [8, 6].map(|cells| Axis::Uniform { lower: 0.0, cell: 0.5, cells }));
    let names: Vec<&str> = case.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["sand", "clay", "block"]);
    let Material::MohrCoulomb(sand) = &case.materials[0].material else { panic!() };
    assert_eq!((sand.friction(), sand.cohesion(), sand.elastic().young), (30_f64.to_radians(), 1e3, 2e7));
    let Material::MohrCoulomb(clay) = &case.materials[1].material else { panic!() };
    assert_eq!((clay.friction(), clay.dilation(), clay.cohesion()), (0.0, 0.0, 2e4));
    assert!(matches!(case.materials[2].material, Material::Hencky(_)));
    assert_eq!(case.bodies[2].velocity, Some([0.0, -1.0]));
    assert_eq!(case.boundary, [[Support::Roller; 2], [Support::Fixed, Support::Free]]);
    assert_eq!((case.solver.background, case.solver.background_cells), (0.0, Extent::Occupied));
    assert_eq!(case.output.times, [0.25, 0.75]);
    assert_eq!(case.histories[1].quantity, Quantity::Reaction { face: Face { axis: 1, upper: false } });
    let columns: Vec<String> = case.histories.iter().flat_map(|h| h.columns()).map(|c| c.name).collect();
    assert_eq!(columns, ["runout", "floor-x", "floor-y", "stress-xx", "stress-yy", "stress-zz", "stress-xy"]);
    assert_eq!((case.checks[0].at, case.checks[0].max, case.checks[1].at), (0.5, Some(4.0), 1.0));
    assert!(case.warnings.is_empty(), "{:?}", case.warnings);
}

#[test]
fn what_the_program_chooses_is_noted() {
    let case = valid(STATIC, &[]);
    let noted = |key: &str| case.notes.iter().find(|note| note.key == key).map(|note| note.value.as_str());
    assert_eq!((noted("solver.background"), noted("solver.tolerance")), (Some("0.0001"), Some("1e-8")));
    assert_eq!((case.solver.background, case.solver.linear.factor), (1e-4, Some("mumps")));
    let case = valid(&STATIC.replace("end   = 1.0\n", ""), &[]);
    assert_eq!(case.analysis.end, 1.0);
    assert!(case.notes.iter().any(|note| note.key == "analysis.end"));
}

#[test]
fn free_faces_move_outward() {
    let case = valid(STATIC, &["grid.upper=[2.5, 1.9]"]);
    assert_eq!(case.grid.upper(), [3.0, 2.0]);
    let case = valid(STATIC, &["grid.upper=[2.5, 2]", "boundary.right=roller"]);
    assert_eq!((case.grid.lower(), case.grid.upper()), ([-0.5, 0.0], [2.5, 2.0]));
    assert!(case.notes.iter().any(|note| note.key == "grid.lower.0" && note.value == "-0.5"));
}

#[test]
fn doubtful_cases_are_warned_of() {
    let rows = [
        (FULL, "gravity.acceleration=[0, -9.8]", "near 9.81"),
        (FULL, "material.sand.young=500", "young = 5e2 Pa"),
        (FULL, "material.sand.young=2e13", "check the unit"),
        (FULL, "material.clay.poisson=0.49999", "nearly incompressible"),
        (FULL, "material.clay.cohesion=0", "no strength"),
        (FULL, "material.clay.unit_weight=18", "check the unit"),
        (FULL, "body.0.points_per_cell=1", "too coarsely"),
        (FULL, "body.1.box.lower.1=0.9", "body.0 and body.1 overlap"),
        (FULL, "body.1.material=sand", "material.clay: no body"),
        (FULL, "gravity.ramp=5", "never fully applied"),
        (FULL, "output.every=5", "beyond the end"),
        (STATIC, "material.soil.poisson=0.46", "expect locking"),
        (STATIC, "gravity.acceleration=[0, -9.81]", "no body has mass"),
        (STATIC, "title=x", "nothing loads"),
        (STATIC, "solver.linear={ksp=\"cg\", pc=\"jacobi\", factor=\"mumps\"}", "is not used"),
    ];
    for (text, change, says) in rows {
        let warnings = valid(text, &[change]).warnings;
        assert!(warnings.iter().any(|warning| warning.contains(says)), "{change}: {warnings:?}");
    }
    let plastic = FULL.replace("[stabilisation]\nmethod = \"f-bar\"", "");
    assert!(valid(&plastic, &[]).warnings.iter().any(|warning| warning.contains("material.sand is plastic")));
}
