//! Validates materials, and warns of doubtful parameters.

pub(super) mod band;
mod cut_off;
mod law;
mod parameters;

use super::{limit_load, reduction};
use crate::case::{Body, NamedMaterial, Stage};
use crate::constants::STANDARD_GRAVITY;
use crate::grid::GridSpec;
use crate::record::{CaseTable, KeyPlace};
use crate::report::Report;
use crate::schema::{Draft, LawName, MaterialTable, Range, SupportTable};
use crate::words::{Geometry, Side};
use bsmpm::material::{LayeredMaterial, Profile};
use bsmpm::model::Regime;
use law::law;
use parameters::Parameters;

/// Materials at most: a point holds its material's number in 16 bits.
const MOST: usize = 65_536;

/// What the rest of the case says to materials.
#[derive(Clone, Copy)]
pub(super) struct CaseFacts<'a> {
    pub(super) regime: Option<Regime>,
    pub(super) geometry: Option<Geometry>,
    pub(super) grid: Option<&'a GridSpec>,
    pub(super) bodies: Option<&'a [Body]>,
    pub(super) stages: Option<&'a [Stage]>,
    pub(super) reduction: Reduction,
}

/// What [strength_reduction] makes of every material.
#[derive(Clone, Copy)]
pub(super) struct Reduction {
    /// that strength is divided by; 1: none
    factor: f64,
    /// no strength limits the stress
    elastic: bool,
    /// that Young's modulus is multiplied by
    stiffness: f64,
    /// the case seeks a limit load, which multiplies it
    is_for_limit_load: bool,
}

impl Reduction {
    /// That of the case; without the table none. Young's moduli are multiplied by a further `stiffness`.
    pub(super) fn of(draft: &Draft, stiffness: f64) -> Self {
        let table = draft.strength_reduction.value();
        let elastic = table.and_then(|table| table.elastic.get()).unwrap_or(false);
        let factor = reduction::at_start(draft).and_then(|table| table.factor.get());
        let own_stiffness = table.and_then(|table| table.stiffness.get());
        let is_for_limit_load = limit_load::is_sought(draft);
        Self {
            factor: factor.unwrap_or(1.0),
            elastic,
            stiffness: stiffness * own_stiffness.unwrap_or(1.0),
            is_for_limit_load,
        }
    }
}

/// All materials in the order of the file.
pub(super) fn read_all(draft: &Draft, around: CaseFacts<'_>, report: &mut Report<'_>) -> Option<Vec<NamedMaterial>> {
    let named = draft.material.items();
    if draft.material.is_given() && named.is_empty() {
        let message = "E0301: the case has no material. Add a table [material.NAME] for each soil.";
        draft.material.consequence(message, &["material"], report);
    }
    if named.len() > MOST {
        let message = format!(
            "E0302: the case has {} materials, and at most {MOST} are possible. Merge materials with equal \
             parameters.",
            named.len()
        );
        draft.material.error(message, report);
        return None;
    }
    let read = named
        .iter()
        .enumerate()
        .map(|(number, (name, record))| read(number, name, record, around, report));
    let read: Vec<_> = read.collect();
    let materials = read.into_iter().collect::<Option<Vec<_>>>()?;
    let is_limited = has_friction(draft) || materials.iter().any(|named| named.material.yields());
    if draft.strength_reduction.is_given() && !around.reduction.elastic && !is_limited {
        report.warn(reduction::without_strength("strength_reduction"));
    }
    Some(materials)
}

/// Whether a face of the grid, a rigid body or a strip has friction, by what is written of it.
fn has_friction(draft: &Draft) -> bool {
    let faces = draft.boundary.value();
    let mut sides = Side::ALL.as_flattened().iter();
    let bodies = draft.rigid.items().iter().map(|rigid| &rigid.friction_coefficient);
    let contacts = draft.strips().filter_map(|strip| strip.contact);
    let mut coefficients = bodies.chain(contacts.map(|contact| &contact.friction_coefficient));
    sides.any(|side| faces.is_some_and(|faces| faces.face(*side).table().is_some()))
        || coefficients.any(|key| key.get().is_some_and(|friction| friction > 0.0))
}

