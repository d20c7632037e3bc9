//! Validates tests of one material point.

use crate::case::{ElementStage, ElementTest, NamedMaterial};
use crate::grid::GridSpec;
use crate::nearest::unknown_name;
use crate::record::{CaseTable, Field};
use crate::report::Report;
use crate::schema::{Draft, ElementStageTable, ElementTable};
use crate::words::Path;
use bsmpm::element::Target;

/// All tests in the order of the file, without those that have an error.
pub(super) fn read_all(
    draft: &Draft,
    materials: Option<&[NamedMaterial]>,
    grid: Option<&GridSpec>,
    report: &mut Report<'_>,
) -> Vec<ElementTest> {
    let named = draft.element.items().iter();
    named
        .filter_map(|(name, record)| read(name, record, materials?, grid?, report))
        .collect()
}

fn read(
    name: &str,
    record: &ElementTable,
    materials: &[NamedMaterial],
    grid: &GridSpec,
    report: &mut Report<'_>,
) -> Option<ElementTest> {
    let material = material(record, materials, report);
    let stages = record.stage.items();
    if record.stage.is_given() && stages.is_empty() {
        let message = "E0690: the test has no stage, so nothing is applied to the soil. Add for example stage = [{ test = \
             \"triaxial\", compression = 0.05 }].";
        record.stage.consequence(message, &[record.stage.path()], report);
    }
    let mut undrained = false;
    let mut read = Vec::with_capacity(stages.len());
    for stage in stages {
        read.push(self::stage(stage, report));
        let now = stage.undrained.get().unwrap_or(false);
        if undrained && !now {
            let message = "E0691: a drained stage cannot follow an undrained one, because the dissipation of the pore \
                           pressure is not modelled. Use two tests.";
            stage.location().error(message, report);
        }
        undrained = now;
    }
    let material = material?;
    let height = height(record, &materials[material], grid, report)?;
    let pressure = record.pressure.get()?;
    let k0 = record.k0.get()?;
    let stages: Option<Vec<_>> = read.into_iter().collect();
    Some(ElementTest {
        name: name.to_owned(),
        material,
        height,
        pressure,
        k0,
        stages: stages?,
    })
}

/// Height (m) of the material point above the lower end of the grid, if parameters of the material vary with height;
/// the outer option is `None` after an error.
fn height(
    record: &ElementTable,
    named: &NamedMaterial,
    grid: &GridSpec,
    report: &mut Report<'_>,
) -> Option<Option<f64>> {
    if !named.material.is_graded() {
        if record.height.is_given() {
            let message = format!(
                "E0692: the parameters of material.{} do not vary with height, so `height` has no effect. Remove \
                 `height`.",
                named.name
            );
            record.height.error(message, report);
        }
        return Some(None);
    }
    if !record.height.is_given() {
        let message = format!(
            "E0692: the parameters of material.{} vary with height, but the test does not give the height of its \
             material point. Add `height`.",
            named.name
        );
        record.height.error(message, report);
        return None;
    }
    Some(Some(record.height.get()? - grid.lower()[grid.dims() - 1]))
}

/// The number of its material.
fn material(record: &ElementTable, materials: &[NamedMaterial], report: &mut Report<'_>) -> Option<usize> {
    if !record.material.is_given() {
        if materials.len() > 1 {
            let message = format!(
                "E0693: the case has {} materials, and the test does not say which one it uses. Add `material`.",
                materials.len()
            );
            record.material.error(message, report);
            return None;
        }
        return Some(0);
    }
    let wanted = record.material.text()?;
    let found = materials.iter().position(|named| named.name == wanted);
    if found.is_none() {
        let names = materials.iter().map(|named| named.name.as_str());
        record.material.error(unknown_name("material", wanted, names), report);
    }
    found
}

