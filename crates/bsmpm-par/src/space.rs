//! Compares the free disk space with the expected output.

use crate::checkpoint::{self, Contents, Refusal, agree};
use crate::cli::Arguments;
use crate::gather;
use bsmpm::kinematics::Kinematics;
use bsmpm_io::directory::OutputDirectory;
use bsmpm_io::exit;
use bsmpm_io::{checkpoint as kept, disk};
use bsmpm_ranks::simulation::Simulation;
use bsmpm_scene::{Case, Every, Regime};
use mpi::collective::{CommunicatorCollectives, SystemOperation};
use mpi::topology::SimpleCommunicator;

/// Bytes of a frame's head, and of its line in the list.
const HEAD: u64 = 4096;
/// Bytes of what a checkpoint holds in words, and of its record.
const WORDS: u64 = 1 << 16;
const MIB: f64 = (1_u64 << 20) as f64;

/// What a run may write from here on.
struct Need {
    frames: u64,
    frame: u64, // bytes
    checkpoints: u64,
    checkpoint: u64, // bytes
}

/// A warning for the first rank where its disk has less room than the run may need, or with `--strict-space` the
/// refusal (74). Collective.
pub fn admit<K: Kinematics<D>, const D: usize>(
    world: &SimpleCommunicator,
    held: Option<&OutputDirectory>,
    arguments: &Arguments,
    case: &Case,
    simulation: &mut Simulation<'_, K, D>,
) -> Result<Option<String>, Refusal> {
    let need = Need::of(world, held, arguments.force, case, simulation);
    let shortage = held.and_then(|held| need.shortage(held, arguments.force));
    let outcome = match shortage {
        None => Ok(None),
        Some(room) if arguments.strict_space => {
            let reason = format!(
                "E0701: the disk has too little space: {room}. Nothing was run. Free space on the disk, or remove \
                 `--strict-space`."
            );
            Err(Refusal::new(exit::WRITE, reason))
        }
        Some(room) => Ok(Some(format!(
            "W0722: the disk may have too little space: {room}. The run may stop early. Free space on the disk, \
             or write fewer frames (a larger `output.every`)."
        ))),
    };
    agree(world, outcome)
}

impl Need {
    fn of<K: Kinematics<D>, const D: usize>(
        world: &SimpleCommunicator,
        held: Option<&OutputDirectory>,
        emptied: bool,
        case: &Case,
        simulation: &mut Simulation<'_, K, D>,
    ) -> Self {
        let own = simulation.points.len() as u64;
        let mut points = 0_u64;
        world.all_reduce_into(&own, &mut points, SystemOperation::sum());
        let time = simulation.time();
        let begun = simulation.steps() > 0;
        // Columns that points carry from the first step on.
        let model = &simulation.model;
        let own = &simulation.points;
        let is_damped = !model.damping.is_empty() && model.stabilisation.smooths();
        let dilation = u64::from(model.stabilisation.averages() && own.dilation.is_none());
        let smoothing = 6 * u64::from(is_damped && own.smoothing.is_none());
        let to_come = points * (dilation + smoothing) * size_of::<f64>() as u64;
        let (columns, guess) = simulation.arrays();
        let room = checkpoint::room(
            world,
            &Contents {
                columns,
                guess,
                state: &[],
            },
        );
        // What is to be deleted counts as free, not as there.
        let there = held
            .filter(|_| !emptied)
            .map_or(0, |held| kept::count(held.path()) as u64);
        Self {
            frames: frames(case, time, begun),
            frame: HEAD
                + points
                    * gather::point_bytes::<D>(
                        case.analysis.regime == Regime::Dynamic,
                        case.output.projected_pressure,
                        &simulation.model.materials,
                        &case.output.fields,
                    ),
            // A new one is whole before the oldest goes.
            checkpoints: (case.output.checkpoint.keep.max(1) + 1).saturating_sub(there),
            checkpoint: WORDS + room + to_come,
        }
    }

    fn bytes(&self) -> u64 {
        let frames = self.frames.saturating_mul(self.frame);
        frames.saturating_add(self.checkpoints.saturating_mul(self.checkpoint))
    }

    /// What is to be reported if there is less.
    fn shortage(&self, held: &OutputDirectory, emptied: bool) -> Option<String> {
        // A system that cannot tell is no reason to say anything.
        let free = disk::free(held.path()).ok()? + if emptied { doomed(held) } else { 0 };
        (free < self.bytes()).then(|| {
            format!(
                "`{}` has {:.1} MiB left, and the run may write {:.1} MiB ({} frames, {} checkpoints)",
                held.path().display(),
                free as f64 / MIB,
                self.bytes() as f64 / MIB,
                self.frames,
                self.checkpoints
            )
        })
    }
}

/// Frames from `time` on, those at the start and at the end included.
fn frames(case: &Case, time: f64, begun: bool) -> u64 {
    let timed = bsmpm_scene::model::frame_times(case)
        .into_iter()
        .filter(|wanted| *wanted > time && *wanted < case.analysis.end)
        .count() as u64;
    let counted = match case.output.every {
        Some(Every::Steps(every)) => ((case.analysis.end - time) / case.analysis.dt) as u64 / every,
        _ => 0,
    };
    timed + counted + 1 + u64::from(!begun)
}

/// Bytes of the run that `--force` is about to delete.
fn doomed(held: &OutputDirectory) -> u64 {
    let outputs = held.run().ok().flatten().map_or_else(Vec::new, |run| run.outputs);
    let sizes = outputs
        .iter()
        .filter_map(|output| held.path().join(&output.path).metadata().ok());
    sizes.map(|found| found.len()).sum()
}
