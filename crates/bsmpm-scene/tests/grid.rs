//! Tests positions in the grid, and the default degree.

use bsmpm_scene::{Case, GridAxis, GridSpec};

fn axis(lower: f64, cell: f64, cells: usize) -> GridAxis {
    GridAxis::Uniform { lower, cell, cells }
}

#[test]
fn a_place_on_a_face_has_a_cell_wherever_the_grid_starts() {
    let mut missed = 0;
    for tenths in -200..200 {
        for cells in [1, 3, 7, 12, 29, 60] {
            let lower = f64::from(tenths) / 10.0;
            let cell = 0.1;
            let grid = GridSpec {
                axes: vec![axis(lower, cell, cells), axis(1.0 - lower, cell, cells)],
                order: 2,
                lines: Default::default(),
            };
            let length = cells as f64 * cell;
            let written = f64::from(tenths + cells as i32) / 10.0; // as a person writes the face
            for upper in [grid.upper()[0], written] {
                missed += usize::from(upper - lower > length);
                let found = grid.local([upper, grid.upper()[1]]);
                assert!(
                    found.iter().all(|x| *x <= length && *x >= length - 1e-13),
                    "{lower} {cells}: {found:?}"
                );
            }
            assert_eq!(grid.local([grid.lower()[0], grid.lower()[1]]), [0.0; 2]);
        }
    }
    assert!(missed > 100, "differences that miss the grid: {missed}");
}

#[test]
fn splines_are_quadratic_unless_an_order_is_given_and_the_choice_is_noted() {
    let case = |order: &str| {
        let text = format!(
            "geometry = \"plane-strain\"\nanalysis = {{ type = \"quasi-static\", steps = 1 }}\n\
             grid = {{ lower = [0, 0], upper = [2, 2], cell = 1{order} }}\nboundary = {{ bottom = \"fixed\" }}\n\
             [material.m]\nmodel = \"elastic\"\nyoung = 1e6\npoisson = 0.3\n\
             [[body]]\nmaterial = \"m\"\npoints_per_cell = 2\nbox = {{ lower = [0, 0], upper = [2, 1] }}\n"
        );
        Case::from_text("case.toml", &text, &[]).expect("a valid case")
    };
    let notes = |case: &Case| case.notes.iter().filter(|note| note.key == "grid.degree").count();
    let [absent, given, cubic] = ["", ", degree = \"quadratic\"", ", degree = \"cubic\""].map(case);
    assert_eq!([absent.grid.order, given.grid.order, cubic.grid.order], [2, 2, 3]);
    assert_eq!([notes(&absent), notes(&given), notes(&cubic)], [1, 0, 0]);
}
