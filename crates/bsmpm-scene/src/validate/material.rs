//! Materials and what is doubtful about their parameters.

use super::STANDARD_GRAVITY;
use crate::case::NamedMaterial;
use crate::record::Record;
use crate::report::Report;
use bsmpm::material::{Elastic, Hencky, Material, MohrCoulomb};
use bsmpm::model::Regime;

/// Materials at most: a point holds its material's number in 16 bits.
const MOST: usize = 65_536;

/// All materials in the order of the file.
pub(super) fn read_all(root: &Record, regime: Option<Regime>, report: &mut Report<'_>) -> Option<Vec<NamedMaterial>> {
    let named = root.named("material");
    if root.gives("material") && named.is_empty() {
        root.error("material", "at least one [material.NAME] is needed", report);
    }
    if named.len() > MOST {
        root.error("material", format!("{} materials; at most {MOST} are possible", named.len()), report);
        return None;
    }
    let read: Vec<_> = named.iter().map(|(name, record)| read(name, record, regime, report)).collect();
    read.into_iter().collect()
}

fn read(name: &str, record: &Record, regime: Option<Regime>, report: &mut Report<'_>) -> Option<NamedMaterial> {
    let density = density(record, regime, report);
    let law = law(record, report);
    let (young, poisson) = (record.number("young"), record.number("poisson"));
    warn_of_stiffness(record, young, poisson, report);
    let elastic = Elastic { young: young?, poisson: poisson? };
    let material = match law? {
        None => Material::Hencky(Hencky { elastic }),
        Some([friction, dilation, cohesion]) => {
            let (friction, dilation) = (friction.to_radians(), dilation.to_radians());
            Material::MohrCoulomb(MohrCoulomb::new(elastic, friction, dilation, cohesion))
        }
    };
    Some(NamedMaterial { name: name.to_owned(), material, density: density? })
}

/// kg/m3; the outer option is `None` after an error.
fn density(record: &Record, regime: Option<Regime>, report: &mut Report<'_>) -> Option<Option<f64>> {
    let density = match (record.gives("unit_weight"), record.gives("density")) {
        (true, _) => {
            let density = record.number("unit_weight")? / STANDARD_GRAVITY;
            report.note(record.path_of("density"), format!("{density}"), "unit_weight / 9.81 m/s2");
            density
        }
        (_, true) => record.number("density")?,
        _ if regime == Some(Regime::Dynamic) => {
            let message = "missing: unit_weight or density; a dynamic analysis needs mass";
            report.error(record.origin, &record.path, message);
            return None;
        }
        _ => return Some(None),
    };
    if !(100.0..=30_000.0).contains(&density) {
        report.warn(format!(
            "{}: a density of {density:.6} kg/m3 (unit weight {:.6} kN/m3) is unusual: check the unit",
            record.path,
            density * STANDARD_GRAVITY * 1e-3
        ));
    }
    Some(Some(density))
}

/// Friction, dilation (degrees) and cohesion (Pa), none of an elastic law; the outer option is `None` after an error.
fn law(record: &Record, report: &mut Report<'_>) -> Option<Option<[f64; 3]>> {
    let model = record.word("model")?;
    let (unused, required): (&[&str], &[&str]) = match model {
        "hencky" => (&["friction", "dilation", "cohesion"], &[]),
        "tresca" => (&["friction", "dilation"], &["cohesion"]),
        _ => (&[], &["friction", "cohesion"]),
    };
    let mut whole = true;
    for key in unused.iter().filter(|key| record.gives(key) && !zero_angle(record, model, key)) {
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
    if model == "hencky" {
        return Some(None);
    }
    let given = |key| if record.gives(key) { record.number(key) } else { Some(0.0) };
    let (friction, dilation, cohesion) = (given("friction")?, given("dilation")?, record.number("cohesion")?);
    if dilation > friction {
        let message = format!("{dilation} is out of range; allowed: 0 <= dilation <= friction = {friction}");
        record.error("dilation", message, report);
        return None;
    }
    if friction == 0.0 && cohesion == 0.0 {
        report.warn(format!("{}: friction and cohesion are both 0: the material has no strength", record.path));
    }
    if model == "mohr-coulomb" && !record.gives("dilation") {
        report.note(record.path_of("dilation"), "0.0", "default: plastic flow without change of volume");
    }
    Some(Some([friction, dilation, cohesion]))
}

/// Tresca's angles may be written if they are zero.
fn zero_angle(record: &Record, model: &str, key: &str) -> bool {
    model == "tresca" && record.number(key) == Some(0.0)
}

fn warn_of_stiffness(record: &Record, young: Option<f64>, poisson: Option<f64>, report: &mut Report<'_>) {
    if let Some(young) = young.filter(|young| !(1e3..=1e12).contains(young)) {
        report.warn(format!(
            "{}: young = {young:e} Pa = {:e} kPa is unusual: check the unit",
            record.path,
            young * 1e-3
        ));
    }
    if let Some(poisson) = poisson.filter(|poisson| *poisson > 0.4999) {
        report.warn(format!("{}: poisson = {poisson} is nearly incompressible: expect poor convergence", record.path));
    }
}
