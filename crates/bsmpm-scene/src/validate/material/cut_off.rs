//! Checks of a tension cut-off, and its softening by the cell size.

use super::band::band_of_cells;
use super::parameters::Parameters;
use super::{Layer, profile};
use crate::grid::GridSpec;
use crate::record::Record;
use crate::report::Report;
use crate::rounding::brief;
use bsmpm::material::Decay;

/// Keys that have a meaning only with others.
const DEPENDENT: [[&str; 2]; 3] = [
    ["crack_opening", "tensile_strength"],
    ["softening", "crack_opening"],
    ["reduce_tensile_strength", "tensile_strength"],
];
/// Tensile strength relative to that of the apex, above which it has no effect: more than round-off.
const BEYOND: f64 = 1.0 + 1e-9;
/// Steepness of the exponential decrease at its start, relative to that of the linear one.
const STEEPEST: f64 = 3.0;

/// Checks the keys of the cut-off, and replaces the crack opening by the crack strain of cells; `None` after an error.
pub(super) fn check(
    record: &Record,
    law: &mut Parameters,
    layer: Option<&Layer>,
    grid: Option<&GridSpec>,
    report: &mut Report<'_>,
) -> Option<()> {
    for [key, needed] in DEPENDENT {
        if record.gives(key) && !record.gives(needed) {
            let message =
                format!("E0323: `{key}` has no effect without `{needed}`. Add `{needed}`, or remove `{key}`.");
            record.error(key, message, report);
            return None;
        }
    }
    if !record.gives("tensile_strength") {
        return Some(());
    }
    warn_of_apex(record, law, layer, report);
    if record.gives("crack_opening") {
        let smeared = band_of_cells(record, "crack_opening", grid, report)?;
        let opening = record.number("crack_opening")?;
        let strain = opening / smeared;
        law.set("crack_opening", strain);
        report.note(
            record.path_of("crack_opening"),
            strain.to_string(),
            format!("plastic strain: {opening} m over a band of cells {smeared} m wide"),
        );
        warn_of_collapse(record, law, layer, report);
    }
    Some(())
}

/// Heights at which profiles have their least and largest values.
fn ends(layer: Option<&Layer>) -> [f64; 2] {
    layer.map_or([0.0, 0.0], |layer| [layer.heights.start, layer.heights.end])
}

/// A tensile strength above the mean stress of the apex, which limits nothing.
fn warn_of_apex(record: &Record, law: &Parameters, layer: Option<&Layer>, report: &mut Report<'_>) {
    for y in ends(layer) {
        let friction = law.of("friction_angle").at(y).to_radians();
        let apex = law.of("cohesion").at(y) / friction.tan();
        let strength = law.of("tensile_strength").at(y);
        if friction > 0.0 && strength > BEYOND * apex {
            report.warn(format!(
                "W0318: {}: {} Pa has no effect at y = {y} m, because the law carries at most c/tan(phi) = {} Pa. \
                 Reduce it below this value, or remove it.",
                record.path_of("tensile_strength"),
                brief(strength),
                brief(apex)
            ));
            return;
        }
    }
}

/// A tensile strength that decreases faster than the tension of soil that unloads: it is lost at once.
fn warn_of_collapse(record: &Record, law: &Parameters, layer: Option<&Layer>, report: &mut Report<'_>) {
    let Some(young) = profile(record, "young") else { return };
    let steepest = if record.word("softening") == Some(Decay::Exponential) {
        STEEPEST
    } else {
        1.0
    };
    let strain = law.of("crack_opening").value / steepest;
    for y in ends(layer) {
        let rate = law.of("tensile_strength").at(y) / strain;
        let limit = young.at(y);
        if rate > limit {
            report.warn(format!(
                "W0319: {}: the tensile strength falls by {rate:.3e} Pa per unit of crack strain (Young's modulus: \
                 {limit:.3e} Pa), so a crack loses its strength at once. Increase `crack_opening`, or use smaller cells.",
                record.path
            ));
            return;
        }
    }
}
