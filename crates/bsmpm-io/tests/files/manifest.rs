//! Tests the manifest.

use bsmpm_io::Error;
use bsmpm_io::manifest::{
    GridExtent, Indicator, Manifest, ManifestCase, ManifestCheck, ManifestChoice, ManifestFailure, Status, Worst,
};

use crate::listing;

fn manifest() -> Manifest {
    let case = ManifestCase::new(
        "slope.toml",
        "A slope",
        "plane-strain",
        "title = \"A slope\"\n".to_owned(),
    );
    let mut manifest = Manifest::begin("0.1.0", vec!["bsmpm-par".into(), "slope.toml".into()], case);
    manifest.versions.insert("petsc".into(), "3.18.5".into());
    manifest.sizes.insert("points".into(), 115_200);
    manifest.timers.insert("residual".into(), 0.1 + 0.2);
    manifest.picture_times = vec![0.109, 0.235];
    manifest.grid = Some(GridExtent {
        lower: vec![0.0, 0.0],
        upper: vec![0.55, 0.1025],
        cell: vec![2.5e-3; 2],
    });
    manifest.choices.push(ManifestChoice {
        key: "grid.upper".into(),
        value: "[0.55]".into(),
        reason: "whole cells".into(),
    });
    manifest.warnings.push("friction \"21.9\" deg".into());
    manifest.checks.push(ManifestCheck {
        quantity: "runout".into(),
        at: Some(0.607),
        value: None,
        min: Some(0.4),
        max: None,
        passed: false,
    });
    manifest.indicators.insert(
        "slip".into(),
        Indicator::new(0.02, "-", "slip over motion", [0.0, 0.01]),
    );
    let worst = Worst {
        kind: "node".into(),
        id: 7,
        position: vec![0.5, 0.25],
        force: Some(2.0),
    };
    let residuals = vec![Some(1.0), None];
    let reason = "no convergence".to_owned();
    manifest.failure = Some(ManifestFailure {
        step: 3,
        time: 0.1,
        reason,
        residuals,
        worst: Some(worst),
        loose: None,
    });
    manifest
}

#[test]
fn a_manifest_reads_back_as_it_was() {
    let dir = tempfile::tempdir().unwrap();
    let mut written = manifest();
    written.write(dir.path()).unwrap();
    assert_eq!(Manifest::read(dir.path()).unwrap(), written);
    std::fs::write(dir.path().join("history.csv"), "abc").unwrap();
    written.name_output("history.csv");
    written.name_output("steps.csv");
    written.name_output("history.csv");
    written.finish(Status::Finished, 0);
    written.seal(dir.path()).unwrap();
    written.write(dir.path()).unwrap();
    let read = Manifest::read(dir.path()).unwrap();
    assert_eq!(read, written);
    assert_eq!(read.outputs.len(), 2);
    // The published test vector of BLAKE3 for "abc".
    let abc = "6437b3ac38465133ffb63b75273a8db548c558465d79db03fd359c6cd5bd9d85";
    assert_eq!(
        (read.outputs[0].bytes, read.outputs[0].blake3.as_deref()),
        (Some(3), Some(abc))
    );
    assert_eq!((read.outputs[1].bytes, read.exit_code), (None, Some(0)));
    assert_eq!(listing(dir.path()), ["history.csv", "run.json"]);
}

#[test]
fn a_number_that_is_not_finite_keeps_the_old_manifest() {
    let dir = tempfile::tempdir().unwrap();
    manifest().write(dir.path()).unwrap();
    let spoil: [fn(&mut Manifest); 6] = [
        |m| m.picture_times[1] = f64::NAN,
        |m| *m.timers.get_mut("residual").unwrap() = f64::INFINITY,
        |m| m.checks[0].value = Some(f64::NAN),
        |m| m.summary.cpu_seconds = f64::NAN,
        |m| m.failure.as_mut().unwrap().time = f64::NAN,
        |m| m.grid.as_mut().unwrap().cell[0] = f64::NAN,
    ];
    for change in spoil {
        let mut bad = manifest();
        change(&mut bad);
        assert!(matches!(bad.write(dir.path()), Err(Error::NotFinite { .. })));
    }
    assert_eq!(Manifest::read(dir.path()).unwrap().picture_times, [0.109, 0.235]);
    assert_eq!(listing(dir.path()), ["run.json"]);
}

#[test]
fn what_is_no_manifest_of_this_form_is_reported() {
    let dir = tempfile::tempdir().unwrap();
    assert!(matches!(
        Manifest::read(dir.path()),
        Err(Error::File { action: "read", .. })
    ));
    let deep = "[".repeat(100_000);
    for text in ["", "{}", "[1]", "{\"schema\": 1}", "{\"schema\": 2}", deep.as_str()] {
        std::fs::write(dir.path().join("run.json"), text).unwrap();
        assert!(matches!(Manifest::read(dir.path()), Err(Error::Format { .. })));
    }
}
