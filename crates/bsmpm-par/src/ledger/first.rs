//! The manifest before the first step.

use crate::cli::Arguments;
use crate::machine;
use crate::setup;
use bsmpm::stabilisation::Stabilisation;
use bsmpm_io::manifest::{self, GridExtent, Manifest, ManifestCheck};
use bsmpm_scene::words::Word;
use bsmpm_scene::{Case, Check, GridAxis};

/// The manifest of a new run of a case.
pub(super) fn manifest(arguments: &Arguments, case: &Case, ranks: usize) -> Manifest {
    let file = arguments
        .case
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let described = manifest::ManifestCase::new(&file, &case.title, case.geometry.word(), case.text.clone());
    let mut manifest = Manifest::begin(
        env!("CARGO_PKG_VERSION"),
        std::env::args_os()
            .map(|argument| argument.to_string_lossy().into_owned())
            .collect(),
        described,
    );
    let axes = &case.grid.axes;
    (manifest.ranks, manifest.threads) = (ranks as u32, arguments.threads);
    manifest.grid = Some(GridExtent {
        lower: case.grid.lower()[..axes.len()].to_vec(),
        upper: case.grid.upper()[..axes.len()].to_vec(),
        cell: axes.iter().map(GridAxis::longest).collect(),
    });
    let estimate = case.estimate(ranks);
    manifest.sizes = [
        ("points", estimate.points),
        ("cells", estimate.cells),
        ("nodes", estimate.nodes),
    ]
    .map(|(k, v)| (k.into(), v))
    .into();
    manifest.picture_times.clone_from(&case.output.times);
    manifest.choices = case
        .notes
        .iter()
        .map(|note| manifest::ManifestChoice {
            key: note.key.clone(),
            value: note.value.clone(),
            reason: note.reason.clone(),
        })
        .collect();
    manifest.choices.extend(setup::choices(case, ranks, &arguments.petsc));
    manifest.warnings = setup::warnings(case, ranks);
    manifest.versions = machine::library_versions();
    let smooths = case.stabilisation.lowers() || case.stabilisation == Stabilisation::ModifiedFBar;
    manifest.summary.smoothing_passes = smooths.then_some(0.0);
    manifest.checks = case.checks.iter().map(unmade).collect();
    manifest
}

/// A check that has not been made yet.
fn unmade(check: &Check) -> ManifestCheck {
    ManifestCheck {
        quantity: check.quantity.clone(),
        at: Some(check.at),
        value: None,
        min: check.min,
        max: check.max,
        passed: false,
    }
}
