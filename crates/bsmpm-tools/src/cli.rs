//! The command line of `bsmpm`.

use std::io::Write;

use clap::{Parser, Subcommand};

use crate::{Error, plot};

/// Looks at what a run of bsmpm-par left.
#[derive(Debug, Parser)]
#[command(name = "bsmpm", version)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw the pictures of a run into its directory.
    Plot(plot::Arguments),
}

/// Carries out a command and prints what it made, one path a line.
///
/// # Errors
/// Those of the command; [`Error::exit_code`] is the program's.
pub fn run(cli: &Cli) -> Result<(), Error> {
    match &cli.command {
        Command::Plot(arguments) => {
            for picture in plot::run(arguments)? {
                // Where nobody listens there is nothing left to do.
                let _ = writeln!(std::io::stdout(), "{}", picture.display());
            }
        }
    }
    Ok(())
}
