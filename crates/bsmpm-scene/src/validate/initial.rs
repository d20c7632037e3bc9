//! Validates the initial stress.

use crate::case::{Body, Case, Gravity, Initial, NamedMaterial};
use crate::record::CaseTable;
use crate::report::Report;
use crate::schema::{Draft, InitialTable, LawName, MaterialTable};
use crate::words::{Geometry, Settled, Start};
use bsmpm::model::Regime;

/// The stress at the start, if any: the whole gravity acts from time 0 then.
pub(super) fn initial(
    draft: &Draft,
    materials: Option<&[NamedMaterial]>,
    bodies: Option<&[Body]>,
    gravity: Option<&Gravity>,
    regime: Option<Regime>,
    report: &mut Report<'_>,
) -> Option<Initial> {
    let record = draft.initial.value();
    let elastic = record.is_some_and(|record| record.gravity.is_given());
    if record.is_none() || elastic {
        let (what, instead) = match elastic {
            true => (
                "initial.gravity = \"elastic\" replaces initial stresses from k0",
                "delete initial.gravity",
            ),
            false => ("the case has no [initial]", "add a table [initial]"),
        };
        for (_, material) in draft.material.items() {
            let ocr = is_of_k0(material).then_some(&material.ocr);
            let k0 = Some(&material.k0).filter(|k0| k0.is_given());
            if let Some(key) = k0.or(ocr) {
                let name = key.name();
                let message = format!("E0405: `{name}` has no effect, because {what}. Delete `{name}`, or {instead}.");
                key.error(message, report);
            }
        }
    }
    let record = record?;
    loaded(draft, record, materials, bodies, gravity, report);
    if elastic {
        return record.gravity.get().map(|start| match start {
            Start::Elastic => Initial::Elastic,
        });
    }
    let dims = draft.geometry.get()?.dims();
    if let Some(gravity) = gravity.filter(|of| !of.acts_down(dims, regime)) {
        let message = format!(
            "E0406: gravity.acceleration = {:?} m/s2 is not vertical, but initial stresses from k0 are in equilibrium \
             with vertical gravity only. Correct this vector, or use initial.gravity = \"elastic\".",
            &gravity.acceleration[..dims]
        );
        draft.gravity.value()?.acceleration.error(message, report);
    }
    at_rest(draft, record, bodies?, report).map(Initial::AtRest)
}

/// Warns of loads that act in full from the start: a state by k0 knows the weight alone.
pub(super) fn sudden(case: &Case, report: &mut Report<'_>) {
    if case.settles || !matches!(case.initial, Some(Initial::AtRest(_))) {
        return;
    }
    for load in case.sudden_loads() {
        report.warn(format!(
            "W0405: {load}: the first step applies the whole load at once, because initial stresses from k0 balance \
             the weight only. Give the load a `ramp`."
        ));
    }
}

/// Gravity must act from the start, on something.
fn loaded(
    draft: &Draft,
    record: &InitialTable,
    materials: Option<&[NamedMaterial]>,
    bodies: Option<&[Body]>,
    gravity: Option<&Gravity>,
    report: &mut Report<'_>,
) {
    if !draft.gravity.is_given() {
        record.location().error(
            "E0407: initial stresses follow from the weight of the soil, but the case has no gravity. Add [gravity].",
            report,
        );
    }
    let dims = draft.geometry.get().map_or(3, Geometry::dims);
    if let (Some(gravity), Some(written)) = (gravity, draft.gravity.value())
        && gravity.ramp > 0.0
        && gravity.is_straight(dims)
    {
        let message = format!(
            "E0409: [initial] gives the stresses of the full weight at t = 0, but gravity.ramp increases gravity from \
             zero until t = {}. Delete gravity.ramp, or delete [initial].",
            gravity.ramp
        );
        written.ramp.error(message, report);
    }
    if let (Some(materials), Some(bodies)) = (materials, bodies)
        && bodies.iter().all(|body| materials[body.material].density.is_none())
    {
        let message = "E0408: initial stresses follow from the weight of the soil, but no body has weight. Give \
                       `density` or `unit_weight` in [material].";
        record.location().error(message, report);
    }
}

/// Whether the stress at the start is led to equilibrium.
pub(super) fn settles(draft: &Draft) -> bool {
    draft.initial.value().and_then(|initial| initial.equilibrium.get()) == Some(Settled::Plastic)
}

/// Whether a material's ocr stands for its k0: not that of Cam-clay, which is of its yield surface.
fn is_of_k0(material: &MaterialTable) -> bool {
    material.ocr.is_given() && material.model.get() != Some(LawName::CamClay)
}

/// K0 = (1 - sin φ) OCR^sin φ (Mayne and Kulhawy, 1982), below passive pressure.
fn overconsolidated(material: &MaterialTable, report: &mut Report<'_>) -> Option<f64> {
    let ocr = material.ocr.get()?;
    let friction = material.friction_angle.profile()?;
    if friction.per_metre != 0.0 {
        let message = "E0410: k0 from `ocr` depends on the friction angle, which varies with depth here, but a \
             material has one k0. Give `k0`, or divide the soil into layers with a constant friction angle.";
        material.ocr.error(message, report);
        return None;
    }
    let sine = friction.value.to_radians().sin();
    let k0 = (1.0 - sine) * ocr.powf(sine);
    let passive = (1.0 + sine) / (1.0 - sine);
    let cohesion = material.cohesion.profile()?;
    if k0 > passive && cohesion.value == 0.0 && cohesion.per_metre == 0.0 {
        let message = format!(
            "E0411: `ocr` = {ocr} gives k0 = {k0:.4}, above the passive limit Kp = {passive:.4}, so the soil would \
             fail at the start. Reduce `ocr`."
        );
        material.ocr.error(message, report);
        return None;
    }
    let reason = format!("from ocr = {ocr}: k0 = (1 - sin(phi)) ocr^sin(phi) (Mayne and Kulhawy, 1982)");
    report.note(material.k0.path(), format!("{k0}"), reason);
    Some(k0)
}

/// The coefficient of every material; 0 for those without that no body is made of.
fn at_rest(draft: &Draft, record: &InitialTable, bodies: &[Body], report: &mut Report<'_>) -> Option<Vec<f64>> {
    if record.k0.is_given() && record.k0.get().is_none() {
        return None;
    }
    let named = draft.material.items();
    let mut found = Vec::with_capacity(named.len());
    for (number, (name, material)) in named.iter().enumerate() {
        let own = match material.k0.is_given() {
            true => Some(material.k0.get()?),
            false if is_of_k0(material) => Some(overconsolidated(material, report)?),
            false => record.k0.get(),
        };
        if material.k0.is_given() && is_of_k0(material) {
            material.ocr.error(
                "E0412: `ocr` and `k0` are both given, but `ocr` already determines k0. Delete one of the two.",
                report,
            );
        }
        if own.is_none() && bodies.iter().any(|body| body.material == number) {
            let message = format!(
                "E0413: material `{name}` has no k0, so its initial horizontal stress is unknown. Give initial.k0, \
                 material.{name}.k0, or initial.gravity = \"elastic\"."
            );
            record.location().error(message, report);
            return None;
        }
        found.push(own.unwrap_or(0.0));
    }
    Some(found)
}
