//! Validates the permeability of a soil.

use crate::report::Report;
use crate::schema::MaterialTable;
use bsmpm::field::pore_water::flow::{Permeability, PermeabilityLaw};

/// Permeability, m/s, beyond which a number is taken for a slip: that of gravel without sand.
const MOST_PERMEABLE: f64 = 1.0;
/// The same, m/s, of the tightest clay.
const LEAST_PERMEABLE: f64 = 1e-14;

/// The hydraulic conductivity along each axis, m/s, and its law; a value without a unit is compared with that of soils.
pub(super) fn permeability(record: &MaterialTable, report: &mut Report<'_>) -> Option<Permeability<3>> {
    let given = record.permeability.value()?;
    // Of a plane the third one moves nothing.
    let along = [0, 1, 2].map(|axis| given[axis.min(given.len() - 1)]);
    // A value with a unit is taken as it is meant.
    let unitless = if record.permeability.has_unit() {
        &[][..]
    } else {
        &along
    };
    if let Some(much) = unitless.iter().find(|k| **k > MOST_PERMEABLE) {
        let path = record.permeability.path();
        report.warn(format!(
            "W0109: {path}: a permeability of {much} m/s is above that of gravel (up to {MOST_PERMEABLE} m/s), so the \
             soil would drain at once. Check the value, and write its unit, such as \"1e-5 m/s\"."
        ));
    }
    if let Some(little) = unitless.iter().find(|k| **k > 0.0 && **k < LEAST_PERMEABLE) {
        report.warn(format!(
            "W0109: {}: a permeability of {little:e} m/s is below that of bentonite (1e-14 m/s). If the value is an \
             intrinsic permeability in m2, multiply the value by 1e7 to convert it to m/s.",
            record.permeability.path()
        ));
    }
    let law = record.permeability_law.if_given()?.unwrap_or(PermeabilityLaw::Constant);
    Some(Permeability {
        along: along.into(),
        law,
    })
}
