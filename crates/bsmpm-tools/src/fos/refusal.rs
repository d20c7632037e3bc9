//! Why a case has no factor of safety, or none that could be trusted.

use bsmpm::material::Material;
use bsmpm::model::Regime;
use bsmpm_scene::{Case, MotionPath, NamedMaterial, Rigid, Shares};

/// The loosest tolerances with which a factor means anything: a study by finite elements found it 45.6 % too high with
/// residuals of 1e-1, 2 % with 1e-2, and no difference from 1e-3 on.
const LOOSEST: f64 = 1e-3;

/// Why a case has no factor of safety, or none that could be trusted.
pub(super) fn refusals(case: &Case, until: Option<f64>) -> Vec<String> {
    let materials = followed(case, until);
    let any = |holds: fn(&Material) -> bool| materials.iter().any(|named| holds(&named.material));
    let has_strength = any(Material::yields) || case.has_friction_at(acting(case, until));
    let has_amplitude = until.is_none() && amplitudes(case).any(|rows| !rows.is_empty());
    let never_full = until.is_none() && ramps(case).any(|ramp| ramp > case.analysis.end);
    let reasons = [
        (
            case.analysis.regime == Regime::Dynamic,
            "analysis.type = \"dynamic\": strength reduction looks for equilibrium; it needs a quasi-static analysis",
        ),
        (
            any(Material::hardens),
            "a material hardens: its strength grows as it is strained, and the factor would be that of the displacement that is \
             looked at; hardening = 0, or no residual strength above the first one, gives one",
        ),
        (
            any(|material| !material.is_linear()),
            "a material's strength follows from what has compressed it: trials begin without stress and stiffen the ground; \
             give cam-clay's undrained strength as \"tresca\" or its critical state as \"mohr-coulomb\", from the start or \
             by the materials of a [[stage]] before",
        ),
        (
            any(|material| material.softens() && material.over(1.0).is_some()),
            "a material's strength grows with the rate of shear, and trials have no time: leave rate_parameter and \
             reference_rate out, and give the strength of the rate that is meant",
        ),
        (
            until.is_none() && !case.stages.is_empty(),
            "it has stages, of which each has a factor of its own: give --stage NAME, at whose end it is wanted, or \"end\"",
        ),
        (
            case.stages.iter().any(|stage| stage.strength_reduction.is_some()),
            "the case divides the strength itself, at the end of a stage or in one: leave that out, as the search does so",
        ),
        (!has_strength, "no material is plastic and no contact has friction: there is no strength to be reduced"),
        (!is_loaded(case), "nothing loads the body at `end`: no weight under gravity, no traction, no point load"),
        (
            has_amplitude,
            "a load follows an amplitude: its factor would be that of whatever acts at `end`; give the load that is meant, \
             with a ramp, or --stage NAME of a stage at whose end it rests",
        ),
        (never_full, "a load grows beyond `end`: it never acts in full, and the factor would be that of a part of it"),
        (
            until.is_none() && case.water.as_ref().is_some_and(|water| water.table.moves()),
            "the water table moves: the factor would be that of whatever the level is as strength falls: give the level that is \
             meant, or --stage NAME: it stays as it is at the end of that stage",
        ),
        (
            until.is_none() && case.rigid.iter().any(Rigid::is_moved),
            "a rigid body moves on a way: what it holds changes as it goes; give --stage NAME, at whose end it is held where it \
             is then, or leave its way out",
        ),
        (
            until.is_none() && is_moved(case),
            "the case prescribes a motion: what moves as prescribed shows no failure, however little strength is left; give the \
             load instead of the motion, or run the case itself and read its force against the motion, or give --stage NAME, \
             at whose end what has moved is held where it is, as a wall is",
        ),
    ];
    let found = reasons.into_iter().filter(|(holds, _)| *holds).map(|(_, reason)| reason.to_owned());
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
    tractions.chain(points).chain(case.rigid.iter().map(|rigid| &rigid.amplitude))
}

fn loose_tolerances(case: &Case) -> impl Iterator<Item = String> {
    let all = [("tolerance", case.solver.tolerance), ("force_tolerance", case.solver.force_tolerance)];
    all.into_iter().filter(|(_, value)| *value > LOOSEST).map(|(key, value)| {
        format!(
            "solver.{key} = {value:e} is too loose for a factor that means anything: at most {LOOSEST:e} (a study by finite \
             elements found 45.6 % too much with 1e-1, 2 % with 1e-2, nothing from 1e-3 on)"
        )
    })
}

pub(super) fn is_moved(case: &Case) -> bool {
    let moves = |path: &MotionPath| path.rows.iter().any(|(_, by)| *by != [0.0; 3]);
    let footing = case.footing.iter().map(|footing| &footing.path);
    footing.chain(case.prescribed.iter().map(|prescribed| &prescribed.path)).any(moves)
}

fn is_loaded(case: &Case) -> bool {
    let falls = case.gravity.as_ref().is_some_and(|gravity| gravity.acceleration != [0.0; 3]);
    let weighs = case.bodies.iter().any(|body| case.materials[body.material].density.is_some());
    let is_pushed = case.tractions.iter().any(|traction| traction.largest() > 0.0)
        || case.point_loads.iter().any(|load| load.force != [0.0; 3]);
    let is_driven = case.rigid.iter().any(|rigid| rigid.force != [0.0; 3] || falls && rigid.mass[0] > 0.0);
    (falls && weighs) || is_pushed || is_driven
}

pub(super) fn ramps(case: &Case) -> impl Iterator<Item = f64> {
    let gravity = case.gravity.iter().map(|gravity| gravity.ramp);
    let tractions = case.tractions.iter().map(|traction| traction.ramp);
    let driven = case.rigid.iter().filter(|rigid| rigid.force != [0.0; 3] && rigid.amplitude.is_empty());
    gravity.chain(tractions).chain(case.point_loads.iter().map(|load| load.ramp)).chain(driven.map(|rigid| rigid.ramp))
}
