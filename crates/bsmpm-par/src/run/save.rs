//! Times and content of checkpoints.

use super::Run;
use crate::checkpoint::{
    self, CheckpointState, Contents, CrossedState, FlowedState, FreeFieldState, Refusal, rigid_accelerations,
    rigid_numbers, rows,
};
use crate::launch;
use bsmpm::kinematics::Kinematics;
use bsmpm::parallel::Halo;
use bsmpm_io::checkpoint::{Facts, FoundCheckpoint};
use mpi::topology::Communicator;
use std::collections::BTreeSet;
use std::rc::Rc;
use std::time::{Duration, Instant};

/// When the last checkpoint was written, and what it and the frames cost.
#[derive(Clone, Copy, Debug)]
pub struct SaveTimes {
    newest: Option<u64>, // step
    soon: bool,          // what there is cannot be gone on from as it should
    first: u64,          // steps when this program began
    last: Instant,
    cost: f64,  // s; until there is one, the time that it took to start
    frame: f64, // s  that the slowest frame took
}

impl SaveTimes {
    /// At the start of a run after `first` steps, whose newest checkpoint is of that step; another one is wanted soon
    /// if the directory has none, or none that fits its tables.
    pub fn new(newest: Option<u64>, soon: bool, first: u64) -> Self {
        Self {
            newest,
            soon,
            first,
            last: Instant::now(),
            cost: launch::age().as_secs_f64(),
            frame: 0.0,
        }
    }

    /// Notes what a frame took.
    pub fn frame_took(&mut self, time: Duration) {
        self.frame = self.frame.max(time.as_secs_f64());
    }

    /// Whether this is the first step that this program has made.
    pub fn is_first(&self, step: u64) -> bool {
        step == self.first + 1
    }
}

/// What is to be done before the next step; the same on all ranks.
#[derive(Clone, Copy, Debug)]
pub struct Due {
    /// stop
    pub stop: bool,
    /// write a checkpoint
    pub checkpoint: bool,
    /// make the step twice
    pub reject: bool,
}

