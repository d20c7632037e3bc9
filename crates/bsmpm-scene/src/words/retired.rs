//! Accepted words that no longer have an effect.

use super::{RemovedWord, Words};

/// Words of `[solver] background_kind`: the background resists strain.
pub(crate) const BACKGROUND_KIND: Words = Words {
    auto: None,
    words: &[("strain", "resists strain"), ("laplacian", "earlier name of strain")],
    later: &[],
    misnomers: &[],
    earlier: &[],
    removed: &[
        replaced_by_extension("ghost-penalty"),
        replaced_by_extension("curvature"),
    ],
};

/// Words of `[solver] background_cells`: all occupied cells have the background.
pub(crate) const BACKGROUND_CELLS: Words = Words {
    auto: None,
    words: &[("occupied", "all cells that hold points")],
    later: &[],
    misnomers: &[],
    earlier: &[],
    removed: &[replaced_by_extension("partly-filled")],
};

/// The last version with the options that were removed after it.
const LAST: &str = "bsmpm 0.1.0, commit 7816fb16";

/// The table of `[solver] linear`, which gave the linear solver by PETSc's names.
pub(super) const PETSC_NAMES: RemovedWord = RemovedWord {
    word: "{ ksp, pc, factor }",
    last: LAST,
    remedy: "Use a word, such as linear = \"direct\". PETSc options follow `--` on the command line.",
};

/// The F-bar method of Zhao, Jiang and Choo (2022), which creates energy.
pub(super) const F_BAR_ZHAO: RemovedWord = RemovedWord {
    word: "f-bar-zhao",
    last: LAST,
    remedy: "Use \"consistent-f-bar\", or \"f-bar\", which averages the volume changes of each step.",
};

/// A form of the background that extended B-splines replace.
const fn replaced_by_extension(word: &'static str) -> RemovedWord {
    RemovedWord {
        word,
        last: "bsmpm 0.1.0, commit c1b20825",
        remedy: "Delete the key: solver.extension = \"linear\", the default in quasi-static analysis, replaces it.",
    }
}
