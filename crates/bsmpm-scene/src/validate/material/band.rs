//! Where a band of shear was not shown to do the work that `band_width` is scaled for.

use super::law::CELLS_OF_BAND;
use crate::case::{Case, Geometry, Rigid, Site};
use crate::record::Record;
use crate::report::Report;
use crate::validate::place::is_at;
use crate::validate::site::{corners, places};
use crate::words::Word;
use bsmpm::material::Material;
use bsmpm::stabilisation::Stabilisation;

/// Warns of every material with a `band_width` outside of what `cases/results/softening.md` measured.
pub(in crate::validate) fn check(case: &Case, root: &Record, report: &mut Report<'_>) {
    let softens = |number: usize, record: &Record| {
        record.gives("band_width") && case.is_followed(number) && falls(&case.materials[number].material)
    };
    let named = root.named("material").iter().enumerate();
    for (_, (_, record)) in named.filter(|(number, (_, of))| softens(*number, of)) {
        let told: Vec<String> = not_shown(case).into_iter().chain(unlike_a_band(case)).collect();
        if !told.is_empty() {
            report.warn(format!(
                "{}: cells are scaled for bands that do the work of {CELLS_OF_BAND} of them, as was measured in plane strain \
                 with \"consistent-f-bar\", \"f-bar\" or \"subgrid-f-bar\" and splines of order 2 and 3; {}; compare two cell \
                 sizes",
                record.path_of("band_width"),
                told.join("; ")
            ));
        }
    }
}

/// Whether some strength is less in the end; what hardens has no bands.
fn falls(material: &Material) -> bool {
    let law = material.at(0.0);
    let numbers = law.parameters();
    let of = |key: &str| {
        let place = law.parameter_names().iter().position(|parameter| parameter.name == key);
        place.map_or(0.0, |place| numbers[place])
    };
    ["friction_angle", "cohesion"].into_iter().any(|key| of(key) > of(&format!("residual_{key}")))
}

/// Of the splines, the method and the geometry.
fn not_shown(case: &Case) -> Vec<String> {
    let mut told = Vec::new();
    let off = |of: f64| 100.0 * (of / CELLS_OF_BAND - 1.0);
    if case.geometry != Geometry::PlaneStrain {
        told.push(format!("in \"{}\" it never was", case.geometry.word()));
    }
    match case.stabilisation {
        Stabilisation::ModifiedFBar => {
            told.push(format!("with \"modified-f-bar\" it is that of 1.3, {:.0} %", off(1.3)));
        }
        Stabilisation::None => told.push(format!("without stabilisation it is that of 3.0, {:+.0} %", off(3.0))),
        Stabilisation::FBarZhao => told.push(format!("with \"{}\" it never was", case.stabilisation.word())),
        Stabilisation::FBar | Stabilisation::ConsistentFBar | Stabilisation::SubgridFBar => {}
    }
    if case.grid.order == 1 {
        told.push(format!("with linear splines it is that of 2.25, {:+.0} %", off(2.25)));
    }
    told
}

/// Of what pushes into the ground: no one band lies under it.
fn unlike_a_band(case: &Case) -> Option<String> {
    let mut strips = case.footing.iter().map(|of| of.site).chain(case.prescribed.iter().map(|of| of.site));
    let is_narrow = |site: Site| {
        if matches!(site, Site::Face(_)) {
            return false;
        }
        let [from, to] = corners(site, &case.grid);
        let beyond = |part: f64| [0, 1, 2].map(|axis| from[axis] + part * (to[axis] - from[axis]));
        [-0.25, 1.25].into_iter().any(|part| is_at(&case.bodies, &case.grid, beyond(part)))
            && places(site, &case.grid).into_iter().any(|at| is_at(&case.bodies, &case.grid, at))
    };
    let is_driven = |body: &Rigid| body.is_moved() || body.free.contains(&true) || body.force != [0.0; 3];
    let pushes = strips.any(is_narrow) || case.rigid.iter().any(is_driven);
    pushes.then(|| "under a strip, where what yields is wider, curves of two cells were 10.6 % apart".to_owned())
}
