//! The program `bsmpm`.
#![forbid(unsafe_code)]

use std::io::Write;
use std::process::ExitCode;

use bsmpm_messages::headed;
use bsmpm_tools::Error;
use bsmpm_tools::cli::{Cli, run};
use clap::Parser;

fn main() -> ExitCode {
    match run(&Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let line = match error {
                // The last line of a validation is its counts, for those who read them there.
                Error::NotValid { .. } => String::new(),
                // Errors of a case begin with their places.
                Error::BadCase { .. } => format!("{error}\n"),
                _ => format!("bsmpm: {}\n", headed(&error.to_string(), "error")),
            };
            let _ = write!(std::io::stderr(), "{line}");
            ExitCode::from(error.exit_code())
        }
    }
}
