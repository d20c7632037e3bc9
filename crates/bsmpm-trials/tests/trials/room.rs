//! Tests that empty cells around the material change neither results nor cost.

use crate::support::cases::{EXACT, SLIDING_BLOCK, changed};
use crate::support::results::manifest;
use crate::support::{Scratch, shipped};
use std::path::Path;

/// The histories and the frame of a step, as bytes.
fn left(directory: &Path, step: usize) -> (Vec<u8>, Vec<u8>) {
    let read = |name: &str| std::fs::read(directory.join(name)).unwrap();
    (read("history.csv"), read(&format!("frames/step_{step:09}.vtu")))
}

/// What the case leaves after so many steps on these numbers of ranks, in grids of these upper corners, all with
/// `further`.
#[track_caller]
fn agree(scratch: &Scratch, ranks: &[usize], uppers: &[&str], further: &[&str], step: usize) {
    let steps = step.to_string();
    let mut first = None;
    for (ranks, upper) in ranks
        .iter()
        .flat_map(|ranks| uppers.iter().map(move |upper| (*ranks, upper)))
    {
        let upper = format!("grid.upper={upper}");
        let arguments = ["case.toml", "-q", "--force", "--max-steps", &steps, "--set", &upper];
        scratch.mpirun(ranks, &[&arguments[..], further].concat()).expect(75);
        let found = left(&scratch.path("case.out"), step);
        assert!(
            *first.get_or_insert_with(|| found.clone()) == found,
            "{ranks} ranks, {upper}"
        );
    }
}

/// The block outruns its room along the floor. Of the walls it never sees any.
#[test]
fn the_sliding_block_has_the_same_bits_in_a_grid_ten_times_as_long_and_as_high_on_1_2_and_4_ranks() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    agree(
        &scratch,
        &[1, 2, 4],
        &["[1.0,0.3]", "[10.0,0.3]", "[10.0,3.0]"],
        &EXACT,
        40,
    );
}

/// A grid of 14 columns is held whole from the start, one of 20 is not: there the block outruns its room in the first
/// steps. After 24 steps two empty cells are left to the wall of the short one: the block touches no function that a
/// wall changes.
#[test]
fn a_room_that_is_made_again_has_the_bits_of_a_grid_that_is_held_whole() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    agree(&scratch, &[1, 3], &["[0.7,0.3]", "[1.0,0.3]", "[3.0,0.9]"], &EXACT, 24);
}

/// Sums over cells and functions beyond those of a cell reach further than the points do.
#[test]
fn what_couples_further_than_a_cell_has_the_same_bits_in_larger_grids() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    for order in ["linear", "quadratic", "cubic"] {
        let order = format!("grid.degree={order}");
        let set = [
            &["--set", "stabilisation.method=consistent-f-bar", "--set", &order],
            &EXACT[..],
        ]
        .concat();
        agree(&scratch, &[1, 3], &["[1.0,0.3]", "[6.0,1.8]"], &set, 30);
    }
}

/// A strip and its penalty, whose points lie at the edge of the material or beyond it.
#[test]
fn the_footing_has_the_same_bits_in_a_grid_ten_times_as_high() {
    let scratch = Scratch::with_case(&std::fs::read_to_string(shipped("short/strip_footing.toml")).unwrap());
    agree(&scratch, &[1], &["[5.0,7.0]", "[5.0,70.0]"], &[], 4);
}

/// The newest checkpoint of a run: its bytes, and the room that its state reports, a text in one piece.
fn newest(directory: &Path) -> (usize, String) {
    let files = std::fs::read_dir(directory.join(bsmpm_io::checkpoint::FOLDER)).unwrap();
    let files = files
        .map(|file| file.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "h5"));
    let bytes = std::fs::read(files.max().unwrap()).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    let (_, rest) = text.split_once("\"room\":").expect("a room");
    (bytes.len(), rest.split("]]").next().unwrap().to_owned())
}

/// What a checkpoint holds, and what it goes on from, is the room at that time; where the block has moved on, it is
/// another one.
#[test]
fn a_run_in_a_large_grid_goes_on_to_the_bit_and_keeps_no_more() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    let mut found = Vec::new();
    for (name, upper) in [("small", "[1.0,0.3]"), ("large", "[10.0,3.0]")] {
        let upper = format!("grid.upper={upper}");
        let case = ["case.toml", "-q", "--set", &upper, "-o", name, "--restart", "auto"];
        for stop in ["7", "33"] {
            scratch
                .mpirun(2, &[&case[..], &["--max-steps", stop]].concat())
                .expect(75);
            found.push(newest(&scratch.path(name)));
        }
        scratch.mpirun(2, &case).expect(0);
        scratch
            .mpirun(2, &["case.toml", "-q", "--force", "--set", &upper, "-o", "whole"])
            .expect(0);
        let last = manifest(&scratch.path("whole")).summary.steps as usize;
        assert!(
            left(&scratch.path("whole"), last) == left(&scratch.path(name), last),
            "{name}"
        );
    }
    assert_ne!(found[2].1, found[3].1, "the block has outrun its room");
    assert!(found[3].0 < found[1].0 + found[1].0 / 10, "{found:?}");
}

/// A body of one column, whose room has fewer columns than ranks go on with it.
#[test]
fn more_ranks_than_the_room_had_columns_can_go_on() {
    let narrow = changed(SLIDING_BLOCK, "upper = [0.5, 0.2]", "upper = [0.15, 0.2]");
    let scratch = Scratch::with_case(&changed(&narrow, "quadratic", "linear"));
    scratch.mpirun(1, &["case.toml", "-q", "-o", "whole"]).expect(0);
    let part = ["case.toml", "-q", "-o", "part", "--restart", "auto"];
    scratch
        .mpirun(1, &[&part[..], &["--max-steps", "3"]].concat())
        .expect(75);
    scratch.mpirun(9, &part).expect(0);
    let [whole, part] = ["whole", "part"].map(|name| crate::support::results::last_frame(&scratch.path(name)));
    for (field, difference) in crate::support::results::differences(&part, &whole) {
        assert!(difference <= 1e-9, "{field} differs by {difference:.1e}");
    }
}
