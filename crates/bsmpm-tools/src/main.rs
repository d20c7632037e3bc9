//! The companion program `bsmpm`; what it does is in the library of the same crate.
#![forbid(unsafe_code)]

use std::io::Write;
use std::process::ExitCode;

use bsmpm_tools::cli::{Cli, run};
use clap::Parser;

fn main() -> ExitCode {
    match run(&Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "bsmpm: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
