//! Width of the bands of cells in which strain localises. Warns of settings for which `band_width` is not verified.

use crate::case::{Case, Geometry, Site};
use crate::grid::GridSpec;
use crate::record::KeyPlace;
use crate::report::Report;
use crate::schema::Draft;
use crate::validate::SQUARE;
use crate::validate::place::is_at;
use crate::validate::site::{corners, places};
use crate::words::Word;
use bsmpm::material::{LayeredMaterial, Material};
use bsmpm::stabilisation::Stabilisation;
use bsmpm_shapes::GridAxis;

/// Cells across which a band of shear does the work of its softening. Splines of order 2 make no narrower slip than a
/// hat of strain over two cells, all of which softens sooner or later; measured with one free band
/// (`scripts/validate`).
pub(super) const CELLS_OF_BAND: f64 = 2.0;

/// Width of a band of cells in which strain localises, m; `None` after the error that cells have different sizes, which
/// belongs to the `key`.
pub(super) fn band_of_cells(key: &KeyPlace, grid: Option<&GridSpec>, report: &mut Report<'_>) -> Option<f64> {
    let axes = &grid?.axes;
    let shortest = axes.iter().map(GridAxis::shortest).fold(f64::INFINITY, f64::min);
    let longest = axes.iter().map(GridAxis::longest).fold(0.0, f64::max);
    if longest > SQUARE * shortest {
        let message = format!(
            "E0316: `{0}` needs cells of equal size, but the cells of the grid are {shortest} to {longest} m \
             long. Set `grid.cell` to one number, or remove `{0}`.",
            key.name()
        );
        key.error(message, report);
        return None;
    }
    Some(CELLS_OF_BAND * longest)
}

/// Warns of every material with a `band_width` outside of what was verified.
pub(in crate::validate) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    for (number, (_, record)) in draft.material.items().iter().enumerate() {
        let is_used = record.band_width.is_given() && case.is_followed(number);
        if !is_used || !falls(&case.materials[number].material) {
            continue;
        }
        let settings: Vec<String> = unverified_settings(case)
            .into_iter()
            .chain(unlike_a_band(case))
            .collect();
        if !settings.is_empty() {
            report.warn(format!(
                "W0304: {}: the scaling of softening by `band_width` is not verified {}, so the soil may soften too \
                 fast or too slowly. Compare the results of two cell sizes.",
                record.band_width.path(),
                settings.join(" and ")
            ));
        }
    }
}

/// Whether some strength is less in the end; what hardens has no bands.
fn falls(material: &LayeredMaterial) -> bool {
    let law = material.at(0.0);
    ["friction_angle", "cohesion"]
        .into_iter()
        .any(|key| parameter(&law, key) > parameter(&law, &format!("residual_{key}")))
}

/// The parameter of a law with a name; 0 where it has none.
fn parameter(law: &Material, name: &str) -> f64 {
    let names = law.parameter_names().iter().map(|parameter| parameter.name);
    names
        .zip(law.parameters())
        .find(|(own, _)| *own == name)
        .map_or(0.0, |(_, value)| value)
}

/// Geometry, stabilisation and splines with which the width is not verified, with the error of the dissipated energy
/// where that was measured.
fn unverified_settings(case: &Case) -> Vec<String> {
    let mut settings = Vec::new();
    if case.geometry != Geometry::PlaneStrain {
        settings.push(format!("for geometry = \"{}\"", case.geometry.word()));
    }
    match case.stabilisation {
        Stabilisation::ModifiedFBar => settings.push(format!("with \"modified-f-bar\" {}", error(1.3))),
        Stabilisation::None => settings.push(format!("without stabilisation {}", error(3.0))),
        Stabilisation::FBar | Stabilisation::ConsistentFBar | Stabilisation::SubgridFBar => {}
    }
    if case.grid.order == 1 {
        settings.push(format!("with linear splines {}", error(2.25)));
    }
    settings
}

/// The error of the dissipated energy with bands so many cells wide, in words.
fn error(cells: f64) -> String {
    format!("(dissipation {:+.0} %)", 100.0 * (cells / CELLS_OF_BAND - 1.0))
}

/// A footing or rigid body that pushes into the ground, below which the soil yields in a wider zone than one band.
fn unlike_a_band(case: &Case) -> Option<String> {
    let mut strips = case
        .footing
        .iter()
        .map(|of| of.site)
        .chain(case.prescribed.iter().map(|of| of.site));
    let pushes = strips.any(|site| is_narrow(case, site))
        || case
            .rigid
            .iter()
            .any(|body| body.is_moved() || body.free.contains(&true) || body.force != [0.0; 3]);
    pushes.then(|| "below a footing or rigid body".to_owned())
}

/// Whether a strip on the ground ends beside ground.
fn is_narrow(case: &Case, site: Site) -> bool {
    if matches!(site, Site::Face(_)) {
        return false;
    }
    let [from, to] = corners(site, &case.grid);
    let goes_on = [-0.25, 1.25].into_iter().any(|part| {
        let beyond = [0, 1, 2].map(|axis| from[axis] + part * (to[axis] - from[axis]));
        is_at(&case.bodies, &case.grid, beyond)
    });
    goes_on
        && places(site, &case.grid)
            .into_iter()
            .any(|at| is_at(&case.bodies, &case.grid, at))
}
