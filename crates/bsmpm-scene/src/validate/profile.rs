//! Profiles along lines.

use super::history;
use crate::case::Profile;
use crate::grid::GridSpec;
use crate::record::Record;
use crate::report::Report;
use crate::words::{Geometry, ProfileQuantity};
use bsmpm::model::Regime;

/// Profiles at most, each a file.
const MOST: usize = 100;

/// All profiles in the order of the file, without those that have an error.
pub(super) fn read_all(
    root: &Record,
    (regime, grid, end): (Option<Regime>, Option<&GridSpec>, Option<f64>),
    report: &mut Report<'_>,
) -> Vec<Profile> {
    let records = root.records("profile");
    if records.len() > MOST {
        root.error(
            "profile",
            format!("E0214: the case has {} profiles (at most {MOST}). Delete some.", records.len()),
            report,
        );
        return Vec::new();
    }
    let mut profiles: Vec<Profile> = Vec::new();
    for record in records {
        let Some(profile) = read((root, record), (regime, grid, end), report) else { continue };
        // Files of some systems are not told apart by the case of letters.
        if profiles.iter().any(|other| other.name.eq_ignore_ascii_case(&profile.name)) {
            record.error(
                "name",
                format!("E0261: another profile has the name `{}`. Give each its own name.", profile.name),
                report,
            );
        }
        profiles.push(profile);
    }
    profiles
}

fn read(
    (root, record): (&Record, &Record),
    (regime, grid, end): (Option<Regime>, Option<&GridSpec>, Option<f64>),
    report: &mut Report<'_>,
) -> Option<Profile> {
    let ends = history::ends(record, grid, report);
    let quantities: Vec<ProfileQuantity> = record.choices("quantities")?;
    if quantities.is_empty() {
        record.error(
            "quantities",
            "E0262: the profile has no quantity, so it would be empty. Name at least one.",
            report,
        );
    }
    if regime == Some(Regime::QuasiStatic) && quantities.contains(&ProfileQuantity::Velocity) {
        let message = "E0218: the analysis has no inertia, so there is no velocity. Delete \"velocity\", or use \
                       analysis.type = \"dynamic\".";
        record.error("quantities", message, report);
    }
    if quantities.contains(&ProfileQuantity::ExcessPressure) && !super::flow::flows(root) {
        let message = "E0263: no water flows in this case, so there is no excess pressure. Delete it, or set \
                       `drainage` of a material.";
        record.error("quantities", message, report);
    }
    let mut times = if record.gives("times") { record.numbers("times")?.to_vec() } else { Vec::new() };
    if record.gives("times") && times.is_empty() {
        record.error(
            "times",
            "E0262: the list of times is empty, so the profile is never written. Add times, or delete the key.",
            report,
        );
    }
    if let Some(late) = times.iter().find(|time| end.is_some_and(|end| **time > end)) {
        record.error(
            "times",
            format!("E0264: the time {late} is beyond the end of the analysis. Reduce it, or increase analysis.end."),
            report,
        );
        return None;
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    Some(Profile {
        name: record.text("name")?.to_owned(),
        dims: root.word::<Geometry>("geometry")?.dims(),
        ends: ends?,
        count: record.count("count")? as usize,
        quantities,
        times,
        fixed: record.flag("fixed")?,
    })
}
