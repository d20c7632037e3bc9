//! Reads the case file on rank 0 and sends it to all ranks.

use crate::cli::Arguments;
use crate::launch::say;
use crate::memory;
use crate::setup;
use bsmpm_io::exit::{CASE, MISSING};
use bsmpm_messages::headed;
use bsmpm_scene::Case;
use mpi::collective::Root;
use mpi::topology::{Communicator, SimpleCommunicator};
use std::io::ErrorKind;

/// The valid case of the command line, for which there is enough memory; `Err` holds the exit code, and rank 0 has said
/// why.
pub fn read(world: &SimpleCommunicator, arguments: &Arguments) -> Result<Case, u8> {
    let speaks = world.rank() == 0;
    let name = arguments.case.display().to_string();
    let bytes = broadcast(world, || {
        bsmpm_scene::load(&arguments.case).map_err(|error| {
            say(&format!("{name}: {}", headed(&error.to_string(), "error")));
            if error.kind() == ErrorKind::InvalidData {
                CASE
            } else {
                MISSING
            }
        })
    })?;
    let case = Case::from_bytes(&name, &bytes, &arguments.set).map_err(|errors| {
        if speaks {
            errors.iter().for_each(|error| say(&format!("{error:#}")));
            let plural = if errors.len() == 1 { "error" } else { "errors" };
            say(&format!(
                "bsmpm-par: {name}: {} {plural}; nothing was run or written",
                errors.len()
            ));
        }
        CASE
    })?;
    memory::admit(world, arguments, &case)?;
    Ok(case)
}

/// Bytes that rank 0 has read, or the exit code of why it has not.
fn broadcast(world: &SimpleCommunicator, bytes: impl FnOnce() -> Result<Vec<u8>, u8>) -> Result<Vec<u8>, u8> {
    let root = world.process_at_rank(0);
    let own = if world.rank() == 0 { bytes() } else { Ok(Vec::new()) };
    // Below zero: the exit code.
    let mut length = own
        .as_ref()
        .map_or_else(|code| -i64::from(*code), |bytes| bytes.len() as i64);
    root.broadcast_into(&mut length);
    let Ok(size) = usize::try_from(length) else {
        return Err(length.unsigned_abs() as u8);
    };
    let mut shared = own.unwrap_or_default();
    shared.resize(size, 0);
    if size > 0 {
        root.broadcast_into(&mut shared[..]);
    }
    Ok(shared)
}

/// What `--check` prints: sizes, choices and warnings.
pub fn describe(case: &Case, ranks: usize, options: &[String]) -> String {
    let estimate = case.estimate(ranks);
    let [own, own_with_newton] =
        [estimate.bytes, estimate.bytes_with_newton].map(|bytes| bytes / ranks as u64 / 1_048_576 + 1);
    let newton = if estimate.bytes_with_newton == estimate.bytes {
        String::new()
    } else {
        format!("; {own_with_newton} once a step needs Newton's method")
    };
    let pressures = match estimate.pressures {
        0 => String::new(),
        pressures => format!(", and {pressures} pore pressures where the bodies start"),
    };
    let mut lines = vec![
        case.title.clone(),
        format!("points           {}", estimate.points),
        format!("cells            {}", estimate.cells),
        format!("nodes            {}", estimate.nodes),
        format!("unknowns         at most {}{pressures}", estimate.unknowns),
        format!("memory           about {own} MiB on each of {ranks} rank(s){newton}"),
        format!(
            "ranks            at most {}, useful: about {}",
            case.most_ranks(),
            estimate.useful_ranks
        ),
        format!("nominal steps    {}", bsmpm_scene::model::nominal_steps(case)),
    ];
    if let Some(narrowest) = &case.opening {
        let cells = narrowest.cells;
        let path = &narrowest.path;
        let width = narrowest.brief_width();
        lines.push(format!(
            "hole or notch    {cells:.1} cells across {path} of {width} m, the fewest of all"
        ));
    }
    let noted = case
        .notes
        .iter()
        .map(|note| format!("{} = {} ({})", note.key, note.value, note.reason));
    let chosen = setup::choices(case, ranks, options);
    lines.extend(
        noted.chain(
            chosen
                .iter()
                .map(|choice| format!("{} = {} ({})", choice.key, choice.value, choice.reason)),
        ),
    );
    lines.extend(case.renamings.iter().map(|renaming| format!("note: {renaming}")));
    lines.extend(
        setup::warnings(case, ranks)
            .iter()
            .map(|warning| headed(warning, "warning")),
    );
    lines.join("\n")
}