impl<K: Kinematics<D>, const D: usize> Run<'_, K, D> {
    /// What is due, if a step may take as long as the `slowest` (s) so far and half as long again.
    pub(super) fn due(&self, slowest: f64) -> Due {
        let steps = self.simulation.steps();
        let wanted = &self.case.output.checkpoint;
        let end = launch::age().as_secs_f64() + 1.5 * slowest + 3.0 * self.saving.cost + 1.5 * self.saving.frame;
        // Only the first rank knows the tables.
        let soon = self.saving.soon && self.saving.newest != Some(steps);
        // Nor need every rank have the environment of the one that was given a fault.
        let reject = self.fault.is_some_and(|fault| fault.rejects(steps + 1));
        let mut clock = [
            end,
            self.saving.last.elapsed().as_secs_f64(),
            f64::from(soon),
            f64::from(reject),
        ];
        self.simulation.halo.all_reduce_max(&mut clock);
        let counted = wanted
            .every_steps
            .is_some_and(|every| steps > 0 && steps.is_multiple_of(every));
        Due {
            stop: self.arguments.max_steps.is_some_and(|most| steps >= most)
                || self
                    .arguments
                    .max_wall
                    .is_some_and(|limit| clock[0] > limit.as_secs_f64()),
            checkpoint: counted || clock[1] > wanted.wall || clock[2] > 0.0,
            reject: clock[3] > 0.0,
        }
    }

    /// A frame and a checkpoint, if a signal has asked for them.
    pub(super) fn save_on_request(&mut self) -> Result<(), u8> {
        if !self.simulation.halo.requests().take_save() {
            return Ok(());
        }
        self.log
            .line("save", "Writing a frame and a checkpoint, as requested by a signal.");
        self.frame_if_new();
        self.checkpoint()
    }

    /// A frame, if there is none of this state.
    pub(super) fn frame_if_new(&mut self) {
        if self.last_frame != Some(self.simulation.steps()) {
            self.frame();
        }
    }

    /// A checkpoint, if there is none of this state; the exit code where it cannot be written. Collective.
    pub(super) fn checkpoint(&mut self) -> Result<(), u8> {
        let step = self.simulation.steps();
        if self.saving.newest == Some(step) {
            return Ok(());
        }
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("checkpoints");
        let begin = Instant::now();
        self.account();
        let found = self.write_checkpoint(step).map_err(|refusal| self.lose(&refusal))?;
        if let (Some(found), Some(ledger)) = (found, &mut self.ledger) {
            let mebibytes = found.record.bytes as f64 / 1_048_576.0;
            let written = ledger.checkpointed(&found);
            let seconds = begin.elapsed().as_secs_f64();
            let text = format!("Checkpoint of step {step} written: {mebibytes:.1} MiB in {seconds:.2} s.");
            self.log.detail("checkpoint", &text);
            self.require(written);
        }
        let last = Instant::now();
        let cost = begin.elapsed().as_secs_f64();
        self.saving = SaveTimes {
            newest: Some(step),
            soon: false,
            last,
            cost,
            ..self.saving
        };
        Ok(())
    }

    fn write_checkpoint(&mut self, step: u64) -> Result<Option<FoundCheckpoint>, Refusal> {
        let world = self.universe.world();
        let text = checkpoint::agree(&world, self.state(step))?;
        let text = checkpoint::broadcast(&world, 0, text);
        let case = self
            .ledger
            .as_mut()
            .map_or_else(String::new, |ledger| ledger.manifest().case.blake3.clone());
        let facts = Facts {
            version: env!("CARGO_PKG_VERSION").into(),
            case,
            ranks: world.size().unsigned_abs(),
            step,
            time: self.simulation.time(),
        };
        let store = self
            .ledger
            .as_mut()
            .map(super::RunWriter::store)
            .transpose()
            .map_err(Refusal::from);
        let store = checkpoint::agree(&world, store)?;
        let fault = self.fault;
        let writes = world.rank() == 0;
        let (columns, guess) = self.simulation.arrays();
        let contents = Contents {
            columns,
            guess,
            state: &text,
        };
        checkpoint::write(self.hdf5, &world, store, &facts, &contents, &|phase| {
            fault.iter().for_each(|fault| fault.strike_in(writes, step, phase));
        })
    }

    /// The text of a checkpoint; nothing on ranks without files.
    fn state(&mut self, step: u64) -> Result<Vec<u8>, Refusal> {
        let Some(ledger) = &mut self.ledger else {
            return Ok(Vec::new());
        };
        let simulation = &self.simulation;
        let interactions = &simulation.state;
        let state = CheckpointState {
            steps: step,
            slabs: simulation.slabs().bounds().to_vec(),
            parts: simulation.slabs().parts().to_vec(),
            lines: self
                .case
                .grid
                .lines
                .iter()
                .take(self.case.grid.dims())
                .map(|lines| lines.iter().map(|line| [line.breakpoint, line.multiplicity]).collect())
                .collect(),
            room: Some(
                simulation
                    .model
                    .grid
                    .room()
                    .iter()
                    .map(|range| [range.start, range.end])
                    .collect(),
            ),
            progress: simulation.progress(),
            traction: rows(&interactions.traction),
            anchors: [interactions.anchors.strips.clone(), interactions.anchors.loads.clone()],
            water_anchors: interactions.anchors.water.clone(),
            crossed: CrossedState::of(&interactions.crossed),
            flowed: interactions.flowed.as_ref().map(FlowedState::of),
            position: rows(&interactions.position),
            held: rows(&interactions.held),
            free_field: interactions.columns.iter().map(FreeFieldState::of).collect(),
            rigid: interactions.bodies.iter().map(rigid_numbers).collect(),
            rigid_accelerations: rigid_accelerations(&interactions.bodies),
            pressure: [
                if interactions.pressure.iter().all(Vec::is_empty) {
                    Vec::new()
                } else {
                    rows(&interactions.pressure)
                },
                Vec::new(),
            ],
            record: self.recorder.state(),
            issued: self.issued.clone(),
            numbered_surfaces: BTreeSet::new(),
            numbered_bodies: BTreeSet::new(),
            last_frame: self.last_frame,
            files: ledger.files(step)?,
        };
        state.text()
    }

    /// Warns that a checkpoint could not be written, the older ones being good; all ranks know why.
    fn lose(&mut self, refusal: &Refusal) -> u8 {
        self.log.failure(&refusal.reason);
        if let Some(ledger) = &mut self.ledger {
            ledger.abandon(refusal.code);
        }
        refusal.code
    }
}
