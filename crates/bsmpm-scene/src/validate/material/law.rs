//! Makes the constitutive law of a material.

use super::band::{CELLS_OF_BAND, band_of_cells};
use super::parameters::{KeyProfile, Parameters};
use super::{Layer, cut_off};
use crate::grid::GridSpec;
use crate::record::{CaseTable, Field};
use crate::report::Report;
use crate::schema::{Kind, LawKey, LawName, MaterialTable};
use crate::words::Geometry;
use bsmpm::material::{CamClay, Decay, Elastic, LayeredMaterial, Match, Material, Profile, Separation};

/// The keys that Tresca's law has not, but that may be written if they are zero.
const TRESCA_ANGLES: [&str; 2] = ["friction_angle", "dilation_angle"];

/// The law of a material; `None` after an error.
pub(super) fn law<'a>(
    record: &'a MaterialTable,
    layer: Option<&Layer>,
    grid: Option<&GridSpec>,
    geometry: Option<Geometry>,
    report: &mut Report<'_>,
) -> Option<Parameters<'a>> {
    let model = record.model.get()?;
    if !has_its_keys(record, model, report) {
        return None;
    }
    let (required, known) = model.keys();
    let mut values = Vec::new();
    let keys = required.iter().chain(known).filter_map(|name| record.law_key(name));
    for key in keys.filter(|key| key.place().is_given()) {
        let name = key.place().name();
        let range = match MaterialTable::TABLE.key(name).map(|key| &key.kind) {
            Some(Kind::Profile(_, range, _) | Kind::Quantity(_, range)) => range,
            _ => continue,
        };
        let profile = key.profile()?;
        if let Some(layer) = layer {
            layer.check(key.place(), range, &profile, report);
        }
        values.push(KeyProfile { key: name, profile });
    }
    if model == LawName::CamClay {
        star(record, &mut values, report)?;
    }
    let mut parameters = Parameters { model, values };
    if model == LawName::SensitiveClay {
        remould(record, &mut parameters, report)?;
    }
    check(record, &parameters, layer, report)?;
    warn_of_match(record, &parameters, geometry, report);
    if model == LawName::MuI
        && let Some((slow, fast)) = record.mu_s.get().zip(record.mu_2.get())
        && slow > fast
    {
        let message = format!(
            "E0306: the friction coefficient at large shear rates, mu_2 = {fast}, is smaller than the static one, \
             mu_s = {slow}. Set `mu_2` to at least `mu_s`."
        );
        record.mu_2.error(message, report);
        return None;
    }
    if model == LawName::CamClay {
        check_cam_clay(record, &parameters, report)?;
    }
    if !matches!(model, LawName::Softening | LawName::SensitiveClay) {
        cut_off::check(record, &mut parameters, layer, grid, report)?;
    } else {
        regularise(record, &mut parameters, grid, report)?;
        warn_of_collapse(record, &parameters, layer, report);
    }
    Some(parameters)
}

/// Whether a record gives all keys of its model, and none that this has not.
fn has_its_keys(record: &MaterialTable, model: LawName, report: &mut Report<'_>) -> bool {
    let (required, known) = model.keys();
    let mut whole = true;
    for key in record.law_keys() {
        // Tresca's angles may be written if they are zero.
        let is_zero_angle = model == LawName::Tresca
            && TRESCA_ANGLES.contains(&key.place().name())
            && matches!(key, LawKey::Angle(angle) if angle.plain() == Some(0.0));
        let key = key.place();
        let name = key.name();
        if key.is_given() && !required.contains(&name) && !known.contains(&name) && !is_zero_angle {
            let message = format!(
                "E0304: the model \"{model}\" has no parameter `{name}`. Remove the key, or choose another \
                     `model`."
            );
            key.error(message, report);
            whole = false;
        }
    }
    let needed = required.iter().filter_map(|name| record.law_key(name));
    for key in needed.map(LawKey::place).filter(|key| !key.is_given()) {
        let message = format!(
            "E0305: the model \"{model}\" needs the parameter `{0}`, which is missing. Add \
                               `{0}`.",
            key.name()
        );
        key.error(message, report);
        whole = false;
    }
    whole
}

