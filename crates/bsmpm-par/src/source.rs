//! The case file: read by rank 0, parsed by every rank from the same bytes.

use crate::cli::Arguments;
use bsmpm_scene::Case;
use mpi::collective::Root;
use mpi::topology::{Communicator, SimpleCommunicator};

/// Exit code of a wrong case.
const WRONG: u8 = 65;
/// Exit code of a case file that is missing or cannot be read.
const MISSING: u8 = 66;

/// The valid case of the command line; `Err` holds the exit code, and rank 0 has said why.
pub fn read(world: &SimpleCommunicator, arguments: &Arguments) -> Result<Case, u8> {
    let speaks = world.rank() == 0;
    let name = arguments.case.display().to_string();
    let bytes = broadcast(world, || {
        bsmpm_scene::load(&arguments.case).map_err(|error| eprintln!("bsmpm-par: {name}: {error}")).ok()
    })
    .ok_or(MISSING)?;
    Case::from_bytes(&name, &bytes, &arguments.set).map_err(|errors| {
        if speaks {
            errors.iter().for_each(|error| eprintln!("{error:#}"));
            let plural = if errors.len() == 1 { "error" } else { "errors" };
            eprintln!("bsmpm-par: {name}: {} {plural}; nothing was run or written", errors.len());
        }
        WRONG
    })
}

/// Bytes that rank 0 may have; `None` everywhere if it has none.
fn broadcast(world: &SimpleCommunicator, bytes: impl FnOnce() -> Option<Vec<u8>>) -> Option<Vec<u8>> {
    let root = world.process_at_rank(0);
    let own = if world.rank() == 0 { bytes() } else { None };
    let mut length = own.as_ref().map_or(-1, |bytes| bytes.len() as i64);
    root.broadcast_into(&mut length);
    let length = usize::try_from(length).ok()?;
    let mut shared = own.unwrap_or_else(|| vec![0; length]);
    if length > 0 {
        root.broadcast_into(&mut shared[..]);
    }
    Some(shared)
}

/// What `--check` prints: sizes, choices and warnings.
pub fn describe(case: &Case, ranks: usize) {
    let estimate = case.estimate();
    println!("{}", case.title);
    println!("points           {}", estimate.points);
    println!("cells            {}", estimate.cells);
    println!("nodes            {}", estimate.nodes);
    println!("unknowns         at most {}", estimate.unknowns);
    println!("memory           about {} MiB on each of {ranks} rank(s)", estimate.bytes / ranks as u64 / 1_048_576 + 1);
    println!("ranks            at most {}", case.grid.axes[0].cells());
    println!("nominal steps    {}", (case.analysis.end / case.analysis.dt - 1e-6).ceil());
    for note in &case.notes {
        println!("{} = {} ({})", note.key, note.value, note.reason);
    }
    for warning in &case.warnings {
        println!("warning: {warning}");
    }
}
