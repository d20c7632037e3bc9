//! The command line of `bsmpm`.

use std::io::Write;
use std::path::{Path, PathBuf};

use bsmpm_messages::headed;
use clap::{Parser, Subcommand};

use crate::{
    Error, compare, element, estimate, explain, fos, keys, limit_load, plot, slurm, sweep, validate, verify_case,
};

/// Starts runs of bsmpm-par, and evaluates their results.
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
    Plot(plot::PlotArguments),
    /// Draw one quantity of several runs in one picture, or print it as a table
    Compare(Box<compare::CompareArguments>),
    /// Run the cases of a matrix and compare their histories with reference values
    Validate(validate::ValidateArguments),
    /// Find the factor of safety of a case by strength reduction
    Fos(fos::FosArguments),
    /// Find the ultimate load of a footing or another prescribed motion on two to four grids, and extrapolate it
    LimitLoad(Box<limit_load::LimitLoadArguments>),
    /// Vary settings of a case, and compare the errors and the costs of the results
    Sweep(Box<sweep::SweepArguments>),
    /// Run a case on three grids: observed order, extrapolated values, grid convergence index
    VerifyCase(verify_case::VerifyArguments),
    /// Tell what a case will cost before it is run: time, memory, disk
    Estimate(Box<estimate::EstimateArguments>),
    /// Compute laboratory tests (one material point) of the materials of a case
    Element(element::ElementArguments),
    /// Write a job script for Slurm that resubmits itself until the case is done
    Slurm(slurm::SlurmArguments),
    /// Explain messages by their codes: what each means, why it matters, what to do
    Explain(explain::ExplainArguments),
    /// Print every key of a case file with its unit, range and default, and every quantity of a history
    Keys(keys::KeysArguments),
}

/// Carries out a command and prints what it made: tables, and pictures with one path a line.
///
/// # Errors
/// Those of the command; [`Error::exit_code`] is the program's.
pub fn run(cli: &Cli) -> Result<(), Error> {
    // Where nobody listens there is nothing left to do.
    let say = |line: &str| _ = writeln!(std::io::stderr(), "{line}");
    match &cli.command {
        Command::Plot(arguments) => print("", &plot::run(arguments)?),
        Command::Compare(arguments) => {
            let made = compare::run(arguments)?;
            made.notes.iter().for_each(|note| say(&format!("bsmpm: {note}")));
            print(&made.table.unwrap_or_default(), made.picture.as_slice());
        }
        Command::Validate(arguments) => {
            let counts = validate::run(arguments, |part| print(&format!("{part}\n"), &[]))?;
            let known = match counts.known {
                0 => String::new(),
                rows => format!("{rows} row(s) fail as the matrix expects\n"),
            };
            print(
                &format!("\n{known}{} passed, {} failed\n", counts.passed, counts.failed),
                &[],
            );
            if counts.failed > 0 {
                return Err(Error::NotValid { failed: counts.failed });
            }
        }
        Command::Fos(arguments) => {
            let (table, pictures) = fos::run(arguments, say)?;
            print(&table, &pictures);
        }
        Command::LimitLoad(arguments) => {
            let found = limit_load::run(arguments, say)?;
            print(&found.text, &found.files);
            if !found.is_reached {
                return Err(Error::NoLimitLoad);
            }
        }
        Command::Sweep(arguments) => {
            let (table, files) = sweep::run(arguments, say)?;
            print(&table, &files);
        }
        Command::VerifyCase(arguments) => {
            let (table, files) = verify_case::run(arguments, say)?;
            print(&table, &files);
        }
        Command::Estimate(arguments) => print(&estimate::run(arguments, say)?, &[]),
        Command::Element(arguments) => {
            let (table, files) = element::run(arguments, say)?;
            print(&table, &files);
        }
        Command::Explain(arguments) => print(&explain::run(arguments)?, &[]),
        Command::Keys(arguments) => print(&keys::run(arguments), &[]),
        Command::Slurm(arguments) => {
            let script = slurm::run(arguments, |line| say(&headed(line, "warning")))?;
            // Half a script must not pass for one.
            let failed = bsmpm_io::Error::file("write", Path::new("the standard output"));
            let mut stdout = std::io::stdout();
            stdout
                .write_all(&script.unwrap_or_default())
                .and_then(|()| stdout.flush())
                .map_err(failed)?;
        }
    }
    Ok(())
}

/// A table, and files with one path a line.
fn print(table: &str, files: &[PathBuf]) {
    let mut stdout = std::io::stdout();
    // Where nobody listens there is nothing left to do.
    let _ = write!(stdout, "{table}");
    for file in files {
        let _ = writeln!(stdout, "{}", file.display());
    }
}

#[cfg(test)]
mod tests {
    use bsmpm_io::exit::{ALL, CASE, DONE, MISSING, NO_CONVERGENCE, USAGE, WRITE};
    use clap::CommandFactory;

    /// What the help says of some codes.
    const WORDS: [(&str, u8); 10] = [
        ("command line", USAGE),
        ("has errors", CASE),
        ("no such case", MISSING),
        ("does not start", WRITE),
        ("could not be written", WRITE),
        ("no stable state", NO_CONVERGENCE),
        ("no limit was reached", NO_CONVERGENCE),
        ("no run was completed", NO_CONVERGENCE),
        ("done, whatever", DONE),
        ("estimated", DONE),
    ];

    #[test]
    fn the_help_names_the_codes_of_the_list() {
        let mut seen = 0;
        for mut command in super::Cli::command().get_subcommands().cloned() {
            let help = command.render_long_help().to_string();
            let Some((_, rest)) = help.split_once("Exit codes: ") else {
                continue;
            };
            let report = rest
                .split("\n\n")
                .next()
                .unwrap_or_default()
                .split_whitespace()
                .collect::<Vec<_>>()
                .join(" ");
            for part in report.split("; ") {
                let numbers = part
                    .split(|c: char| !c.is_ascii_digit())
                    .filter_map(|word| word.parse::<u8>().ok());
                assert!(numbers.clone().all(|code| ALL.contains(&code)), "{part}");
                let is_reported = WORDS.iter().filter(|(words, _)| part.contains(words));
                is_reported
                    .for_each(|(words, code)| assert_eq!(numbers.clone().next(), Some(*code), "{words}: {part}"));
            }
            seen += 1;
        }
        assert_eq!(seen, 9);
    }
}
