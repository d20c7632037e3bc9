//! Examines an output directory for `--restart auto`.

use super::FreshStart;
use crate::checkpoint::Refusal;
use crate::machine;
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::quadrature::Quadrature;
use bsmpm_io::checkpoint::FoundCheckpoint;
use bsmpm_io::directory::ExistingRunPolicy;
use bsmpm_io::exit;
use bsmpm_io::manifest::{Manifest, ManifestRestart, Status};
use bsmpm_messages::without_code;
use bsmpm_scene::words::Word;
use bsmpm_scene::{Case, Difference, Error, MASS};

/// Restarts in a row from one step after which no more is tried: the loop of a batch system would have no end.
const MOST_FUTILE: usize = 3;

/// The run in a directory.
#[derive(Clone, Copy)]
pub(super) enum PriorRun {
    Nothing,
    Unfinished,
    /// with its exit code
    Complete(u8),
}

impl PriorRun {
    pub(super) fn bytes(self) -> Vec<u8> {
        match self {
            Self::Nothing => vec![0],
            Self::Unfinished => vec![1],
            Self::Complete(code) => vec![2, code],
        }
    }

    pub(super) fn of(bytes: Vec<u8>) -> Self {
        match bytes[..] {
            [2, code] => Self::Complete(code),
            [0] => Self::Nothing,
            _ => Self::Unfinished,
        }
    }
}

/// What there is to go on with. A run whose checks or indicators failed came to its end, too: they would fail again.
pub(super) fn look(run: Option<&Manifest>, case: &Case) -> Result<PriorRun, Refusal> {
    let Some(run) = run else { return Ok(PriorRun::Nothing) };
    let changed = admissible("the run in the output directory", run, case)?;
    let further = changed
        .iter()
        .any(|change| change.key == "analysis.end" && is_later(change));
    let ended = match (run.status, run.exit_code) {
        (Status::Finished, _) => Some(exit::DONE),
        (Status::Failed, Some(code @ (exit::CHECK | exit::INDICATOR))) => Some(code),
        _ => None,
    };
    Ok(ended
        .filter(|_| !further)
        .map_or(PriorRun::Unfinished, PriorRun::Complete))
}

fn is_later(change: &Difference) -> bool {
    let [was, is] = [&change.was, &change.is].map(|text| text.as_ref()?.parse::<f64>().ok());
    was.zip(is).is_none_or(|(was, is)| is > was)
}

fn refused(reason: String) -> Refusal {
    Refusal::new(exit::CHECKPOINT, reason)
}

/// How a run begins again in whose directory there is no checkpoint: only if it was killed or stopped before it had
/// one, so that nothing is deleted that had been kept.
pub(super) fn afresh(run: Option<&Manifest>, passed_over: &[String], ranks: i32) -> Result<FreshStart, Refusal> {
    if let Some(bad) = passed_over.first() {
        return Err(refused(bad.clone()));
    }
    let Some(run) = run else {
        return Ok(FreshStart::default());
    };
    if let Some(gone) = &run.checkpoint {
        return Err(refused(format!(
            "E0724: checkpoint `{gone}`, which run.json names, is missing. The run cannot be continued. Restore the \
             checkpoint, or start again with `--force`."
        )));
    }
    // One that was stopped has a checkpoint, unless that was before it had found its first state.
    let kept_nothing = [Some(exit::WRITE), Some(exit::STOPPED)].contains(&run.exit_code);
    if run.status != Status::Running && !kept_nothing {
        let ended = format!("{:?}", run.status).to_lowercase();
        return Err(refused(format!(
            "E0726: the run in the output directory ended ({ended}) without a checkpoint. The run cannot be \
             continued. Start again with `--force`."
        )));
    }
    futile(&run.restarts, 0)?;
    let ranks = ranks.unsigned_abs();
    let restart = ManifestRestart {
        checkpoint: String::new(),
        step: 0,
        ranks_before: run.ranks,
        ranks,
        start: bsmpm_io::utc::now(),
        changed: Vec::new(),
    };
    Ok(FreshStart {
        existing: ExistingRunPolicy::Delete,
        restarts: run.restarts.iter().cloned().chain([restart]).collect(),
        warnings: vec![
            "W0730: the earlier run ended before its first checkpoint. This run begins at the first step. Write \
             checkpoints more often with `output.checkpoint`."
                .into(),
        ],
    })
}

/// The keys that differ between a case and what was run, if a run may continue with all of them changed.
pub(super) fn admissible(what: &str, past: &Manifest, case: &Case) -> Result<Vec<Difference>, Refusal> {
    let differences = bsmpm_scene::differences(&past.case.text, &case.text);
    let differences = differences.map_err(|errors| refused(unreadable(what, &errors)))?;
    let bound: Vec<String> = differences
        .iter()
        .filter(|difference| !difference.may_change)
        .map(ToString::to_string)
        .collect();
    if bound.is_empty() {
        return Ok(differences);
    }
    Err(refused(format!(
        "E0721: the case has changed since {what}: {}. The run cannot be continued. Restore the old values, or start \
         again with `--force`.",
        bound.join("; ")
    )))
}

/// Why the case of an earlier run is not read any more.
fn unreadable(what: &str, errors: &[Error]) -> String {
    let removed = errors
        .iter()
        .find_map(|error| error.removed.map(|removed| (&error.key, removed)));
    match removed {
        None => format!(
            "E0727: this version of the program cannot read the case of {what}. The run cannot be continued. Use the \
             version that began the run, or start again with `--force`."
        ),
        Some((key, removed)) => format!(
            "E0728: the case of {what} uses `{key} = {}`, which was removed after {}. This version cannot \
             continue the run. Use {}, or change the case and start again with `--force`. {}",
            removed.value(),
            removed.last,
            removed.last,
            removed.remedy
        ),
    }
}