/// Cohesion that falls faster than shear stress does where material unloads: the point has no path, it drops at once.
/// How fast friction falls depends on the pressure, and is not looked at.
fn warn_of_collapse(record: &MaterialTable, law: &Parameters<'_>, layer: Option<&Layer>, report: &mut Report<'_>) {
    let Some(young) = record.young.profile() else { return };
    let Some(poisson) = record.poisson.get() else {
        return;
    };
    // An exponential decay begins three times as fast as it goes on the whole.
    let steepest = if (record.softening.get() == Some(Decay::Exponential)) | (law.model == LawName::SensitiveClay) {
        3.0
    } else {
        1.0
    };
    let strain = law.of(record.softening_strain.name()).value / steepest;
    let ends = layer.map_or([0.0, 0.0], |layer| [layer.heights.start, layer.heights.end]);
    for y in ends {
        let rate = (record.cohesion.profile_or_zero().at(y) - law.of(record.residual_cohesion.name()).at(y)) / strain;
        let limit = 1.5 * 0.5 * young.at(y) / (1.0 + poisson);
        if rate > limit {
            report.warn(format!(
                "W0305: {}: the cohesion falls by {rate:.3e} Pa per unit of plastic strain (limit {limit:.3e} Pa), so \
                 it is lost all at once. Increase `softening_strain`, or (with `band_width`) use smaller cells.",
                record.location().path
            ));
            return;
        }
    }
}

/// The numbers of softening that sensitive clay's are (Einav and Randolph, 2005): in shear without change of volume the
/// largest shear is √3 times the plastic strain that the law has. `None` after an error.
fn remould<'a>(record: &'a MaterialTable, law: &mut Parameters<'a>, report: &mut Report<'_>) -> Option<()> {
    let cohesion = record.cohesion.profile()?;
    let sensitivity = record.sensitivity.get()?;
    let remoulded = Profile {
        value: cohesion.value / sensitivity,
        per_metre: cohesion.per_metre / sensitivity,
        ..cohesion
    };
    law.values.push(KeyProfile {
        key: record.residual_cohesion.name(),
        profile: remoulded,
    });
    let mut values = law.values.iter_mut();
    let strain = values.find(|own| own.key == record.softening_strain.name())?;
    strain.profile.value /= 3.0_f64.sqrt();
    if record.rate_parameter.is_given() != record.reference_rate.is_given() {
        let missing = match record.rate_parameter.is_given() {
            true => &record.reference_rate,
            false => &record.rate_parameter,
        };
        let message = format!(
            "E0305: a rate-dependent strength needs both `rate_parameter` and `reference_rate`. Add `{}`.",
            missing.name()
        );
        missing.error(message, report);
        return None;
    }
    Some(())
}

/// The slopes in ln v over ln p', from those in v over ln p' where they are given instead; `None` after an error.
fn star<'a>(record: &'a MaterialTable, values: &mut Vec<KeyProfile<'a>>, report: &mut Report<'_>) -> Option<()> {
    let slopes = [
        [&record.kappa_star, &record.kappa],
        [&record.lambda_star, &record.lambda],
    ];
    let of_volume = slopes.iter().find(|[_, slope]| slope.is_given());
    if let Some([_, slope]) = of_volume.filter(|_| !record.void_ratio.is_given()) {
        let message = "E0314: `kappa` and `lambda`, slopes of the specific volume over ln p', need the initial void \
                       ratio e0. Add `void_ratio`, or give `kappa_star` = kappa/(1 + e0) and `lambda_star` = \
                       lambda/(1 + e0).";
        slope.error(message, report);
        return None;
    }
    for [starred, slope] in slopes {
        let key = starred.name();
        if !starred.is_given() && !slope.is_given() {
            let message = format!(
                "E0305: the model \"modified-cam-clay\" needs the slope `{key}`, which is missing. Add \
                 `{key}`, or `{}` and `void_ratio`.",
                slope.name()
            );
            starred.error(message, report);
            return None;
        }
        if slope.is_given() {
            let value = slope.get()? / (1.0 + record.void_ratio.get()?);
            report.note(
                starred.path(),
                value.to_string(),
                format!("{} / (1 + void_ratio)", slope.name()),
            );
            let profile = Profile::constant(value);
            values.push(KeyProfile { key, profile });
        }
    }
    Some(())
}

