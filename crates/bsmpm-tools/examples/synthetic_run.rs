//! Writes runs that never were, to look at the pictures that `bsmpm plot` makes of them:
//! `cargo run --example synthetic_run DIRECTORY` makes `DIRECTORY/long`, `tall`, `wide` and `coarse`.

#[path = "../tests/plot/collapse.rs"]
mod collapse;

use std::path::PathBuf;

use collapse::Collapse;

fn main() -> Result<(), bsmpm_io::Error> {
    let directory = PathBuf::from(std::env::args_os().nth(1).unwrap_or_else(|| "synthetic.out".into()));
    let long = Collapse { body: [0.2, 0.1], grid: [0.55, 0.1025], cell: 2.5e-3, points: [480, 240] };
    long.write(&directory.join("long"), &[0.12, 0.24, 0.6], true)?;
    let tall = Collapse { body: [2.0, 10.0], grid: [5.0, 12.0], cell: 0.25, points: [100, 500] };
    tall.write(&directory.join("tall"), &[], true)?;
    let wide = Collapse { body: [40.0, 4.0], grid: [200.0, 5.0], cell: 0.5, points: [400, 40] };
    wide.write(&directory.join("wide"), &[], false)?;
    let coarse = Collapse { body: [5.0, 5.0], grid: [10.0, 8.0], cell: 1.0, points: [20, 20] };
    coarse.write(&directory.join("coarse"), &[], false)
}
