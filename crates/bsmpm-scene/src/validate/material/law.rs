//! What makes a material the law that its `model` names.

use super::{Layer, is_graded, profile};
use crate::record::Record;
use crate::report::Report;
use crate::schema::{BELOW_90, Range};
use crate::words::{Law, Word};
use bsmpm::material::{
    DruckerPrager, Elastic, Graded, GradedStrength, Hencky, Law as _, Match, Material, MohrCoulomb, Profile,
    Separation, VonMises,
};

/// What a law has besides the elastic parameters.
pub(super) enum Parameters {
    Hencky,
    /// Friction and dilation angle (degrees), cohesion (Pa).
    MohrCoulomb([Profile; 3]),
    /// The same, and where the cone meets the pyramid.
    DruckerPrager([Profile; 3], Match),
    /// Yield stress and hardening modulus, Pa.
    VonMises([f64; 2]),
}

/// The plain law.
pub(super) fn uniform(elastic: Elastic, law: Parameters, (factor, separation): (f64, Separation)) -> Material {
    match law {
        Parameters::Hencky => Material::Hencky(Hencky { elastic }),
        Parameters::MohrCoulomb([friction, dilation, cohesion]) => {
            let (friction, dilation) = (friction.value.to_radians(), dilation.value.to_radians());
            let law = MohrCoulomb::new(elastic, friction, dilation, cohesion.value);
            Material::MohrCoulomb(law.separating(separation).reduced(factor))
        }
        Parameters::DruckerPrager([friction, dilation, cohesion], fit) => {
            let strength = (friction.value.to_radians(), dilation.value.to_radians(), cohesion.value);
            Material::DruckerPrager(DruckerPrager::new(elastic, strength, fit).reduced(factor))
        }
        Parameters::VonMises([yield_stress, hardening]) => {
            Material::VonMises(VonMises::new(elastic, yield_stress, hardening).reduced(factor))
        }
    }
}

/// The law by height above the grid's lower corner.
pub(super) fn graded(
    young: Profile,
    poisson: f64,
    law: Parameters,
    (layer, factor, separation): (&Layer, f64, Separation),
) -> Material {
    let relative = |profile: Profile| Profile { at: profile.at - layer.base, ..profile };
    let strength = match law {
        Parameters::Hencky | Parameters::DruckerPrager(..) | Parameters::VonMises(_) => None, // refused before
        Parameters::MohrCoulomb([friction, dilation, cohesion]) => Some(GradedStrength {
            friction: relative(radians(friction)),
            dilation: dilation.value.to_radians(),
            cohesion: relative(cohesion),
            reduction: factor,
            separation,
        }),
    };
    let heights = layer.heights.start - layer.base..layer.heights.end - layer.base;
    Material::Graded(Graded::new(relative(young), poisson, strength, heights))
}

/// All keys that some laws have and others have not.
fn all_keys() -> Vec<&'static str> {
    let of = |word| Law::of(word).map(keys).map_or(Vec::new(), |(required, known)| [required, known].concat());
    let mut all: Vec<&str> = Law::WORDS.words().flat_map(of).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Keys that a law needs, and further ones that it knows.
fn keys(law: Law) -> (&'static [&'static str], &'static [&'static str]) {
    match law {
        Law::Hencky => (&[], &[]),
        Law::Tresca => (&["cohesion"], &[]),
        Law::MohrCoulomb => (&["friction", "cohesion"], &["dilation", "separation"]),
        Law::DruckerPrager => (&["friction", "cohesion"], &["dilation", "match"]),
        Law::VonMises => (&["yield_stress"], &["hardening"]),
    }
}

/// The law's own parameters; `None` after an error.
pub(super) fn law(record: &Record, layer: Option<&Layer>, report: &mut Report<'_>) -> Option<Parameters> {
    let model = record.word("model")?;
    let (required, known) = keys(model);
    let mut whole = true;
    let all = all_keys();
    let unused = all.iter().filter(|key| !required.contains(key) && !known.contains(key));
    for key in unused.filter(|key| record.gives(key) && !zero_angle(record, model, key)) {
        record.error(key, format!("has no meaning in model \"{model}\""), report);
        whole = false;
    }
    for key in required.iter().filter(|key| !record.gives(key)) {
        report.error(record.origin, &record.path_of(key), format!("missing; model \"{model}\" needs it"));
        whole = false;
    }
    if !whole {
        return None;
    }
    match model {
        Law::Hencky => Some(Parameters::Hencky),
        Law::MohrCoulomb | Law::Tresca => mohr_coulomb(record, model, layer, report).map(Parameters::MohrCoulomb),
        Law::DruckerPrager | Law::VonMises if is_graded(record) => {
            record.error("model", format!("\"{model}\" has no parameters that depend on the height yet"), report);
            None
        }
        Law::DruckerPrager => {
            let strength = mohr_coulomb(record, model, layer, report)?;
            let fit = record.word("match").unwrap_or_default();
            warn_of_plane_strain(record, &strength, fit, report);
            Some(Parameters::DruckerPrager(strength, fit))
        }
        Law::VonMises => {
            Some(Parameters::VonMises([record.number("yield_stress")?, record.number("hardening").unwrap_or(0.0)]))
        }
    }
}

