//! Reasons why a case has no reliable factor of safety.

use bsmpm::material::LayeredMaterial;
use bsmpm::model::Regime;
use bsmpm_scene::{Case, NamedMaterial, Rigid, Shares};

/// The loosest tolerances with which a factor means anything: a study by finite elements found it 45.6 % too high with
/// residuals of 1e-1, 2 % with 1e-2, and no difference from 1e-3 on.
const LOOSEST: f64 = 1e-3;

/// Why a case has no factor of safety, or none that could be trusted, at its end or at the end of the stage that ends
/// at the time `until`: texts with their codes, none if `bsmpm fos` accepts the case.
pub fn refusals(case: &Case, until: Option<f64>) -> Vec<String> {
    let materials = followed(case, until);
    let any = |holds: fn(&LayeredMaterial) -> bool| materials.iter().any(|named| holds(&named.material));
    let has_strength = any(LayeredMaterial::yields) || case.has_friction_at(acting(case, until));
    let has_amplitude = until.is_none() && amplitudes(case).any(|rows| !rows.is_empty());
    let never_full = until.is_none() && ramps(case).any(|ramp| ramp > case.analysis.end);
    let reasons = [
        (
            case.analysis.regime == Regime::Dynamic,
            "E0810: `bsmpm fos` needs a static equilibrium, but the analysis is dynamic. Set `analysis.type = \
             \"quasi-static\"`.",
        ),
        (
            any(LayeredMaterial::hardens),
            "E0811: a material hardens (`hardening`, or residual strength above peak), so the factor of safety \
             depends on the displacement. Set `hardening = 0`, or a residual strength not above the peak.",
        ),
        (
            any(|material| !material.is_linear()),
            "E0812: the strength of Cam-clay depends on its stress history, but the trial runs start without stress. \
             Use \"tresca\" (undrained strength) or \"mohr-coulomb\" (critical state).",
        ),
        (
            any(|material| material.softens() && material.with_time_step(1.0).is_some()),
            "E0813: the strength of a material depends on the shear rate, but the trial runs are static. Remove \
             `rate_parameter` and `reference_rate`, and give the strength at the relevant rate.",
        ),
        (
            until.is_none() && !case.stages.is_empty(),
            "E0814: the case has stages, and each stage has its own factor of safety. Choose a stage with `--stage \
             NAME`, or the last one with `--stage end`.",
        ),
        (
            case.stages.iter().any(|stage| stage.strength_reduction.is_some()),
            "E0815: the case reduces its strength at a stage (`strength_reduction`), and `bsmpm fos` reduces it again. \
             Remove `strength_reduction` from the case.",
        ),
        (
            !has_strength,
            "E0816: no material has a yield strength and no interface has friction, so there is no strength to \
             reduce. Use a plastic `model`, for example \"mohr-coulomb\".",
        ),
        (
            !is_loaded(case),
            "E0817: no load acts at the end of the analysis (weight, traction, point load, rigid body), so nothing \
             can fail. Add [gravity] and `unit_weight`, or a load.",
        ),
        (
            has_amplitude,
            "E0818: a load varies in time (`amplitude`), but the factor of safety refers to its last value. Use \
             `ramp` instead, or choose a stage at whose end the load is constant with `--stage NAME`.",
        ),
        (
            never_full,
            "E0819: the `ramp` of a load is longer than the analysis, so this load never acts in full. Reduce `ramp`, \
             or increase `analysis.end`.",
        ),
        (
            until.is_none() && case.water.as_ref().is_some_and(|water| water.table.moves()),
            "E0820: the water table moves, so it is not clear for which level the factor of safety is wanted. Give a \
             constant `water.level`, or choose the end of a stage with `--stage NAME`.",
        ),
        (
            until.is_none() && case.rigid.iter().any(Rigid::is_moved),
            "E0821: a rigid body has a prescribed motion, so its support of the soil changes during a trial run. \
             Remove the motion, or use `--stage NAME`, which stops it at the end of that stage.",
        ),
        (
            until.is_none() && is_moved(case),
            "E0822: a displacement is prescribed, and soil of any strength follows it, so no trial run fails. Give a \
             load instead, or use `--stage NAME`, which stops the motion at the end of that stage.",
        ),
    ];
    let found = reasons
        .into_iter()
        .filter(|(holds, _)| *holds)
        .map(|(_, reason)| reason.to_owned());
    loose_tolerances(case).chain(found).collect()
}

/// A time at which there is what the factor is of.
pub(super) fn acting(case: &Case, until: Option<f64>) -> f64 {
    until.map_or(0.0, |until| case.just_before(until))
}

/// The materials whose strength the trials divide.
pub(super) fn followed(case: &Case, until: Option<f64>) -> Vec<NamedMaterial> {
    case.followed_at(acting(case, until)).collect()
}

/// What the tractions, then the point loads are multiplied with in time.
fn amplitudes(case: &Case) -> impl Iterator<Item = &Shares> {
    let tractions = case.tractions.iter().map(|load| &load.amplitude);
    let points = case.point_loads.iter().map(|load| &load.amplitude);
    tractions
        .chain(points)
        .chain(case.rigid.iter().map(|rigid| &rigid.amplitude))
}

fn loose_tolerances(case: &Case) -> impl Iterator<Item = String> {
    let all = [
        ("tolerance", case.solver.tolerance),
        ("force_tolerance", case.solver.force_tolerance),
    ];
    all.into_iter()
        .filter(|(_, value)| *value > LOOSEST)
        .map(|(key, value)| {
            format!(
                "E0823: solver.{key} = {value:e} is too large (limit: {LOOSEST:e}), so the factor of safety may be too \
             high. Set solver.{key} = {LOOSEST:e} or less."
            )
        })
}

pub(super) fn is_moved(case: &Case) -> bool {
    let footing = case.footing.iter().map(|footing| &footing.path);
    let prescribed = case.prescribed.iter().map(|prescribed| &prescribed.path);
    let mut rows = footing.chain(prescribed).flat_map(|path| &path.rows);
    rows.any(|(_, by)| *by != [0.0; 3])
}

fn is_loaded(case: &Case) -> bool {
    let falls = case
        .gravity
        .as_ref()
        .is_some_and(|gravity| gravity.acceleration != [0.0; 3]);
    let weighs = case
        .bodies
        .iter()
        .any(|body| case.materials[body.material].density.is_some());
    let is_pushed = case.tractions.iter().any(|traction| traction.largest() > 0.0)
        || case.point_loads.iter().any(|load| load.force != [0.0; 3]);
    let is_driven = case
        .rigid
        .iter()
        .any(|rigid| rigid.force != [0.0; 3] || falls && rigid.mass[0] > 0.0);
    (falls && weighs) || is_pushed || is_driven
}

pub(super) fn ramps(case: &Case) -> impl Iterator<Item = f64> {
    let gravity = case.gravity.iter().map(|gravity| gravity.ramp);
    let tractions = case.tractions.iter().map(|traction| traction.ramp);
    let driven = case
        .rigid
        .iter()
        .filter(|rigid| rigid.force != [0.0; 3] && rigid.amplitude.is_empty());
    gravity
        .chain(tractions)
        .chain(case.point_loads.iter().map(|load| load.ramp))
        .chain(driven.map(|rigid| rigid.ramp))
}
