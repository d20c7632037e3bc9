//! Table of the presets for the reference of keys.

use super::{GRADED_POINTS, METHOD, ORDER, Preset};
use crate::constants::NEARLY_INCOMPRESSIBLE;
use crate::words::{Accuracy, Word};

/// Symbol, as in chapter 11 of the theory manual, and meaning of each number that a preset has.
const NUMBERS: [[&str; 2]; 11] = [
    [
        "$n_0$",
        "cells across the shorter side of the rectangle around all bodies",
    ],
    ["$n_B$", "cells across a footing, loaded segment or rigid body"],
    [
        "$r$",
        "distance to which fine cells extend beyond a footing, loaded segment, rigid body or opening, divided by its \
         width",
    ],
    ["$n_o$", "cells across a hole or notch"],
    [
        "$n_k$",
        "basic cell size, divided by the cell size at a steep re-entrant corner",
    ],
    ["$\\rho$", "largest ratio of the sizes of neighbouring cells"],
    ["$n_p$", "material points along each axis of a cell"],
    ["$n_c$", "cells that a shear wave crosses in a step (dynamics)"],
    [
        "$a$",
        "displacement of a moving face of the grid in a step, in cells (quasi-static)",
    ],
    ["$n_\\text{min}$", "smallest number of steps (quasi-static)"],
    ["-", "`solver.tolerance`; `solver.force_tolerance`"],
];

/// The numbers of a preset in the order of [`NUMBERS`].
fn values(preset: &Preset) -> [String; NUMBERS.len()] {
    [
        preset.across.to_string(),
        preset.along.to_string(),
        preset.reach.to_string(),
        preset.opening.to_string(),
        preset.corner.to_string(),
        preset.growth.to_string(),
        preset.points.to_string(),
        preset.crossed.to_string(),
        preset.advance.to_string(),
        preset.steps.to_string(),
        preset.tolerances.join("; "),
    ]
}

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
    let numbers = presets.map(|accuracy| values(&Preset::of(accuracy)));
    for (row, [symbol, meaning]) in NUMBERS.into_iter().enumerate() {
        let values = numbers.each_ref().map(|of_preset| of_preset[row].as_str());
        table += &format!("\n| {symbol} | {meaning} | {} |", values.join(" | "));
    }
    [introduction, table]
}
