//! Writes output directories without a solver, to test `bsmpm plot`: `cargo run --example synthetic_run DIRECTORY`.

#[path = "../tests/plot/collapse.rs"]
mod collapse;
#[path = "../tests/plot/still.rs"]
mod still;

use std::path::PathBuf;

use collapse::Collapse;
use still::{Scene, Still};

fn main() -> Result<(), bsmpm_io::Error> {
    let directory = PathBuf::from(std::env::args_os().nth(1).unwrap_or_else(|| "synthetic.out".into()));
    let long = Collapse {
        body: [0.2, 0.1],
        grid: [0.55, 0.1025],
        cell: 2.5e-3,
        points: [480, 240],
    };
    long.write(&directory.join("long"), &[0.12, 0.24, 0.6], true)?;
    let tall = Collapse {
        body: [2.0, 10.0],
        grid: [5.0, 12.0],
        cell: 0.25,
        points: [100, 500],
    };
    tall.write(&directory.join("tall"), &[], true)?;
    let wide = Collapse {
        body: [40.0, 4.0],
        grid: [200.0, 5.0],
        cell: 0.5,
        points: [400, 40],
    };
    wide.write(&directory.join("wide"), &[], false)?;
    let coarse = Collapse {
        body: [5.0, 5.0],
        grid: [10.0, 8.0],
        cell: 1.0,
        points: [20, 20],
    };
    coarse.write(&directory.join("coarse"), &[], false)?;
    let slope = Still {
        scene: Scene::Slope,
        method: "modified-f-bar",
        softness: 1.0,
        spacing: 1.0 / 6.0,
        steps: 40,
    };
    slope.write(&directory.join("slope"), &[0.5, 1.0])?;
    let footing = Still {
        scene: Scene::Footing,
        spacing: 0.05,
        ..slope
    };
    footing.write(&directory.join("footing"), &[0.5, 1.0])?;
    let locked = Still {
        method: "none",
        softness: 0.6,
        spacing: 0.25,
        steps: 27,
        ..footing
    };
    locked.write(&directory.join("footing-locked"), &[])?;
    let coarse = Still {
        scene: Scene::Slope,
        spacing: 0.5,
        softness: 0.0,
        ..locked
    };
    coarse.write(&directory.join("slope-coarse"), &[0.5])
}
