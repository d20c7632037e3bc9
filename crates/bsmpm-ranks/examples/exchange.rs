//! Tests messages of many lengths between all ranks: `exchange BLOCK`, with blocks of BLOCK bytes.

use bsmpm_ranks::traffic::Traffic;
use bsmpm_ranks::{launch, migrate};
use mpi::topology::{Communicator, SimpleCommunicator};
use std::process::ExitCode;

/// What one rank sends to another: none to some, less than a block, whole blocks, and more.
fn message(from: usize, to: usize, block: usize) -> Vec<u8> {
    let length = [0, 1, block - 1, block, 3 * block + 2][(2 * from + to) % 5];
    (0..length).map(|at| (at * 31 + from * 7 + to * 3) as u8).collect()
}

/// A panic on one rank ends all of them.
fn end(world: &SimpleCommunicator, reason: &str) -> ! {
    eprintln!("exchange: {reason}");
    launch::abort(world, 1)
}

fn main() -> ExitCode {
    let universe = match launch::start(end) {
        Ok(universe) => universe,
        Err(failure) => panic!("{failure}"),
    };
    let world = universe.world();
    let rank = world.rank() as usize;
    let ranks = world.size() as usize;
    let block: usize = std::env::args()
        .nth(1)
        .expect("a block")
        .parse()
        .expect("a number of bytes");
    for round in 0..5 {
        let outgoing: Vec<(usize, Vec<u8>)> = (0..ranks).map(|to| (to, message(rank + round, to, block))).collect();
        let incoming = migrate::exchange(&world, &Traffic::default(), &outgoing, block);
        let all = (0..ranks).map(|from| (from, message(from + round, rank, block)));
        let expected: Vec<(usize, Vec<u8>)> = all.filter(|(_, message)| !message.is_empty()).collect();
        assert!(incoming == expected, "rank {rank} got other bytes in round {round}");
    }
    ExitCode::SUCCESS
}
