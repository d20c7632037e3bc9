//! Tests that the program chooses what a case leaves open, and notes it.

use super::{FULL, SEEPING, STATIC, set, valid};
use bsmpm_scene::Quadrature;
use bsmpm_scene::words::LinearSolver;

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