fn read(
    number: usize,
    name: &str,
    record: &MaterialTable,
    around: CaseFacts<'_>,
    report: &mut Report<'_>,
) -> Option<NamedMaterial> {
    let density = density(record, around.regime, report);
    let saturated = density.and_then(|density| saturated(record, density, report));
    let ratio = record.ru.if_given().map(Option::unwrap_or_default);
    let layer = Layer::of(number, around);
    let law = law(record, layer.as_ref(), around.grid, around.geometry, report);
    let retardation = retardation(record, around.regime, report);
    let young = record.young.profile();
    let poisson = record.poisson.get();
    if let (Some(young), Some(layer)) = (&young, &layer) {
        layer.check(&record.young, &Range::POSITIVE, young, report);
    }
    warn_of_stiffness(record, young.map(|young| young.value), poisson, report);
    let Reduction {
        factor,
        elastic,
        stiffness,
        ..
    } = around.reduction;
    refuse_reduced_yield(record, around.reduction, report);
    let young = young?;
    let poisson = poisson?;
    let law = law?;
    let law = if elastic { Parameters::elastic() } else { law };
    let young = Profile {
        value: stiffness * young.value,
        per_metre: stiffness * young.per_metre,
        ..young
    };
    note_stiffness(record, around.reduction, report);
    let material = law.material(record, young, poisson, layer.as_ref(), factor)?;
    if let Some(layer) = layer.filter(|_| factor != 1.0) {
        note_reduction(record, &material, &layer, factor, report);
    }
    let density = density?;
    let saturated = saturated?;
    let retardation = retardation?;
    Some(NamedMaterial {
        name: name.to_owned(),
        material,
        density,
        saturated,
        ratio: ratio?,
        retardation,
    })
}

/// Refuses a reduced strength of clay whose yield surface follows from its `ocr`.
fn refuse_reduced_yield(record: &MaterialTable, reduction: Reduction, report: &mut Report<'_>) {
    let of_yield = record.ocr.is_given() && record.model.get() == Some(LawName::CamClay);
    if reduction.factor != 1.0 && !reduction.elastic && of_yield {
        let message = "E0312: `ocr` sets the yield surface relative to the initial stress, so a lower strength \
             (strength_reduction.factor) would enlarge it. Give `preconsolidation` instead of `ocr`.";
        record.ocr.error(message, report);
    }
}

/// Notes a changed stiffness, and strength that is left out.
fn note_stiffness(record: &MaterialTable, reduction: Reduction, report: &mut Report<'_>) {
    let Reduction { elastic, stiffness, .. } = reduction;
    if elastic || stiffness != 1.0 {
        let value = format!("young x {stiffness}{}", if elastic { ", elastic" } else { "" });
        let reason = if reduction.is_for_limit_load {
            "analysis.purpose"
        } else {
            "strength_reduction.elastic and .stiffness"
        };
        report.note(&record.location().path, value, reason);
    }
}

/// Heights (m, in the case's coordinates) between which bodies of a material lie; the grid's if there are none.
struct Layer {
    heights: std::ops::Range<f64>,
    base: f64, // of the grid
}

impl Layer {
    fn of(number: usize, around: CaseFacts<'_>) -> Option<Self> {
        let grid = around.grid?;
        let bodies = around.bodies?;
        let exchanges = around.stages.unwrap_or_default().iter();
        let exchanges = exchanges.flat_map(|stage| &stage.materials);
        let replaced: Vec<usize> = exchanges
            .filter(|(_, to)| *to == number)
            .map(|(from, _)| *from)
            .collect();
        let up = grid.dims() - 1;
        let made = bodies
            .iter()
            .filter(|body| body.material == number || replaced.contains(&body.material))
            .map(|body| body.region.corners());
        let made = made.map(|corners| corners.map(|corner| corner[up]));
        let found = made.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
        let [lower, upper] = found.unwrap_or([grid.lower(), grid.upper()].map(|corner| corner[up]));
        Some(Self {
            heights: lower..upper,
            base: grid.lower()[up],
        })
    }

