//! Tests that the table of features in the repository's README agrees with the case reader. `BSMPM_RENEW=1` writes the
//! table again.

mod features {
    pub mod rows;
}

use bsmpm_scene::Case;
use bsmpm_tools::fos;
use features::rows::{BLOCK_IN_PLANE, BLOCK_IN_SPACE, Feature, MOHR_COULOMB, PORES, ROWS, WATER};
use std::fs;
use std::path::{Path, PathBuf};

/// Geometries and analyses that a feature is tried in.
const GEOMETRIES: [&str; 3] = ["plane-strain", "axisymmetric", "3d"];
const ANALYSES: [&str; 3] = ["quasi-static", "dynamic", "consolidation"];

const BEGIN: &str = "<!-- features: renewed by `BSMPM_RENEW=1 cargo test -p bsmpm-tools --test features` -->\n";
const END: &str = "<!-- end of features -->\n";

/// What the reader says of a feature, the best last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Verdict {
    No,
    Warning,
    Yes,
}

impl Verdict {
    fn word(self) -> &'static str {
        match self {
            Self::No => "no",
            Self::Warning => "with a warning",
            Self::Yes => "yes",
        }
    }
}

/// A block of soil in the lower part of the grid with a feature.
fn case_text(feature: &Feature, geometry: &str, analysis: &str) -> String {
    let block = if geometry == "3d" {
        BLOCK_IN_SPACE
    } else {
        BLOCK_IN_PLANE
    };
    let extra = if geometry == "3d" {
        feature.extra_in_space.unwrap_or(feature.extra)
    } else {
        feature.extra
    };
    let fit = if geometry == "plane-strain" {
        "plane-strain"
    } else {
        "outer"
    };
    let middle = if geometry == "axisymmetric" { "0.0" } else { "4.0" };
    let [time, soil, tables] = match analysis {
        "quasi-static" => ["steps = 10", "", ""],
        "dynamic" => ["end = 1.0\ndt = 0.01", "", ""],
        _ if !feature.soil.is_empty() => ["end = \"10 d\"\ndt = \"1 d\"", "", feature.extra_with_flow],
        _ if extra.contains("[water]") => ["end = \"10 d\"\ndt = \"1 d\"", PORES, feature.extra_with_flow],
        _ => ["end = \"10 d\"\ndt = \"1 d\"", PORES, WATER],
    };
    block
        .replace("{GEOMETRY}", geometry)
        .replace("{TOP}", feature.top)
        .replace(
            "{ANALYSIS}",
            &format!("type = \"{analysis}\"\n{time}\n{}", feature.analysis_keys),
        )
        .replace("{BOTTOM}", feature.bottom.unwrap_or("fixed"))
        .replace("{RIGHT}", feature.right.unwrap_or("roller"))
        .replace("{LAW}", feature.law.unwrap_or(MOHR_COULOMB))
        .replace("{SOIL}", &format!("{soil}{}", feature.soil))
        .replace("{TABLES}", &format!("{extra}{tables}"))
        .replace("{FIT}", fit)
        .replace("{X}", middle)
}

/// What the reader says of a case, and the texts that it says it with.
fn judge(feature: &Feature, geometry: &str, analysis: &str) -> (Verdict, String) {
    let text = case_text(feature, geometry, analysis);
    let case = match Case::from_text("case.toml", &text, &[]) {
        Ok(case) => case,
        Err(errors) => return (Verdict::No, errors.iter().map(|error| format!("{error}\n")).collect()),
    };
    let refusals = if feature.is_factor_of_safety {
        fos::refusals(&case, None)
    } else {
        Vec::new()
    };
    if !refusals.is_empty() {
        return (Verdict::No, refusals.join("\n"));
    }
    // Of the feature, not of the block that every row has.
    let general =
        Case::from_text("case.toml", &case_text(&Feature::NONE, geometry, analysis), &[]).map(|case| case.warnings);
    let general = general.unwrap_or_default();
    let own: Vec<String> = case
        .warnings
        .into_iter()
        .filter(|warning| !general.contains(warning))
        .collect();
    if own.is_empty() {
        (Verdict::Yes, String::new())
    } else {
        (Verdict::Warning, own.join("\n"))
    }
}

/// The row of a feature: the geometries in any analysis, then dynamic and consolidation in any geometry.
fn row(feature: &Feature) -> String {
    let best_of = |pairs: Vec<(&str, &str)>| {
        let verdicts = pairs
            .into_iter()
            .map(|(geometry, analysis)| judge(feature, geometry, analysis).0);
        verdicts.max().unwrap_or(Verdict::No).word()
    };
    let of_geometry = |geometry| best_of(ANALYSES.map(|analysis| (geometry, analysis)).to_vec());
    let of_analysis = |analysis| best_of(GEOMETRIES.map(|geometry| (geometry, analysis)).to_vec());
    let geometries = GEOMETRIES.map(of_geometry).join(" | ");
    format!(
        "| {} | {geometries} | {} | {} |\n",
        feature.name,
        of_analysis("dynamic"),
        of_analysis("consolidation")
    )
}

fn table() -> String {
    let heading = "| feature | plane strain | axisymmetric | 3-D | dynamic | consolidation |\n| --- | --- | --- | --- | --- | --- |\n";
    heading.to_owned() + &ROWS.iter().map(row).collect::<String>()
}

fn readme() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md")
}

#[test]
fn the_table_in_the_readme_is_what_the_reader_says() {
    let text = fs::read_to_string(readme()).unwrap();
    let (before, rest) = text.split_once(BEGIN).expect("the README has the table");
    let (old, after) = rest.split_once(END).expect("the table has an end");
    let new = format!("\n{}\n", table());
    if std::env::var_os("BSMPM_RENEW").is_some() {
        fs::write(readme(), format!("{before}{BEGIN}{new}{END}{after}")).unwrap();
        return;
    }
    assert!(
        old == new,
        "the table of features has changed, renew it as its comment says:\n{new}"
    );
}

/// Without this a slip in a row would read as a feature that is not available.
#[test]
fn every_feature_is_available_somewhere_and_refused_by_its_own_message() {
    for feature in ROWS {
        let mut accepted = 0;
        for geometry in GEOMETRIES {
            for analysis in ANALYSES {
                let (verdict, said) = judge(feature, geometry, analysis);
                accepted += usize::from(verdict != Verdict::No);
                // Codes of keys and values that are not understood.
                let slips = ["E0005", "E0010", "E0011", "E0013", "E0014"];
                let slip = slips.iter().find(|code| said.contains(*code));
                assert!(slip.is_none(), "{} in {geometry}, {analysis}: {said}", feature.name);
                if verdict != Verdict::Yes && std::env::var_os("BSMPM_SHOW").is_some() {
                    eprintln!("{} in {geometry}, {analysis}: {said}", feature.name);
                }
            }
        }
        assert!(accepted > 0, "{} is refused everywhere", feature.name);
    }
}
