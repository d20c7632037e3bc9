//! Validates tests of one material point.

use crate::case::{ElementStage, ElementTest, NamedMaterial};
use crate::grid::GridSpec;
use crate::nearest::unknown_name;
use crate::record::Record;
use crate::report::Report;
use crate::schema::Draft;
use crate::words::Path;
use bsmpm::element::Target;

/// Keys of a stage that say what is driven.
const DRIVES: [&str; 10] = [
    "compression",
    "pressure",
    "shear",
    "shear_stress",
    "strain_xx",
    "strain_yy",
    "strain_zz",
    "stress_xx",
    "stress_yy",
    "stress_zz",
];
/// Those of a mixed stage, by components.
const MIXED: [[&str; 2]; 3] = [
    ["strain_xx", "stress_xx"],
    ["strain_yy", "stress_yy"],
    ["strain_zz", "stress_zz"],
];

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
    record: &Record,
    materials: &[NamedMaterial],
    grid: &GridSpec,
    report: &mut Report<'_>,
) -> Option<ElementTest> {
    let material = material(record, materials, report);
    let stages = record.records("stage");
    if record.gives("stage") && stages.is_empty() {
        let message = "E0690: the test has no stage, so nothing is applied to the soil. Add for example stage = [{ test = \
             \"triaxial\", compression = 0.05 }].";
        record.consequence("stage", message, &[&record.path_of("stage")], report);
    }
    let mut undrained = false;
    let mut read = Vec::with_capacity(stages.len());
    for stage in stages {
        read.push(self::stage(stage, report));
        let now = stage.flag("undrained").unwrap_or(false);
        if undrained && !now {
            let message = "E0691: a drained stage cannot follow an undrained one, because the dissipation of the pore \
                           pressure is not modelled. Use two tests.";
            report.error(stage.origin, &stage.path, message);
        }
        undrained = now;
    }
    let material = material?;
    let height = height(record, &materials[material], grid, report)?;
    let pressure = record.number("pressure")?;
    let k0 = record.number("k0")?;
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
fn height(record: &Record, named: &NamedMaterial, grid: &GridSpec, report: &mut Report<'_>) -> Option<Option<f64>> {
    if !named.material.is_graded() {
        if record.gives("height") {
            let message = format!(
                "E0692: the parameters of material.{} do not vary with height, so `height` has no effect. Remove \
                 `height`.",
                named.name
            );
            record.error("height", message, report);
        }
        return Some(None);
    }
    if !record.gives("height") {
        let message = format!(
            "E0692: the parameters of material.{} vary with height, but the test does not give the height of its \
             material point. Add `height`.",
            named.name
        );
        report.error(record.origin, &record.path_of("height"), message);
        return None;
    }
    Some(Some(record.number("height")? - grid.lower()[grid.dims() - 1]))
}

/// The number of its material.
fn material(record: &Record, materials: &[NamedMaterial], report: &mut Report<'_>) -> Option<usize> {
    if !record.gives("material") {
        if materials.len() > 1 {
            let message = format!(
                "E0693: the case has {} materials, and the test does not say which one it uses. Add `material`.",
                materials.len()
            );
            report.error(record.origin, &record.path_of("material"), message);
            return None;
        }
        return Some(0);
    }
    let wanted = record.text("material")?;
    let found = materials.iter().position(|named| named.name == wanted);
    if found.is_none() {
        let names = materials.iter().map(|named| named.name.as_str());
        record.error("material", unknown_name("material", wanted, names), report);
    }
    found
}

fn stage(record: &Record, report: &mut Report<'_>) -> Option<ElementStage> {
    let path: Path = record.word("test")?;
    let known: &[&'static str] = match path {
        Path::Triaxial | Path::Biaxial | Path::Oedometer | Path::Isotropic => &DRIVES[..2],
        Path::SimpleShear => &DRIVES[2..4],
        Path::Mixed => &DRIVES[2..],
    };
    for key in DRIVES.iter().filter(|key| !known.contains(key) && record.gives(key)) {
        let message = format!("E0694: the key `{key}` has no effect in the test \"{path}\". Remove `{key}`.");
        record.error(key, message, report);
    }
    let targets = targets(record, path, known, report)?;
    let undrained = record.flag("undrained")?;
    let is_held = targets[..3]
        .iter()
        .all(|target| matches!(target, Some(Target::Strain(_))));
    if undrained && (path == Path::Isotropic || is_held || path == Path::Oedometer) {
        let message = format!(
            "E0695: the test \"{path}\" prescribes the volume change, so it cannot be undrained. Remove `undrained`, \
             or use another test."
        );
        record.error("undrained", message, report);
        return None;
    }
    let duration = if record.gives("duration") {
        record.number("duration")?
    } else {
        f64::INFINITY
    };
    Some(ElementStage {
        targets,
        undrained,
        steps: record.count("steps")?,
        duration,
    })
}

/// Targets of the components xx, yy, zz and xy of a stage that knows the `known` keys; `None` after an error.
fn targets(
    record: &Record,
    path: Path,
    known: &[&'static str],
    report: &mut Report<'_>,
) -> Option<[Option<Target>; 4]> {
    let driven = match path {
        Path::Mixed => None,
        _ => match given(record, known) {
            None => {
                refuse_missing(record, path, known, report);
                return None;
            }
            Some(key) => Some(target(record, key)?),
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
            for (axis, keys) in MIXED.iter().enumerate() {
                match given(record, keys) {
                    Some(key) => targets[axis] = Some(target(record, key)?),
                    None => refuse_missing(record, path, keys, report),
                }
            }
            if let Some(key) = given(record, &DRIVES[2..4]) {
                targets[3] = Some(target(record, key)?);
            }
            targets
        }
    })
}

/// The first of the keys that a stage gives.
fn given(record: &Record, keys: &[&'static str]) -> Option<&'static str> {
    keys.iter().copied().find(|key| record.gives(key))
}

/// Refuses a stage that gives none of the keys, one of which it needs.
fn refuse_missing(record: &Record, path: Path, keys: &[&str], report: &mut Report<'_>) {
    let message = format!(
        "E0694: the test \"{path}\" does not say which strain or stress is applied. Add `{}`.",
        keys.join("` or `")
    );
    report.error(record.origin, &record.path, message);
}

/// What a key drives its component to, positive in tension.
fn target(record: &Record, key: &str) -> Option<Target> {
    let value = record.number(key)?;
    Some(match key {
        "compression" => Target::Strain(-value),
        "pressure" => Target::Stress(-value),
        "shear" | "strain_xx" | "strain_yy" | "strain_zz" => Target::Strain(value),
        _ => Target::Stress(value),
    })
}
