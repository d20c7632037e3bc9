//! Writes and reads checkpoints of synthetic material points: `checkpoints TASK ...`
//!
//! - `write DIRECTORY POINTS STEP [PHASE]` writes a checkpoint; rank 0 aborts in that phase.
//! - `storm DIRECTORY POINTS` writes checkpoints until it is killed.
//! - `newest FOLDER POINTS` and `named FILE POINTS` read and check one.

use bsmpm::points::{Points, Seed};
use bsmpm::tensor::{Symmetric, Tensor, Vector};
use bsmpm_io::checkpoint::{Facts, Phase, Store};
use bsmpm_par::checkpoint::{self, CheckpointChoice, Contents, OpenCheckpoint, Refusal};
use bsmpm_par::launch;
use hdf5_collective::Hdf5;
use mpi::environment::Universe;
use mpi::topology::Communicator;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let universe = match launch::start() {
        Ok(universe) => universe,
        Err(code) => return code.into(),
    };
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let hdf5 = Hdf5::initialize(&universe).expect("HDF5 starts");
    let number = |text: &str| text.parse().expect("a number");
    let done = match arguments[..] {
        ["write", directory, points, step] => write(&universe, &hdf5, directory, number(points), number(step), None),
        ["write", directory, points, step, phase] => {
            write(&universe, &hdf5, directory, number(points), number(step), Some(phase))
        }
        ["storm", directory, points] => {
            (1..).try_for_each(|step| write(&universe, &hdf5, directory, number(points), step, None))
        }
        ["newest", folder, points] => read(
            &universe,
            &hdf5,
            CheckpointChoice::Newest(Path::new(folder)),
            number(points),
        ),
        ["named", file, points] => read(
            &universe,
            &hdf5,
            CheckpointChoice::Named(Path::new(file)),
            number(points),
        ),
        _ => panic!("no task: {arguments:?}"),
    };
    let Err(refusal) = done else { return ExitCode::SUCCESS };
    if universe.world().rank() == 0 {
        launch::say(&refusal.reason);
    }
    refusal.code.into()
}

fn write(
    universe: &Universe,
    hdf5: &Hdf5<'_>,
    directory: &str,
    count: u64,
    step: u64,
    phase: Option<&str>,
) -> Result<(), Refusal> {
    let world = universe.world();
    let rank = world.rank() as u64;
    let ranks = world.size() as u64;
    // Unequal shares, and none at all for the last of several ranks.
    let cut = |rank: u64| {
        if rank + 1 >= ranks {
            count
        } else {
            count * (rank * (rank + 1)) / (ranks * (ranks - 1))
        }
    };
    let own = if ranks == 1 {
        0..count
    } else if rank + 1 == ranks {
        count..count
    } else {
        cut(rank)..cut(rank + 1)
    };
    let mut points = points(own, step);
    let store = (rank == 0).then(|| Store::open(Path::new(directory), 2).expect("a directory"));
    let facts = Facts {
        version: env!("CARGO_PKG_VERSION").into(),
        case: "0".repeat(64),
        ranks: ranks as u32,
        step,
        time: step as f64 / 3.0,
    };
    let state = state(step);
    let guess = guess(rank, step);
    let contents = Contents {
        columns: points.named_columns(),
        guess: (guess.into(), WIDTH),
        state: state.as_bytes(),
    };
    let strike = |now: Phase| {
        if rank == 0 && phase.is_some_and(|phase| phase == format!("{now:?}")) {
            std::process::abort();
        }
    };
    checkpoint::write(hdf5, &world, store.as_ref(), &facts, &contents, &strike).map(|_| ())
}

fn read(universe: &Universe, hdf5: &Hdf5<'_>, wanted: CheckpointChoice<'_>, count: u64) -> Result<(), Refusal> {
    let world = universe.world();
    let (found, passed_over) = checkpoint::find(&world, wanted)?;
    passed_over
        .iter()
        .for_each(|warning| launch::say(&format!("passed over: {warning}")));
    let Some(found) = found else {
        if world.rank() == 0 {
            launch::say("no checkpoint");
        }
        return Ok(());
    };
    let law_state = found
        .record
        .arrays
        .iter()
        .find(|array| array.name == "law_state")
        .map_or(0, |array| array.width as usize);
    let names: Vec<&str> = found.record.arrays.iter().map(|array| array.name.as_str()).collect();
    let mut held = Points::<2>::holding(&names, law_state);
    let opened = OpenCheckpoint::new(hdf5, universe.world(), &found)?;
    let text = opened.state()?;
    opened.points(held.named_columns())?;
    let layers = 2 * found.record.ranks as usize;
    for rank in 0..u64::from(found.record.ranks) {
        let at = (2 * rank) as usize;
        assert_eq!(
            opened.guess(layers, WIDTH, at..at + 2)?,
            guess(rank, found.record.step),
            "another displacement"
        );
    }
    opened.close()?;
    let rank = world.rank() as u64;
    let ranks = world.size() as u64;
    let start = |rank: u64| rank * (count / ranks) + rank.min(count % ranks);
    assert_eq!(
        held,
        points(start(rank)..start(rank + 1), found.record.step),
        "other points"
    );
    assert_eq!(text, state(found.record.step).as_bytes());
    if rank == 0 {
        launch::say(&format!(
            "good: step {} of {} ranks",
            found.record.step, found.record.ranks
        ));
    }
    Ok(())
}

/// Numbers of a layer of nodes.
const WIDTH: usize = 6;

/// Two layers of nodes of a rank.
fn guess(rank: u64, step: u64) -> Vec<f64> {
    (0..2 * WIDTH as u64)
        .map(|at| ((rank * 100 + at) as f64).cos() * step as f64)
        .collect()
}

fn state(step: u64) -> String {
    format!("{{\"step\":{step},\"text\":\"{}\"}}", "a longer text ".repeat(2000))
}

/// Points whose every number follows from id and step.
fn points(ids: std::ops::Range<u64>, step: u64) -> Points<2> {
    let number = |id: u64, which: u64| ((id * 37 + which) as f64).sin() * 10_f64.powi((step % 7) as i32);
    let vector = |id, which| Vector::from_fn(|row, _| number(id, which + row as u64));
    let seed = |id| Seed {
        id,
        material: (id % 3) as u16,
        x: vector(id, 0),
        volume: number(id, 2),
        mass: number(id, 3),
        v: vector(id, 4),
    };
    let in_plane = |id, first| {
        let couples = |row, column| (row == 2) != (column == 2);
        let entry = |row, column| number(id, first + (3 * row + column) as u64);
        Tensor::from_fn(|row, column| if couples(row, column) { 0.0 } else { entry(row, column) })
    };
    let mut points = Points::from_seeds(ids.clone().map(seed), true);
    for (p, id) in ids.clone().enumerate() {
        points.u[p] = vector(id, 6);
        points.F.set(p, in_plane(id, 8));
        points.b_e.set(p, Symmetric::of(&in_plane(id, 17)));
        points.sigma.set(p, Symmetric::of(&in_plane(id, 26)));
        points.eps_p[p] = number(id, 40);
    }
    points.gap = Some(ids.map(|id| number(id, 41)).collect());
    points
}
