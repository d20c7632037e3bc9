//! Prints hashes of a checkpoint's arrays and other state, to compare runs: `arrays FILE`.

use bsmpm::points::Points;
use bsmpm_par::checkpoint::{CheckpointChoice, CheckpointState, OpenCheckpoint, Refusal, find};
use bsmpm_par::launch;
use hdf5_collective::Hdf5;
use mpi::environment::Universe;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let universe = match launch::start() {
        Ok(universe) => universe,
        Err(code) => return code.into(),
    };
    let file = std::env::args_os().nth(1).expect("a file");
    match print(&universe, Path::new(&file)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(refusal) => {
            launch::say(&refusal.reason);
            refusal.code.into()
        }
    }
}

fn print(universe: &Universe, file: &Path) -> Result<(), Refusal> {
    let hdf5 = Hdf5::initialize(universe).expect("HDF5 starts");
    let (found, _) = find(&universe.world(), CheckpointChoice::Named(file))?;
    let found = found.expect("a checkpoint that is named is found or refused");
    let opened = OpenCheckpoint::new(&hdf5, universe.world(), &found)?;
    let law_state = found
        .record
        .arrays
        .iter()
        .find(|array| array.name == "law_state")
        .map_or(0, |array| array.width as usize);
    let names: Vec<&str> = found.record.arrays.iter().map(|array| array.name.as_str()).collect();
    let mut points = Points::<2>::holding(&names, law_state);
    opened.points(points.named_columns())?;
    for (name, column) in points.named_columns() {
        let mut bytes = Vec::new();
        (0..column.rows()).for_each(|p| column.put(p, &mut bytes));
        println!("{name} {}", blake3::hash(&bytes));
    }
    let guess = found.record.array("guess").expect("the nodal displacement");
    let rows = guess.rows as usize;
    let guess = opened.guess(rows, guess.width as usize, 0..rows)?;
    let bytes: Vec<u8> = guess.iter().flat_map(|value| value.to_le_bytes()).collect();
    println!("guess {}", blake3::hash(&bytes));
    let state = CheckpointState::parse(&found.path, &opened.state()?)?;
    let rest = format!(
        "{:?} {:?} {:?} {:?} {:?} {:?}",
        state.steps, state.slabs, state.progress, state.traction, state.position, state.record
    );
    println!("state {}", blake3::hash(rest.as_bytes()));
    opened.close()
}
