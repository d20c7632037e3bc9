//! Fuzz targets: functions that pass arbitrary bytes to one part of the program. No input may cause a panic or a number
//! that is not finite.
//!
//! `tests/replay/main.rs` executes all targets on stored inputs (corpora). `scripts/fuzz` searches for new inputs with
//! libFuzzer.
#![forbid(unsafe_code)]
// As in `bsmpm`: N, dN and F are what the paper calls so.
#![allow(non_snake_case)]

mod alone;
mod case;
mod draw;
mod manifest;
mod material;
mod record;
mod spline;
mod step;
mod table;

/// A direct solver for one rank; the physics' tests have other doubles there.
#[allow(dead_code)]
#[path = "../../bsmpm/tests/support/solver.rs"]
mod solver;

/// What is fuzzed, by its name.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name, and that of its corpus.
    pub name: &'static str,
    /// Panics where a promise is broken.
    pub run: fn(&[u8]),
}

/// All targets.
pub const TARGETS: [Target; 7] = [
    Target {
        name: "case",
        run: case::target,
    },
    Target {
        name: "record",
        run: record::target,
    },
    Target {
        name: "manifest",
        run: manifest::target,
    },
    Target {
        name: "table",
        run: table::target,
    },
    Target {
        name: "step",
        run: step::target,
    },
    Target {
        name: "material",
        run: material::target,
    },
    Target {
        name: "spline",
        run: spline::target,
    },
];

/// The target of that name.
pub fn named(name: &str) -> Option<Target> {
    TARGETS.into_iter().find(|target| target.name == name)
}
