//! Checks of a tension cut-off, and its softening by the cell size.

use super::Layer;
use super::band::band_of_cells;
use super::parameters::Parameters;
use crate::grid::GridSpec;
use crate::record::{CaseTable, KeyPlace};
use crate::report::Report;
use crate::rounding::brief;
use crate::schema::MaterialTable;
use bsmpm::material::Decay;

/// Tensile strength relative to that of the apex, above which it has no effect: more than round-off.
const BEYOND: f64 = 1.0 + 1e-9;
/// Steepness of the exponential decrease at its start, relative to that of the linear one.
const STEEPEST: f64 = 3.0;

/// Checks the keys of the cut-off, and replaces the crack opening by the crack strain of cells; `None` after an error.
pub(super) fn check(
    record: &MaterialTable,
    law: &mut Parameters<'_>,
    layer: Option<&Layer>,
    grid: Option<&GridSpec>,
    report: &mut Report<'_>,
) -> Option<()> {
    let strength: &KeyPlace = &record.tensile_strength;
    let opening: &KeyPlace = &record.crack_opening;
    let dependent: [[&KeyPlace; 2]; 3] = [
        [opening, strength],
        [&record.softening, opening],
        [&record.reduce_tensile_strength, strength],
    ];
    if let Some([key, needed]) = dependent
        .iter()
        .find(|[key, needed]| key.is_given() && !needed.is_given())
    {
        let message = format!(
            "E0323: `{0}` has no effect without `{1}`. Add `{1}`, or remove `{0}`.",
            key.name(),
            needed.name()
        );
        key.error(message, report);
        return None;
    }
    if !strength.is_given() {
        return Some(());
    }
    warn_of_apex(record, layer, report);
    if opening.is_given() {
        let smeared = band_of_cells(opening, grid, report)?;
        let width = record.crack_opening.get()?;
        let strain = width / smeared;
        law.set(opening.name(), strain);
        report.note(
            opening.path(),
            strain.to_string(),
            format!("plastic strain: {width} m over a band of cells {smeared} m wide"),
        );
        warn_of_collapse(record, strain, layer, report);
    }
    Some(())
}

/// Heights at which profiles have their least and largest values.
fn ends(layer: Option<&Layer>) -> [f64; 2] {
    layer.map_or([0.0, 0.0], |layer| [layer.heights.start, layer.heights.end])
}

/// A tensile strength above the mean stress of the apex, which limits nothing.
fn warn_of_apex(record: &MaterialTable, layer: Option<&Layer>, report: &mut Report<'_>) {
    for y in ends(layer) {
        let friction = record.friction_angle.profile_or_zero().at(y).to_radians();
        let apex = record.cohesion.profile_or_zero().at(y) / friction.tan();
        let strength = record.tensile_strength.profile_or_zero().at(y);
        if friction > 0.0 && strength > BEYOND * apex {
            report.warn(format!(
                "W0318: {}: {} Pa has no effect at y = {y} m, because the law carries at most c/tan(phi) = {} Pa. \
                 Reduce it below this value, or remove it.",
                record.tensile_strength.path(),
                brief(strength),
                brief(apex)
            ));
            return;
        }
    }
}

/// A tensile strength that decreases faster than the tension of soil that unloads: it is lost at once.
fn warn_of_collapse(record: &MaterialTable, strain: f64, layer: Option<&Layer>, report: &mut Report<'_>) {
    let Some(young) = record.young.profile() else { return };
    let steepest = if record.softening.get() == Some(Decay::Exponential) {
        STEEPEST
    } else {
        1.0
    };
    let strain = strain / steepest;
    for y in ends(layer) {
        let rate = record.tensile_strength.profile_or_zero().at(y) / strain;
        let limit = young.at(y);
        if rate > limit {
            report.warn(format!(
                "W0319: {}: the tensile strength falls by {rate:.3e} Pa per unit of crack strain (Young's modulus: \
                 {limit:.3e} Pa), so a crack loses its strength at once. Increase `crack_opening`, or use smaller cells.",
                record.location().path
            ));
            return;
        }
    }
}
