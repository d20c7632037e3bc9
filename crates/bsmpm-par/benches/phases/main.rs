//! Measures the phases of a step, starting at a checkpoint: `phases CASE CHECKPOINT SECONDS [--set KEY=VALUE]...`

mod kernels;
mod machine;

use bsmpm::interactions::state::InteractionState;
use bsmpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain, Solid};
use bsmpm::model::Model;
use bsmpm::points::Points;
use bsmpm::schedule::TimeInterval;
use bsmpm_par::checkpoint::{self, CheckpointChoice, OpenCheckpoint};
use bsmpm_par::{launch, setup};
use bsmpm_ranks::halo::MpiHalo;
use bsmpm_ranks::linear::KspSolver;
use bsmpm_ranks::signals::Requests;
use bsmpm_ranks::slab::Slabs;
use bsmpm_ranks::timers::Timers;
use bsmpm_scene::{Case, Geometry};
use hdf5_collective::Hdf5;
use mpi::environment::Universe;
use petsc_rs::Petsc;
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use std::rc::Rc;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| argument != "--bench")
        .collect();
    let [case, checkpoint, seconds, rest @ ..] = &arguments[..] else {
        // `cargo bench` and `cargo test --benches` start it without a case: there is nothing to measure.
        println!("usage: phases CASE CHECKPOINT SECONDS [--set KEY=VALUE]...");
        return ExitCode::SUCCESS;
    };
    let set: Vec<String> = rest.iter().filter(|argument| *argument != "--set").cloned().collect();
    let Ok(universe) = launch::start() else {
        return ExitCode::FAILURE;
    };
    let seconds = seconds.parse().map_err(Into::into);
    match seconds.and_then(|seconds| measure(&universe, case, &set, checkpoint, seconds)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("phases: {error}");
            ExitCode::FAILURE
        }
    }
}

/// A state of a run.
struct State<const D: usize> {
    points: Points<D>, // sorted by cell
    interactions: InteractionState<D>,
    guess: Vec<f64>, // m, nodal displacement of the last step
    time: f64,       // s
}

/// What a checkpoint holds.
fn state<K: Kinematics<D>, const D: usize>(
    universe: &Universe,
    path: &Path,
    model: &mut Model<K, D>,
) -> Result<State<D>, Box<dyn Error>> {
    let hdf5 = Hdf5::initialize(universe)?;
    let refused = |refusal: checkpoint::Refusal| refusal.reason;
    let (found, _) = checkpoint::find(&universe.world(), CheckpointChoice::Named(path)).map_err(refused)?;
    let found = found.ok_or("there is no checkpoint")?;
    let names: Vec<&str> = found.record.arrays.iter().map(|array| array.name.as_str()).collect();
    let width = bsmpm::material::state_width(&model.materials);
    let mut points = Points::holding(&names, width);
    let opened = OpenCheckpoint::new(&hdf5, universe.world(), &found).map_err(refused)?;
    opened.points(points.named_columns()).map_err(refused)?;
    let state = opened
        .state()
        .and_then(|text| checkpoint::CheckpointState::parse(path, &text))
        .map_err(refused)?;
    model.grid = state.within(&model.grid).ok_or("the checkpoint is of another grid")?;
    if !state.parts.is_empty() {
        return Err("the checkpoint is of slabs that are cut into parts".into());
    }
    let layers = model.grid.layers().len();
    let guess = opened
        .guess(layers, model.grid.layer_nodes() * D, 0..layers)
        .map_err(refused)?;
    opened.close().map_err(refused)?;
    let mut interactions = state
        .interactions()
        .ok_or("the checkpoint's surfaces are of another case")?;
    let columns = state
        .free_field
        .iter()
        .map(|column| column.column(width))
        .collect::<Option<_>>();
    interactions.columns = columns.ok_or("the columns of the checkpoint's free field are not whole")?;
    points.sort_by_cell(&model.grid);
    Ok(State {
        points,
        interactions,
        guess,
        time: found.record.time(),
    })
}

fn measure(universe: &Universe, case: &str, set: &[String], path: &str, seconds: f64) -> Result<(), Box<dyn Error>> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build_global()?;
    let text = bsmpm_scene::load(Path::new(case))?;
    let case = Case::from_bytes(case, &text, set).map_err(|errors| format!("{errors:?}"))?;
    match case.geometry {
        Geometry::PlaneStrain => measure_in::<PlaneStrain, 2>(universe, &case, path, seconds),
        Geometry::Axisymmetric => measure_in::<Axisymmetric, 2>(universe, &case, path, seconds),
        Geometry::Solid => measure_in::<Solid, 3>(universe, &case, path, seconds),
    }
}

fn measure_in<K: Kinematics<D>, const D: usize>(
    universe: &Universe,
    case: &Case,
    path: &str,
    seconds: f64,
) -> Result<(), Box<dyn Error>> {
    let mut model = bsmpm_scene::model::model::<K, D>(case)?;
    let State {
        points,
        interactions,
        guess,
        time,
    } = state(universe, Path::new(path), &mut model)?;
    let columns = model.grid.columns();
    let slabs = Slabs::new(vec![columns.start, columns.end], 1, columns).ok_or("no columns")?;
    let timers = Rc::new(Timers::default());
    let requests = Rc::new(Requests::default());
    let halo = Rc::new(MpiHalo::new(
        universe.world(),
        &slabs,
        &model.grid,
        Rc::clone(&timers),
        requests,
    ));
    let choice = setup::linear(case, 1, &[]);
    let petsc = Petsc::initialize(universe, &choice.options())?;
    let mut solver = KspSolver::<D, D>::new(&petsc, choice, &model.grid, Rc::clone(&halo), timers);
    println!(
        "| {} points, {:.4} s | ns per point | bytes per point, read and written | of a step |",
        points.len(),
        time
    );
    println!("| --- | --- | --- | --- |");
    let bench = kernels::Bench {
        model: &model,
        points: &points,
        state: &interactions,
        halo: &*halo,
        interval: TimeInterval {
            start: time,
            dt: case.analysis.dt,
        },
        seconds,
    };
    bench.run(&guess, &mut solver)?;
    println!(
        "| bytes of a point; with its shape functions and two trial states | {} | | |",
        kernels::bytes(points, &model)
    );
    let triad = machine::triad(seconds);
    let multiply_add = machine::multiply_add(seconds);
    println!("| triad, GB/s; dependent-free multiply-add, GFlop/s | {triad:.1}; {multiply_add:.1} | | |");
    Ok(())
}
