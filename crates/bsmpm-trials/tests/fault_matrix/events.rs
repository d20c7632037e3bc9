//! Tests that in the case of the fault tests soil yields, points move between ranks and a step is shortened.

use crate::ground::{Ground, Trial};
use crate::support::results::{all_frames, ids, steps};
use crate::table::{Tried, trials};
use bsmpm_io::frame::Frame;
use std::collections::BTreeMap;

/// m  Size of the case's cells.
const CELL: f64 = 0.1;

/// Everything that there is to be seen: frames and checkpoints after every fifth step.
fn seen(ground: &Ground) -> Trial {
    let trial = ground.trial(2);
    trial
        .start(&["--set", "output.checkpoint={every_steps=5,keep=100}"], &[])
        .end()
        .expect(0);
    trial
}

/// Where the slabs began at the checkpoint of a step: the state is a text, whose beginning is in one piece.
fn slabs(trial: &Trial, step: u64) -> Vec<usize> {
    let bytes = std::fs::read(trial.checkpoint(&format!("step_{step:09}.h5"))).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    let (_, rest) = text.split_once("\"slabs\":[").expect("slabs");
    rest.split(']')
        .next()
        .unwrap()
        .split(',')
        .map(|bound| bound.parse().unwrap())
        .collect()
}

/// The rank of every point, by id.
fn owners(frame: &Frame, slabs: &[usize]) -> BTreeMap<u64, usize> {
    let owner = |x: f64| slabs.iter().rposition(|&begin| begin <= (x / CELL) as usize).unwrap();
    ids(frame)
        .into_iter()
        .zip(frame.position.iter().map(|x| owner(x[0])))
        .collect()
}

/// Plastic flow from about the fifth step, points that change their rank before the fifteenth, a step that is cut.
pub fn all(ground: &Ground, _: usize) -> Tried {
    let mut reported = String::new();
    let tried = trials(1, |_| {
        let trial = seen(ground);
        let frames = all_frames(&trial.directory());
        let at = |step: u64| frames.iter().find(|frame| frame.step == step).expect("a frame");
        let flowing = at(5)
            .real("plastic_strain", 1)
            .unwrap()
            .iter()
            .filter(|&&strain| strain > 1e-4)
            .count();
        // The first slabs are the next ones, too: they are looked at after more steps than these.
        let ranks = [0, 5, 10, 15].map(|step| owners(at(step), &slabs(&trial, step.max(5))));
        let moved = ranks
            .windows(2)
            .flat_map(|two| two[0].iter().filter(|(id, rank)| two[1][id] != **rank))
            .count();
        let steps = steps(&trial.directory());
        let cuts = steps
            .get("cutbacks")
            .unwrap()
            .iter()
            .position(|&cuts| cuts > 0.0)
            .map_or(0, |row| row + 1);
        reported = format!("{flowing} points flow at step 5, {moved} change ranks by 15, step {cuts} is cut");
        assert!(flowing > 50 && moved >= 50 && (20..=26).contains(&cuts), "{reported}");
        moved as f64
    });
    tried.figure(|_| reported.clone())
}
