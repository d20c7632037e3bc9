//! Tests that invalid cases are refused: one file for each table of the case file.

pub mod analysis;
pub mod bodies;
pub mod boundary;
pub mod element;
pub mod file;
pub mod grid;
pub mod histories;
pub mod materials;
pub mod output;
pub mod quasi_static;
pub mod solver;

use super::Row;

/// Names, types and units (rows I01 to I04, I07).
pub fn language() -> Vec<Row> {
    [
        file::LANGUAGE,
        grid::LANGUAGE,
        materials::LANGUAGE,
        bodies::LANGUAGE,
        boundary::LANGUAGE,
        analysis::LANGUAGE,
        solver::LANGUAGE,
        output::LANGUAGE,
        histories::LANGUAGE,
    ]
    .concat()
}

/// Numbers out of range (I07 to I10, I15, I18, I25).
pub fn ranges() -> Vec<Row> {
    [
        grid::RANGES,
        materials::RANGES,
        bodies::RANGES,
        analysis::RANGES,
        solver::RANGES,
        output::RANGES,
        histories::RANGES,
    ]
    .concat()
}

/// Rules between keys (I11 to I18, I20, I26).
pub fn rules() -> Vec<Row> {
    [
        grid::RULES,
        materials::RULES,
        bodies::RULES,
        analysis::RULES,
        solver::RULES,
        output::RULES,
        histories::RULES,
    ]
    .concat()
}