    /// Reports a parameter that varies with height and leaves its range; a constant has been compared with it before.
    fn check(&self, key: &KeyPlace, range: &Range, profile: &Profile, report: &mut Report<'_>) {
        if profile.per_metre == 0.0 && range.contains(profile.value) {
            return;
        }
        for y in [self.heights.start, self.heights.end] {
            let value = profile.at(y);
            if !range.contains(value) {
                let message = format!(
                    "E0303: the value at y = {y} m, inside a body of this material, is {value} (allowed: {}). \
                     Correct `value` or `per_metre` of this parameter.",
                    range.condition(key.name())
                );
                key.error(message, report);
                return;
            }
        }
    }
}

/// Notes the reduced strength, at the lowest and the highest place if it differs there.
fn note_reduction(
    record: &MaterialTable,
    material: &LayeredMaterial,
    layer: &Layer,
    factor: f64,
    report: &mut Report<'_>,
) {
    let low = parameters_at(material, layer.heights.start - layer.base);
    let high = parameters_at(material, layer.heights.end - layer.base);
    if low.is_empty() {
        return;
    }
    let value = if low == high {
        low
    } else {
        format!(
            "{low} at y = {}; {high} at y = {}",
            layer.heights.start, layer.heights.end
        )
    };
    report.note(
        &record.location().path,
        value,
        format!("strength_reduction.factor = {factor}"),
    );
}

/// The parameters of a material at a height (m, above the grid's base) in words.
fn parameters_at(material: &LayeredMaterial, height: f64) -> String {
    let law = material.at(height);
    let named = law.parameter_names().iter().zip(law.parameters());
    let written = named.map(|(parameter, value)| match parameter.unit {
        "rad" => format!("{} = {:.6} deg", parameter.name, value.to_degrees()),
        unit => format!("{} = {value:.6} {unit}", parameter.name),
    });
    written.collect::<Vec<_>>().join(", ")
}

/// kg/m3; the outer option is `None` after an error.
fn density(record: &MaterialTable, regime: Option<Regime>, report: &mut Report<'_>) -> Option<Option<f64>> {
    let density = match (record.unit_weight.is_given(), record.density.is_given()) {
        (true, _) => {
            let density = record.unit_weight.get()? / STANDARD_GRAVITY;
            report.note(record.density.path(), format!("{density}"), "unit_weight / 9.81 m/s2");
            density
        }
        (_, true) => record.density.get()?,
        _ if regime == Some(Regime::Dynamic) => {
            let message = "E0310: a dynamic analysis needs the mass of the material. Add `unit_weight` or `density`.";
            record.location().error(message, report);
            return None;
        }
        _ => return Some(None),
    };
    let has_unit = record.unit_weight.has_unit() || record.density.has_unit();
    if !has_unit && !(100.0..=30_000.0).contains(&density) {
        report.warn(format!(
            "W0108: {}: a density of {density:.3} kg/m3 (unit weight {:.3} kN/m3) is unusual: soil and rock have 5 to \
             30 kN/m3. Check the value, and write its unit, such as unit_weight = \"20 kN/m3\".",
            record.location().path,
            density * STANDARD_GRAVITY * 1e-3
        ));
    }
    Some(Some(density))
}

/// kg/m3  of a material below the water table; the outer option is `None` after an error.
fn saturated(record: &MaterialTable, density: Option<f64>, report: &mut Report<'_>) -> Option<Option<f64>> {
    let key = &record.saturated_unit_weight;
    let Some(unit_weight) = key.if_given()? else {
        return Some(None);
    };
    let saturated = unit_weight / STANDARD_GRAVITY;
    match density {
        None => {
            let message = "E0310: `saturated_unit_weight` is given, but not the unit weight above the water table. Add \
                 `unit_weight` or `density`.";
            key.error(message, report);
        }
        Some(dry) if saturated < dry => {
            let [wet, dry] = [saturated, dry].map(|density| density * STANDARD_GRAVITY * 1e-3);
            let message = format!(
                "E0309: the saturated unit weight ({wet:.6} kN/m3) is below the unit weight above the water table \
                 ({dry:.6} kN/m3). Correct one of the two unit weights."
            );
            key.error(message, report);
        }
        Some(_) => {}
    }
    report.note(
        format!("{}.saturated density", record.location().path),
        format!("{saturated}"),
        "saturated_unit_weight / 9.81 m/s2",
    );
    Some(Some(saturated))
}