/// What modified Cam-clay asks for beyond the ranges of its keys, and where its linear moduli hold; `None` after an
/// error.
fn check_cam_clay(record: &MaterialTable, law: &Parameters<'_>, report: &mut Report<'_>) -> Option<()> {
    let [kappa, lambda] = [&record.kappa_star, &record.lambda_star].map(|key| law.of(key.name()).value);
    if lambda <= kappa {
        let message = format!(
            "E0307: the slope of the normal compression line (lambda_star = {lambda}) must exceed the slope of the \
             unloading line (kappa_star = {kappa}). Correct `lambda_star` or `kappa_star`."
        );
        record.lambda_star.error(message, report);
        return None;
    }
    if !record.preconsolidation.is_given() && !record.ocr.is_given() {
        let message = "E0305: the model \"modified-cam-clay\" needs the size of its initial yield surface. Add \
                       `preconsolidation` or `ocr`.";
        record.preconsolidation.error(message, report);
        return None;
    }
    let young = record.young.profile()?;
    let poisson = record.poisson.get()?;
    let clay = CamClay::new(
        Elastic {
            young: young.value,
            poisson,
        },
        [kappa, lambda, 1.0, 0.0, 1.0],
    );
    let at = clay.reference_pressure();
    report.note(
        &record.location().path,
        format!(
            "young and poisson are those at p = {at:.6} Pa; Poisson's ratio is negative below p = {:.6} Pa",
            at * (1.0 - 2.0 * poisson) / (1.0 + poisson)
        ),
        "K = p (1 - kappa*)/kappa*, G constant",
    );
    if record.ocr.get().is_some_and(|ocr| ocr > 2.0) {
        report.warn(format!(
            "W0306: {}: with ocr above 2 this clay softens and dilates in shear, so results depend on the cell size. \
             Compare the results of two values of `grid.cell`.",
            record.location().path
        ));
    }
    Some(())
}

/// The plastic strain of cells for that of a shear band, so that a band does the same work in any (crack band: Bažant
/// and Oh, 1983). `None` after an error.
fn regularise(
    record: &MaterialTable,
    law: &mut Parameters<'_>,
    grid: Option<&GridSpec>,
    report: &mut Report<'_>,
) -> Option<()> {
    let residual = [record.residual_friction_angle.name(), record.residual_cohesion.name()];
    let [friction, cohesion] = residual.map(|key| law.of(key).value);
    let falls =
        record.friction_angle.profile_or_zero().value > friction || record.cohesion.profile_or_zero().value > cohesion;
    if !falls {
        report.note(
            &record.location().path,
            "hardens",
            "no residual strength is below its peak, so shear bands do not form",
        );
    }
    let Some(width) = record.band_width.get() else {
        if !falls {
            return Some(());
        }
        report.warn(format!(
            "W0307: {}: this material softens, and shear bands are always two cells wide, so results depend on the \
             cell size. Add `band_width` (real width of a band), or compare two cell sizes.",
            record.location().path
        ));
        return Some(());
    };
    let smeared = band_of_cells(&record.band_width, grid, report)?;
    let scaled = [&record.softening_strain, &record.reference_rate];
    for KeyProfile { key, profile } in &mut law.values {
        let Some(key) = scaled.iter().find(|scaled| scaled.name() == *key) else {
            continue;
        };
        let of_band = profile.value;
        profile.value *= width / smeared;
        if of_band > 0.0 {
            report.note(
                key.path(),
                profile.value.to_string(),
                format!(
                    "{of_band} in a band of {width} m, which is {smeared} m wide in cells of {} m",
                    smeared / CELLS_OF_BAND
                ),
            );
        }
    }
    Some(())
}

/// The error of a dilation angle above the friction angle, deg.
fn dilates_too_much(dilation: f64, friction: f64) -> String {
    format!(
        "E0308: the dilation angle ({dilation} deg) exceeds the friction angle ({friction} deg). Reduce the dilation \
         angle to the friction angle or less."
    )
}

