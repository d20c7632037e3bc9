//! Whether a run begins or goes on, and from what.

use crate::checkpoint::{Opened, Refusal, State, Wanted, agree, broadcast, find};
use crate::cli::{Arguments, Restart};
use crate::exit;
use crate::migrate;
use crate::simulation::points_by_column;
use crate::slab::Slabs;
use bsmpm::control::Stepper;
use bsmpm::grid::Grid;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::Model;
use bsmpm::points::Points;
use bsmpm::schedule::Schedule;
use bsmpm_io::checkpoint::{FOLDER, Found};
use bsmpm_io::directory::{Existing, OutputDirectory};
use bsmpm_io::manifest::{self, Manifest, Status};
use bsmpm_scene::{Case, Difference};
use hdf5_collective::Hdf5;
use mpi::collective::{CommunicatorCollectives, SystemOperation};
use mpi::environment::Universe;
use mpi::topology::Communicator;
use std::path::{Path, PathBuf};

/// Restarts in a row from one step after which no more is tried: the loop of a batch system would have no end.
const MOST_FUTILE: usize = 3;

/// How a run starts.
pub enum Start<'h> {
    /// From the case.
    New(Existing),
    /// From a checkpoint.
    Resumed(Box<Resumed<'h>>),
    /// Not at all: the case's end was reached before.
    Complete,
}

/// A checkpoint from which a run goes on.
pub struct Resumed<'h> {
    /// It and its record.
    pub found: Found,
    /// Everything that is no array.
    pub state: State,
    /// Keys of the case that have changed since, with both values.
    pub changed: Vec<String>,
    /// What is to be told, on the first rank.
    pub warnings: Vec<String>,
    /// Where the run went on before, on the first rank.
    pub restarts: Vec<manifest::Restart>,
    opened: Opened<'h>,
}

/// Decides how the run starts, with everything verified that it starts from. `held` is the first rank's. Collective.
///
/// # Errors
/// The same on all ranks: the checkpoint, or the run in the directory, is of another case, or damaged (76); the last
/// restarts came to nothing (72).
pub fn plan<'h>(
    (hdf5, universe): (&'h Hdf5<'h>, &Universe),
    held: Option<&OutputDirectory>,
    arguments: &Arguments,
    case: &Case,
) -> Result<Start<'h>, Refusal> {
    let world = universe.world();
    let Some(restart) = &arguments.restart else {
        return Ok(Start::New(if arguments.force { Existing::Delete } else { Existing::Refuse }));
    };
    let run = agree(&world, held.map_or(Ok(None), OutputDirectory::run).map_err(Refusal::from))?;
    let (found, passed_over) = match restart {
        Restart::From(file) => find(&world, Wanted::Named(file))?,
        Restart::Auto => {
            let there = agree(&world, held.map_or(Ok(There::Unfinished), |_| there(run.as_ref(), case)))?;
            match There::ALL[usize::from(broadcast(&world, 0, vec![there as u8])[0])] {
                There::Nothing => return Ok(Start::New(Existing::Refuse)),
                There::Complete => return Ok(Start::Complete),
                There::Unfinished => find(&world, Wanted::Newest(&arguments.directory().join(FOLDER)))?,
            }
        }
    };
    let Some(found) = found else {
        // With the bad checkpoints the rows of the run would go, too.
        let none = passed_over.first().map_or(Ok(()), |bad| Err(Refusal::new(exit::CHECKPOINT, bad.clone())));
        return agree(&world, none).map(|()| Start::New(Existing::Delete));
    };
    let restarts = run.map_or_else(Vec::new, |run| run.restarts);
    let hopeless = if *restart == Restart::Auto { futile(&restarts, found.record.step) } else { Ok(()) };
    agree(&world, hopeless)?;
    let opened = Opened::new((hdf5, universe.world()), &found)?;
    let state = State::parse(&found.path, &opened.state()?)?;
    let past = &state.files.manifest;
    let changed = admissible(&format!("the checkpoint {}", found.path.display()), past, case)?;
    let mut warnings: Vec<String> =
        passed_over.into_iter().map(|bad| format!("{bad}; an older checkpoint is used")).collect();
    warnings.extend(other_machine(past, world.size().unsigned_abs(), &found));
    warnings.extend(changed.iter().map(|change| format!("since the checkpoint, {change}")));
    Ok(Start::Resumed(Box::new(Resumed { found, state, changed, warnings, restarts, opened })))
}

/// What a directory holds, as the first rank sees it.
#[derive(Clone, Copy)]
enum There {
    Nothing,
    Complete,
    Unfinished,
}

impl There {
    const ALL: [Self; 3] = [Self::Nothing, Self::Complete, Self::Unfinished];
}

fn there(run: Option<&Manifest>, case: &Case) -> Result<There, Refusal> {
    let Some(run) = run else { return Ok(There::Nothing) };
    let changed = admissible("the run in the output directory", run, case)?;
    let further = changed.iter().any(|change| change.starts_with("analysis.end"));
    Ok(if run.status == Status::Finished && !further { There::Complete } else { There::Unfinished })
}

