//! Starts MPI, and ends all ranks after a failure on one.

use mpi::collective::{CommunicatorCollectives, SystemOperation};
use mpi::environment::Universe;
use mpi::topology::{Communicator, SimpleCommunicator};
use std::fmt;

/// Environment variables in which a launcher passes the number of ranks.
const LAUNCHED: [&str; 4] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_SIZE", "SLURM_STEP_NUM_TASKS"];

/// Reason why the ranks could not be started.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaunchFailure {
    /// MPI could not be started.
    NoMpi,
    /// The launcher started this number of processes, and each is a run of its own.
    Apart(usize),
}

impl fmt::Display for LaunchFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoMpi => write!(
                f,
                "E0772: MPI could not be started. Nothing was run. Check the installation of MPI, and the command that starts the run."
            ),
            Self::Apart(processes) => write!(
                f,
                "E0773: mpirun started {processes} separate processes, not one parallel run, because this program \
                 uses another MPI library. Nothing was run. Use the mpirun of this program's MPI library."
            ),
        }
    }
}

/// Starts MPI. From here on a panic on any rank calls `end` with the reason, which must report it and end the job
/// ([`abort`]). Call it first in `main`, before any other thread exists, because it sets environment variables.
pub fn start(end: fn(&SimpleCommunicator, &str) -> !) -> Result<Universe, LaunchFailure> {
    prepare(!LAUNCHED.iter().any(|name| std::env::var_os(name).is_some()));
    let Some((universe, _)) = mpi::initialize_with_threading(mpi::Threading::Funneled) else {
        return Err(LaunchFailure::NoMpi);
    };
    abort_on_panic(end);
    let ranks = universe.world().size().unsigned_abs() as usize;
    let wanted = LAUNCHED
        .iter()
        .find_map(|name| std::env::var(name).ok()?.parse::<usize>().ok());
    match wanted {
        Some(wanted) if ranks == 1 && wanted > 1 => Err(LaunchFailure::Apart(wanted)),
        _ => Ok(universe),
    }
}

/// Open MPI settings for every run: no file pointers that ranks share, because they overflow a buffer of fixed size
/// with long names.
const ALWAYS: [(&str, &str); 1] = [("OMPI_MCA_sharedfp", "individual")];

/// Settings without a launcher. Open MPI would otherwise start a daemon and look for a network, and would use one
/// session folder for all such runs on a node, which the first run that ends deletes.
const ALONE: [(&str, &str); 4] = [
    ("OMPI_MCA_ess_singleton_isolated", "1"),
    ("OMPI_MCA_orte_create_session_dirs", "0"),
    ("OMPI_MCA_pml", "ob1"),
    ("OMPI_MCA_btl", "self"),
];

/// Sets the variables that the environment does not set.
#[allow(unsafe_code)]
fn prepare(alone: bool) {
    let settings = ALWAYS.iter().chain(ALONE.iter().filter(|_| alone));
    for (name, value) in settings.filter(|(name, _)| std::env::var_os(name).is_none()) {
        // SAFETY: called first thing in `main`, before any other thread exists.
        unsafe { std::env::set_var(name, value) };
    }
}

/// Aborts all ranks on a panic. Otherwise rsmpi finalises MPI while the panic unwinds, and the other ranks wait
/// forever.
fn abort_on_panic(end: fn(&SimpleCommunicator, &str) -> !) {
    std::panic::set_hook(Box::new(move |panic| {
        let world = SimpleCommunicator::world();
        let place = panic
            .location()
            .map_or_else(String::new, |place| format!(" at {place}"));
        let text = panic.payload();
        let text = text
            .downcast_ref::<&str>()
            .copied()
            .or_else(|| text.downcast_ref::<String>().map(String::as_str));
        let reason = text.unwrap_or("no reason given");
        end(
            &world,
            &format!(
                "E0774: internal error (panic on rank {}{place}): {reason}. This is a defect of the program. Report \
                 this message with the case file.",
                world.rank()
            ),
        );
    }));
}

/// Ends the job on all ranks with `code`, after a failure that the other ranks do not know of.
pub fn abort(world: &SimpleCommunicator, code: u8) -> ! {
    // With one rank there is nothing to end, and Open MPI would print nine lines about its abort.
    let is_running = mpi::environment::is_initialized() && !mpi::environment::is_finalized();
    if is_running && world.size() > 1 {
        world.abort(i32::from(code));
    }
    std::process::exit(i32::from(code));
}

/// Returns the largest exit code of all ranks; 0 if all succeeded. Collective.
pub fn agree(world: &SimpleCommunicator, own: u8) -> u8 {
    let mut largest = 0;
    world.all_reduce_into(&own, &mut largest, SystemOperation::max());
    largest
}

/// Returns the number of ranks for which `holds` is true. Collective.
pub fn count(world: &SimpleCommunicator, holds: bool) -> usize {
    let mut sum = 0_u32;
    world.all_reduce_into(&u32::from(holds), &mut sum, SystemOperation::sum());
    sum as usize
}
