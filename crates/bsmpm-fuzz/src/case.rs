//! Fuzzes the parser of case files.

use bsmpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain, Solid};
use bsmpm_scene::{Case, Error, Estimate, Geometry, seed};

/// Between the file and its overrides, and between those; no TOML holds it.
const SEPARATOR: u8 = 0x1e;
/// Overrides at most.
const OVERRIDES: usize = 8;
/// Points, cells, and columns of cells, beyond which none are made.
const MOST: u64 = 4096;

/// A case file, then overrides.
pub fn target(data: &[u8]) {
    let mut parts = data.split(|&byte| byte == SEPARATOR);
    let bytes = parts.next().unwrap_or_default();
    let overrides: Vec<String> = parts
        .take(OVERRIDES)
        .map(|part| String::from_utf8_lossy(part).into_owned())
        .collect();
    match Case::from_bytes("case.toml", bytes, &overrides) {
        Ok(case) => accepted(&case),
        Err(errors) => refused(&errors),
    }
}

/// The effective text is the same case again, the estimate counts the points that there are, and all lie in the grid.
fn accepted(case: &Case) {
    let again = Case::from_text("case.toml", &case.text, &[]);
    assert_eq!(again.as_ref(), Ok(case), "the case as it is run is another one");
    let estimate = case.estimate(1);
    assert_eq!(estimate.points, case.points());
    assert!(estimate.points > 0 && estimate.cells > 0 && estimate.nodes > estimate.cells);
    let columns = case.grid.axes[0].cells();
    if estimate.points > MOST || columns as u64 > MOST {
        return;
    }
    match case.geometry {
        Geometry::PlaneStrain => seeded::<PlaneStrain, 2>(case, &estimate),
        Geometry::Axisymmetric => seeded::<Axisymmetric, 2>(case, &estimate),
        Geometry::Solid => seeded::<Solid, 3>(case, &estimate),
    }
}

/// A case that is accepted has a model, and as many points as it says.
fn seeded<K: Kinematics<D>, const D: usize>(case: &Case, estimate: &Estimate) {
    let columns = case.grid.axes[0].cells();
    if estimate.cells <= MOST {
        bsmpm_scene::model::model::<K, D>(case).expect("a model of what is accepted");
    }
    let by_column = case.points_by_column();
    assert_eq!(
        (by_column.len(), by_column.iter().sum()),
        (case.grid.spans(0), estimate.points)
    );
    let mut count = 0;
    for (number, seed) in seed::<K, D>(case, 0..columns).enumerate() {
        assert_eq!(seed.id, number as u64);
        assert!(usize::from(seed.material) < case.materials.len());
        assert!(
            seed.volume > 0.0 && seed.volume.is_finite() && seed.mass >= 0.0 && seed.mass.is_finite(),
            "{seed:?}"
        );
        for (x, axis) in seed.x.iter().zip(&case.grid.axes) {
            assert!((0.0..=axis.length()).contains(x), "{seed:?} of {axis:?}");
        }
        count += 1;
    }
    assert_eq!(count, estimate.points);
}

/// Every error has something to say, on one line, and nothing in it commands the terminal.
fn refused(errors: &[Error]) {
    assert!(!errors.is_empty());
    for error in errors {
        assert!(!error.message.is_empty());
        let line = error.to_string();
        let page = format!("{error:#}");
        assert!(!line.chars().any(char::is_control), "{line:?}");
        assert!(!page.chars().any(|c| c.is_control() && c != '\n'), "{page:?}");
    }
}
