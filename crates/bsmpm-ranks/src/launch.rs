//! Starts MPI, and ends all ranks after a failure on one.

use mpi::collective::{CommunicatorCollectives, SystemOperation};
use mpi::environment::Universe;
use mpi::topology::{Communicator, SimpleCommunicator};
use std::fmt;

/// Variables by which a launcher gives a process the number of ranks.
const LAUNCHED: [&str; 4] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_SIZE", "SLURM_STEP_NUM_TASKS"];

/// Why there are no ranks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaunchFailure {
    /// MPI could not be started.
    NoMpi,
    /// The launcher started so many processes, and each is a run of its own.
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

/// Starts MPI. From here on a panic on any rank goes to `end` with its reason, which is to end the job ([`abort`]) and
/// to say why. First thing in `main`, before any other thread: it sets environment variables.
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

/// Settings of Open MPI for every run. Files have no pointer that ranks share: Open MPI's would fill a buffer of fixed
/// size with long names.
const ALWAYS: [(&str, &str); 1] = [("OMPI_MCA_sharedfp", "individual")];

/// Settings without a launcher. Open MPI would start a daemon and look for a network; one rank needs neither. Its
/// folder for the processes of a node would be shared by all such runs, and go with the first that ends.
const ALONE: [(&str, &str); 4] = [
    ("OMPI_MCA_ess_singleton_isolated", "1"),
    ("OMPI_MCA_orte_create_session_dirs", "0"),
    ("OMPI_MCA_pml", "ob1"),
    ("OMPI_MCA_btl", "self"),
];

/// Sets what the environment has not set by itself.
#[allow(unsafe_code)]
fn prepare(alone: bool) {
    let settings = ALWAYS.iter().chain(ALONE.iter().filter(|_| alone));
    for (name, value) in settings.filter(|(name, _)| std::env::var_os(name).is_none()) {
        // SAFETY: called first thing in `main`, before any other thread exists.
        unsafe { std::env::set_var(name, value) };
    }
}

/// rsmpi finalises MPI while a panic unwinds, and the other ranks would wait for ever: abort them all instead.
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

/// Ends the job on all ranks with `code`, for failures that the other ranks do not know of.
pub fn abort(world: &SimpleCommunicator, code: u8) -> ! {
    // A rank alone has nobody to end, and Open MPI would print nine lines about its abort.
    let is_running = mpi::environment::is_initialized() && !mpi::environment::is_finalized();
    if is_running && world.size() > 1 {
        world.abort(i32::from(code));
    }
    std::process::exit(i32::from(code));
}

/// The same exit code on all ranks: the largest of them, 0 where all are well. Collective.
pub fn agree(world: &SimpleCommunicator, own: u8) -> u8 {
    let mut largest = 0;
    world.all_reduce_into(&own, &mut largest, SystemOperation::max());
    largest
}

/// Number of ranks on which a condition holds. Collective.
pub fn count(world: &SimpleCommunicator, holds: bool) -> usize {
    let mut sum = 0_u32;
    world.all_reduce_into(&u32::from(holds), &mut sum, SystemOperation::sum());
    sum as usize
}
