//! Validates pore-water flow.

mod crossing;
mod drains;
mod leaks;
mod permeability;
mod retention;
mod shown;
mod water_table;

pub(super) use drains::drain_of;
pub use shown::HELD_WATER;
pub(super) use shown::check;

use self::drains::{Ground, drain, inflow, named, there};
use self::permeability::permeability;
use self::retention::retention;
use super::site::AroundStrip;
use crate::case::{ActiveLoads, Flow, NamedMaterial, Stage};
use crate::constants::STANDARD_GRAVITY;
use crate::record::{CaseTable, KeyPlace};
use crate::report::Report;
use crate::schema::{Draft, MaterialTable};
use crate::words::{AnalysisType, Drainage};
use bsmpm::field::pore_water::flow::{Motion, Soil};
use bsmpm::model::Regime;

/// N/m3  of water, unless a case gives it.
const WATER: f64 = 9810.0;

/// Message of a key that only pore-water flow uses.
const WITHOUT_FLOW: &str = "E0501: no material has pore-water flow, so this entry has no effect. Give a material \
                            `drainage = \"coupled\"`, `porosity` and `permeability`, or remove this entry.";

/// Drainage that the case gives a material.
fn drainage(draft: &Draft, material: &MaterialTable) -> Option<Drainage> {
    if material.drainage.is_given() {
        return material.drainage.get();
    }
    match draft.water.value() {
        Some(water) if water.drainage.is_given() => water.drainage.get(),
        _ => Some(Drainage::Given),
    }
}

/// The flow of water, if any material has it; the outer option is `None` after an error.
pub(super) fn read(
    draft: &Draft,
    materials: Option<&[NamedMaterial]>,
    around: AroundStrip<'_>,
    stages: Option<&[Stage]>,
    report: &mut Report<'_>,
) -> Option<Option<Flow>> {
    let soils: Vec<Option<Option<Soil<3>>>> = draft
        .material
        .items()
        .iter()
        .map(|(_, record)| soil(draft, record, report))
        .collect();
    if soils.iter().all(|soil| matches!(soil, Some(None))) {
        refuse_without_flow(draft, report);
        return Some(None);
    }
    let soils: Vec<Option<Soil<3>>> = soils.into_iter().collect::<Option<_>>()?;
    let bodies = around.bodies.unwrap_or_default();
    let stages = stages.unwrap_or_default();
    let ground = Ground {
        soils: &soils,
        materials: materials?,
        around,
        there: &[],
    };
    let mut drains = Vec::new();
    for (number, record) in draft.drain.items().iter().enumerate() {
        let there = &there(ActiveLoads::Drain(number), stages, bodies);
        drains.push(drain(record, Ground { there, ..ground }, report));
    }
    named(draft, report);
    let mut inflows = Vec::new();
    for (number, record) in draft.inflow.items().iter().enumerate() {
        let there = &there(ActiveLoads::Inflow(number), stages, bodies);
        inflows.push(inflow(record, Ground { there, ..ground }, report));
    }
    let drains = drains.into_iter().collect::<Option<_>>()?;
    let inflows = inflows.into_iter().collect::<Option<_>>()?;
    let bulk = draft.water.value().filter(|water| water.bulk.is_given());
    let bulk = bulk.map_or(Some(f64::INFINITY), |water| water.bulk.get())?;
    let retains = soils.iter().flatten().any(|soil| soil.retention.is_some());
    let suction = suction(draft, retains, report)?;
    Some(Some(Flow {
        unit_weight: unit_weight(draft)?,
        bulk,
        soils,
        drains,
        inflows,
        suction,
        motion: Motion::Flows,
        at_rest: Motion::Held,
    }))
}

/// Refuses what only pore-water flow uses, in a case without it.
fn refuse_without_flow(draft: &Draft, report: &mut Report<'_>) {
    let drain = draft.drain.items().first().map(CaseTable::location);
    let inflow = draft.inflow.items().first().map(CaseTable::location);
    for location in drain.into_iter().chain(inflow) {
        location.error(WITHOUT_FLOW, report);
    }
    if let Some(water) = draft.water.value().filter(|water| water.bulk.is_given()) {
        water.bulk.error(WITHOUT_FLOW, report);
    }
}

