//! Validates profiles along lines.

use super::history;
use crate::case::Profile;
use crate::grid::GridSpec;
use crate::observables::ProfileQuantity;
use crate::report::Report;
use crate::schema::{Draft, ProfileTable};
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
            record.name.error(message, report);
        }
        profiles.push(profile);
    }
    profiles
}

fn read(
    draft: &Draft,
    record: &ProfileTable,
    regime: Option<Regime>,
    grid: Option<&GridSpec>,
    end: Option<f64>,
    report: &mut Report<'_>,
) -> Option<Profile> {
    let ends = history::ends(&record.from, &record.to, grid, report);
    let quantities = record.quantities.value()?.clone();
    if quantities.is_empty() {
        record.quantities.error(
            "E0652: the list is empty, so the profile has no values. Name a quantity.",
            report,
        );
    }
    if regime == Some(Regime::QuasiStatic) && quantities.contains(&ProfileQuantity::Velocity) {
        record.quantities.error(history::needs_dynamics("velocity"), report);
    }
    if quantities.contains(&ProfileQuantity::ExcessPressure) && !super::flow::flows(draft) {
        record.quantities.error(history::needs_flow("excess-pressure"), report);
    }
    let mut times = record.times.list()?.to_vec();
    if record.times.is_given() && times.is_empty() {
        let message = "E0652: the list is empty, so the profile is never written. Give a time, or remove `times` to \
                       write the profile with every frame.";
        record.times.error(message, report);
    }
    if let Some(late) = times.iter().find(|time| end.is_some_and(|end| **time > end)) {
        record.times.error(history::after_the_end(*late), report);
        return None;
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    Some(Profile {
        name: record.name.text()?.to_owned(),
        dims: draft.geometry.get()?.dims(),
        ends: ends?,
        count: record.count.get()? as usize,
        quantities,
        times,
        fixed: record.fixed.get()?,
    })
}