/// What laws with friction ask for beyond the ranges of their keys; `None` after an error.
fn check(record: &MaterialTable, law: &Parameters<'_>, layer: Option<&Layer>, report: &mut Report<'_>) -> Option<()> {
    if !law.model.keys().0.contains(&"cohesion") {
        return Some(());
    }
    let friction = bounds(record.friction_angle.profile_or_zero(), layer);
    let dilation = bounds(record.dilation_angle.profile_or_zero(), layer);
    let cohesion = bounds(record.cohesion.profile_or_zero(), layer);
    let last = [&record.residual_dilation_angle, &record.residual_friction_angle].map(Field::profile_or_zero);
    let ends = layer.map_or([0.0, 0.0], |layer| [layer.heights.start, layer.heights.end]);
    if let Some(y) = ends.into_iter().find(|&y| last[0].at(y) > last[1].at(y)) {
        let [dilation, friction] = last.map(|profile| profile.at(y));
        record
            .residual_dilation_angle
            .error(dilates_too_much(dilation, friction), report);
        return None;
    }
    if dilation.1 > friction.1 {
        record
            .dilation_angle
            .error(dilates_too_much(dilation.1, friction.1), report);
        return None;
    }
    if dilation.1 > friction.0 {
        let path = record.dilation_angle.path();
        report.warn(format!(
            "W0308: {path}: where the dilation angle ({} deg) exceeds the friction angle, the program reduces it to \
             the friction angle. Let `dilation_angle` vary with height as `friction_angle` does.",
            dilation.1
        ));
    }
    if friction.1 == 0.0 && cohesion.1 == 0.0 {
        report.warn(format!(
            "W0309: {}: friction angle and cohesion are both 0, so the material has no shear strength. Correct \
             `friction_angle` or `cohesion`.",
            record.location().path
        ));
    }
    if !matches!(law.model, LawName::Tresca | LawName::SensitiveClay) && !record.dilation_angle.is_given() {
        report.note(
            record.dilation_angle.path(),
            "0.0",
            "default: plastic flow without volume change",
        );
    }
    // Only where an apex is free of stress can what opens there be a gap: with cohesion it would pull with c cot phi
    // until it has closed, and without friction there is no apex.
    if record.separation.get() == Some(Separation::Closing) && (friction.0 <= 0.0 || cohesion.1 > 0.0) {
        let message = "E0317: separation = \"gap\" needs a friction angle above 0 and zero cohesion, because only \
             such soil opens without tension. Correct `friction_angle` and `cohesion`, or remove `separation`.";
        record.separation.error(message, report);
    }
    Some(())
}

/// A cone that has another strength in plane strain than the pyramid it is to stand for; in other geometries one that
/// is matched there by default.
fn warn_of_match(record: &MaterialTable, law: &Parameters<'_>, geometry: Option<Geometry>, report: &mut Report<'_>) {
    let values = law.values.iter().map(|own| KeyProfile {
        key: own.key,
        profile: Profile::constant(own.profile.value),
    });
    let uniform = Parameters {
        model: law.model,
        values: values.collect(),
    };
    let Some(LayeredMaterial::Uniform(law)) = uniform.material(record, Profile::constant(1.0), 0.0, None, 1.0) else {
        return;
    };
    let Material::DruckerPrager(cone) = law.without_cut_off().into_owned() else {
        return;
    };
    if geometry.is_some_and(|geometry| geometry != Geometry::PlaneStrain) {
        if !record.fit.is_given() {
            report.warn(format!(
                "W0310: {}: the default cone (for plane strain) has {:.1} % of the Mohr-Coulomb strength in \
                 compression, {:.1} % in extension. Use fit = \"outer\" for compression, or \"inner\" for extension.",
                record.fit.path(),
                100.0 * cone.strength_over(Match::Outer),
                100.0 * cone.strength_over(Match::Inner)
            ));
        }
        return;
    }
    let ratio = cone.strength_in_plane_strain();
    if (ratio - 1.0).abs() > 0.005 {
        report.warn(format!(
            "W0311: {}: in plane strain this Drucker-Prager cone has {:.1} % of the Mohr-Coulomb strength. For the \
             Mohr-Coulomb strength use model = \"mohr-coulomb\".",
            record.location().path,
            100.0 * ratio
        ));
    }
}

/// Least and largest value within a layer; without a layer those at the profile's own height.
fn bounds(profile: Profile, layer: Option<&Layer>) -> (f64, f64) {
    profile.bounds(&layer.map_or(profile.at..profile.at, |layer| layer.heights.clone()))
}
