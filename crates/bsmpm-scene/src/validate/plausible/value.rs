//! Warns of values that are probably given in a wrong unit.

use super::Scale;
use crate::record::{Field, KeyPlace, OrTable};
use crate::report::Report;
use crate::schema::{DepthTable, Draft, MaterialTable};

/// Young's modulus (Pa) above which it is that of some soil.
const STIFF: f64 = 1e5;
/// The same below which it is that of none.
const SOFT: f64 = 1e3;
/// Stress of the case over Young's modulus from which on soil would be squeezed by parts of its height.
const SQUEEZED: f64 = 0.05;
/// Strength (Pa) above which it is that of some soil.
const STRONG: f64 = 100.0;
/// Strength over the stress of the case below which it carries nothing of it.
const NOTHING: f64 = 1e-3;
/// Young's modulus over strength above which one of them is out of scale, where no stress is known.
const RIGID: f64 = 1e5;
/// Friction angle (degrees) below which it is that of no soil; radians are less than this.
const FLAT: f64 = 2.0;
/// Dilation angle (degrees) below which it may be in radians: that of 45 degrees.
const BARELY: f64 = 0.8;
/// Load over the stress of the case below which it changes nothing.
const NO_LOAD: f64 = 1e-3;
/// Pressure (Pa) above which it is no slip.
const LOAD: f64 = 1e3;
/// Force over the weight of a square of the case's height below which it changes nothing.
const NO_FORCE: f64 = 1e-4;

/// Stiffness, strength and angles of a material.
pub(super) fn material(record: &MaterialTable, scale: &Scale, report: &mut Report<'_>) {
    if let Some(young) = bare(&record.young).filter(|young| is_soft(*young, scale)) {
        report.warn(format!(
            "W0101: {}: a modulus of {young} Pa ({} kPa) is too small for the stress in this case{}. If kPa are \
             meant, write \"{young} kPa\"; otherwise write \"{young} Pa\".",
            record.young.path(),
            1e-3 * young,
            scale.shown()
        ));
    }
    for key in [&record.cohesion, &record.yield_stress, &record.residual_cohesion] {
        let Some(strength) = bare(key).filter(|strength| is_weak(*strength, record, scale)) else {
            continue;
        };
        report.warn(format!(
            "W0102: {}: a strength of {strength} Pa ({} kPa) is negligible against the stress in this case{}. If kPa \
             are meant, write \"{strength} kPa\"; otherwise write \"{strength} Pa\".",
            key.path(),
            1e-3 * strength,
            scale.shown()
        ));
    }
    for (key, least) in [
        (&record.friction_angle, FLAT),
        (&record.residual_friction_angle, FLAT),
        (&record.dilation_angle, BARELY),
        (&record.residual_dilation_angle, BARELY),
    ] {
        let Some(angle) = bare(key).filter(|angle| angle.abs() < least) else {
            continue;
        };
        report.warn(format!(
            "W0103: {}: an angle of {angle} degrees is so small that radians may be meant ({:.3} degrees). Without a \
             unit, angles are in degrees. Write \"{angle} rad\" or \"{angle} deg\".",
            key.path(),
            angle.to_degrees()
        ));
    }
}

/// Whether soil with this modulus (Pa) would not stand the case.
fn is_soft(young: f64, scale: &Scale) -> bool {
    let is_squeezed = scale.stress.is_some_and(|stress| stress > SQUEEZED * young);
    young < SOFT || young <= STIFF && is_squeezed
}

/// Whether a strength (Pa) is nothing beside the stress of the case or, where that is not known, beside the modulus.
fn is_weak(strength: f64, record: &MaterialTable, scale: &Scale) -> bool {
    let young = record.young.profile_or_zero().value;
    let is_nothing = scale
        .stress
        .map_or(young > RIGID * strength, |stress| strength < NOTHING * stress);
    strength < STRONG && is_nothing
}

/// Tractions and point loads.
pub(super) fn loads(draft: &Draft, scale: &Scale, report: &mut Report<'_>) {
    let Some(stress) = scale.stress else { return };
    for record in draft.traction.items() {
        let pressure = bare(&record.pressure).map(f64::abs);
        let pressure = pressure.or_else(|| match record.stress.value()? {
            OrTable::Value(stress) => bare_list(&record.stress, stress),
            OrTable::Table(_) => None,
        });
        let key: &KeyPlace = match record.pressure.is_given() {
            true => &record.pressure,
            false => &record.stress,
        };
        if let Some(load) = pressure.filter(|load| *load < LOAD && *load < NO_LOAD * stress) {
            report.warn(format!(
                "W0110: {}: a load of {load} Pa ({} kPa) is negligible against the stress in this case{}. If kPa are \
                 meant, write \"{load} kPa\"; otherwise write \"{load} Pa\".",
                key.path(),
                1e-3 * load,
                scale.shown()
            ));
        }
    }
    for record in draft.point_load.items() {
        let weight = stress * scale.height;
        if let Some(force) = bare_list(&record.force, record.force.items()).filter(|force| *force < NO_FORCE * weight) {
            report.warn(format!(
                "W0110: {}: a force of {force} N is negligible against the weight of the soil in this case ({:.3} \
                 kN). Check the value, and write its unit, such as \"{force} kN/m\" in plane strain.",
                record.force.path(),
                1e-3 * weight
            ));
        }
    }
}

/// The value of a key, or of its profile, if it is written without a unit.
fn bare<T: DepthTable>(key: &Field<OrTable<f64, T>>) -> Option<f64> {
    let (place, value): (&KeyPlace, f64) = match key.value()? {
        OrTable::Value(value) => (key, *value),
        OrTable::Table(table) => (table.value(), table.value().get()?),
    };
    (value != 0.0 && !place.has_unit()).then_some(value)
}

/// Size of a vector that is written without units.
fn bare_list(key: &KeyPlace, numbers: &[f64]) -> Option<f64> {
    let size = numbers.iter().map(|along| along * along).sum::<f64>().sqrt();
    (size > 0.0 && !key.has_unit()).then_some(size)
}