fn stage(record: &ElementStageTable, report: &mut Report<'_>) -> Option<ElementStage> {
    let path: Path = record.test.get()?;
    let drives = record.drives();
    let known = match path {
        Path::Triaxial | Path::Biaxial | Path::Oedometer | Path::Isotropic => 0..2,
        Path::SimpleShear => 2..4,
        Path::Mixed => 2..drives.len(),
    };
    for (number, key) in drives.iter().enumerate() {
        if key.is_given() && !known.contains(&number) {
            let name = key.name();
            let message = format!("E0694: the key `{name}` has no effect in the test \"{path}\". Remove `{name}`.");
            key.error(message, report);
        }
    }
    let targets = targets(record, path, &drives[known], report)?;
    let undrained = record.undrained.get()?;
    let is_held = targets[..3]
        .iter()
        .all(|target| matches!(target, Some(Target::Strain(_))));
    if undrained && (path == Path::Isotropic || is_held || path == Path::Oedometer) {
        let message = format!(
            "E0695: the test \"{path}\" prescribes the volume change, so it cannot be undrained. Remove `undrained`, \
             or use another test."
        );
        record.undrained.error(message, report);
        return None;
    }
    let duration = record.duration.if_given()?.unwrap_or(f64::INFINITY);
    Some(ElementStage {
        targets,
        undrained,
        steps: record.steps.get()?,
        duration,
    })
}

/// Targets of the components xx, yy, zz and xy of a stage that knows the `known` keys; `None` after an error.
fn targets(
    record: &ElementStageTable,
    path: Path,
    known: &[&Field<f64>],
    report: &mut Report<'_>,
) -> Option<[Option<Target>; 4]> {
    let driven = match path {
        Path::Mixed => None,
        _ => match given(known) {
            None => {
                refuse_missing(record, path, known, report);
                return None;
            }
            Some(key) => Some(target(key)?),
        },
    };
    let held = Some(Target::Strain(0.0));
    Some(match (path, driven) {
        (Path::Triaxial, yy) => [None, yy, None, held],
        (Path::Biaxial, yy) => [None, yy, held, held],
        (Path::Oedometer, yy) => [held, yy, held, held],
        (Path::Isotropic, Some(Target::Strain(volume))) => {
            let each = Some(Target::Strain(volume / 3.0));
            [each, each, each, held]
        }
        (Path::Isotropic, stress) => [stress, stress, stress, held],
        (Path::SimpleShear, xy) => [held, None, held, xy],
        (Path::Mixed, _) => {
            let mut targets = [None, None, None, held];
            let normal = [
                [&record.strain_xx, &record.stress_xx],
                [&record.strain_yy, &record.stress_yy],
                [&record.strain_zz, &record.stress_zz],
            ];
            for (axis, keys) in normal.iter().enumerate() {
                match given(keys) {
                    Some(key) => targets[axis] = Some(target(key)?),
                    None => refuse_missing(record, path, keys, report),
                }
            }
            if let Some(key) = given(&[&record.shear, &record.shear_stress]) {
                targets[3] = Some(target(key)?);
            }
            targets
        }
    })
}

/// The first of the keys that a stage gives.
fn given<'a>(keys: &[&'a Field<f64>]) -> Option<&'a Field<f64>> {
    keys.iter().copied().find(|key| key.is_given())
}

/// Refuses a stage that gives none of the keys, one of which it needs.
fn refuse_missing(record: &ElementStageTable, path: Path, keys: &[&Field<f64>], report: &mut Report<'_>) {
    let names: Vec<&str> = keys.iter().map(|key| key.name()).collect();
    let message = format!(
        "E0694: the test \"{path}\" does not say which strain or stress is applied. Add `{}`.",
        names.join("` or `")
    );
    record.location().error(message, report);
}

/// What a key drives its component to, positive in tension.
fn target(key: &Field<f64>) -> Option<Target> {
    let value = key.get()?;
    Some(match key.name() {
        "compression" => Target::Strain(-value),
        "pressure" => Target::Stress(-value),
        "shear" | "strain_xx" | "strain_yy" | "strain_zz" => Target::Strain(value),
        _ => Target::Stress(value),
    })
}
