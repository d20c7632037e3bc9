//! Begins a run from its case or a checkpoint.

use super::refuse;
use crate::checkpoint::{Refusal, SurfaceCounts, agree};
use crate::cli::Arguments;
use crate::launch;
use crate::ledger::RunWriter;
use crate::log::Log;
use crate::machine;
use crate::record::Recorder;
use crate::restart::{self, RestartedState, ResumedRun, RunStart};
use crate::run::RecordedSimulation;
use crate::run::RunFiles;
use crate::run::{PriorState, Run, Task};
use crate::setup::Cut;
use crate::space;
use bsmpm::grid::Grid;
use bsmpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain, Solid};
use bsmpm_io::directory::OutputDirectory;
use bsmpm_io::exit;
use bsmpm_io::lock::Unseen;
use bsmpm_io::table::TableColumn;
use bsmpm_ranks::linear::Choice;
use bsmpm_ranks::load::{self, Rows};
use bsmpm_ranks::signals::Requests;
use bsmpm_ranks::simulation::Libraries;
use bsmpm_ranks::simulation::PartitionedModel;
use bsmpm_ranks::simulation::Simulation;
use bsmpm_ranks::slab::Slabs;
use bsmpm_ranks::timers::Timers;
use bsmpm_scene::model::{model_at, points, schedule, seeds};
use bsmpm_scene::{Case, Geometry};
use hdf5_collective::Hdf5;
use mpi::collective::{CommunicatorCollectives, SystemOperation};
use mpi::environment::Universe;
use mpi::topology::{Communicator, SimpleCommunicator};
use std::path::Path;
use std::rc::Rc;

/// Runs the task, whatever its geometry, with the libraries that have started; `Err` holds the exit code, and rank 0
/// has said why.
pub(super) fn run(
    libraries: Libraries<'_>,
    hdf5: &Hdf5<'_>,
    choice: Choice,
    task: Task,
    cut: Cut,
    requests: Rc<Requests>,
) -> Result<u8, u8> {
    match task.case.geometry {
        Geometry::PlaneStrain => run_in::<PlaneStrain, 2>(libraries, hdf5, choice, task, cut, requests),
        Geometry::Axisymmetric => run_in::<Axisymmetric, 2>(libraries, hdf5, choice, task, cut, requests),
        Geometry::Solid => run_in::<Solid, 3>(libraries, hdf5, choice, task, cut, requests),
    }
}

fn run_in<K: Kinematics<D>, const D: usize>(
    libraries: Libraries<'_>,
    hdf5: &Hdf5<'_>,
    choice: Choice,
    mut task: Task,
    cut: Cut,
    requests: Rc<Requests>,
) -> Result<u8, u8> {
    let universe = libraries.universe;
    let refused = |refusal: Refusal| refuse(universe, refusal.code, &refusal.reason);
    let held = hold(universe, &task.arguments).map_err(refused)?;
    let mut start = restart::plan(hdf5, universe, held.as_ref(), &task.arguments, &task.case).map_err(refused)?;
    if let RunStart::Resumed(resumed) = &start {
        let lines = resumed.lines(&task.case).map_err(refused)?;
        task.case.keep_lines(lines);
        task.case.keep_mass(resumed.mass(&task.case));
    }
    let Task { case, arguments, .. } = &task;
    if let RunStart::Complete(code) = start {
        return Ok(remark(
            universe,
            code,
            &format!("The run in `{}` is already complete.", arguments.directory().display()),
        ));
    }
    let timers = Rc::new(Timers::default());
    let scene = scene::<K, D>(libraries, choice, case, cut, &start, Rc::clone(&timers), requests);
    let mut scene = scene.map_err(refused)?;
    let simulation = &mut scene.simulation;
    let warning = space::admit(&universe.world(), held.as_ref(), arguments, case, simulation).map_err(refused)?;
    start.warn(warning);
    start.warn(crowded(&universe.world(), arguments.threads));
    let counts = SurfaceCounts {
        strips: simulation.model.boundary.strips.len(),
        drains: simulation.model.surfaces().water.len(),
    };
    let before = before(&start, &arguments.directory(), case, counts);
    let ledger = ledger(universe, held, arguments, case, scene.recorder.columns(), &start).map_err(refused)?;
    if let RunStart::Resumed(resumed) = start {
        resumed.close().map_err(refused)?;
    }
    let speaks = universe.world().rank() == 0;
    let log = Log::new(speaks, arguments, case);
    let files = RunFiles { hdf5, ledger, log };
    Ok(Run::new(universe, files, task, scene, timers, before).until_the_end())
}

/// Prints a remark on rank 0 and hands the exit code on.
fn remark(universe: &Universe, code: u8, text: &str) -> u8 {
    if universe.world().rank() == 0 {
        launch::say(&format!("bsmpm-par: {text}"));
    }
    code
}

/// What is wrong where this process has fewer cores than threads, as where `mpirun` binds a rank to one core, or this
/// host fewer than all of its ranks have threads. Collective.
fn crowded(world: &SimpleCommunicator, threads: u32) -> Option<String> {
    let here = u64::from(threads) * u64::from(world.split_shared(world.rank()).size().unsigned_abs());
    let cores = std::thread::available_parallelism().ok()?.get();
    if threads as usize > cores {
        return Some(format!(
            "W0720: this rank has {threads} threads, but only {cores} core(s). The run is slow. Add `--bind-to none` or `--map-by \
             slot:PE={threads}` to mpirun."
        ));
    }
    let all = machine::processors().filter(|&all| threads > 1 && here > all)?;
    Some(format!(
        "W0721: the ranks of this host have {here} threads in all, but the host has only {all} processors. The run is \
         slow. Reduce `--threads` or the number of ranks."
    ))
}

