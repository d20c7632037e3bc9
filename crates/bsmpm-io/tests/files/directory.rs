//! Tests the output directory.

use std::fs;
use std::path::Path;

use bsmpm_io::Error;
use bsmpm_io::directory::{ExistingRunPolicy, OutputDirectory};
use bsmpm_io::lock::Unseen;
use bsmpm_io::manifest::{Manifest, ManifestCase};

use crate::listing;

fn manifest(outputs: &[&str]) -> Manifest {
    let mut manifest = Manifest::begin(
        "0.1.0",
        vec![],
        ManifestCase::new("a.toml", "A", "plane-strain", String::new()),
    );
    outputs.iter().for_each(|output| manifest.name_output(output));
    manifest
}

fn claim(path: &Path, existing: ExistingRunPolicy) -> Result<OutputDirectory, Error> {
    OutputDirectory::hold(path, Unseen::Respect).and_then(|held| held.claim(existing, &manifest(&[])))
}

/// A directory with a finished run and a file of the user's.
fn run() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(dir.path().join("frames")).unwrap();
    for file in [
        "history.csv",
        "frames.pvd",
        "frames/step_000000000.vtu",
        "notes.txt",
        "frames/notes.txt",
        "mine.csv",
    ] {
        fs::write(dir.path().join(file), file).unwrap();
    }
    let named = [
        "history.csv",
        "frames.pvd",
        "frames/step_000000000.vtu",
        "frames/step_000000009.vtu",
    ];
    manifest(&named).write(dir.path()).unwrap();
    dir
}

#[test]
fn a_new_directory_is_made_and_claimed_once() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("deep/er.out");
    assert_eq!(claim(&path, ExistingRunPolicy::Refuse).unwrap().path(), path);
    assert_eq!(listing(&path), ["run.json"]);
    let error = claim(&path, ExistingRunPolicy::Refuse).unwrap_err();
    assert!(matches!(&error, Error::Occupied { found, .. } if found == "run.json"));
    assert_eq!(error.exit_code(), 73);
}

#[test]
fn of_many_that_claim_at_once_one_succeeds() {
    let dir = tempfile::tempdir().unwrap();
    let attempts = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8)
            .map(|_| scope.spawn(|| claim(dir.path(), ExistingRunPolicy::Refuse).is_ok()))
            .collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap())
            .filter(|&claimed| claimed)
            .count()
    });
    assert_eq!(attempts, 1);
    Manifest::read(dir.path()).unwrap();
}

#[test]
fn any_file_of_a_run_is_enough_to_refuse() {
    for file in [
        "run.json",
        "history.csv",
        "steps.csv",
        "residuals.csv",
        "frames.pvd",
        "frames/a.vtu",
        "checkpoint/a.h5",
    ] {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, "").unwrap();
        assert!(
            matches!(
                claim(dir.path(), ExistingRunPolicy::Refuse),
                Err(Error::Occupied { .. })
            ),
            "{file}"
        );
        assert!(claim(dir.path(), ExistingRunPolicy::Delete).is_err(), "{file}");
        assert!(path.exists());
    }
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("notes.txt"), "").unwrap();
    claim(dir.path(), ExistingRunPolicy::Refuse).unwrap();
}

#[test]
fn force_deletes_what_is_named_and_nothing_else() {
    let dir = run();
    claim(dir.path(), ExistingRunPolicy::Delete).unwrap();
    assert_eq!(
        listing(dir.path()),
        ["frames/notes.txt", "mine.csv", "notes.txt", "run.json"]
    );
    assert_eq!(Manifest::read(dir.path()).unwrap().outputs, []);
}

#[test]
fn force_stops_at_a_file_of_a_run_that_is_not_named() {
    let dir = run();
    fs::write(dir.path().join("steps.csv"), "").unwrap();
    let before = listing(dir.path());
    assert!(
        matches!(claim(dir.path(), ExistingRunPolicy::Delete), Err(Error::Occupied { found, .. }) if found == "steps.csv")
    );
    assert_eq!(listing(dir.path()), before);
}

#[test]
fn a_hostile_manifest_deletes_nothing() {
    let outside = tempfile::tempdir().unwrap();
    fs::write(outside.path().join("a.csv"), "precious").unwrap();
    let absolute = outside.path().join("a.csv");
    let hostile = [
        absolute.to_str().unwrap(),
        "../a.csv",
        "frames/../../a.csv",
        "./../a.csv",
        "",
        ".",
        "frames",
        "notes.txt",
        "out/a.csv",
        "link.csv",
        "folder.csv",
    ];
    for name in hostile {
        let dir = run();
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(outside.path(), dir.path().join("out")).unwrap();
            std::os::unix::fs::symlink(&absolute, dir.path().join("link.csv")).unwrap();
        }
        fs::create_dir(dir.path().join("folder.csv")).unwrap();
        manifest(&["history.csv", name]).write(dir.path()).unwrap();
        let error = claim(dir.path(), ExistingRunPolicy::Delete).unwrap_err();
        assert!(
            matches!(&error, Error::UnsafeOutput { name: reported, .. } if reported == name),
            "{name}: {error}"
        );
        assert_eq!(error.exit_code(), 73);
        assert!(dir.path().join("history.csv").exists(), "{name}");
        assert!(absolute.exists(), "{name}");
    }
}

#[test]
fn a_path_that_is_a_file_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("file");
    fs::write(&path, "").unwrap();
    assert!(matches!(
        claim(&path, ExistingRunPolicy::Delete),
        Err(Error::NotDirectory { .. })
    ));
    let error = claim(&path.join("below"), ExistingRunPolicy::Refuse).unwrap_err();
    assert!(matches!(&error, Error::Directory { action: "create", .. }), "{error}");
    assert_eq!(error.exit_code(), 73);
}

#[test]
fn a_directory_that_was_only_held_is_as_if_it_had_never_been() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("new.out");
    drop(OutputDirectory::hold(&path, Unseen::Respect).unwrap());
    assert!(!path.exists());
    let held = OutputDirectory::hold(&path, Unseen::Respect).unwrap();
    fs::write(path.join("notes.txt"), "").unwrap();
    drop(held);
    assert_eq!(listing(&path), ["notes.txt"]);
    assert_eq!(
        OutputDirectory::hold(&path, Unseen::Respect).unwrap().run().unwrap(),
        None
    );
}

#[test]
fn a_run_that_goes_on_loses_what_was_written_since_and_nothing_else() {
    let dir = run();
    let held = || OutputDirectory::hold(dir.path(), Unseen::Respect).unwrap();
    assert!(held().run().unwrap().is_some());
    held().go_on(&manifest(&["history.csv", "frames.pvd"])).unwrap();
    assert_eq!(
        listing(dir.path()),
        [
            "frames.pvd",
            "frames/notes.txt",
            "history.csv",
            "mine.csv",
            "notes.txt",
            "run.json"
        ]
    );
    manifest(&["history.csv", "../mine.csv"]).write(dir.path()).unwrap();
    let error = held().go_on(&manifest(&["history.csv"])).unwrap_err();
    assert!(matches!(error, Error::UnsafeOutput { .. }));
    assert!(dir.path().join("mine.csv").exists());
}
