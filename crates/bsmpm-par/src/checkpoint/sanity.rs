//! Checks that the material points in a checkpoint have physically possible values.

use super::refusal::{Refusal, agree};
use super::write::infinite;
use bsmpm::grid::Grid;
use bsmpm::points::{Number, Points};
use mpi::collective::{CommunicatorCollectives, SystemOperation};
use mpi::topology::SimpleCommunicator;
use std::ops::Range;
use std::path::Path;

/// Bits of a word.
const WORD: u64 = u64::BITS as u64;

/// Refuses points that cannot be a state of a run in this grid with so many materials and the ids `present`, of which
/// so many have left, or from 0 on without a gap. Collective.
///
/// # Errors
/// The same on all ranks (76): what is wrong with which point.
pub fn require<const D: usize>(
    world: &SimpleCommunicator,
    file: &Path,
    points: &mut Points<D>,
    grid: &Grid<D>,
    materials: usize,
    present: Option<&[Range<u64>]>,
    left: u64,
) -> Result<(), Refusal> {
    let own = finite(points).and_then(|()| possible(points, grid, materials));
    agree(world, own.map_err(|reason| Refusal::unusable(file, &reason)))?;
    let all = 0..u64::MAX;
    let present = present.unwrap_or(std::slice::from_ref(&all));
    let counted = once(world, &points.id, present, left);
    agree(world, counted.map_err(|reason| Refusal::unusable(file, &reason)))
}

fn finite<const D: usize>(points: &mut Points<D>) -> Result<(), String> {
    let found = points
        .named_columns()
        .into_iter()
        .filter(|(_, column)| column.number() == Number::F64)
        .find_map(|(name, column)| {
            let (p, value) = infinite(&*column)?;
            Some((name, p, value))
        });
    match found {
        None => Ok(()),
        Some((name, p, value)) => Err(format!("{name} of point {} is {value}", points.id[p])),
    }
}

fn possible<const D: usize>(points: &Points<D>, grid: &Grid<D>, materials: usize) -> Result<(), String> {
    for p in 0..points.len() {
        let wrong = if usize::from(points.material[p]) >= materials {
            "its material is none of the case"
        } else if grid.locate(&points.x[p]).is_none() {
            "its position x is outside the grid"
        } else if points.mass[p] < 0.0 {
            "its mass is negative"
        } else if points.volume[p] <= 0.0 {
            "its volume is not positive"
        } else if points.F.at(p).determinant() <= 0.0 {
            "det F is not positive"
        } else if points.state_of(p).iter().any(|number| *number < 0.0) {
            "the state of its law is negative"
        } else {
            continue;
        };
        return Err(format!("point {}: {wrong}", points.id[p]));
    }
    Ok(())
}

/// Every number of `present` once, as far as there are points, but for at most so many that have `left`, of which
/// stages may have taken some: a bit for each. Collective; `Err` on all ranks or none.
fn once(world: &SimpleCommunicator, ids: &[u64], present: &[Range<u64>], left: u64) -> Result<(), String> {
    let own = ids.len() as u64;
    let mut all = 0_u64;
    world.all_reduce_into(&own, &mut all, SystemOperation::sum());
    let expected: u64 = present.iter().map(|range| range.end - range.start).sum();
    if expected < all || (expected > all + left && expected != u64::MAX) {
        return Err(format!(
            "it has {all} points, where the case has {expected} at that time"
        ));
    }
    let places = if left > 0 { expected } else { all };
    let mut seen = vec![0_u64; places.div_ceil(WORD).max(1) as usize];
    for at in ids
        .iter()
        .filter_map(|&id| place(present, id))
        .filter(|at| *at < places)
    {
        seen[(at / WORD) as usize] |= 1 << (at % WORD);
    }
    let mut seen_by_all = vec![0_u64; seen.len()];
    world.all_reduce_into(&seen[..], &mut seen_by_all[..], SystemOperation::bitwise_or());
    // As many points as numbers: if no more are missing than may be, none is there twice.
    let mut missing = (0..)
        .zip(present.iter().cloned().flatten())
        .take(places as usize)
        .filter(|(at, _)| seen_by_all[(at / WORD) as usize] >> (at % WORD) & 1 == 0);
    match missing.nth((places - all) as usize) {
        None => Ok(()),
        Some(_) if left > 0 => Err(format!("it has {all} points, of which one is there twice")),
        Some((_, id)) => Err(format!(
            "it has {all} points, but none is point {id}: another is there twice"
        )),
    }
}

/// The place of a number among those of `present`.
fn place(present: &[Range<u64>], id: u64) -> Option<u64> {
    let mut before = 0;
    for range in present {
        if range.contains(&id) {
            return Some(before + id - range.start);
        }
        before += range.end - range.start;
    }
    None
}