/// The output directory, on rank 0, which from now on is nobody else's. Collective.
fn hold(universe: &Universe, arguments: &Arguments) -> Result<Option<OutputDirectory>, Refusal> {
    let world = universe.world();
    let unseen = if arguments.break_lock {
        Unseen::Break
    } else {
        Unseen::Respect
    };
    let held = (world.rank() == 0).then(|| OutputDirectory::hold(&arguments.directory(), unseen));
    agree(&world, held.transpose().map_err(Refusal::from))
}

/// The points, on the ranks of their slabs, and what is recorded of them. Collective.
fn scene<'p, K: Kinematics<D>, const D: usize>(
    libraries: Libraries<'p>,
    choice: Choice,
    case: &Case,
    cut: Cut,
    start: &RunStart<'_>,
    timers: Rc<Timers>,
    requests: Rc<Requests>,
) -> Result<RecordedSimulation<'p, K, D>, Refusal> {
    let universe = libraries.universe;
    let Cut { room, slabs, parts } = cut;
    let at = if let RunStart::Resumed(resumed) = start {
        resumed.state.progress.t
    } else {
        0.0
    };
    let mut model = model_at::<K, D>(case, at).map_err(|error| Refusal::new(exit::CASE, error.to_string()))?;
    let schedule = schedule(case);
    if let RunStart::Resumed(resumed) = start {
        let restarted = resumed.read(universe, case, &mut model, &schedule)?;
        let RestartedState {
            slabs,
            points,
            state,
            stepper,
        } = restarted;
        let partitioned = PartitionedModel { model, slabs, points };
        let mut simulation = Simulation::new(libraries, choice, partitioned, schedule, timers, requests);
        simulation.resume(resumed.state.steps, stepper, state);
        let recorder = Recorder::resume(case, &resumed.state.record);
        let recorder = recorder.ok_or_else(|| {
            Refusal::new(
                exit::CHECKPOINT,
                "E0719: the histories of the case differ from those of the run that wrote the checkpoint. The run \
                 cannot be continued. Restore the histories of the case, or start again with `--force`.",
            )
        })?;
        return Ok(RecordedSimulation { simulation, recorder });
    }
    model.grid = model.grid.within(std::array::from_fn(|axis| room[axis].clone()));
    let world = universe.world();
    let rank = world.rank().unsigned_abs() as usize;
    let slabs = parted::<K, D>(
        &world,
        rank,
        case,
        &model.grid,
        slabs.reaching(model.grid.beyond()),
        parts,
    );
    let slabs = slabs.ok_or_else(|| Refusal::new(exit::CASE, case.too_many(world.size().unsigned_abs() as usize)))?;
    let points = points::<K, D>(case, slabs.columns(rank), |x| {
        model.grid.locate(x).is_none_or(|cell| slabs.owner(&cell) == rank)
    });
    let partitioned = PartitionedModel { model, slabs, points };
    let simulation = Simulation::new(libraries, choice, partitioned, schedule, timers, requests);
    let recorder = Recorder::new(case, &simulation.points, &*simulation.halo);
    Ok(RecordedSimulation { simulation, recorder })
}

/// The slabs cut into their parts, by the points that they get: each of their ranks counts those of some columns.
/// Collective.
fn parted<K: Kinematics<D>, const D: usize>(
    world: &SimpleCommunicator,
    rank: usize,
    case: &Case,
    grid: &Grid<D>,
    slabs: Slabs,
    parts: usize,
) -> Option<Slabs> {
    if parts == 1 {
        return Some(slabs);
    }
    let columns = slabs.columns(rank / parts);
    let part = rank % parts;
    let start = columns.start + columns.len() * part / parts;
    let end = columns.start + columns.len() * (part + 1) / parts;
    let mut rows = Rows::none(grid, &slabs);
    seeds::<K, D>(case, start..end).for_each(|seed| rows.count(&seed.x));
    let mut counts = vec![0.0; rows.counts.len()];
    world.all_reduce_into(&rows.counts[..], &mut counts[..], SystemOperation::sum());
    load::parted(grid, slabs, &counts, parts)
}

/// What there was before.
fn before(start: &RunStart<'_>, directory: &Path, case: &Case, counts: SurfaceCounts) -> PriorState {
    let RunStart::Resumed(resumed) = start else {
        return PriorState::default();
    };
    let ResumedRun { state, .. } = &**resumed;
    PriorState {
        resumed: true,
        is_branch: !resumed.is_in(directory),
        last_frame: state.last_frame,
        issued: state.issued(case, counts),
        timers: state.files.manifest.timers.clone(),
        communication: state.files.manifest.communication.clone(),
        linear: state.files.manifest.linear.clone(),
        cpu_seconds: state.files.manifest.summary.cpu_seconds,
    }
}

/// The files, on rank 0. Collective.
fn ledger(
    universe: &Universe,
    held: Option<OutputDirectory>,
    arguments: &Arguments,
    case: &Case,
    columns: Vec<TableColumn>,
    start: &RunStart<'_>,
) -> Result<Option<RunWriter>, Refusal> {
    let world = universe.world();
    let ranks = world.size().unsigned_abs() as usize;
    let opened = held.map(|held| match start {
        RunStart::New(beginning) => RunWriter::open(held, beginning, arguments, case, ranks, columns),
        RunStart::Resumed(resumed) => RunWriter::resume(held, arguments, case, ranks, columns, resumed),
        RunStart::Complete(_) => unreachable!("such a run does not begin"),
    });
    agree(&world, opened.transpose().map_err(Refusal::from))
}