/// A cone that has another strength in plane strain than the pyramid it is to stand for.
fn warn_of_plane_strain(record: &Record, strength: &[Profile; 3], fit: Match, report: &mut Report<'_>) {
    let [friction, dilation, cohesion] = strength.each_ref().map(|profile| profile.value);
    let angles = (friction.to_radians(), dilation.to_radians(), cohesion);
    let cone = DruckerPrager::new(Elastic { young: 1.0, poisson: 0.0 }, angles, fit);
    let ratio = cone.strength_in_plane_strain();
    if (ratio - 1.0).abs() > 0.005 {
        report.warn(format!(
            "{}: in plane strain this cone has {:.1} % of mohr-coulomb's strength (with match = \"plane-strain\" and dilation = \
             friction it has all); use mohr-coulomb where that is meant",
            record.path,
            100.0 * ratio
        ));
    }
}

/// Friction and dilation angle (degrees) and cohesion (Pa); zero unless given.
fn mohr_coulomb(record: &Record, model: Law, layer: Option<&Layer>, report: &mut Report<'_>) -> Option<[Profile; 3]> {
    let given = |key| if record.gives(key) { profile(record, key) } else { Some(Profile::constant(0.0)) };
    let (friction, dilation, cohesion) = (given("friction")?, given("dilation")?, given("cohesion")?);
    if let Some(layer) = layer {
        layer.check(record, ("friction", &BELOW_90), &friction, report);
        layer.check(record, ("cohesion", &Range::NOT_NEGATIVE), &cohesion, report);
    }
    let heights = layer.map_or(friction.at..friction.at, |layer| layer.heights.clone());
    let (least, most) = friction.bounds(&heights);
    if dilation.value > most {
        let message = format!("{} is out of range; allowed: 0 <= dilation <= friction = {most}", dilation.value);
        record.error("dilation", message, report);
        return None;
    }
    if dilation.value > least {
        let path = record.path_of("dilation");
        report
            .warn(format!("{path}: {} is above the friction angle in places, and lowered to it there", dilation.value));
    }
    if most == 0.0 && cohesion.bounds(&heights).1 == 0.0 {
        report.warn(format!("{}: friction and cohesion are both 0: the material has no strength", record.path));
    }
    if model != Law::Tresca && !record.gives("dilation") {
        report.note(record.path_of("dilation"), "0.0", "default: plastic flow without change of volume");
    }
    Some([friction, dilation, cohesion])
}

/// What becomes of the volume that opens at the apex. Only where that is free of stress can it be a gap: with cohesion
/// it would pull with c cot phi until it has closed, and without friction there is no apex.
pub(super) fn separation(
    record: &Record,
    law: &Parameters,
    layer: Option<&Layer>,
    report: &mut Report<'_>,
) -> Separation {
    let separation = record.word("separation").unwrap_or_default();
    let (Separation::Closing, Parameters::MohrCoulomb([friction, _, cohesion])) = (separation, law) else {
        return Separation::Forgotten;
    };
    let bounds =
        |profile: &Profile| profile.bounds(&layer.map_or(profile.at..profile.at, |layer| layer.heights.clone()));
    if bounds(friction).0 <= 0.0 || bounds(cohesion).1 > 0.0 {
        let message = "\"closing\" needs friction and no cohesion: a gap is what opens where the stress is zero";
        record.error("separation", message, report);
    }
    Separation::Closing
}

/// Tresca's angles may be written if they are zero.
fn zero_angle(record: &Record, model: Law, key: &str) -> bool {
    model == Law::Tresca && matches!(key, "friction" | "dilation") && record.number(key) == Some(0.0)
}

fn radians(profile: Profile) -> Profile {
    Profile { value: profile.value.to_radians(), per_metre: profile.per_metre.to_radians(), ..profile }
}
