//! Prepares a run from the command line. Files are written only after all checks have passed.

mod begin;

use crate::cli::Arguments;
use crate::fault::Fault;
use crate::launch;
use crate::run::Task;
use crate::setup::{self, Cut};
use crate::source;
use bsmpm::lanes;
use bsmpm_io::exit;
use bsmpm_ranks::linear;
use bsmpm_ranks::signals::Requests;
use bsmpm_ranks::simulation::Libraries;
use hdf5_collective::Hdf5;
use mpi::environment::Universe;
use mpi::topology::Communicator;
use petsc_rs::Petsc;
use std::io::Write;
use std::rc::Rc;

/// Runs what the command line asks for and returns the exit code; the same on every rank.
pub fn run(universe: &Universe) -> u8 {
    match prepare(universe) {
        Ok(Some((task, cut))) => solve(universe, task, cut).unwrap_or_else(|code| code),
        Ok(None) => exit::DONE,
        Err(code) => code,
    }
}

/// Prints a reason on rank 0 and hands the exit code on.
fn refuse(universe: &Universe, code: u8, reason: &str) -> u8 {
    if universe.world().rank() == 0 {
        launch::complain(reason);
    }
    code
}

/// What is to be run, `None` if it was only to be checked; `Err` holds the exit code, and rank 0 has said why.
fn prepare(universe: &Universe) -> Result<Option<(Task, Cut)>, u8> {
    let world = universe.world();
    let speaks = world.rank() == 0;
    let ranks = world.size().unsigned_abs() as usize;
    let arguments = Arguments::read(speaks)?;
    let fault = agreed(universe, exit::USAGE, Fault::from_environment(ranks))?;
    agreed(universe, exit::USAGE, choose_lanes())?;
    let case = source::read(&world, &arguments)?;
    let Some(cut) = setup::cut(&case, ranks) else {
        return Err(refuse(universe, exit::CASE, &case.too_many(ranks)));
    };
    if arguments.check {
        if speaks {
            // A closed stdout is no reason to fail.
            let _ = writeln!(
                std::io::stdout(),
                "{}",
                source::describe(&case, ranks, &arguments.petsc)
            );
        }
        return Ok(None);
    }
    Ok(Some((Task { case, arguments, fault }, cut)))
}

/// The outcome of this rank, if it is good on all; else the exit code, and the ranks that know a reason have said it.
fn agreed<T>(universe: &Universe, code: u8, mine: Result<T, String>) -> Result<T, u8> {
    let world = universe.world();
    // What is wrong everywhere is said once.
    let first = world.rank() == 0;
    let own = u8::from(mine.is_err());
    let everywhere = world.size().unsigned_abs() as usize == bsmpm_ranks::launch::count(&world, own == 1);
    if let (Err(reason), true) = (&mine, first || !everywhere) {
        launch::complain(reason);
    }
    let failed = bsmpm_ranks::launch::agree(&world, own * code);
    mine.map_err(|_| failed)
        .and_then(|good| if failed == 0 { Ok(good) } else { Err(failed) })
}

/// Computes with the vectors of `BSMPM_LANES`, for tests; without it with the widest.
fn choose_lanes() -> Result<(), String> {
    let Some(name) = std::env::var_os("BSMPM_LANES") else {
        return Ok(());
    };
    let name = name.to_string_lossy();
    lanes::choose(&name).map_err(|error| {
        format!(
            "E0710: the environment variable BSMPM_LANES = \"{name}\" cannot be used: {error}. Nothing was run. \
            Unset BSMPM_LANES."
        )
    })
}

/// The threads that share the points of this rank; its own one is the first of them, so that one is none more.
fn start_threads(count: u32) -> Result<(), String> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(count as usize)
        .use_current_thread();
    pool.build_global().map_err(|error| {
        format!("E0711: {count} threads could not be started: {error}. Nothing was run. Reduce `--threads`.")
    })
}

/// Options of PETSc, each with its value if it has one, that have every solve reported: they wait for the run's own
/// systems.
fn reports(options: &[String]) -> (Vec<&str>, Vec<(&str, Option<&str>)>) {
    let mut others = Vec::new();
    let mut waiting = Vec::<(&str, Option<&str>)>::new();
    let mut is_value = false; // of one that waits
    for option in options.iter().map(String::as_str) {
        let is_name = option.starts_with('-') && option.parse::<f64>().is_err();
        let has_report = ["_view", "_monitor", "_converged_reason"]
            .iter()
            .any(|part| option.contains(part));
        let waits = is_name && has_report && option != "-log_view";
        match waiting.last_mut() {
            Some((_, value)) if is_value && !is_name => *value = Some(option),
            _ if waits => waiting.push((option, None)),
            _ => others.push(option),
        }
        is_value = waits;
    }
    (others, waiting)
}

fn solve(universe: &Universe, task: Task, cut: Cut) -> Result<u8, u8> {
    let Task { case, arguments, .. } = &task;
    let ranks = universe.world().size().unsigned_abs() as usize;
    let choice = setup::linear(case, ranks, &arguments.petsc);
    let (own, reports) = reports(&arguments.petsc);
    let options: Vec<&str> = choice.options().into_iter().chain(own).collect();
    let petsc = Petsc::initialize(universe, &options).map_err(|error| {
        format!("E0712: PETSc could not be started: {error}. Nothing was run. Check the installation of PETSc.")
    });
    let petsc = agreed(universe, exit::BUG, petsc)?;
    let probed = linear::probe(&petsc, &choice).map_err(|error| {
        format!(
            "E0713: the linear solver cannot be used: {error}. Nothing was run. Remove the PETSc options \
            after `--`, or set solver.linear = \"direct\"."
        )
    });
    agreed(universe, exit::CASE, probed)?;
    let set = reports
        .iter()
        .try_for_each(|(name, value)| petsc.set_option(name, *value));
    agreed(
        universe,
        exit::BUG,
        set.map_err(|error| {
            format!("E0714: PETSc does not accept an option: {error}. Nothing was run. Correct the options after `--`.")
        }),
    )?;
    agreed(universe, exit::BUG, start_threads(arguments.threads))?;
    let hdf5 = Hdf5::initialize(universe).map_err(|error| {
        format!("E0715: HDF5 could not be started: {error}. Nothing was run. Check the installation of HDF5.")
    });
    let hdf5 = agreed(universe, exit::BUG, hdf5)?;
    let requests = Requests::of_signals().map_err(|error| {
        format!(
            "E0716: the operating system refused the handling of Ctrl-C and kill (signals): {error}. Nothing was run. \
             Report this message."
        )
    });
    let requests = Rc::new(agreed(universe, exit::BUG, requests)?);
    let libraries = Libraries {
        universe,
        petsc: &petsc,
    };
    begin::run(libraries, &hdf5, choice, task, cut, requests)
}

#[cfg(test)]
mod tests {
    use super::reports;

    #[test]
    fn reports_wait_with_their_values_and_other_options_do_not() {
        let words = "-ksp_view :view.txt -ksp_type cg -ksp_monitor -ksp_rtol -1e-3 -log_view :times.txt";
        let options: Vec<String> = words.split(' ').map(String::from).collect();
        let (others, waiting) = reports(&options);
        assert_eq!(
            others,
            ["-ksp_type", "cg", "-ksp_rtol", "-1e-3", "-log_view", ":times.txt"]
        );
        assert_eq!(waiting, [("-ksp_view", Some(":view.txt")), ("-ksp_monitor", None)]);
    }
}
