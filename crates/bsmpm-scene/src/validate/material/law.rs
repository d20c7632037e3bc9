//! Makes the constitutive law of a material.

use super::band::{CELLS_OF_BAND, band_of_cells};
use super::parameters::{KeyProfile, Parameters};
use super::{Layer, cut_off, profile};
use crate::grid::GridSpec;
use crate::record::Record;
use crate::report::Report;
use crate::schema::{Kind, LawName, MATERIAL};
use crate::words::{Geometry, Word};
use bsmpm::material::{CamClay, Decay, Elastic, LayeredMaterial, Match, Material, Profile, Separation};

/// The law of a material; `None` after an error.
pub(super) fn law(
    record: &Record,
    layer: Option<&Layer>,
    grid: Option<&GridSpec>,
    geometry: Option<Geometry>,
    report: &mut Report<'_>,
) -> Option<Parameters> {
    let model: LawName = record.word("model")?;
    if !has_its_keys(record, model, report) {
        return None;
    }
    let (required, known) = model.keys();
    let mut values = Vec::new();
    for &key in required.iter().chain(known).filter(|key| record.gives(key)) {
        let (profile, range) = match MATERIAL.key(key).map(|key| &key.kind) {
            Some(Kind::Profile(_, range, _)) => (profile(record, key)?, range),
            Some(Kind::Quantity(_, range)) => (Profile::constant(record.number(key)?), range),
            _ => continue,
        };
        if let Some(layer) = layer {
            layer.check(record, key, range, &profile, report);
        }
        values.push(KeyProfile { key, profile });
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
    let [slow, fast] = ["mu_s", "mu_2"].map(|key| parameters.of(key).value);
    if model == LawName::MuI && slow > fast {
        let message = format!(
            "E0306: the friction coefficient at large shear rates, mu_2 = {fast}, is smaller than the static one, \
             mu_s = {slow}. Set `mu_2` to at least `mu_s`."
        );
        record.error("mu_2", message, report);
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
fn has_its_keys(record: &Record, model: LawName, report: &mut Report<'_>) -> bool {
    let (required, known) = model.keys();
    let mut whole = true;
    let all = all_keys();
    let unused = all.iter().filter(|key| !required.contains(key) && !known.contains(key));
    for key in unused.filter(|key| record.gives(key) && !zero_angle(record, model, key)) {
        let message = format!(
            "E0304: the model \"{model}\" has no parameter `{key}`. Remove the key, or choose another \
                     `model`."
        );
        record.error(key, message, report);
        whole = false;
    }
    for key in required.iter().filter(|key| !record.gives(key)) {
        let message = format!(
            "E0305: the model \"{model}\" needs the parameter `{key}`, which is missing. Add \
                               `{key}`."
        );
        report.error(record.origin, &record.path_of(key), message);
        whole = false;
    }
    whole
}

/// Cohesion that falls faster than shear stress does where material unloads: the point has no path, it drops at once.
/// How fast friction falls depends on the pressure, and is not looked at.
fn warn_of_collapse(record: &Record, law: &Parameters, layer: Option<&Layer>, report: &mut Report<'_>) {
    let Some(young) = profile(record, "young") else { return };
    let Some(poisson) = record.number("poisson") else {
        return;
    };
    // An exponential decay begins three times as fast as it goes on the whole.
    let steepest = if (record.word("softening") == Some(Decay::Exponential)) | (law.model == LawName::SensitiveClay) {
        3.0
    } else {
        1.0
    };
    let strain = law.of("softening_strain").value / steepest;
    let ends = layer.map_or([0.0, 0.0], |layer| [layer.heights.start, layer.heights.end]);
    for y in ends {
        let rate = (law.of("cohesion").at(y) - law.of("residual_cohesion").at(y)) / strain;
        let limit = 1.5 * 0.5 * young.at(y) / (1.0 + poisson);
        if rate > limit {
            report.warn(format!(
                "W0305: {}: the cohesion falls by {rate:.3e} Pa per unit of plastic strain (limit {limit:.3e} Pa), so \
                 it is lost all at once. Increase `softening_strain`, or (with `band_width`) use smaller cells.",
                record.path
            ));
            return;
        }
    }
}

/// The numbers of softening that sensitive clay's are (Einav and Randolph, 2005): in shear without change of volume the
/// largest shear is √3 times the plastic strain that the law has. `None` after an error.
fn remould(record: &Record, law: &mut Parameters, report: &mut Report<'_>) -> Option<()> {
    let cohesion = law.of("cohesion");
    let sensitivity = law.of("sensitivity").value;
    let remoulded = Profile {
        value: cohesion.value / sensitivity,
        per_metre: cohesion.per_metre / sensitivity,
        ..cohesion
    };
    law.values.push(KeyProfile {
        key: "residual_cohesion",
        profile: remoulded,
    });
    let strain = law.values.iter_mut().find(|own| own.key == "softening_strain")?;
    strain.profile.value /= 3.0_f64.sqrt();
    if record.gives("rate_parameter") != record.gives("reference_rate") {
        let missing = if record.gives("rate_parameter") {
            "reference_rate"
        } else {
            "rate_parameter"
        };
        let message = format!(
            "E0305: a rate-dependent strength needs both `rate_parameter` and `reference_rate`. Add `{missing}`."
        );
        report.error(record.origin, &record.path_of(missing), message);
        return None;
    }
    Some(())
}

/// The slopes in ln v over ln p', from those in v over ln p' where they are given instead; `None` after an error.
fn star(record: &Record, values: &mut Vec<KeyProfile>, report: &mut Report<'_>) -> Option<()> {
    const SLOPES: [[&str; 2]; 2] = [["kappa_star", "kappa"], ["lambda_star", "lambda"]];
    let of_volume = SLOPES.into_iter().find(|[_, slope]| record.gives(slope));
    if let Some([_, slope]) = of_volume.filter(|_| !record.gives("void_ratio")) {
        let message = "E0314: `kappa` and `lambda`, slopes of the specific volume over ln p', need the initial void \
                       ratio e0. Add `void_ratio`, or give `kappa_star` = kappa/(1 + e0) and `lambda_star` = \
                       lambda/(1 + e0).";
        record.error(slope, message, report);
        return None;
    }
    for [starred, slope] in SLOPES {
        if !record.gives(starred) && !record.gives(slope) {
            let message = format!(
                "E0305: the model \"modified-cam-clay\" needs the slope `{starred}`, which is missing. Add \
                 `{starred}`, or `{slope}` and `void_ratio`."
            );
            report.error(record.origin, &record.path_of(starred), message);
            return None;
        }
        if record.gives(slope) {
            let value = record.number(slope)? / (1.0 + record.number("void_ratio")?);
            report.note(
                record.path_of(starred),
                value.to_string(),
                format!("{slope} / (1 + void_ratio)"),
            );
            values.push(KeyProfile {
                key: starred,
                profile: Profile::constant(value),
            });
        }
    }
    Some(())
}

/// What modified Cam-clay asks for beyond the ranges of its keys, and where its linear moduli hold; `None` after an
/// error.
fn check_cam_clay(record: &Record, law: &Parameters, report: &mut Report<'_>) -> Option<()> {
    let [kappa, lambda] = ["kappa_star", "lambda_star"].map(|key| law.of(key).value);
    if lambda <= kappa {
        let message = format!(
            "E0307: the slope of the normal compression line (lambda_star = {lambda}) must exceed the slope of the \
             unloading line (kappa_star = {kappa}). Correct `lambda_star` or `kappa_star`."
        );
        record.error("lambda_star", message, report);
        return None;
    }
    if !record.gives("preconsolidation") && !record.gives("ocr") {
        let message = "E0305: the model \"modified-cam-clay\" needs the size of its initial yield surface. Add \
                       `preconsolidation` or `ocr`.";
        report.error(record.origin, &record.path_of("preconsolidation"), message);
        return None;
    }
    let young = profile(record, "young")?;
    let poisson = record.number("poisson")?;
    let clay = CamClay::new(
        Elastic {
            young: young.value,
            poisson,
        },
        [kappa, lambda, 1.0, 0.0, 1.0],
    );
    let at = clay.reference_pressure();
    report.note(
        &record.path,
        format!(
            "young and poisson are those at p = {at:.6} Pa; Poisson's ratio is negative below p = {:.6} Pa",
            at * (1.0 - 2.0 * poisson) / (1.0 + poisson)
        ),
        "K = p (1 - kappa*)/kappa*, G constant",
    );
    if record.number("ocr").is_some_and(|ocr| ocr > 2.0) {
        report.warn(format!(
            "W0306: {}: with ocr above 2 this clay softens and dilates in shear, so results depend on the cell size. \
             Compare the results of two values of `grid.cell`.",
            record.path
        ));
    }
    Some(())
}

/// The plastic strain of cells for that of a shear band, so that a band does the same work in any (crack band: Bažant
/// and Oh, 1983). `None` after an error.
fn regularise(record: &Record, law: &mut Parameters, grid: Option<&GridSpec>, report: &mut Report<'_>) -> Option<()> {
    let falls = ["friction_angle", "cohesion"].map(|key| (law.of(key), law.of(&format!("residual_{key}"))));
    let falls = falls.into_iter().any(|(first, last)| first.value > last.value);
    if !falls {
        report.note(
            &record.path,
            "hardens",
            "no residual strength is below its peak, so shear bands do not form",
        );
    }
    let Some(width) = record.number("band_width") else {
        if !falls {
            return Some(());
        }
        report.warn(format!(
            "W0307: {}: this material softens, and shear bands are always two cells wide, so results depend on the \
             cell size. Add `band_width` (real width of a band), or compare two cell sizes.",
            record.path
        ));
        return Some(());
    };
    let smeared = band_of_cells(record, "band_width", grid, report)?;
    for KeyProfile { key, profile } in &mut law.values {
        if !["softening_strain", "reference_rate"].contains(key) {
            continue;
        }
        let of_band = profile.value;
        profile.value *= width / smeared;
        if of_band > 0.0 {
            report.note(
                record.path_of(key),
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

/// All keys that some laws have and others have not.
fn all_keys() -> Vec<&'static str> {
    let laws = LawName::WORDS.words().filter_map(LawName::of);
    let mut all: Vec<&str> = laws.flat_map(|law| [law.keys().0, law.keys().1].concat()).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// The error of a dilation angle above the friction angle, deg.
fn dilates_too_much(dilation: f64, friction: f64) -> String {
    format!(
        "E0308: the dilation angle ({dilation} deg) exceeds the friction angle ({friction} deg). Reduce the dilation \
         angle to the friction angle or less."
    )
}

/// What laws with friction ask for beyond the ranges of their keys; `None` after an error.
fn check(record: &Record, law: &Parameters, layer: Option<&Layer>, report: &mut Report<'_>) -> Option<()> {
    if !law.model.keys().0.contains(&"cohesion") {
        return Some(());
    }
    let friction = law.bounds("friction_angle", layer);
    let dilation = law.bounds("dilation_angle", layer);
    let cohesion = law.bounds("cohesion", layer);
    let last = ["residual_dilation_angle", "residual_friction_angle"].map(|key| law.of(key));
    let ends = layer.map_or([0.0, 0.0], |layer| [layer.heights.start, layer.heights.end]);
    if let Some(y) = ends.into_iter().find(|&y| last[0].at(y) > last[1].at(y)) {
        let [dilation, friction] = last.map(|profile| profile.at(y));
        record.error("residual_dilation_angle", dilates_too_much(dilation, friction), report);
        return None;
    }
    if dilation.1 > friction.1 {
        record.error("dilation_angle", dilates_too_much(dilation.1, friction.1), report);
        return None;
    }
    if dilation.1 > friction.0 {
        let path = record.path_of("dilation_angle");
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
            record.path
        ));
    }
    if !matches!(law.model, LawName::Tresca | LawName::SensitiveClay) && !record.gives("dilation_angle") {
        report.note(
            record.path_of("dilation_angle"),
            "0.0",
            "default: plastic flow without volume change",
        );
    }
    // Only where an apex is free of stress can what opens there be a gap: with cohesion it would pull with c cot phi
    // until it has closed, and without friction there is no apex.
    if record.word("separation") == Some(Separation::Closing) && (friction.0 <= 0.0 || cohesion.1 > 0.0) {
        let message = "E0317: separation = \"gap\" needs a friction angle above 0 and zero cohesion, because only \
             such soil opens without tension. Correct `friction_angle` and `cohesion`, or remove `separation`.";
        record.error("separation", message, report);
    }
    Some(())
}

/// A cone that has another strength in plane strain than the pyramid it is to stand for; in other geometries one that
/// is matched there by default.
fn warn_of_match(record: &Record, law: &Parameters, geometry: Option<Geometry>, report: &mut Report<'_>) {
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
        if !record.gives("fit") {
            report.warn(format!(
                "W0310: {}: the default cone (for plane strain) has {:.1} % of the Mohr-Coulomb strength in \
                 compression, {:.1} % in extension. Use fit = \"outer\" for compression, or \"inner\" for extension.",
                record.path_of("fit"),
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
            record.path,
            100.0 * ratio
        ));
    }
}

/// Tresca's angles may be written if they are zero.
fn zero_angle(record: &Record, model: LawName, key: &str) -> bool {
    model == LawName::Tresca && matches!(key, "friction_angle" | "dilation_angle") && record.number(key) == Some(0.0)
}
