//! Fuzzes steps of small valid cases.

mod scene;

use crate::alone::SerialRun;
use arbitrary::Unstructured;
use bsmpm::grid::Grid;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::points::Points;
use bsmpm_scene::{Case, model};

/// Points at most.
const POINTS: u64 = 64;
/// Steps: the second begins with what the first has left.
const STEPS: usize = 2;

/// The choices of a case.
pub fn target(data: &[u8]) {
    // What the bytes are too few for is no input.
    let Ok(text) = scene::text(&mut Unstructured::new(data)) else {
        return;
    };
    let Ok(case) = Case::from_text("case.toml", &text, &[]) else {
        return;
    };
    if case.points() <= POINTS {
        try_steps(&case);
    }
}

fn try_steps(case: &Case) {
    let text = &*case.text;
    let scene = model::model::<PlaneStrain, 2>(case).unwrap_or_else(|error| panic!("{error} in\n{text}"));
    let points = model::points::<PlaneStrain, 2>(case, 0..case.grid.spans(0), |_| true);
    let mut run = SerialRun::new(scene, points);
    if run.start(case).is_err() {
        return;
    }
    check(&run.points, &run.model.grid, text);
    let schedule = model::schedule(case);
    let mut t = 0.0;
    for _ in 0..STEPS {
        let Some(end) = schedule.next(t) else { return };
        let before = (run.points.clone(), run.guess.clone());
        match run.step(t, end - t) {
            Ok(report) => {
                assert!(
                    report.force.is_finite() && run.guess.iter().all(|u| u.is_finite()),
                    "{report:?} in\n{text}"
                );
                check(&run.points, &run.model.grid, text);
                assert_eq!((&run.points.id, &run.points.mass), (&before.0.id, &before.0.mass));
                run.points.sort_by_cell(&run.model.grid);
            }
            Err(error) => {
                assert!(!error.to_string().is_empty());
                assert!(
                    (&run.points, &run.guess) == (&before.0, &before.1),
                    "{error} left traces in\n{text}"
                );
                return;
            }
        }
        t = end;
    }
}

/// All numbers finite, no point outside the grid or inside out.
fn check(points: &Points<2>, grid: &Grid<2>, text: &str) {
    let mut points = points.clone();
    for (name, column) in points.named_columns() {
        if column.number() == bsmpm::points::Number::F64 {
            let mut bytes = Vec::new();
            (0..column.rows()).for_each(|p| column.put(p, &mut bytes));
            let numbers = bytes
                .chunks_exact(8)
                .map(|bytes| f64::from_le_bytes(bytes.try_into().expect("eight")));
            assert!(
                numbers.into_iter().all(f64::is_finite),
                "{name} is not finite in\n{text}"
            );
        }
    }
    assert!(points.x.iter().all(|x| grid.locate(x).is_some()), "outside in\n{text}");
    assert!(points.F.iter().all(|F| F.determinant() > 0.0), "inside out in\n{text}");
    assert!(
        points.eps_p.iter().all(|eps_p| *eps_p >= 0.0),
        "negative plastic strain in\n{text}"
    );
}
