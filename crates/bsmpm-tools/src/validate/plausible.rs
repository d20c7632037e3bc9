//! Tests that no run of the validation matrix causes a warning of implausible input.

use super::matrix::ValidationMatrix;
use bsmpm_messages::code_of;
use bsmpm_scene::{Case, load};
use std::path::Path;

#[test]
fn no_run_of_the_validation_looks_like_a_slip() {
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/validation");
    let matrix = ValidationMatrix::read(&base.join("matrix.toml")).expect("the matrix can be read");
    let mut read = 0;
    let mut found = Vec::new();
    for study in &matrix.study {
        for run in &study.run {
            let path = base.join(run.case.as_ref().unwrap_or(&study.case));
            let bytes = load(&path).expect("the case can be read");
            let name = format!("{}: {}", study.title, run.name);
            let case = Case::from_bytes(&name, &bytes, &[&study.set[..], &run.set].concat());
            let case = case.unwrap_or_else(|errors| panic!("{name}: {errors:?}"));
            let slips = case
                .warnings
                .iter()
                .filter(|text| code_of(text).is_some_and(|code| code.starts_with("W01")));
            found.extend(slips.map(|slip| format!("{name}: {slip}")));
            read += 1;
        }
    }
    assert!(read > 100, "{read} runs");
    assert!(found.is_empty(), "{}", found.join("\n"));
}
