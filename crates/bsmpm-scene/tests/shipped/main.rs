//! Tests that the cases in `cases/` are valid.

mod memory;
mod paper;
mod solids;

use bsmpm_scene::{Case, load};
use std::path::{Path, PathBuf};

fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases")
}

fn read(path: &Path) -> Case {
    let bytes = load(path).unwrap();
    let errors = |errors: Vec<bsmpm_scene::Error>| errors.iter().map(|e| format!("{e:#}\n")).collect::<String>();
    Case::from_bytes(&path.display().to_string(), &bytes, &[])
        .map_err(errors)
        .unwrap_or_else(|text| panic!("{text}"))
}

#[test]
fn every_shipped_case_is_valid() {
    let mut folders = vec![cases()];
    let mut found = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "toml") && !path.ends_with("matrix.toml") {
                let case = read(&path);
                // The ground of the faults does without C0 lines on purpose, and is reported; so is the study of
                // densities. Where water flows there are none at the ends of loads, nor below fill. What a column that
                // is let go holds of its own water's weight, its first step has at once. Clay of which a level is drawn
                // down stays full.
                let on_purpose = |warning: &String| {
                    let without = [
                        "mini_footing",
                        "embankment_consolidation",
                        "embankment_lifts",
                        "undrained_strip",
                    ]
                    .map(Some);
                    let line = "undrained_footing.toml"; // the study of friction beside one
                    without.contains(&path.file_stem().and_then(|stem| stem.to_str()))
                        && (warning.starts_with("W0216") || warning.starts_with("W0217"))
                        || path.ends_with("two_densities.toml") && warning.starts_with("W0221") && warning.contains("factor of 2.")
                        || path.ends_with(line) && warning.starts_with("W0218")
                        || path.ends_with("lid_square.toml") && warning.starts_with("W0408") // its shear
                        || ["rapid_drawdown.toml", "saturated_slide.toml"].iter().any(|name| path.ends_with(name))
                            && warning.starts_with("W0553")
                        || path.ends_with("saturated_collapse.toml") && warning.starts_with("W0551")
                };
                let is_slip = |warning: &String| warning.starts_with("W01");
                assert!(
                    !case.warnings.iter().any(is_slip),
                    "{}: {:?}",
                    path.display(),
                    case.warnings
                );
                assert!(
                    case.warnings.iter().all(on_purpose),
                    "{}: {:?}",
                    path.display(),
                    case.warnings
                );
                found += 1;
            }
        }
    }
    assert!(found >= 15);
}
