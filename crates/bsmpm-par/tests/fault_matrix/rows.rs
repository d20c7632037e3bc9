//! Every row of the faults: its number in the project's list, how it is brought about, and how often: `[short, full]`.

use crate::table::{Row, row};
use crate::{damaged, events, footing, kills, places, rejected, restart, signals, writing};

/// All rows. B: everything that the run leaves is the uninterrupted run's to the bit.
#[rustfmt::skip] // a row is a line
pub fn all() -> Vec<Row> {
    vec![
        row("F00", "the case: plastic flow, points that change ranks, a step that is cut", [1, 1], events::all),
        row("F01", "a rank is killed at any instant; --restart auto: B", [2, 50], kills::rank),
        row("F02", "the writer is killed in each of 9 phases of a checkpoint; B", [1, 6], kills::writer),
        row("F03", "a writer of checkpoints is killed at any instant", [10, 300], writing::storm),
        row("F04", "launcher and ranks are killed at once; B", [1, 10], kills::all),
        row("F04", "mpirun is killed, its ranks are on their own; B", [1, 10], kills::launcher),
        row("F05", "power loss: what is synced, named and removed in which order", [1, 1], writing::order),
        row("F06", "full disk under a checkpoint; B", [1, 10], writing::full_disk),
        row("F06", "files must not grow as large as a checkpoint; B", [1, 5], writing::small_files),
        row("F07", "full disk under the frames; B", [1, 5], writing::full_frames),
        row("F09", "USR1 to mpirun at any instant; no step is lost, B", [2, 20], signals::usr1),
        row("F10", "USR1 to one rank; no step is lost, B", [1, 10], signals::usr1_to_a_rank),
        row("F11", "USR2: a frame and a checkpoint; B but for the frames", [1, 5], signals::usr2),
        row("F12", "TERM to mpirun that leaves the time; no step is lost, B", [0, 10], signals::term),
        row("F12", "TERM to mpirun that kills at once; B", [1, 10], signals::term_in_a_hurry),
        row("F13", "TERM to mpirun twice; B", [1, 5], signals::term_twice),
        row("F14", "--max-wall, again and again to the end; B", [1, 10], signals::max_wall),
        row("F15", "a chain of restarts, 6 steps each; B", [1, 1], restart::chain),
        row("F16", "the short cases, stopped half way and after step 2; B", [12, 160], restart::recover_short),
        row("F16", "the cases of the validation, the same", [0, 12], restart::recover_validation),
        row("F16", "the paper's cases, the same", [0, 4], restart::recover_paper),
        row("F17", "a step that has converged is rejected and made again; B", [4, 20], rejected::footing),
        row("F17", "the short cases, the step half way rejected; B", [12, 160], rejected::short),
        row("F17", "the cases of the validation, the same", [0, 12], rejected::validation),
        row("F18", "the interval of checkpoints changes no bit; B", [1, 1], restart::intervals),
        row("F19", "restart on another number of ranks", [1, 1], restart::other_ranks),
        row("F20", "repeated with ranks that are stopped and let go; B", [1, 10], restart::repeated),
        row("F21", "checkpoint cut short: by name refused, auto takes the one before", [8, 40], damaged::truncated),
        row("F22", "one bit flipped in file or record", [500, 500], damaged::flipped),
        row("F22", "the same, through the whole program", [3, 10], damaged::flipped_in_full),
        row("F23", "what is no checkpoint: text, directory, pipe, device, circle of links, ...", [1, 1], damaged::foreign),
        row("F24", "another case", [1, 1], restart::other_case),
        row("F24", "keys that may change", [1, 1], restart::free_keys),
        row("F25", "checkpoint of another form", [1, 1], damaged::other_form),
        row("F26", "HDF5 that nobody of ours wrote, with a true record", [1, 1], damaged::hostile),
        row("F27", "output directory that cannot be written to", [1, 1], places::no_permission),
        row("F28", "a second run in the same directory", [1, 5], places::second_run),
        row("F29", "the lock of a run that was killed on another host", [1, 2], places::stale_lock),
        row("F30", "panic on the first and on the last rank; B", [2, 10], kills::panic),
        row("F33", "no convergence: 80, and from there on", [1, 1], restart::no_convergence),
        row("F35", "a point leaves the grid: 81, and --restart auto in a loop", [1, 1], places::left),
        row("F36", "ranks without points; more ranks than columns of cells", [1, 1], places::idle_ranks),
        row("F37", "more memory than there may be", [1, 1], places::memory),
        row("F38", "nobody listens", [1, 1], places::unheard),
        row("F39", "clocks that jump", [1, 1], places::clock),
        row("F40", "a slow disk; B", [1, 1], writing::slow),
        row("all", "strip footing killed ten times, on 2, 3, 1, 2, ... ranks: p/c", [0, 1], footing::killed),
    ]
}