/// That a checkpoint is damaged, and an older one is used.
pub(super) fn passed_over(bad: &str) -> String {
    let reason = without_code(bad).split(". ").next().unwrap_or_default();
    format!(
        "W0731: a checkpoint is skipped, because {reason}. The run continues from an older checkpoint. Check the \
        disk and the file system."
    )
}

/// That a key was changed since a checkpoint.
pub(super) fn changed_since(change: &str) -> String {
    format!(
        "W0732: the case has changed since the checkpoint: {change}. The run continues with the new value. Check \
        that the change is intended."
    )
}

/// Whether the last restarts were all from this step.
pub(super) fn futile(restarts: &[ManifestRestart], step: u64) -> Result<(), Refusal> {
    let same = restarts.iter().rev().take_while(|restart| restart.step == step).count();
    if same < MOST_FUTILE {
        return Ok(());
    }
    let reason = format!(
        "E0729: {same} restarts in a row made no progress beyond step {step}. The run was not continued. Name a checkpoint with \
         `--restart FILE`, or start again with `--force`."
    );
    Err(Refusal::new(exit::STALLED, reason))
}

/// Warns if the run began in a version that had neither extended splines nor fitted quadrature by default, and goes on
/// with one of them.
pub(super) fn new_defaults(past: &Manifest, case: &Case) -> Option<String> {
    let began_without = !past.sizes.contains_key("most_tied_functions");
    let solver = &case.solver;
    let goes_on_with = solver.extended_splines == ExtendedSplines::Linear || solver.quadrature == Quadrature::Fitted;
    (began_without && goes_on_with).then(|| {
        "W0733: the run began with an earlier version of the program, whose default methods differ. Displacements at \
         the surface may jump at this restart. For consistent results, start again with `--force`."
            .into()
    })
}

/// The mass matrix of a run of a case. The program notes its choice of one; before it chose, a case without one had the
/// lumped one.
pub(super) fn mass(past: &Manifest, case: &Case) -> MassMatrix {
    match past.choices.iter().find(|choice| choice.key == MASS) {
        Some(choice) => MassMatrix::of(&choice.value).unwrap_or_default(),
        None if case.notes.iter().any(|note| note.key == MASS) => MassMatrix::Lumped,
        None => case.analysis.mass,
    }
}

/// Why the run will not repeat to the bit, if so.
pub(super) fn other_machine(past: &Manifest, ranks: u32, found: &FoundCheckpoint) -> Vec<String> {
    let mut reasons = Vec::new();
    if found.record.ranks != ranks {
        let before = found.record.ranks;
        reasons.push(format!(
            "W0734: the checkpoint was written on {before} rank(s), and the run continues on {ranks} rank(s). Results \
             agree within the solver's tolerances only. Use {before} rank(s) for identical results."
        ));
    }
    let version = env!("CARGO_PKG_VERSION");
    if past.version != version {
        reasons.push(format!(
            "W0735: the checkpoint was written by version {}, and the run continues with version {version}. Results may differ. Use the \
             same version for identical results.",
            past.version
        ));
    }
    for (library, now) in machine::library_versions() {
        if let Some(before) = past.versions.get(&library).filter(|before| **before != now) {
            reasons.push(format!(
                "W0736: the checkpoint was written with {library} {before}, and the run continues with {now}. Results may differ slightly. \
                 Use the same libraries for identical results."
            ));
        }
    }
    reasons
}

#[cfg(test)]
mod tests {
    use super::*;
    use bsmpm_io::manifest::{ManifestCase, ManifestChoice};

    const BLOCK: &str = r#"
        geometry = "plane-strain"
        [analysis]
        type = "dynamic"
        end = 1.0
        dt = 0.1
        [grid]
        lower = [0, 0]
        upper = [2, 2]
        cell = 1.0
        degree = "quadratic"
        [material.elastic]
        model = "elastic"
        young = 1e6
        poisson = 0.0
        density = 1000.0
        [[body]]
        material = "elastic"
        box = { lower = [0, 0], upper = [2, 2] }
        points_per_cell = 2
        [gravity]
        acceleration = [0.0, -9.81]
        [boundary]
        bottom = "fixed"
    "#;

    #[test]
    fn a_run_that_goes_on_keeps_the_mass_matrix_that_it_began_with() {
        let case = |overrides: &[&str]| {
            let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
            Case::from_bytes("block", BLOCK.as_bytes(), &overrides).unwrap()
        };
        let described = ManifestCase::new("block", "", "plane-strain", BLOCK.to_owned());
        let mut past = Manifest::begin("0", Vec::new(), described);
        let mut today = case(&[]);
        assert_eq!(today.analysis.mass, MassMatrix::Consistent);
        // A version that did not choose.
        assert_eq!(mass(&past, &today), MassMatrix::Lumped);
        today.keep_mass(MassMatrix::Lumped);
        let noted: Vec<&str> = today
            .notes
            .iter()
            .filter(|note| note.key == MASS)
            .map(|note| &*note.value)
            .collect();
        assert_eq!((today.analysis.mass, &*noted), (MassMatrix::Lumped, &["lumped"][..]));
        assert_eq!(
            mass(&past, &case(&["analysis.mass=consistent"])),
            MassMatrix::Consistent
        );
        let chosen = |value: &str| ManifestChoice {
            key: MASS.into(),
            value: value.into(),
            reason: String::new(),
        };
        for (value, expected) in [("lumped", MassMatrix::Lumped), ("consistent", MassMatrix::Consistent)] {
            past.choices = vec![chosen(value)];
            assert_eq!(mass(&past, &case(&[])), expected);
        }
    }
}
