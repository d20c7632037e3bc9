//! Tests that shipped 3-D cases are cut into slabs and get a linear solver by their size.

use super::cases;
use bsmpm_scene::words::LinearSolver;
use bsmpm_scene::{Case, load};

/// Slabs of a solid are cut along y, too: 56 x 56 cells from above and a C0 line along each axis, 65,000 unknowns.
#[test]
fn ranks_of_a_solid_are_not_bounded_by_its_columns_along_x() {
    let bytes = load(&cases().join("square_footing.toml")).unwrap();
    let case = Case::from_bytes("square_footing.toml", &bytes, &["grid.cell=0.0625".to_owned()]).unwrap();
    let useful = case.estimate(1).useful_ranks;
    assert_eq!((case.most_ranks(), case.parts(57 * 57, [1; 2])), (57 * 57, Some(57)));
    assert!(useful > 57, "{useful} of use");
}

/// By unknowns, Poisson's ratio and what must repeat to the bit.
#[test]
fn the_linear_solver_of_a_solid_is_taken_by_size() {
    let text = load(&cases().join("round_column.toml")).unwrap();
    let on = |ranks: usize, set: &[&str]| {
        let overrides: Vec<String> = set.iter().map(ToString::to_string).collect();
        let case = Case::from_bytes("round_column", &text, &overrides).unwrap();
        case.solver.linear_on(ranks)
    };
    assert_eq!(on(1, &[]), LinearSolver::Direct);
    assert_eq!(on(2, &["grid.cell=0.05"]), LinearSolver::IncompleteCholesky);
    assert_eq!(
        on(1, &["grid.cell=0.05", "material.sand.poisson=0.49"]),
        LinearSolver::Direct
    );
    assert_eq!(
        on(1, &["grid.cell=0.05", "solver.linear=\"direct\""]),
        LinearSolver::Direct
    );
    assert_eq!(
        on(1, &["grid.cell=0.05", "strength_reduction.factor=1.2"]),
        LinearSolver::Direct
    );
    for (set, why) in [
        (vec![], "up to 10000 a direct solver is fastest"),
        (vec!["grid.cell=0.05", "strength_reduction.factor=1.2"], "near failure"),
    ] {
        let overrides: Vec<String> = set.iter().map(ToString::to_string).collect();
        let notes = Case::from_bytes("round_column", &text, &overrides).unwrap().notes;
        let reported: Vec<_> = notes
            .iter()
            .filter(|note| note.key.starts_with("solver.linear"))
            .collect();
        assert!(
            matches!(reported[..], [note] if note.value == "direct" && note.reason.contains(why)),
            "{reported:?}"
        );
    }
    let many = "grid.cell=0.025";
    assert_eq!(on(1, &[many]), LinearSolver::MultigridCycles);
    assert_eq!(on(2, &[many]), LinearSolver::IncompleteCholesky);
    assert_eq!(
        on(2, &[many, "solver.reproducible=false"]),
        LinearSolver::MultigridCycles
    );
    // Several ranks factorise what one has multigrid over the grid's splines for: memory and warning are theirs.
    let set = [many, "material.sand.poisson=0.49"];
    assert_eq!(
        (on(1, &set), on(2, &set)),
        (LinearSolver::SplineMultigrid, LinearSolver::Direct)
    );
    let case = Case::from_bytes("round_column", &text, &set.map(str::to_owned)).unwrap();
    let warned = |ranks| {
        case.warnings_on(ranks)
            .iter()
            .any(|warning| warning.starts_with("W0235"))
    };
    assert!(!warned(1) && warned(2));
    let named = [many, set[1], "solver.linear=\"direct\""].map(str::to_owned);
    let named = Case::from_bytes("round_column", &text, &named).unwrap();
    assert_eq!(case.estimate(2), named.estimate(2));
    assert!(
        case.estimate(2).bytes > 2 * case.estimate(1).bytes,
        "{:?}",
        case.estimate(2)
    );
}