/// s  of its damping, 0 without; `None` after an error.
fn retardation(record: &MaterialTable, regime: Option<Regime>, report: &mut Report<'_>) -> Option<f64> {
    let Some(damping) = record.damping.value() else {
        return Some(0.0);
    };
    if regime == Some(Regime::QuasiStatic) {
        let message = "E0311: a quasi-static analysis has no velocities, so damping cannot act. Remove `damping`, or \
                       use analysis.type = \"dynamic\".";
        record.damping.error(message, report);
    }
    let ratio = damping.ratio.get()?;
    let frequency = damping.frequency.get()?;
    let time = ratio / (std::f64::consts::PI * frequency);
    report.note(
        &damping.location().path,
        format!("retardation time {time:.6} s"),
        "ratio/(pi frequency)",
    );
    Some(time)
}

/// Poisson's ratio above which an elastic material is nearly incompressible.
const STIFF: f64 = 0.4999;
/// Poisson's ratio from which a material that yields is: Tresca's footing takes three times the iterations there.
const STIFF_TO_FLOW: f64 = 0.499;

fn warn_of_stiffness(record: &MaterialTable, young: Option<f64>, poisson: Option<f64>, report: &mut Report<'_>) {
    // Without a unit it is looked at with the stresses of the case.
    let least = if record.young.has_unit() { 1e3 } else { 0.0 };
    if let Some(young) = young.filter(|young| !(least..=1e12).contains(young)) {
        report.warn(format!(
            "W0302: {}: a Young's modulus of {} kPa is unusual (usual: 1 kPa to 1000 GPa). Check the unit of \
             `young`.",
            record.location().path,
            young * 1e-3
        ));
    }
    let Some(model) = record.model.get() else {
        return;
    };
    let poisson = poisson.filter(|of| *of > STIFF || model != LawName::Hencky && *of >= STIFF_TO_FLOW);
    let Some(poisson) = poisson else { return };
    let by_itself =
        [LawName::SensitiveClay, LawName::MuI, LawName::CamClay].contains(&model) || record.drainage.is_given();
    let instead = young.filter(|_| !by_itself).map(|young| as_undrained(young, poisson));
    let path = &record.location().path;
    report.warn(match instead {
        Some((young, bulk)) => format!(
            "W0303: {path}: poisson = {poisson} makes pressures oscillate. Set drainage = \"undrained\", young = \
             {young:.5e}, poisson = {DRAINED}, porosity = {POROSITY}, water.bulk = {bulk:.5e}, analysis.type = \
             \"consolidation\"."
        ),
        None => format!(
            "W0303: {path}: poisson = {poisson} makes the pressure oscillate, and the solver needs many iterations. \
             Use poisson = 0.49 or less."
        ),
    });
}

/// Poisson's ratio of a skeleton whose water carries the pressure, and the part of the volume that it has.
const DRAINED: f64 = 0.25;
const POROSITY: f64 = 0.5;

/// Young's modulus of such a skeleton, and the bulk modulus of its water, with which undrained soil has the elasticity
/// of `young` and `poisson`.
fn as_undrained(young: f64, poisson: f64) -> (f64, f64) {
    let skeleton = young * (1.0 + DRAINED) / (1.0 + poisson);
    let water = bulk_modulus(young, poisson) - bulk_modulus(skeleton, DRAINED);
    (skeleton, POROSITY * water)
}

/// Bulk modulus of an elastic material, Pa.
fn bulk_modulus(young: f64, poisson: f64) -> f64 {
    young / (3.0 * (1.0 - 2.0 * poisson))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn undrained_soil_is_as_stiff_as_what_it_stands_for() {
        let (young, bulk) = as_undrained(1e5, 0.4999);
        let shear = |young: f64, poisson: f64| young / (2.0 * (1.0 + poisson));
        assert!((shear(young, DRAINED) / shear(1e5, 0.4999) - 1.0).abs() < 1e-12);
        let whole = young / (3.0 * (1.0 - 2.0 * DRAINED)) + bulk / POROSITY;
        assert!((whole * 3.0 * (1.0 - 2.0 * 0.4999) / 1e5 - 1.0).abs() < 1e-9);
    }
}
