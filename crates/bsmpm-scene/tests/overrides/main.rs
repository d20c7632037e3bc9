//! Tests `--set KEY=VALUE`, and values of valid cases.

mod assignments;
mod defaults;
mod full_case;
mod loads;
mod materials;
mod motion;
mod retired;
mod rigid;
mod softening;
mod strips;
mod warnings;
mod water;

use bsmpm_scene::{Case, Error};

const FULL: &str = include_str!("../full.toml");
const STATIC: &str = include_str!("../bad_cases/static.toml");
const ROUND: &str = include_str!("../bad_cases/round.toml");
const SEEPING: &str = include_str!("../bad_cases/seeping.toml");

fn set(text: &str, overrides: &[&str]) -> Result<Case, Vec<Error>> {
    Case::from_text(
        "case.toml",
        text,
        &overrides.iter().map(ToString::to_string).collect::<Vec<_>>(),
    )
}

fn valid(text: &str, overrides: &[&str]) -> Case {
    set(text, overrides).unwrap_or_else(|errors| panic!("{overrides:?}: {errors:#?}"))
}

/// What is warned of but for what the base itself is: rigid bodies of the full one are thinner than two of its cells.
fn doubts(text: &str, overrides: &[&str]) -> Vec<String> {
    let base = valid(text, &[]).warnings;
    valid(text, overrides)
        .warnings
        .into_iter()
        .filter(|warning| !base.contains(warning))
        .collect()
}
