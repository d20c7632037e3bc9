//! The solver program: `mpirun -n 2 bsmpm-par case.toml`.

use bsmpm_par::{launch, program};
use std::process::ExitCode;

fn main() -> ExitCode {
    match launch::start() {
        Ok(universe) => {
            let code = program::run(&universe);
            drop(universe);
            ExitCode::from(code)
        }
        Err(code) => ExitCode::from(code),
    }
}