/// The keys that differ between a case and what was run, if a run may go on with all of them changed.
fn admissible(what: &str, past: &Manifest, case: &Case) -> Result<Vec<String>, Refusal> {
    let refused = |reason: String| Refusal::new(exit::CHECKPOINT, format!("{what} {reason}"));
    let differences = bsmpm_scene::differences(&past.case.text, &case.text);
    let differences = differences.map_err(|_| refused("is of a case that this version does not know".into()))?;
    let (free, bound): (Vec<Difference>, Vec<Difference>) =
        differences.into_iter().partition(|difference| difference.may_change);
    let told = |list: &[Difference]| list.iter().map(ToString::to_string).collect::<Vec<_>>();
    if bound.is_empty() {
        Ok(told(&free))
    } else {
        Err(refused(format!("is of another case: {}", told(&bound).join("; "))))
    }
}

fn futile(restarts: &[manifest::Restart], step: u64) -> Result<(), Refusal> {
    let same = restarts.iter().rev().take_while(|restart| restart.step == step).count();
    if same < MOST_FUTILE {
        return Ok(());
    }
    let reason = format!(
        "{same} restarts in a row came to no checkpoint beyond step {step}; --restart with that checkpoint's file tries again"
    );
    Err(Refusal::new(exit::STALLED, reason))
}

/// Why the run will not repeat to the bit, if so.
fn other_machine(past: &Manifest, ranks: u32, found: &Found) -> Vec<String> {
    let mut reasons = Vec::new();
    if found.record.ranks != ranks {
        let before = found.record.ranks;
        reasons.push(format!(
            "restart on {ranks} rank(s) of a checkpoint of {before}: it agrees within tolerances, not to the bit"
        ));
    }
    let version = env!("CARGO_PKG_VERSION");
    if past.version != version {
        reasons.push(format!("restart by version {version} of a checkpoint by {}", past.version));
    }
    reasons
}

impl Resumed<'_> {
    /// Whether the checkpoint is one of the run in that directory.
    pub fn is_in(&self, directory: &Path) -> bool {
        let whole = |path: &Path| path.canonicalize().ok();
        self.found
            .path
            .parent()
            .is_some_and(|folder| whole(folder).is_some_and(|f| whole(&directory.join(FOLDER)) == Some(f)))
    }

    /// The directory of the run that wrote the checkpoint, if it is still in its folder.
    pub fn directory(&self) -> Option<PathBuf> {
        let folder = self.found.path.parent()?;
        folder.ends_with(FOLDER).then(|| folder.parent().map(Path::to_owned))?
    }

    /// Reads the points and the nodal displacement, each rank what lies in its slab. Collective.
    ///
    /// # Errors
    /// The same on all ranks (76): they are not those of this case.
    pub fn read(
        &self,
        universe: &Universe,
        model: &Model<PlaneStrain, 2>,
        schedule: &Schedule,
    ) -> Result<(Slabs, Points<2>, Stepper), Refusal> {
        let world = universe.world();
        let foreign = |what: &str| {
            Refusal::new(
                exit::CHECKPOINT,
                format!("the checkpoint {} cannot be used: {what}", self.found.path.display()),
            )
        };
        let names: Vec<&str> = self.found.record.arrays.iter().map(|array| array.name.as_str()).collect();
        let mut points = Points::holding(&names);
        self.opened.points(points.named_columns())?;
        let slabs =
            self.slabs(universe, &model.grid, &points).ok_or_else(|| foreign("its slabs are not of this grid"))?;
        let rank = world.rank().unsigned_abs() as usize;
        let window = model.grid.window(slabs.columns(rank));
        migrate::points(&world, &slabs, &window, &mut points);
        points.surface = self.state.surface();
        let surface = model.boundary.surface();
        let sizes = |lists: &[Vec<_>]| lists.iter().map(Vec::len).collect::<Vec<_>>();
        let same = sizes(&points.surface.traction) == sizes(&surface.traction)
            && sizes(&points.surface.position) == sizes(&surface.position);
        if !same {
            return Err(foreign("its surfaces are not of this case"));
        }
        let guess = self.opened.guess(slabs.layers(rank, window.order()), window.layer_nodes() * 2)?;
        let stepper = Stepper::resume(guess, self.state.progress, schedule);
        Ok((slabs, points, stepper.ok_or_else(|| foreign("its step control is in no state it can be in"))?))
    }

    /// The cut of the grid: as it was, or on another number of ranks one with about equal numbers of points.
    fn slabs(&self, universe: &Universe, grid: &Grid<2>, points: &Points<2>) -> Option<Slabs> {
        let (world, columns) = (universe.world(), grid.axes()[0].cells());
        let ranks = world.size().unsigned_abs() as usize;
        if self.found.record.ranks as usize == ranks {
            return Slabs::new(self.state.slabs.clone(), ranks, columns);
        }
        let own = points_by_column(grid, points);
        let mut counts = vec![0.0; own.len()];
        world.all_reduce_into(&own[..], &mut counts[..], SystemOperation::sum());
        Slabs::cut(&counts, ranks)
    }

    /// Closes the checkpoint. Collective.
    ///
    /// # Errors
    /// The same on all ranks (76).
    pub fn close(self) -> Result<(), Refusal> {
        self.opened.close()
    }
}