/// Whether water flows through a material.
fn is_permeable(soils: &[Option<Soil<3>>], material: usize) -> bool {
    soils[material].as_ref().is_some_and(|soil| soil.permeability.is_some())
}

/// Pa  the largest suction at the start.
fn suction(draft: &Draft, retains: bool, report: &mut Report<'_>) -> Option<f64> {
    let Some(water) = draft.water.value().filter(|water| water.suction.is_given()) else {
        return Some(f64::INFINITY);
    };
    if !retains {
        let message = "E0503: no material has a `retention` curve, so `suction` has no effect. Give the soil above \
                       the water table a `retention` curve, or remove `suction`.";
        water.suction.consequence(message, &["material"], report);
    }
    if water.gives_no_table() {
        let message = "E0504: `suction` applies above the water table, but the case has no water table. Give \
                       `water.level`, `level_path`, `line` or `line_path`, or remove `suction`.";
        water.suction.error(message, report);
    }
    water.suction.get()
}

/// N/m3  of water under the case's gravity; under the standard one without any.
fn unit_weight(draft: &Draft) -> Option<f64> {
    let given = draft
        .water
        .value()
        .map_or(Some(WATER), |water| water.unit_weight.get())?;
    let Some(gravity) = draft.gravity.value() else {
        return Some(given);
    };
    let [x, y, z] = gravity.acceleration.vector()?;
    let is_static = draft.analysis.value()?.r#type.get().map(AnalysisType::regime) == Some(Regime::QuasiStatic);
    let up = draft.geometry.get()?.dims() - 1;
    let pull = if is_static {
        [x, y, z][up].abs()
    } else {
        x.hypot(y).hypot(z)
    };
    Some(given / STANDARD_GRAVITY * pull)
}

/// What a material is to water; the outer option is `None` after an error.
fn soil(draft: &Draft, record: &MaterialTable, report: &mut Report<'_>) -> Option<Option<Soil<3>>> {
    let flowing: [&KeyPlace; 4] = [
        &record.porosity,
        &record.permeability,
        &record.permeability_law,
        &record.retention,
    ];
    let drainage = drainage(draft, record)?;
    let needs = match drainage {
        Drainage::Given => &flowing[..0],
        Drainage::Undrained => &flowing[..1],
        Drainage::Coupled => &flowing[..2],
    };
    let known = if drainage == Drainage::Coupled {
        flowing.len()
    } else {
        needs.len()
    };
    let mut failed = false;
    for key in needs.iter().filter(|key| !key.is_given()) {
        let message = format!(
            "E0505: `{0}` is missing, but drainage = \"{drainage}\" requires it. Add `{0}`, or change \
             `drainage`.",
            key.name()
        );
        key.error(message, report);
        failed = true;
    }
    for key in flowing[known..].iter().filter(|key| key.is_given()) {
        let message = format!(
            "E0506: `{0}` has no effect with drainage = \"{drainage}\". Set drainage = \"coupled\" for pore-water \
             flow, or remove `{0}`.",
            key.name()
        );
        key.error(message, report);
        failed = true;
    }
    if failed {
        return None;
    }
    if drainage == Drainage::Given {
        return Some(None);
    }
    let porosity = record.porosity.get()?;
    let retention = match record.retention.value() {
        Some(of) => Some(retention(of, report)?),
        None => None,
    };
    let permeability = match drainage {
        Drainage::Coupled => Some(permeability(record, report)?),
        Drainage::Given | Drainage::Undrained => None,
    };
    Some(Some(Soil {
        porosity,
        permeability,
        retention,
    }))
}

/// Whether water flows, or is kept from flowing, in any material.
pub(super) fn flows(draft: &Draft) -> bool {
    draft
        .material
        .items()
        .iter()
        .any(|(_, record)| drainage(draft, record) != Some(Drainage::Given))
}
