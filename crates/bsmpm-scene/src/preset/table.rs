//! Table of the presets for the reference of keys.

use super::{GRADED_POINTS, METHOD, ORDER, Preset};
use crate::constants::NEARLY_INCOMPRESSIBLE;
use crate::words::{Accuracy, Word};

/// A row of the table: a number that each preset has.
struct Row {
    symbol: &'static str,
    meaning: &'static str,
    value: fn(&Preset) -> String,
}

/// The rows, with the symbols of chapter 11 of the theory manual.
const ROWS: [Row; 11] = [
    Row {
        symbol: "$n_0$",
        meaning: "cells across the shorter side of the rectangle around all bodies",
        value: |preset| preset.across.to_string(),
    },
    Row {
        symbol: "$n_B$",
        meaning: "cells across a footing, loaded segment or rigid body",
        value: |preset| preset.along.to_string(),
    },
    Row {
        symbol: "$r$",
        meaning: "distance to which fine cells extend beyond a footing, loaded segment, rigid body or opening, divided \
                  by its width",
        value: |preset| preset.reach.to_string(),
    },
    Row {
        symbol: "$n_o$",
        meaning: "cells across a hole or notch",
        value: |preset| preset.opening.to_string(),
    },
    Row {
        symbol: "$n_k$",
        meaning: "basic cell size, divided by the cell size at a steep re-entrant corner",
        value: |preset| preset.corner.to_string(),
    },
    Row {
        symbol: "$\\rho$",
        meaning: "largest ratio of the sizes of neighbouring cells",
        value: |preset| preset.growth.to_string(),
    },
    Row {
        symbol: "$n_p$",
        meaning: "material points along each axis of a cell",
        value: |preset| preset.points.to_string(),
    },
    Row {
        symbol: "$n_c$",
        meaning: "cells that a shear wave crosses in a step (dynamics)",
        value: |preset| preset.crossed.to_string(),
    },
    Row {
        symbol: "$a$",
        meaning: "displacement of a moving face of the grid in a step, in cells (quasi-static)",
        value: |preset| preset.advance.to_string(),
    },
    Row {
        symbol: "$n_\\text{min}$",
        meaning: "smallest number of steps (quasi-static)",
        value: |preset| preset.steps.to_string(),
    },
    Row {
        symbol: "-",
        meaning: "`solver.tolerance`; `solver.force_tolerance`",
        value: |preset| preset.tolerances.join("; "),
    },
];

/// What the presets choose: an introduction, then a table in Markdown.
pub(crate) fn preset_table() -> [String; 2] {
    let presets = [Accuracy::Draft, Accuracy::Standard, Accuracy::Reference];
    let words = presets.map(Word::word);
    let introduction = format!(
        "The program derives the keys that the case does not give from these numbers. All presets use {} splines, and \
         at least {GRADED_POINTS} material points along each axis of a cell if the grid is graded. They use `{}` if a \
         material is plastic, or if its Poisson's ratio exceeds {NEARLY_INCOMPRESSIBLE}. [Chapter 11](../theory/discretisation.md#presets) \
         describes how cells and steps follow from the numbers.",
        ORDER.word(),
        METHOD.word(),
    );
    let mut table = format!(
        "| symbol | meaning | {} |\n| --- | --- | --- | --- | --- |",
        words.join(" | ")
    );
    for row in ROWS {
        let values = presets.map(|accuracy| (row.value)(&Preset::of(accuracy)));
        table += &format!("\n| {} | {} | {} |", row.symbol, row.meaning, values.join(" | "));
    }
    [introduction, table]
}
