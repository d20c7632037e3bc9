//! Validates profiles along lines.

use super::history;
use crate::case::Profile;
use crate::grid::GridSpec;
use crate::observables::ProfileQuantity;
use crate::record::Record;
use crate::report::Report;
use crate::schema::Draft;
use bsmpm::model::Regime;

/// Profiles at most, each a file.
const MOST: usize = 100;

/// All profiles in the order of the file, without those that have an error.
pub(super) fn read_all(
    draft: &Draft,
    regime: Option<Regime>,
    grid: Option<&GridSpec>,
    end: Option<f64>,
    report: &mut Report<'_>,
) -> Vec<Profile> {
    let records = draft.profile.items();
    if records.len() > MOST {
        draft.profile.error(history::too_many(records.len(), MOST), report);
        return Vec::new();
    }
    let mut profiles: Vec<Profile> = Vec::new();
    for record in records {
        let Some(profile) = read(draft, record, regime, grid, end, report) else {
            continue;
        };
        // Some file systems do not distinguish upper and lower case.
        if profiles
            .iter()
            .any(|other| other.name.eq_ignore_ascii_case(&profile.name))
        {
            let message = format!(
                "E0610: another profile has the name `{}` (upper and lower case count as equal). Rename one of the \
                 two profiles.",
                profile.name
            );
            record.error("name", message, report);
        }
        profiles.push(profile);
    }
    profiles
}

fn read(
    draft: &Draft,
    record: &Record,
    regime: Option<Regime>,
    grid: Option<&GridSpec>,
    end: Option<f64>,
    report: &mut Report<'_>,
) -> Option<Profile> {
    let ends = history::ends(record, grid, report);
    let quantities: Vec<ProfileQuantity> = record.choices("quantities")?;
    if quantities.is_empty() {
        record.error(
            "quantities",
            "E0652: the list is empty, so the profile has no values. Name a quantity.",
            report,
        );
    }
    if regime == Some(Regime::QuasiStatic) && quantities.contains(&ProfileQuantity::Velocity) {
        record.error("quantities", history::needs_dynamics("velocity"), report);
    }
    if quantities.contains(&ProfileQuantity::ExcessPressure) && !super::flow::flows(draft) {
        record.error("quantities", history::needs_flow("excess-pressure"), report);
    }
    let mut times = if record.gives("times") {
        record.numbers("times")?.to_vec()
    } else {
        Vec::new()
    };
    if record.gives("times") && times.is_empty() {
        let message = "E0652: the list is empty, so the profile is never written. Give a time, or remove `times` to \
                       write the profile with every frame.";
        record.error("times", message, report);
    }
    if let Some(late) = times.iter().find(|time| end.is_some_and(|end| **time > end)) {
        record.error("times", history::after_the_end(*late), report);
        return None;
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    Some(Profile {
        name: record.text("name")?.to_owned(),
        dims: draft.geometry.get()?.dims(),
        ends: ends?,
        count: record.count("count")? as usize,
        quantities,
        times,
        fixed: record.flag("fixed")?,
    })
}
